#include "Common/Core/TimeText.h"

namespace rt {
namespace {

std::string formatted(const std::tm& time, const char* format) {
    char text[64];
    return std::string(text, std::strftime(text, sizeof text, format, &time));
}

} // namespace

// Standard C++ has the same only with one state for all threads.
std::string utcText(std::time_t time, const char* format) {
    std::tm utc{};
#ifdef _WIN32
    gmtime_s(&utc, &time);
#else
    gmtime_r(&time, &utc);
#endif
    return formatted(utc, format);
}

std::string localTimeText(std::time_t time, const char* format) {
    std::tm local{};
#ifdef _WIN32
    localtime_s(&local, &time);
#else
    localtime_r(&time, &local);
#endif
    return formatted(local, format);
}

} // namespace rt
