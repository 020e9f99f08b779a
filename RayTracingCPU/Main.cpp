// ray-tracing-cpu: flags to options, options to a session, and the engine it drives.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/App/Ranks/Ranks.h"
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

std::unique_ptr<rt::app::Engine> makeEngine(rt::app::Policy policy, std::uint32_t threads) {
    rt::cpu::CpuEngineOptions engine;
    engine.policy = enginePolicy(policy);
    engine.threads = threads;
    return rt::cpu::makeCpuEngine(engine);
}

rt::app::EngineFactory engineFactory(const rt::app::Options& options, const rt::app::Communicator* ranks) {
    const bool isShare = ranks != nullptr && options.threads == 0;
    const std::uint32_t threads = isShare ? rt::app::threadsOfRank(*ranks) : options.threads;
    return [policy = options.policy, threads] { return makeEngine(policy, threads); };
}

int run(const std::vector<std::string>& arguments, rt::app::Communicator* ranks) {
    const auto options = rt::app::parseOptions(kProgram, arguments, std::cout);
    if (!options) return 0; // --help, --version
    rt::setUpLog({kProgram, options->quiet, options->verbose, options->logFile});
    if (options->window && ranks != nullptr) throw rt::UsageError(rt::app::kNoWindowOfRanks);
    if (options->window) {
#ifdef RT_HAS_WINDOW
        return static_cast<int>(rt::gui::runWindow(
            *options,
            {[](const rt::app::EngineChoice& choice) { return makeEngine(choice.policy, choice.threads); }, {}}));
#else
        throw rt::UsageError(rt::app::kNoWindow);
#endif
    }
    return static_cast<int>(rt::app::runSession(*options, engineFactory(*options, ranks), ranks));
}

// As a rank other than 0, whose messages are rank 0's. False: rank 0 has not ended it yet.
bool follow(const std::vector<std::string>& arguments, rt::app::Communicator& ranks) {
    std::ostream nowhere(nullptr);
    const auto options = rt::app::parseOptions(kProgram, arguments, nowhere);
    if (!options || options->window || options->command != rt::app::Command::Render) return false;
    rt::setUpLog({kProgram, true, false, ""});
    return rt::app::followSession(*options, engineFactory(*options, &ranks), ranks);
}

} // namespace

int main(int argc, char** argv) {
    return rt::runMain(kProgram, [&] {
        const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
        const std::unique_ptr<rt::app::Communicator> ranks = rt::app::joinRanks();
        return rt::app::runOnRank(
            ranks.get(), [&] { return run(arguments, ranks.get()); }, [&] { return follow(arguments, *ranks); });
    });
}
