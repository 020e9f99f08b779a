// The part of an image that --region and --tiles leave to render. Tiles are rendered whole.
#pragma once
#include "Common/App/Options/Options.h"
#include "Common/Image/FilmTiles.h"
#include "Common/Image/ImageRows.h"

namespace rt::app {

inline bool isWholeImage(const Options& options) {
    return !options.region && !options.tiles;
}

// Throws UsageError when the region reaches beyond the image, or nothing is left to render.
image::TileList tilesToRender(const Options& options, const image::Film& film);

// What a statistic may call "done": samples of every pixel that is to be rendered; of an adaptive film their mean.
std::uint64_t samplesPerPixel(const Options& options, const image::Film& film);

// Black outside of the region; `rows` as they are without one.
image::ImageRows withinRegion(image::ImageRows rows, const std::optional<Region>& region);

} // namespace rt::app
