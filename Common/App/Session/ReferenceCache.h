// References that were rendered, by any of the programs: films that converge to one image, kept on disk under a hash of
// all that this image depends on, so that each is rendered once and gets better when more is asked for.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

#include "Common/App/Session/Settings.h"
#include "Common/Image/Film.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// What two renders must have in common to converge to one image.
struct ReferenceKey {
    std::uint64_t sceneHash = 0;
    scene::CameraDesc camera; // no part of the scene's hash
    std::uint32_t width = 0, height = 0, maxDepth = 0;
    bool operator==(const ReferenceKey&) const = default;
};

inline constexpr std::uint32_t kReferenceSeed = 0x5eed0001; // what is measured has 0, 1, ...
inline constexpr std::uint32_t kReferenceReplicates = 4;    // which tell its variance
// The defaults, which are the best estimator there is, with a seed of its own and replicates.
RenderSettings referenceSettings(const ReferenceKey& key, std::uint32_t spp);

class ReferenceCache {
  public:
    static constexpr std::uintmax_t kMaxBytes = std::uintmax_t{2} << 30;

    // An empty folder: nothing is kept. When there are more than so many bytes of references, those that were used
    // least recently go.
    explicit ReferenceCache(std::filesystem::path folder, std::uintmax_t maxBytes = kMaxBytes)
        : folder_(std::move(folder)), maxBytes_(maxBytes) {}
    // In the user's cache folder.
    static ReferenceCache ofUser();

    std::filesystem::path fileOf(const ReferenceKey& key) const;
    bool has(const ReferenceKey& key) const;
    // None where there is none; a damaged one is warned of, and is as none.
    std::optional<image::Film> load(const ReferenceKey& key) const;
    // Replaces the file as a whole. That it cannot be written is warned of.
    void save(const ReferenceKey& key, const image::Film& film) const;

  private:
    void shrink() const;

    std::filesystem::path folder_;
    std::uintmax_t maxBytes_;
};

} // namespace rt::app
