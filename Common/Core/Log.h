// Messages for the user: to standard error and, if asked, to a file, once setUpLog() was called.
#pragma once
#include <string>

namespace rt {

struct LogSettings {
    std::string program;  // begins every line on standard error
    bool quiet = false;   // errors only
    bool verbose = false; // debug messages too
    std::string file;     // empty: none; it gets what standard error gets, and informative messages always
};

// The level named by RT_LOG (trace, debug, info, warn, error, off) wins over `quiet` and `verbose`. Colours are used on
// a terminal unless NO_COLOR is set. Throws UsageError for a bad RT_LOG, RenderError when the file cannot be written.
void setUpLog(const LogSettings& settings);

// One line each, made printable (Printable.h).
void logDebug(const std::string& message);
void logInfo(const std::string& message);
void logWarning(const std::string& message);

} // namespace rt
