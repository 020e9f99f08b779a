#include "Common/Image/MergeCheckpoints.h"

#include <optional>
#include <string>

#include "Common/Core/Error.h"
#include "Common/Image/FilmTiles.h"

namespace rt::image {
namespace {

constexpr std::uint32_t kNobody = ~0u;

// "tile 7 (pixels 56,0 to 63,7)"
std::string describeTile(const Film& film, std::uint32_t tile) {
    const std::uint32_t x = tile % film.tilesX() * Film::kTile, y = tile / film.tilesX() * Film::kTile;
    const auto corner = [](std::uint32_t px, std::uint32_t py) {
        return std::to_string(px) + "," + std::to_string(py);
    };
    return "tile " + std::to_string(tile) + " (pixels " + corner(x, y) + " to " +
           corner(x + Film::kTile - 1, y + Film::kTile - 1) + ")";
}

void checkSameRender(const std::string& name, const Checkpoint& part, const std::string& firstName,
                     const Checkpoint& first) {
    for (const auto& [field, value] : first.render.items()) {
        const auto other = part.render.find(field);
        const std::string text = other == part.render.end() ? "missing" : other->dump();
        if (text != value.dump())
            throw InputError(name + ": " + field + " is " + text + " but " + value.dump() + " in " + firstName);
    }
    if (part.film.desc() != first.film.desc())
        throw InputError(name + ": keeps its film otherwise than " + firstName +
                         "; say --replicates, --stats and --aov alike for all parts");
}

class Merger {
  public:
    explicit Merger(const std::vector<std::filesystem::path>& files) : files_(files) {}

    Checkpoint merge() {
        for (std::uint32_t i = 0; i < files_.size(); ++i) add(i);
        checkComplete();
        return std::move(*whole_);
    }

  private:
    std::string name(std::uint32_t file) const { return files_[file].string(); }

    void add(std::uint32_t file) {
        Checkpoint part = readCheckpoint(files_[file]);
        addLaterFields(part.render);
        if (part.render.is_object()) part.render.erase(kSecondsField);
        if (part.film.desc().adaptive)
            throw InputError(name(file) + ": its samples are adaptive, which is planned for a whole image: " +
                             "it cannot be merged");
        if (whole_) {
            checkSameRender(name(file), part, name(0), *whole_);
        } else {
            whole_ = {part.render, Film(part.film.desc())};
            owners_.assign(part.film.tileCount(), kNobody);
        }
        const TileList tiles = tilesOf(part, file);
        unpackTiles(packTiles(part.film, tiles), whole_->film);
    }

    // The tiles that have samples, which no file before has.
    TileList tilesOf(const Checkpoint& part, std::uint32_t file) {
        TileList tiles;
        const std::uint64_t spp = part.render.value("spp", std::uint64_t{0});
        for (std::uint32_t tile = 0; tile < part.film.tileCount(); ++tile) {
            const std::uint64_t samples = part.film.samples(tile);
            if (samples == 0) continue;
            if (samples < spp)
                throw InputError(name(file) + ": " + describeTile(part.film, tile) + " has " + std::to_string(samples) +
                                 " of " + std::to_string(spp) + " samples; finish it by --resume");
            if (owners_[tile] != kNobody)
                throw InputError(name(file) + ": " + describeTile(part.film, tile) + " is in " + name(owners_[tile]) +
                                 " as well");
            owners_[tile] = file;
            tiles.push_back(tile);
        }
        return tiles;
    }

    void checkComplete() const {
        std::uint32_t missing = 0;
        std::string first;
        for (std::uint32_t tile = 0; tile < owners_.size(); ++tile) {
            if (owners_[tile] != kNobody) continue;
            if (missing++ == 0) first = describeTile(whole_->film, tile);
        }
        if (missing > 0)
            throw InputError("the parts lack " + std::to_string(missing) + " of " + std::to_string(owners_.size()) +
                             " tiles, the first of them " + first);
    }

    const std::vector<std::filesystem::path>& files_;
    std::optional<Checkpoint> whole_;
    std::vector<std::uint32_t> owners_; // of each tile: the file that has it
};

} // namespace

Checkpoint mergeCheckpoints(const std::vector<std::filesystem::path>& files) {
    return Merger(files).merge();
}

} // namespace rt::image
