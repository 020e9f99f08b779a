// ray-tracing-gpu: flags to options, options to a session, and the engine it drives.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Ranks/Ranks.h"
#include "Common/App/Session/Session.h"
#include "Common/Core/Log.h"
#include "Common/Core/RunMain.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuEngine.h"
#include "RayTracingGPU/OwningEngine.h"
#ifdef RT_HAS_WINDOW
#include "Common/Gui/App.h"
#endif

namespace {

using rt::app::kGpuProgram;

// The device is opened only when something is to be rendered.
class Device {
  public:
    Device(const rt::app::Options& options, const rt::app::Communicator* ranks) : options_(options), ranks_(ranks) {}
    std::unique_ptr<rt::app::Engine> makeEngine() {
        const std::string device = ranks_ == nullptr || !options_.device.empty() ? options_.device : deviceOfRank();
        context_.emplace(
            rt::vulkan::ContextOptions{device, options_.validation, rt::gpu::neededBy(options_.gpuEngine)});
        return rt::gpu::makeGpuEngine(*context_, {.engine = options_.gpuEngine,
                                                  .measures = ranks_ == nullptr,
                                                  .passSeconds = rt::gpu::kUnwatchedPassSeconds});
    }

  private:
    // The ranks of a host take devices like the best one in turn.
    std::string deviceOfRank() const {
        const rt::vulkan::Instance instance(false);
        const std::vector<std::size_t> places =
            rt::vulkan::devicesForRanks(rt::vulkan::findDevices(instance), rt::gpu::neededBy(options_.gpuEngine));
        return std::to_string(places[static_cast<std::size_t>(ranks_->localRank()) % places.size()]);
    }

    const rt::app::Options& options_;
    const rt::app::Communicator* ranks_;
    std::optional<rt::vulkan::VulkanContext> context_;
};

rt::ExitCode render(const rt::app::Options& options, rt::app::Communicator* ranks) {
    rt::ExitCode code;
    {
        Device device(options, ranks);
        const auto makeEngine = [&] { return device.makeEngine(); };
        code = rt::app::runSession(options, makeEngine, ranks);
    }
    if (const std::uint64_t messages = rt::vulkan::Instance::allValidationMessages(); messages > 0) {
        throw rt::RenderError(std::to_string(messages) + " messages of Vulkan's validation");
    }
    return code;
}

#ifdef RT_HAS_WINDOW

std::vector<rt::app::EngineDevice> suitableDevices() {
    const rt::vulkan::Instance instance(false);
    const std::vector<rt::vulkan::DeviceInfo> all = rt::vulkan::findDevices(instance);
    std::vector<rt::app::EngineDevice> suitable;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].suitable()) continue;
        const auto isNamesake = [&](const auto& device) { return device.name.find(all[i].name) != std::string::npos; };
        const bool isUnique = std::count_if(all.begin(), all.end(), isNamesake) == 1;
        suitable.push_back(
            {all[i].name, isUnique ? all[i].name : std::to_string(i), rt::gpu::enginesOf(all[i]), all[i].isSoftware()});
    }
    return suitable;
}

rt::ExitCode showWindow(const rt::app::Options& options) {
    rt::gui::WindowProgram program;
    program.makeEngine = [&options](const rt::app::EngineChoice& choice) {
        const rt::vulkan::ContextOptions context{choice.device, options.validation, rt::gpu::neededBy(choice.kind)};
        return std::make_unique<rt::gpu::OwningEngine>(context, rt::gpu::GpuEngineOptions{.engine = choice.kind});
    };
    program.devices = suitableDevices();
    return rt::gui::runWindow(options, program);
}

#else

rt::ExitCode showWindow(const rt::app::Options&) {
    throw rt::UsageError(rt::app::kNoWindow);
}

#endif

int run(const std::vector<std::string>& arguments, rt::app::Communicator* ranks) {
    const auto options = rt::app::parseOptions(kGpuProgram, arguments, std::cout);
    if (!options) return 0; // --help, --version
    rt::setUpLog({kGpuProgram, options->quiet, options->verbose, options->logFile});
    if (options->command == rt::app::Command::ListDevices && ranks == nullptr) {
        const rt::vulkan::Instance instance(options->validation);
        std::cout << rt::vulkan::describeDevices(rt::vulkan::findDevices(instance));
        return 0;
    }
    if (options->window && ranks != nullptr) throw rt::UsageError(rt::app::kNoWindowOfRanks);
    return static_cast<int>(options->window ? showWindow(*options) : render(*options, ranks));
}

// As a rank other than 0, whose messages are rank 0's. False: rank 0 has not ended it yet.
bool follow(const std::vector<std::string>& arguments, rt::app::Communicator& ranks) {
    std::ostream nowhere(nullptr);
    const auto options = rt::app::parseOptions(kGpuProgram, arguments, nowhere);
    if (!options || options->window || options->command != rt::app::Command::Render) return false;
    rt::setUpLog({kGpuProgram, true, false, ""});
    Device device(*options, &ranks);
    const auto makeEngine = [&] { return device.makeEngine(); };
    return rt::app::followSession(*options, makeEngine, ranks);
}

} // namespace

int main(int argc, char** argv) {
    return rt::runMain(kGpuProgram, [&] {
        const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
        const std::unique_ptr<rt::app::Communicator> ranks = rt::app::joinRanks();
        return rt::app::runOnRank(
            ranks.get(), [&] { return run(arguments, ranks.get()); }, [&] { return follow(arguments, *ranks); });
    });
}
