// Names of the feature bits, for --features and the statistics.
#pragma once
#include <string>
#include <vector>

#include "Common/Shared/Base/Features.h"

namespace rt::app {

// "all" or a list of names; UsageError names the first unknown one and those that exist.
shared::Features parseFeatures(const std::string& text);

// Names of the bits that are set in the mask, and of those that are not.
std::vector<std::string> featureNames(shared::Features features);
std::vector<std::string> absentFeatureNames(shared::Features features);

} // namespace rt::app
