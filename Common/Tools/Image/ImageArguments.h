// The command line of ray-tracing-image.
#pragma once
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "Common/Image/Flip.h"
#include "Common/Image/Metrics.h"
#include "Common/Manual/Page.h"
#include "Common/Render/Settings.h"

namespace rt::tools {

inline constexpr const char* kImageTool = "ray-tracing-image";

// Two images of one size, and how far they are apart.
struct Difference {
    const image::Image& image;
    const image::Image& reference;
    image::ErrorFigures figures;
};

struct Metric {
    const char* name;
    double (*of)(const Difference&);
    bool moreIsBetter;
};

// The first is the default of --max.
inline constexpr Metric kMetrics[] = {
    {"mse", [](const Difference& d) { return d.figures.mse; }, false},
    {"rmse", [](const Difference& d) { return d.figures.rmse; }, false},
    {"relmse", [](const Difference& d) { return d.figures.relmse; }, false},
    {"mae", [](const Difference& d) { return d.figures.mae; }, false},
    {"psnr", [](const Difference& d) { return d.figures.psnr; }, true},
    {"flip", [](const Difference& d) { return image::flip(d.image, d.reference); }, false}};

// A pixel of a scene's image.
struct PixelArguments {
    std::string scene, pixel;
    std::string camera;
    std::uint32_t width = 0, height = 0; // of the image that the pixel is of; 0: as the programs' flags
};

// Of `probe`.
struct ProbeArguments : PixelArguments {
    std::string strategy = "lights";
    std::string show, sampler; // empty: by default
    std::uint32_t rows = 128, samples = 4096, paths = 16;
    std::uint32_t strata = 0; // 0: edges are not drawn
    std::uint32_t seed = 0;
    bool json = false;
    std::string sphereLight, quadLight, triangleLight, lightSelection; // empty: by default
};

// Of `paths`.
struct PathsArguments : PixelArguments {
    app::RenderSettings settings;
    std::uint32_t sample = kNoSample; // of which all paths are wanted
    std::uint32_t listed = 16;
    bool json = false;

    static constexpr std::uint32_t kNoSample = ~0u;
};

struct ImageArguments {
    std::string command; // "diff", "info", "convert", "merge", "denoise", "probe" or "paths"
    std::string a, b;
    ProbeArguments probe;
    PathsArguments paths;
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
