#include "Common/Bench/Machine.h"

#include <chrono>
#include <thread>

#include "Common/Core/BuildInfo.h"
#include "Common/Core/CpuFeatures.h"
#include "Common/Core/TimeText.h"

namespace rt::bench {
namespace {

std::string today() {
    using std::chrono::system_clock;
    return utcText(system_clock::to_time_t(system_clock::now()), "%Y-%m-%d %H:%M UTC");
}

std::string compiler() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#elif defined(_MSC_VER)
    return "Visual C++ " + std::to_string(_MSC_VER);
#else
    return "unknown";
#endif
}

std::string systemName() {
#if defined(__linux__)
    return "Linux";
#elif defined(_WIN32)
    return "Windows";
#elif defined(__APPLE__)
    return "macOS";
#else
    return "unknown";
#endif
}

} // namespace

std::vector<Fact> machineFacts() {
    std::vector<Fact> facts = {{"date", today()},
                               {"program", "ray-tracing-bench " + programVersion()},
                               {"compiler", compiler()},
                               {"system", systemName()},
                               {"processor", processorName()},
                               {"instruction set", name(bestInstructionSet())},
                               {"hardware threads", std::to_string(std::thread::hardware_concurrency())}};
#ifndef NDEBUG
    facts.push_back({"build", "with assertions: not for figures"});
#endif
    return facts;
}

} // namespace rt::bench
