// ray-tracing-cpu: flags to options, options to a session, and the engine it drives.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/Session.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/RunMain.h"
#include "RayTracingCPU/CpuEngine.h"
#ifdef RT_HAS_WINDOW
#include "Common/Gui/App.h"
#endif

namespace {

constexpr const char* kProgram = "ray-tracing-cpu";

rt::cpu::Policy enginePolicy(rt::app::Policy policy) {
    switch (policy) {
        case rt::app::Policy::Seq:
            return rt::cpu::Policy::Seq;
        case rt::app::Policy::ParUnseq:
            return rt::cpu::Policy::ParUnseq;
        case rt::app::Policy::Par:
            break;
    }
    return rt::cpu::Policy::Par;
}

int run(const std::vector<std::string>& arguments) {
    const auto options = rt::app::parseOptions(kProgram, arguments, std::cout);
    if (!options) return 0; // --help, --version
    rt::setUpLog({kProgram, options->quiet, options->verbose, options->logFile});
    const auto makeEngine = [](rt::app::Policy policy, std::uint32_t threads) {
        rt::cpu::CpuEngineOptions engine;
        engine.policy = enginePolicy(policy);
        engine.threads = threads;
        return rt::cpu::makeCpuEngine(engine);
    };
    if (options->window) {
#ifdef RT_HAS_WINDOW
        return static_cast<int>(rt::gui::runWindow(*options, {[&makeEngine](const rt::app::EngineChoice& choice) {
                                                                  return makeEngine(choice.policy, choice.threads);
                                                              },
                                                              {}}));
#else
        throw rt::UsageError(rt::app::kNoWindow);
#endif
    }
    return static_cast<int>(
        rt::app::runSession(*options, [&] { return makeEngine(options->policy, options->threads); }));
}

} // namespace

int main(int argc, char** argv) {
    return rt::runMain(kProgram, [&] { return run({argv + std::min(argc, 1), argv + argc}); });
}
