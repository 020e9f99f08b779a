#include "Common/Scene/Compiler/TextureTable.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Compiler/PerlinTable.h"

namespace rt::scene {

namespace {

// IEC 61966-2-1.
double srgbDecode(double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Of every byte.
const std::array<double, 256>& srgbTable() {
    static const auto table = [] {
        std::array<double, 256> linear{};
        for (int i = 0; i < 256; ++i) linear[static_cast<std::size_t>(i)] = srgbDecode(i / 255.0);
        return linear;
    }();
    return table;
}

// What two textures of the same texels have in common.
std::string keyOf(const ImageTexture& source) {
    return source.file + '\n' + source.standIn + '\n' + (source.image ? std::to_string(*source.image) : "") +
           (source.colorSpace == ColorSpace::Linear ? "\nlinear" : "");
}

std::uint32_t noiseKind(NoiseKind kind) {
    switch (kind) {
        case NoiseKind::Marble:
            return shared::kTextureMarble;
        case NoiseKind::Turbulence:
            return shared::kTextureTurbulence;
        case NoiseKind::Smooth:
            break;
    }
    return shared::kTextureNoise;
}

TexelData whiteTexel() {
    TexelData data;
    data.width = data.height = 1;
    data.format = shared::kTexelSrgb8;
    data.words = {0xffffffffu};
    return data;
}

EncodedTexels whiteInstead(const std::string& reason, std::vector<std::string>& notices) {
    notices.push_back(reason + "; it is left out, and what it multiplies counts alone");
    return {1, whiteTexel};
}

} // namespace

glm::dvec3 texelColor(const CompiledScene& scene, const shared::Image& image, std::uint32_t x, std::uint32_t y) {
    const std::size_t texel = std::size_t{y} * image.width + x;
    if (image.format == shared::kTexelLinearF32 || image.format == shared::kTexelLinearF32A) {
        const std::size_t width = image.format == shared::kTexelLinearF32A ? 4 : 3;
        const std::uint32_t* words = &scene.texels[image.firstTexel + width * texel];
        return {shared::uintBitsToFloat(words[0]), shared::uintBitsToFloat(words[1]),
                shared::uintBitsToFloat(words[2])};
    }
    const std::uint32_t word = scene.texels[image.firstTexel + texel];
    if (image.format == shared::kTexelLinear8) return glm::dvec3(shared::vec3(shared::decodeLinear8(word)));
    const auto& linear = srgbTable();
    return {linear[word & 255u], linear[word >> 8 & 255u], linear[word >> 16 & 255u]};
}

TextureTable::TextureTable(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out)
    : id_(desc.id), library_(desc.textures), options_(options), out_(out) {}

std::uint32_t TextureTable::resolve(const ColorOrTexture& source, shared::vec3& color) {
    if (const auto* constant = std::get_if<glm::dvec3>(&source)) {
        color = shared::vec3(*constant);
        return shared::kNone;
    }
    const auto& name = std::get<std::string>(source);
    const auto found = library_.find(name);
    if (found != library_.end())
        if (const auto* solid = std::get_if<SolidTexture>(&found->second)) {
            color = shared::vec3(solid->color);
            return shared::kNone;
        }
    color = shared::vec3(1.0f);
    return named(name);
}

std::uint32_t TextureTable::named(const std::string& name) {
    const auto desc = library_.find(name);
    if (desc == library_.end()) throw InputError(id_ + ": texture \"" + name + "\" is not defined");
    const auto [entry, isNew] = named_.try_emplace(name, shared::kNone);
    if (!isNew) {
        if (entry->second == shared::kNone) throw InputError(id_ + ": /textures/" + name + ": refers to itself");
        return entry->second;
    }
    const auto tooDeep = [&] {
        return InputError(id_ + ": /textures/" + name + ": checkers are nested deeper than " +
                          std::to_string(shared::kMaxCheckerDepth));
    };
    // Bounds the recursion; what lies below the innermost checker is one more.
    if (++depth_ > shared::kMaxCheckerDepth + 1) throw tooDeep();
    const shared::Texture made = record(desc->second);
    --depth_;
    if (nesting(made) > shared::kMaxCheckerDepth) throw tooDeep(); // also through textures made for something else
    out_.textures.push_back(made);
    return entry->second = static_cast<std::uint32_t>(out_.textures.size() - 1);
}

int TextureTable::nesting(const shared::Texture& texture) const {
    if (texture.kind != shared::kTextureChecker) return 0;
    return 1 + std::max(nesting(out_.textures[texture.first]), nesting(out_.textures[texture.second]));
}

// A checker refers to textures only, so its constants become solid ones.
std::uint32_t TextureTable::child(const ColorOrTexture& source) {
    shared::Texture solid{};
    const std::uint32_t index = resolve(source, solid.color);
    if (index != shared::kNone) return index;
    solid.kind = shared::kTextureSolid;
    solid.first = solid.second = shared::kNone;
    out_.textures.push_back(solid);
    return static_cast<std::uint32_t>(out_.textures.size() - 1);
}

shared::Texture TextureTable::record(const TextureDesc& desc) {
    shared::Texture texture{};
    texture.color = shared::vec3(1.0f);
    texture.scale = 1.0f;
    texture.first = texture.second = shared::kNone;
    if (const auto* solid = std::get_if<SolidTexture>(&desc)) {
        texture.kind = shared::kTextureSolid;
        texture.color = shared::vec3(solid->color);
    } else if (const auto* checker = std::get_if<CheckerTexture>(&desc)) {
        texture.kind = shared::kTextureChecker;
        texture.scale = static_cast<float>(checker->scale);
        texture.first = child(checker->even);
        texture.second = child(checker->odd);
    } else if (const auto* noise = std::get_if<NoiseTexture>(&desc)) {
        texture.kind = noiseKind(noise->kind);
        texture.color = shared::vec3(noise->tint);
        texture.scale = static_cast<float>(noise->scale);
        texture.frequency = static_cast<float>(noise->frequency);
        const auto [table, isNew] = perlin_.try_emplace(noise->seed, 0u);
        if (isNew) table->second = appendPerlinTable(noise->seed, out_);
        texture.first = table->second;
    } else {
        const auto& source = std::get<ImageTexture>(desc);
        texture.kind = shared::kTextureImage;
        texture.color = shared::vec3(source.tint);
        texture.first = image(source);
        texture.wrapU = static_cast<std::uint32_t>(source.wrapU);
        texture.wrapV = static_cast<std::uint32_t>(source.wrapV);
        texture.uvSet = source.uvSet;
        const auto& rows = source.uvTransform;
        texture.uRow = shared::vec3(glm::dvec3(rows[0], rows[1], rows[2]));
        texture.vRow = shared::vec3(glm::dvec3(rows[3], rows[4], rows[5]));
    }
    return texture;
}

EncodedTexels TextureTable::openFile(const ImageTexture& source, const std::filesystem::path& path) const {
    if (!options_.loadTexels) throw InputError(id_ + ": " + path.string() + ": images cannot be read here");
    return options_.loadTexels(path, source.image);
}

EncodedTexels TextureTable::open(const ImageTexture& source) {
    // Of files that must not be read nobody learns whether they exist: all are refused.
    const bool orWhite = source.standIn == kWhiteStandIn && mayRead(source.file);
    const std::string standIn = source.standIn == kWhiteStandIn && !orWhite ? std::string() : source.standIn;
    std::optional<std::filesystem::path> path = locateAsset(source.file, standIn, options_, id_, out_.notices);
    if (orWhite) {
        if (!path) return whiteInstead(id_ + ": " + source.file + ": no such file", out_.notices);
        try {
            return openFile(source, *path);
        } catch (const InputError& error) {
            return whiteInstead(error.what(), out_.notices);
        }
    }
    if (!path) {
        const std::filesystem::path installed =
            options_.installedMaps ? installedPlanetMap(source.standIn) : std::filesystem::path();
        out_.notices.push_back(source.file + ": " + (installed.empty() ? "a generated map" : installed.string()) +
                               " stands in");
        if (installed.empty()) return {0, [name = source.standIn] { return makePlanetMap(name); }};
        path = installed;
    }
    return openFile(source, *path);
}

void TextureTable::append(const ImageTexture& source, TexelData data) {
    shared::Image image{};
    image.firstTexel = static_cast<std::uint32_t>(out_.texels.size());
    image.width = data.width;
    image.height = data.height;
    image.format = data.format;
    if (source.colorSpace == ColorSpace::Linear && image.format == shared::kTexelSrgb8)
        image.format = shared::kTexelLinear8;
    if (source.colorSpace == ColorSpace::Srgb && data.isEncoded)
        for (std::size_t i = 0; i < data.words.size(); ++i) {
            if (image.format == shared::kTexelLinearF32A && i % 4 == 3) continue; // opacity is never encoded
            std::uint32_t& word = data.words[i];
            word = shared::floatBitsToUint(static_cast<float>(srgbDecode(shared::uintBitsToFloat(word))));
        }
    out_.texels.insert(out_.texels.end(), data.words.begin(), data.words.end());
    if (out_.texels.size() > shared::kNone)
        throw InputError(id_ + ": " + source.file + ": all images together exceed 16 GiB");
    out_.images.push_back(image);
}

// Few at a time are decoded beside those that are done, and these take their memory once, so that all takes little more
// than the texels do.
void TextureTable::loadImages(const std::vector<const ImageTexture*>& sources) {
    std::vector<const ImageTexture*> images;
    std::vector<EncodedTexels> encoded;
    std::size_t count = out_.texels.size();
    for (const ImageTexture* source : sources) {
        const auto index = static_cast<std::uint32_t>(out_.images.size() + images.size());
        if (!images_.try_emplace(keyOf(*source), index).second) continue;
        images.push_back(source);
        encoded.push_back(open(*source));
        count += encoded.back().count;
    }
    if (images.size() > 1) out_.texels.reserve(count);
    decode(images, encoded);
}

void TextureTable::decode(const std::vector<const ImageTexture*>& images, std::vector<EncodedTexels>& encoded) {
    constexpr std::size_t kMaxAtATime = 8;
    const std::size_t atATime = std::min(threadCount(0), kMaxAtATime);
    for (std::size_t first = 0; first < images.size(); first += atATime) {
        std::vector<TexelData> decoded(std::min(atATime, images.size() - first));
        std::vector<std::string> failures(decoded.size());
        parallelFor(0, decoded.size(), [&](std::size_t i) {
            interruptionPoint();
            try {
                decoded[i] = encoded[first + i].decoded();
            } catch (const InputError& error) {
                if (images[first + i]->standIn != kWhiteStandIn) throw;
                failures[i] = error.what();
            }
            encoded[first + i] = {};
        });
        for (std::size_t i = 0; i < decoded.size(); ++i) {
            if (!failures[i].empty()) decoded[i] = whiteInstead(failures[i], out_.notices).decoded();
            append(*images[first + i], std::move(decoded[i]));
        }
    }
}

void TextureTable::findImages(const std::string& name, int depth, std::vector<const ImageTexture*>& found) const {
    const auto texture = library_.find(name);
    if (texture == library_.end()) return;
    if (const auto* image = std::get_if<ImageTexture>(&texture->second)) found.push_back(image);
    const auto* checker = std::get_if<CheckerTexture>(&texture->second);
    if (!checker || depth == 0) return;
    for (const ColorOrTexture* cube : {&checker->even, &checker->odd})
        if (const auto* inner = std::get_if<std::string>(cube)) findImages(*inner, depth - 1, found);
}

void TextureTable::loadImages(const std::vector<std::string>& textures) {
    std::vector<const ImageTexture*> sources;
    for (const std::string& name : textures) findImages(name, shared::kMaxCheckerDepth, sources);
    loadImages(sources);
}

std::uint32_t TextureTable::image(const ImageTexture& source) {
    loadImages(std::vector<const ImageTexture*>{&source});
    return images_.at(keyOf(source));
}

bool TextureTable::mayShowImage(const std::string& name, int depth) const {
    const auto found = library_.find(name);
    if (found == library_.end()) return false;
    if (const auto* checker = std::get_if<CheckerTexture>(&found->second)) {
        const auto showsImage = [&](const ColorOrTexture& cube) {
            const auto* inner = std::get_if<std::string>(&cube);
            return inner && (depth == 0 || mayShowImage(*inner, depth - 1));
        };
        return showsImage(checker->even) || showsImage(checker->odd);
    }
    return std::holds_alternative<ImageTexture>(found->second);
}

bool TextureTable::isGreyImage(std::uint32_t index) const {
    constexpr std::size_t kMaxTexels = 1 << 16; // looked at
    constexpr double kMaxDifference = 0.02;     // in the mean: compression colours what is grey
    const shared::Texture& texture = out_.textures[index];
    if (texture.kind != shared::kTextureImage) return false;
    const shared::Image& image = out_.images[texture.first];
    const std::size_t count = std::size_t{image.width} * image.height;
    const std::size_t step = std::max<std::size_t>(1, count / kMaxTexels);
    double difference = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < count; i += step, ++seen) {
        const glm::dvec3 c = texelColor(out_, image, static_cast<std::uint32_t>(i % image.width),
                                        static_cast<std::uint32_t>(i / image.width));
        difference += std::abs(c.x - c.y) + std::abs(c.y - c.z);
    }
    return difference <= kMaxDifference * static_cast<double>(seen);
}

glm::dvec3 TextureTable::mean(std::uint32_t index) const {
    const shared::Texture& texture = out_.textures[index];
    switch (texture.kind) {
        case shared::kTextureSolid:
            return texture.color;
        case shared::kTextureChecker:
            return 0.5 * (mean(texture.first) + mean(texture.second));
        case shared::kTextureImage: {
            const shared::Image& image = out_.images[texture.first];
            glm::dvec3 sum(0);
            for (std::uint32_t y = 0; y < image.height; ++y)
                for (std::uint32_t x = 0; x < image.width; ++x) sum += texelColor(out_, image, x, y);
            return sum / (double(image.width) * image.height) * glm::dvec3(texture.color);
        }
        default:
            return 0.5 * glm::dvec3(texture.color);
    }
}

} // namespace rt::scene
