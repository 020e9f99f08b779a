// The command line of ray-tracing-image.
#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "Common/Image/Metrics.h"
#include "Common/Manual/Page.h"

namespace rt::tools {

inline constexpr const char* kImageTool = "ray-tracing-image";

using FigureOfError = double image::ErrorFigures::*;

struct Metric {
    const char* name;
    FigureOfError value;
    bool moreIsBetter;
};

// The first is the default of --max.
inline constexpr Metric kMetrics[] = {{"mse", &image::ErrorFigures::mse, false},
                                      {"rmse", &image::ErrorFigures::rmse, false},
                                      {"relmse", &image::ErrorFigures::relmse, false},
                                      {"mae", &image::ErrorFigures::mae, false},
                                      {"psnr", &image::ErrorFigures::psnr, true}};

struct ImageArguments {
    std::string command; // "diff", "info", "convert", "merge" or "denoise"
    std::string a, b;
    std::string metric; // empty: all
    std::optional<double> max;
    std::string output;
    std::string layer;
    std::vector<std::string> parts;
    float exposure = 0;
    std::string tonemap = "none";
};

// Nothing after --help, --help-all and --version, which are answered on `out`. Throws UsageError.
std::optional<ImageArguments> parseImageArguments(const std::vector<std::string>& arguments, std::ostream& out);

manual::Page imagePage();

} // namespace rt::tools
