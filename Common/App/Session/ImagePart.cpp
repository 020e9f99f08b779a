#include "Common/App/Session/ImagePart.h"

#include <algorithm>
#include <string>
#include <utility>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

using image::Film;

// Tiles side by side that go to one share: they share what is in the cache.
constexpr std::uint32_t kNeighbours = 4;

// Runs of tiles go to the shares in turn, and a row of tiles begins one share further than the row above it, so that
// what takes long in the image is spread over all shares.
std::uint32_t shareOf(std::uint32_t x, std::uint32_t y, std::uint32_t shares) {
    return (x / kNeighbours + y) % shares;
}

void checkRegion(const Region& region, const image::FilmDesc& film) {
    if (region.x + region.width <= film.width && region.y + region.height <= film.height) return;
    throw UsageError("--region: reaches beyond the image of " + std::to_string(film.width) + "x" +
                     std::to_string(film.height) + " pixels");
}

bool touches(const Region& region, std::uint32_t tileX, std::uint32_t tileY) {
    const auto overlaps = [](std::uint32_t tile, std::uint32_t begin, std::uint32_t size) {
        return (tile + 1) * Film::kTile > begin && tile * Film::kTile < begin + size;
    };
    return overlaps(tileX, region.x, region.width) && overlaps(tileY, region.y, region.height);
}

} // namespace

image::TileList tilesToRender(const Options& options, const Film& film) {
    if (options.region) checkRegion(*options.region, film.desc());
    image::TileList tiles;
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile) {
        const std::uint32_t x = tile % film.tilesX(), y = tile / film.tilesX();
        if (options.region && !touches(*options.region, x, y)) continue;
        if (options.tiles && shareOf(x, y, options.tiles->of) != options.tiles->number - 1) continue;
        tiles.push_back(tile);
    }
    if (tiles.empty()) throw UsageError("--tiles: the image has too few tiles of 8x8 pixels for so many shares");
    return tiles;
}

std::uint64_t samplesPerPixel(const Options& options, const Film& film) {
    return isWholeImage(options) ? film.samplesPerPixel() : image::minSamples(film, tilesToRender(options, film));
}

image::ImageRows withinRegion(image::ImageRows rows, const std::optional<Region>& region) {
    if (!region) return rows;
    image::ImageRows result = rows;
    const std::size_t first = std::size_t{region->x} * rows.channels;
    const std::size_t end = first + std::size_t{region->width} * rows.channels;
    result.read = [read = std::move(rows.read), first, end, r = *region](std::uint32_t y, std::span<float> row) {
        if (y < r.y || y >= r.y + r.height) {
            std::fill(row.begin(), row.end(), 0.0f);
            return;
        }
        read(y, row);
        std::fill_n(row.begin(), first, 0.0f);
        std::fill(row.begin() + static_cast<std::ptrdiff_t>(end), row.end(), 0.0f);
    };
    return result;
}

} // namespace rt::app
