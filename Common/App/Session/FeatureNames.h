// Names of the feature bits, for --features and the statistics.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace rt::app {

// "all" or a list of names; UsageError names the first unknown one and those that exist.
std::uint32_t parseFeatures(const std::string& text);

// Names of the bits that are set in the mask, and of those that are not.
std::vector<std::string> featureNames(std::uint32_t features);
std::vector<std::string> absentFeatureNames(std::uint32_t features);

} // namespace rt::app
