#include "Common/App/Session/SceneImages.h"

#include <cstddef>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "Common/Image/ImageIo.h"
#include "Common/Scene/Gltf/GltfFile.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

// What the scene compiler wants of an image file: sRGB bytes packed into words, or floats as words. Values of 16
// bits become floats.
scene::TexelData toTexelData(const image::Texels& texels) {
    scene::TexelData data;
    data.width = texels.width;
    data.height = texels.height;
    if (!texels.srgb16.empty()) {
        const bool hasOpacity = !texels.alpha16.empty();
        const auto word = [](std::uint16_t value) { return shared::floatBitsToUint(float(value) / 65535.0f); };
        data.format = hasOpacity ? shared::kTexelLinearF32A : shared::kTexelLinearF32;
        data.isEncoded = true;
        data.words.reserve(texels.srgb16.size() + texels.alpha16.size());
        for (std::size_t i = 0; i < texels.srgb16.size(); ++i) {
            data.words.push_back(word(texels.srgb16[i]));
            if (hasOpacity && i % 3 == 2) data.words.push_back(word(texels.alpha16[i / 3]));
        }
        return data;
    }
    if (texels.srgb8.empty()) {
        data.format = shared::kTexelLinearF32;
        data.words.resize(texels.linear.size());
        std::memcpy(data.words.data(), texels.linear.data(), texels.linear.size() * sizeof(float));
        return data;
    }
    data.format = shared::kTexelSrgb8;
    data.words.resize(texels.srgb8.size() / 3);
    for (std::size_t i = 0; i < data.words.size(); ++i) {
        const std::uint8_t* rgb = &texels.srgb8[3 * i];
        const std::uint32_t alpha = texels.alpha8.empty() ? 0xffu : texels.alpha8[i];
        data.words[i] = rgb[0] | std::uint32_t{rgb[1]} << 8 | std::uint32_t{rgb[2]} << 16 | alpha << 24;
    }
    return data;
}

// What several compilations ask for, by threads of theirs: decoded by the first.
class KeptImage {
  public:
    explicit KeptImage(scene::EncodedTexels encoded) : encoded_(std::move(encoded)) {}

    std::size_t count() const { return encoded_.count; }
    scene::TexelData decoded() {
        const std::scoped_lock lock(mutex_);
        if (!data_) {
            data_ = encoded_.decoded();
            encoded_.decoded = nullptr; // and what it was decoded from
        }
        return *data_;
    }

  private:
    std::mutex mutex_;
    scene::EncodedTexels encoded_;
    std::optional<scene::TexelData> data_;
};

} // namespace

TexelLoader makeTexelLoader() {
    const auto files = std::make_shared<std::map<fs::path, scene::GltfImages>>();
    return [files](const fs::path& path, std::optional<std::uint32_t> image) {
        if (!image) {
            const auto bytes = std::make_shared<const std::vector<std::byte>>(image::readTexels(path));
            return scene::EncodedTexels(image::texelCount(*bytes),
                                        [bytes, path] { return toTexelData(image::decodeTexels(*bytes, path)); });
        }
        const scene::GltfImages& images = files->try_emplace(path, path).first->second;
        const std::span<const std::byte> bytes = images.encoded(*image);
        const std::string name = path.string() + ": /images/" + std::to_string(*image);
        return scene::EncodedTexels(image::texelCount(bytes),
                                    [bytes, name] { return toTexelData(image::decodeTexels(bytes, name)); });
    };
}

TexelLoader makeKeepingTexelLoader() {
    using Images = std::map<std::pair<fs::path, std::optional<std::uint32_t>>, std::shared_ptr<KeptImage>>;
    return [images = std::make_shared<Images>(), load = makeTexelLoader()](const fs::path& path,
                                                                           std::optional<std::uint32_t> image) {
        std::shared_ptr<KeptImage>& kept = (*images)[{path, image}];
        if (!kept) kept = std::make_shared<KeptImage>(load(path, image));
        return scene::EncodedTexels(kept->count(), [kept] { return kept->decoded(); });
    };
}

} // namespace rt::app
