// Results as files for other programs.
#pragma once
#include <string>

#include "Common/Bench/Results.h"

namespace rt::bench {

std::string toJson(const Results& results); // version 1; pictures are left out
// Throws InputError naming the file and the place.
Results parseResults(const std::string& text, const std::string& file);

// One line of column names, one for each row; RFC 4180. What is not known is an empty field.
std::string toCsv(const Results& results);

} // namespace rt::bench
