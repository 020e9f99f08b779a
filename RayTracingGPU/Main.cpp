// ray-tracing-gpu: flags to options, options to a session, and the engine it drives.
#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options.h"
#include "Common/App/Session.h"
#include "Common/Core/Log.h"
#include "Common/Core/RunMain.h"
#include "RayTracingGPU/GpuEngine.h"

namespace {

using rt::app::kGpuProgram;

// The device is opened only when something is to be rendered.
rt::ExitCode render(const rt::app::Options& options) {
    std::optional<rt::vulkan::VulkanContext> context;
    const rt::ExitCode code = rt::app::runSession(options, [&] {
        context.emplace(rt::vulkan::ContextOptions{options.device, options.validation});
        return rt::gpu::makeGpuEngine(*context);
    });
    if (context && context->validationMessages() > 0) {
        throw rt::RenderError(std::to_string(context->validationMessages()) + " messages of Vulkan's validation");
    }
    return code;
}

int run(const std::vector<std::string>& arguments) {
    const auto options = rt::app::parseOptions(kGpuProgram, arguments, std::cout);
    if (!options) return 0;  // --help, --version
    rt::setUpLog({kGpuProgram, options->quiet, options->verbose, options->logFile});
    if (options->command == rt::app::Command::ListDevices) {
        const rt::vulkan::Instance instance(options->validation);
        std::cout << rt::vulkan::describeDevices(rt::vulkan::findDevices(instance));
        return 0;
    }
    return static_cast<int>(render(*options));
}

}  // namespace

int main(int argc, char** argv) {
    return rt::runMain(kGpuProgram, [&] { return run({argv + std::min(argc, 1), argv + argc}); });
}
