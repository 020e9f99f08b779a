#include "Common/Core/Log.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"

namespace rt {
namespace {

using Level = spdlog::level::level_enum;

Level levelNamed(const std::string& name) {
    for (const auto& [text, level] : {std::pair{"trace", Level::trace},
                                      {"debug", Level::debug},
                                      {"info", Level::info},
                                      {"warn", Level::warn},
                                      {"error", Level::err},
                                      {"off", Level::off}})
        if (name == text) return level;
    throw UsageError("RT_LOG " + name + ": must be trace, debug, info, warn, error or off");
}

Level standardErrorLevel(const LogSettings& settings) {
    const char* named = std::getenv("RT_LOG");
    if (named != nullptr && *named != '\0') return levelNamed(named);
    return settings.verbose ? Level::debug : settings.quiet ? Level::err : Level::warn;
}

} // namespace

void setUpLog(const LogSettings& settings) try {
    const bool colour = std::getenv("NO_COLOR") == nullptr;
    auto console = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(colour ? spdlog::color_mode::automatic
                                                                                : spdlog::color_mode::never);
    console->set_level(standardErrorLevel(settings));
    console->set_pattern("%n: %^%l%$: %v");
    auto logger = std::make_shared<spdlog::logger>(settings.program, console);
    Level minimum = console->level();
    if (!settings.file.empty()) {
        auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(settings.file);
        file->set_level(std::min(console->level(), Level::info));
        file->set_pattern("%Y-%m-%dT%H:%M:%S.%e %l: %v");
        minimum = std::min(minimum, file->level());
        logger->sinks().push_back(file);
        logger->flush_on(Level::trace); // a crash must not take the last lines with it
    }
    logger->set_level(minimum);
    spdlog::set_default_logger(logger);
} catch (const spdlog::spdlog_ex& error) {
    throw RenderError(settings.file + ": the log cannot be written: " + error.what());
}

void logDebug(const std::string& message) {
    spdlog::default_logger_raw()->debug(printable(message));
}

void logInfo(const std::string& message) {
    spdlog::default_logger_raw()->info(printable(message));
}

void logWarning(const std::string& message) {
    spdlog::default_logger_raw()->warn(printable(message));
}

} // namespace rt
