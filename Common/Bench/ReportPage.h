// The report as one HTML file that needs nothing else: it follows the reader's light or dark, prints, and sorts its
// tables where scripts may run.
#pragma once
#include <string>

#include "Common/Bench/Document.h"

namespace rt::bench {

// Points of charts lead to the rows of tables that have the same origin.
std::string toHtml(const Document& document, const std::string& title);

} // namespace rt::bench
