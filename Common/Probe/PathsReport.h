// What is written of a pixel's samples: sentences, figures as JSON, a strip as a picture.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "Common/Image/Image.h"
#include "Common/Probe/PathsRun.h"

namespace rt::probe {

// What the samples are of.
struct PathsPlace {
    std::string scene; // its id
    std::array<std::uint32_t, 2> pixel{};
    app::RenderSettings rendering;
};

// What most of the variance is, and what may help against it, as far as the figures tell. One sentence or more.
std::string adviceOf(const PathsResult& result, const app::RenderSettings& rendering);
// What is to be known of the figures.
std::vector<std::string> notesOf(const PathsResult& result, const app::RenderSettings& rendering);

std::string shareText(double share);         // "82 %"
std::string textOf(const FoundLight& found); // "BSDF sampling after 2 bounces"
nlohmann::ordered_json figuresOf(const PathsResult& result, const PathsPlace& place);
std::string textOf(const PathsResult& result, const PathsPlace& place); // with line breaks

// The brightest of samples [first, end), of which there is one; those that are not a number are the least.
std::size_t brightestOf(std::span<const float> samples, std::size_t first, std::size_t end);

// A bar for each sample, in order: as high as the root of its brightness by the brightest one's, and in the colour of
// what brought most of it; where there are more samples than pixels, for the brightest of several. Linear values.
image::Image stripOf(const PathsResult& result);

} // namespace rt::probe
