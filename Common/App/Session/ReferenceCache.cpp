#include "Common/App/Session/ReferenceCache.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/BuildInfo.h"
#include "Common/Core/Error.h"
#include "Common/Core/Format.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFormat = 1;
constexpr const char* kExtension = ".rtr";

} // namespace

RenderSettings referenceSettings(const ReferenceKey& key, std::uint32_t spp) {
    RenderSettings settings;
    settings.width = key.width;
    settings.height = key.height;
    settings.maxDepth = key.maxDepth;
    settings.spp = spp;
    settings.seed = kReferenceSeed;
    settings.replicates = kReferenceReplicates;
    return settings;
}

ReferenceCache ReferenceCache::ofUser() {
    const fs::path cache = userCacheFolder();
    return ReferenceCache(cache.empty() ? cache : cache / "references");
}

fs::path ReferenceCache::fileOf(const ReferenceKey& key) const {
    if (folder_.empty()) return {};
    const std::uint64_t parts[] = {kFormat,      key.sceneHash,        key.width,     key.height,
                                   key.maxDepth, kReferenceReplicates, kReferenceSeed};
    std::uint64_t hash = hashBytes(std::as_bytes(std::span(parts)));
    const std::string& version = programVersion();
    hash = hashBytes(std::as_bytes(std::span(version.data(), version.size())), hash);
    const scene::CameraDesc& c = key.camera;
    const double camera[] = {c.lookFrom.x, c.lookFrom.y, c.lookFrom.z, c.lookAt.x,    c.lookAt.y,     c.lookAt.z,
                             c.up.x,       c.up.y,       c.up.z,       c.verticalFov, c.defocusAngle, c.focusDistance};
    hash = hashBytes(std::as_bytes(std::span(camera)), hash);
    return folder_ / formatted("%016llx%s", static_cast<unsigned long long>(hash), kExtension);
}

bool ReferenceCache::has(const ReferenceKey& key) const {
    std::error_code none;
    return !folder_.empty() && fs::is_regular_file(fileOf(key), none);
}

std::optional<image::Film> ReferenceCache::load(const ReferenceKey& key) const {
    if (!has(key)) return std::nullopt;
    const fs::path file = fileOf(key);
    try {
        std::ifstream in(file, std::ios::binary);
        image::Film film =
            image::Film::readState({key.width, key.height, kReferenceReplicates, false}, in, file.string());
        std::error_code ignored; // only when it was used last is lost
        fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
        return film;
    } catch (const InputError& error) {
        logWarning(std::string(error.what()) + "; the reference is made anew");
        return std::nullopt;
    }
}

void ReferenceCache::save(const ReferenceKey& key, const image::Film& film) const {
    if (folder_.empty()) return;
    try {
        fs::create_directories(folder_);
        AtomicFile target(fileOf(key));
        film.writeState(target.stream());
        target.commit();
        shrink();
    } catch (const std::exception& error) {
        logWarning("the reference is not kept: " + messageOf(error));
    }
}

// Whatever another program takes away meanwhile is gone all the same.
void ReferenceCache::shrink() const {
    struct Kept {
        fs::file_time_type used;
        std::uintmax_t bytes;
        fs::path file;
    };
    std::vector<Kept> files;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
        std::error_code gone, sizeless;
        const Kept kept{entry.last_write_time(gone), entry.file_size(sizeless), entry.path()};
        if (gone || sizeless || kept.file.extension() != kExtension) continue;
        bytes += kept.bytes;
        files.push_back(kept);
    }
    std::sort(files.begin(), files.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    for (std::size_t i = 0; i + 1 < files.size() && bytes > maxBytes_; ++i) { // the last was written now
        std::error_code ignored;
        fs::remove(files[i].file, ignored);
        bytes -= files[i].bytes;
    }
}

} // namespace rt::app
