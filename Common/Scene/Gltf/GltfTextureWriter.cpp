#include "Common/Scene/Gltf/GltfTextureWriter.h"

#include <cmath>
#include <iterator>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Gltf/GltfImagePacking.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxImageBytes = std::uint64_t{1} << 32;

bool startsWith(std::span<const std::byte> content, std::initializer_list<int> bytes) {
    std::size_t i = 0;
    for (const int byte : bytes)
        if (i >= content.size() || std::to_integer<int>(content[i++]) != byte) return false;
    return true;
}

bool isPng(std::span<const std::byte> content) {
    return startsWith(content, {0x89, 'P', 'N', 'G'});
}
bool isPngOrJpeg(std::span<const std::byte> content) {
    return isPng(content) || startsWith(content, {0xff, 0xd8, 0xff});
}

// By the header of a PNG: red, green and blue are one channel.
bool isGrey(std::span<const std::byte> content) {
    constexpr std::size_t kColorType = 25;
    if (!isPng(content) || content.size() <= kColorType) return false;
    const int type = std::to_integer<int>(content[kColorType]);
    return type == 0 || type == 4;
}

std::string imageKey(const ImageTexture& image) {
    return image.file + '\n' + (image.image ? std::to_string(*image.image) : "") + '\n' + image.standIn;
}

// Whether they lie on a surface alike.
bool haveOnePlace(const ImageTexture& a, const ImageTexture& b) {
    return a.uvSet == b.uvSet && a.uvTransform == b.uvTransform && a.wrapU == b.wrapU && a.wrapV == b.wrapV;
}

int samplerWrap(Wrap wrap) {
    constexpr int kClamp = 33071, kRepeat = 10497, kMirror = 33648;
    return wrap == Wrap::Clamp ? kClamp : wrap == Wrap::Repeat ? kRepeat : kMirror;
}

// The first image of all channels; null: none has any.
const ImageTexture* firstImage(const GltfChannels& channels) {
    for (const auto& channel : channels)
        if (channel && channel->image != nullptr) return channel->image;
    return nullptr;
}

} // namespace

// ---- textures without an image -------------------------------------------------------------------------------------

const TextureDesc& GltfTextureWriter::find(const std::string& texture) const {
    const auto own = scene_.textures.find(texture);
    if (own != scene_.textures.end()) return own->second;
    const auto other = more_.find(texture);
    if (other != more_.end()) return other->second;
    throw InputError(scene_.id + ": texture \"" + texture + "\" is not defined");
}

const ImageTexture* GltfTextureWriter::imageOf(const std::string& texture) const {
    return std::get_if<ImageTexture>(&find(texture));
}

// Of images, which only checkers have here, a grey.
glm::dvec3 GltfTextureWriter::meanOf(const ColorOrTexture& source, int depth) const {
    constexpr int kDeepest = 16;
    if (const auto* color = std::get_if<glm::dvec3>(&source)) return *color;
    const TextureDesc& desc = find(std::get<std::string>(source));
    if (const auto* solid = std::get_if<SolidTexture>(&desc)) return solid->color;
    if (const auto* noise = std::get_if<NoiseTexture>(&desc)) return 0.5 * noise->tint;
    const auto* checker = std::get_if<CheckerTexture>(&desc);
    if (checker == nullptr || depth == kDeepest) return glm::dvec3(0.5);
    return 0.5 * (meanOf(checker->even, depth + 1) + meanOf(checker->odd, depth + 1));
}

glm::dvec3 GltfTextureWriter::colorOf(const std::string& texture) {
    if (!std::holds_alternative<SolidTexture>(find(texture)))
        notices_.add("texture", texture, "glTF has no formulas: its mean stands in");
    return meanOf(texture, 0);
}

// ---- images --------------------------------------------------------------------------------------------------------

// The first by the alphabet of textures that show the image.
std::string GltfTextureWriter::nameOf(const ImageTexture& image) const {
    for (const auto* textures : {&scene_.textures, &more_})
        for (const auto& [name, texture] : *textures)
            if (const auto* other = std::get_if<ImageTexture>(&texture))
                if (imageKey(*other) == imageKey(image)) return name;
    return {};
}

GltfTextureWriter::Encoded GltfTextureWriter::read(const ImageTexture& image) {
    Encoded result{{}, nameOf(image)};
    const bool orWhite = image.standIn == kWhiteStandIn && mayRead(image.file);
    std::vector<std::string> notices;
    try {
        const std::string standIn = image.standIn == kWhiteStandIn && !orWhite ? std::string() : image.standIn;
        const auto path = locateAsset(image.file, standIn, {}, scene_.id, notices);
        if (!path) {
            if (orWhite) notices_.add(image.file + ": no such file; it is left out");
            return result;
        }
        if (!image.image) {
            result.content = readFile(*path, kMaxImageBytes);
        } else {
            const GltfImages& inside = files_.try_emplace(*path, *path).first->second;
            const std::span<const std::byte> content = inside.encoded(*image.image);
            result.content.assign(content.begin(), content.end());
        }
    } catch (const InputError& error) {
        if (!orWhite) throw;
        notices_.add(std::string(error.what()) + "; it is left out");
    }
    return result;
}

const GltfTextureWriter::Encoded& GltfTextureWriter::encoded(const ImageTexture& image) {
    const auto [entry, isNew] = encoded_.try_emplace(imageKey(image));
    if (isNew) entry->second = read(image);
    return entry->second;
}

std::optional<TexelData> GltfTextureWriter::decoded(const ImageTexture& image) {
    if (encoded(image).content.empty()) {
        for (const std::string& planet : planetMapNames())
            if (planet == image.standIn) return makePlanetMap(planet);
        return std::nullopt;
    }
    if (!tools_.loadTexels) return std::nullopt;
    std::vector<std::string> notices;
    try {
        return tools_.loadTexels(*locateAsset(image.file, image.standIn, {}, scene_.id, notices), image.image)
            .decoded();
    } catch (const InputError& error) {
        if (image.standIn != kWhiteStandIn) throw;
        notices_.add(std::string(error.what()) + "; it is left out");
        return std::nullopt;
    }
}

// Whether an image can be the texture as it is.
bool GltfTextureWriter::fits(const GltfChannels& channels, ColorSpace space, const ImageTexture& image) {
    const std::span<const std::byte> content = encoded(image).content;
    if (!isPngOrJpeg(content)) return false;
    const bool grey = isGrey(content);
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const auto& wanted = channels[i];
        if (!wanted) continue;
        if (wanted->image == nullptr || wanted->scale != 1 || wanted->offset != 0) return false;
        if (imageKey(*wanted->image) != imageKey(image) || !haveOnePlace(*wanted->image, image)) return false;
        const bool isOpacity = wanted->channel == Channel::Alpha;
        if (isOpacity != (i == 3) || (!grey && static_cast<std::size_t>(wanted->channel) != i)) return false;
        if (!isOpacity && wanted->image->colorSpace != space) return false;
    }
    return true;
}

int GltfTextureWriter::whole(const ImageTexture& image) {
    const auto [entry, isNew] = images_.try_emplace(imageKey(image), 0);
    if (isNew) entry->second = document_.addImage(encoded(image).content, encoded(image).name);
    return entry->second;
}

std::optional<int> GltfTextureWriter::composed(const GltfChannels& channels, ColorSpace space) {
    const ImageTexture& first = *firstImage(channels);
    std::string key = space == ColorSpace::Srgb ? "colours" : "numbers";
    std::map<std::string, TexelData> texels;
    for (const auto& wanted : channels) {
        if (!wanted) continue;
        key += "\n" + std::to_string(static_cast<int>(wanted->channel)) + ' ' + std::to_string(wanted->scale) + ' ' +
               std::to_string(wanted->offset);
        if (wanted->image == nullptr) continue;
        const std::string own = imageKey(*wanted->image);
        key += (wanted->image->colorSpace == ColorSpace::Srgb ? "s\n" : "l\n") + own;
        if (!haveOnePlace(*wanted->image, first))
            notices_.add("images \"" + encoded(first).name + "\" and \"" + encoded(*wanted->image).name +
                         "\" become one, with the place of the first");
    }
    if (const auto known = images_.find(key); known != images_.end()) return known->second;
    for (const auto& wanted : channels) {
        if (!wanted || wanted->image == nullptr || texels.count(imageKey(*wanted->image)) > 0) continue;
        std::optional<TexelData> data = tools_.encodePng ? decoded(*wanted->image) : std::nullopt;
        if (!data) return std::nullopt;
        texels[imageKey(*wanted->image)] = std::move(*data);
    }
    const PackedImage packed = packImage(
        channels, space, [&](const ImageTexture& image) -> const TexelData& { return texels.at(imageKey(image)); });
    const std::vector<std::byte> png = tools_.encodePng(packed.width, packed.height, packed.channels, packed.texels);
    return images_[key] = document_.addImage(png, encoded(first).name);
}

// ---- textures ------------------------------------------------------------------------------------------------------

int GltfTextureWriter::sampler(const ImageTexture& image) {
    const std::string key = std::to_string(samplerWrap(image.wrapU)) + ' ' + std::to_string(samplerWrap(image.wrapV));
    const auto [entry, isNew] = samplers_.try_emplace(key, 0);
    if (isNew)
        entry->second =
            document_.add("samplers", {{"wrapS", samplerWrap(image.wrapU)}, {"wrapT", samplerWrap(image.wrapV)}});
    return entry->second;
}

// The reverse of what uvRows() of the reader makes of KHR_texture_transform.
void GltfTextureWriter::addTransform(const ImageTexture& image, OrderedJson& info) {
    const std::array<double, 6>& rows = image.uvTransform;
    if (rows == ImageTexture().uvTransform) return;
    const double a = rows[0], b = -rows[1], d = -rows[3], e = rows[4];
    const double x = rows[2] - b, y = 1 - e - rows[5];
    double rotation = 0, scaleU = a, scaleV = e;
    if (b != 0 || d != 0) {
        rotation = std::atan2(-d, a);
        scaleU = std::hypot(a, d);
        scaleV = std::copysign(std::hypot(b, e), a * e - b * d);
        if (std::abs(a * b + d * e) > 1e-9 * std::hypot(a, d) * std::hypot(b, e))
            notices_.add("image \"" + encoded(image).name + "\" lies askew: its axes become those of a rectangle");
    }
    OrderedJson transform = OrderedJson::object();
    if (x != 0 || y != 0) transform["offset"] = {x, y};
    if (rotation != 0) transform["rotation"] = rotation;
    if (scaleU != 1 || scaleV != 1) transform["scale"] = {scaleU, scaleV};
    document_.use("KHR_texture_transform");
    info["extensions"]["KHR_texture_transform"] = std::move(transform);
}

std::optional<OrderedJson> GltfTextureWriter::info(const GltfChannels& channels, ColorSpace space) {
    const ImageTexture& image = *firstImage(channels);
    std::optional<int> source;
    if (fits(channels, space, image))
        source = whole(image);
    else
        source = composed(channels, space);
    if (!source) {
        const bool isMissing = encoded(image).content.empty() && image.standIn == kWhiteStandIn; // and was told so
        if (!isMissing) notices_.add("image \"" + encoded(image).name + "\" cannot be what glTF needs: left out");
        return std::nullopt;
    }
    const int used = sampler(image);
    const std::string key = std::to_string(*source) + ' ' + std::to_string(used);
    const auto [entry, isNew] = textures_.try_emplace(key, 0);
    if (isNew) entry->second = document_.add("textures", {{"source", *source}, {"sampler", used}});
    OrderedJson info = {{"index", entry->second}};
    if (image.uvSet != 0) info["texCoord"] = image.uvSet;
    addTransform(image, info);
    return info;
}

} // namespace rt::scene
