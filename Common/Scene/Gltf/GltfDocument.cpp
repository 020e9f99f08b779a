#include "Common/Scene/Gltf/GltfDocument.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include <glm/common.hpp>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/TextSearch.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertices = 34962, kIndices = 34963; // what a buffer view is for

void appendWord(std::string& text, std::size_t word) {
    for (int i = 0; i < 4; ++i) text += static_cast<char>(word >> 8 * i & 0xff);
}

void writeFile(const fs::path& path, std::span<const std::byte> content) {
    AtomicFile file(path);
    file.stream().write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    file.commit();
}

} // namespace

std::string toUri(const std::string& name) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    constexpr std::string_view kPlain = "-._~";
    std::string uri;
    for (const char c : name) {
        const bool isLetter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (isLetter || kPlain.find(c) != std::string_view::npos) {
            uri += c;
            continue;
        }
        const auto code = static_cast<unsigned char>(c);
        uri += {'%', kDigits[code >> 4], kDigits[code & 15]};
    }
    return uri;
}

// ---- notices -------------------------------------------------------------------------------------------------------

void GltfNotices::leaveOut(const char* one, const char* many, std::size_t count) {
    auto& known = counts_[one];
    known.first = many;
    known.second += count;
}

std::vector<std::string> GltfNotices::lines() const {
    std::vector<std::string> result;
    std::string all;
    for (const auto& [one, known] : counts_) {
        const auto& [many, count] = known;
        all += (all.empty() ? "" : ", ") + (count == 1 ? one : std::to_string(count) + " " + many);
    }
    if (!all.empty()) result.push_back("left out, as glTF has no word for it: " + all);
    for (const auto& [what, names] : named_) {
        const std::string rest = names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : "";
        result.push_back(what.first + " \"" + *names.begin() + "\"" + rest + ": " + what.second);
    }
    result.insert(result.end(), lines_.begin(), lines_.end());
    return result;
}

// ---- what the document has -----------------------------------------------------------------------------------------

GltfDocument::GltfDocument(fs::path file)
    : file_(std::move(file)), isBinary_(lowerCase(file_.extension().string()) == ".glb"), stem_(file_.stem().string()) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "Ray Tracing Twins"}};
    names_ = {lowerCase(file_.filename().string()), lowerCase(stem_ + ".bin")};
}

int GltfDocument::add(const char* array, OrderedJson element) {
    OrderedJson& all = root_[array];
    all.push_back(std::move(element));
    return static_cast<int>(all.size()) - 1;
}

int GltfDocument::addOf(const char* extension, const char* array, OrderedJson element) {
    use(extension);
    OrderedJson& all = root_["extensions"][extension][array];
    all.push_back(std::move(element));
    return static_cast<int>(all.size()) - 1;
}

int GltfDocument::addView(std::span<const std::byte> bytes, int target) {
    while (buffer_.size() % 4 != 0) buffer_.push_back({});
    OrderedJson view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

int GltfDocument::addAccessor(std::span<const std::byte> bytes, int target, OrderedJson accessor) {
    accessor["bufferView"] = addView(bytes, target);
    return add("accessors", std::move(accessor));
}

int GltfDocument::addVertices(std::span<const glm::vec2> values) {
    return addAccessor(std::as_bytes(values), kVertices,
                       {{"componentType", kFloat}, {"type", "VEC2"}, {"count", values.size()}});
}

int GltfDocument::addVertices(std::span<const glm::vec3> values, bool hasBounds) {
    OrderedJson accessor = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", values.size()}};
    if (hasBounds && !values.empty()) {
        glm::vec3 least = values.front(), largest = values.front();
        for (const glm::vec3& value : values) {
            least = glm::min(least, value);
            largest = glm::max(largest, value);
        }
        accessor["min"] = arrayOf(least);
        accessor["max"] = arrayOf(largest);
    }
    return addAccessor(std::as_bytes(values), kVertices, std::move(accessor));
}

int GltfDocument::addVertices(std::span<const glm::vec4> values) {
    return addAccessor(std::as_bytes(values), kVertices,
                       {{"componentType", kFloat}, {"type", "VEC4"}, {"count", values.size()}});
}

int GltfDocument::addIndices(std::span<const glm::uvec3> triangles, std::size_t vertices) {
    const bool areShort = vertices <= std::numeric_limits<std::uint16_t>::max();
    OrderedJson accessor = {{"componentType", areShort ? kUnsignedShort : kUnsignedInt},
                            {"type", "SCALAR"},
                            {"count", 3 * triangles.size()}};
    if (!areShort) return addAccessor(std::as_bytes(triangles), kIndices, std::move(accessor));
    std::vector<std::uint16_t> corners;
    corners.reserve(3 * triangles.size());
    for (const glm::uvec3& t : triangles)
        for (int i = 0; i < 3; ++i) corners.push_back(static_cast<std::uint16_t>(t[i]));
    return addAccessor(std::as_bytes(std::span(corners)), kIndices, std::move(accessor));
}

// Begins with the name of the file, as other files beside a result do; what is taken grows a number.
std::string GltfDocument::nameBeside(const std::string& name, const std::string& ending) {
    constexpr std::string_view kUnwanted = "/\\:*?\"<>|"; // in names of files, by some system
    constexpr std::size_t kLongest = 100;
    std::size_t length = std::min(name.size(), kLongest);
    while (length < name.size() && (static_cast<unsigned char>(name[length]) & 0xc0) == 0x80) --length; // whole letters
    std::string start = name.substr(0, length);
    for (char& c : start)
        if (kUnwanted.find(c) != std::string_view::npos || static_cast<unsigned char>(c) < 0x20) c = '_';
    if (start.rfind(stem_ + ".", 0) != 0) start = stem_ + "." + start;
    for (int number = 1;; ++number) {
        std::string candidate = start + (number == 1 ? "" : "-" + std::to_string(number)) + ending;
        if (names_.insert(lowerCase(candidate)).second) return candidate;
    }
}

int GltfDocument::addImage(std::span<const std::byte> content, const std::string& name) {
    const bool isPng = !content.empty() && content.front() == std::byte{0x89};
    OrderedJson image = {{"name", name}};
    if (isBinary_) {
        image["mimeType"] = isPng ? "image/png" : "image/jpeg";
        image["bufferView"] = addView(content, 0);
    } else {
        const std::string file = nameBeside(name, isPng ? ".png" : ".jpg");
        image["uri"] = toUri(file);
        beside_[file_.parent_path() / file].assign(content.begin(), content.end());
    }
    return add("images", std::move(image));
}

// ---- files ---------------------------------------------------------------------------------------------------------

void GltfDocument::write() {
    if (!used_.empty()) root_["extensionsUsed"] = used_;
    if (!buffer_.empty()) {
        OrderedJson buffer = {{"byteLength", buffer_.size()}};
        if (!isBinary_) buffer["uri"] = toUri(stem_ + ".bin");
        root_["buffers"] = OrderedJson::array({buffer});
    }
    if (isBinary_) return writeBinary(root_.dump());
    for (const auto& [path, content] : beside_) writeFile(path, content);
    if (!buffer_.empty()) writeFile(file_.parent_path() / (stem_ + ".bin"), buffer_);
    const std::string text = root_.dump(1) + '\n';
    writeFile(file_, std::as_bytes(std::span(text)));
}

void GltfDocument::writeBinary(const std::string& json) {
    constexpr std::size_t kHeader = 12, kChunkHeader = 8, kJson = 0x4e4f534a, kBinary = 0x004e4942;
    std::string text = json;
    while (text.size() % 4 != 0) text += ' ';
    while (buffer_.size() % 4 != 0) buffer_.push_back({});
    const std::size_t bytes =
        kHeader + kChunkHeader + text.size() + (buffer_.empty() ? 0 : kChunkHeader + buffer_.size());
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw RenderError(file_.string() + ": would exceed the 4 GiB of a .glb file; .gltf may have more");
    std::string start = "glTF";
    for (const std::size_t word : {std::size_t{2}, bytes, text.size(), kJson}) appendWord(start, word);
    start += text;
    if (!buffer_.empty())
        for (const std::size_t word : {buffer_.size(), kBinary}) appendWord(start, word);
    AtomicFile file(file_);
    file.stream() << start;
    file.stream().write(reinterpret_cast<const char*>(buffer_.data()), static_cast<std::streamsize>(buffer_.size()));
    file.commit();
}

} // namespace rt::scene
