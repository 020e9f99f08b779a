// Times as texts, in a format of std::strftime.
#pragma once
#include <ctime>
#include <string>

namespace rt {

std::string utcText(std::time_t time, const char* format);
std::string localTimeText(std::time_t time, const char* format); // in the zone that the machine is set to

} // namespace rt
