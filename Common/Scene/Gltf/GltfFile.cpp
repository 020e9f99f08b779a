#include "Common/Scene/Gltf/GltfFile.h"

#include <cstring>
#include <exception>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/OtherCase.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfCheck.h"
#include "Common/Scene/Gltf/GltfMeshopt.h"
#include "Common/Scene/Gltf/GltfUri.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxGlbBytes = std::numeric_limits<std::uint32_t>::max(); // of .glb, by its header
constexpr std::size_t kGlbHeader = 20;                                            // with that of the first chunk

using Content = std::shared_ptr<const std::vector<std::byte>>;

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return value;
}

bool isBinary(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

// The JSON of a file.
std::string_view textOf(std::span<const std::byte> bytes, const std::string& file) {
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    if (!isBinary(bytes)) return {text, bytes.size()};
    constexpr std::uint32_t kJson = 0x4e4f534a;
    if (bytes.size() < kGlbHeader) throw InputError(file + ": ends within the header of a .glb file");
    if (const std::uint32_t version = wordAt(bytes, 4); version != 2)
        throw InputError(file + ": version " + std::to_string(version) + " of the .glb format: must be 2");
    if (const std::uint32_t length = wordAt(bytes, 8); length > bytes.size())
        throw InputError(file + ": has " + std::to_string(bytes.size()) + " bytes of the " + std::to_string(length) +
                         " that its header states");
    const std::uint32_t length = wordAt(bytes, 12);
    if (wordAt(bytes, 16) != kJson || length > bytes.size() - kGlbHeader)
        throw InputError(file + ": the first chunk is not JSON of a length that the file has");
    return {text + kGlbHeader, length};
}

// The first BIN chunk behind the JSON of a .glb file, if there is one; chunks of other kinds are for other programs.
std::optional<std::span<const std::byte>> binaryChunk(std::span<const std::byte> bytes, const std::string& file) {
    constexpr std::uint32_t kBinary = 0x004e4942;
    constexpr std::size_t kChunkHeader = 8;
    const std::size_t end = wordAt(bytes, 8);
    for (std::size_t at = kGlbHeader + wordAt(bytes, 12); at + kChunkHeader <= end;) {
        const std::size_t length = wordAt(bytes, at), start = at + kChunkHeader;
        if (length > end - start)
            throw InputError(file + ": the chunk at byte " + std::to_string(at) + " ends beyond the file");
        if (wordAt(bytes, at + 4) == kBinary) return bytes.subspan(start, length);
        at = start + length;
    }
    return std::nullopt;
}

// ---- buffers and images --------------------------------------------------------------------------------------------

// What buffers are made of.
class BufferReader {
  public:
    BufferReader(const fs::path& path, Content content) : path_(path), content_(std::move(content)) {
        bytes_ = content_->size();
        if (isBinary(*content_)) chunk_ = binaryChunk(*content_, path.string());
    }

    GltfBuffer read(const JsonNode& buffer, bool isFirst) {
        const auto uri = buffer.find("uri");
        GltfBuffer read;
        std::string holder;
        if (uri && isDataUri(uri->string())) {
            holder = "the data URI";
            read.content = std::make_shared<const std::vector<std::byte>>(bytesOfDataUri(*uri));
            read.bytes = *read.content;
        } else if (uri) {
            holder = '"' + printable(uri->string(), 200) + '"';
            read.content = fileBeside(uri->string());
            read.bytes = *read.content;
        } else if (isFirst && chunk_) {
            holder = "the binary chunk";
            read.content = content_;
            read.bytes = *chunk_;
        } else {
            return read; // extensions may have other ideas of what it is
        }
        const JsonNode length = buffer.at("byteLength");
        if (length.value().get<std::uint64_t>() > read.bytes.size())
            length.failValue("at most what " + holder + " has, " + counted(read.bytes.size(), "byte", "bytes"));
        read.bytes = read.bytes.first(length.value().get<std::size_t>());
        return read;
    }

    std::uint64_t bytes() const { return bytes_; } // that were read
    const std::vector<std::string>& notices() const { return notices_; }

  private:
    // Many buffers may lie in one file.
    Content fileBeside(const std::string& uri) {
        const fs::path path = besideGltf(path_, uri);
        Content& content = files_[path];
        if (!content) {
            content = std::make_shared<const std::vector<std::byte>>(readFile(present(path), kMaxGlbBytes));
            bytes_ += content->size();
        }
        return content;
    }

    // The file of another case where there is none of this.
    fs::path present(const fs::path& path) {
        std::error_code none;
        if (!mayRead(path) || fs::exists(path, none)) return path;
        fs::path other = findInOtherCase(path);
        if (other.empty()) return path;
        notices_.push_back(path.string() + ": there is no such file; read: " + other.filename().string());
        return other;
    }

    const fs::path& path_;
    std::vector<std::string> notices_;
    const Content content_; // of the file itself
    std::optional<std::span<const std::byte>> chunk_;
    std::map<fs::path, Content> files_;
    std::uint64_t bytes_ = 0;
};

// The image stays encoded.
GltfImage readImage(const JsonNode& node) {
    GltfImage image;
    if (const auto name = node.find("name")) image.name = name->string();
    const auto uri = node.find("uri");
    if (const auto view = node.find("bufferView"))
        image.bufferView = view->value().get<int>();
    else if (uri && isDataUri(uri->string()))
        image.content = bytesOfDataUri(*uri);
    else if (uri)
        image.uri = uri->string();
    return image;
}

// ---- the rest ------------------------------------------------------------------------------------------------------

std::string firstLine(const std::string& message) {
    return printable(message.substr(0, message.find('\n')));
}

// Indices whose accessor has no buffer view, as in compressed or sparse ones: the library would refuse the file.
class BareIndices {
  public:
    // Takes them out of a document that has been checked.
    explicit BareIndices(nlohmann::json& document) {
        if (!document.contains("meshes")) return;
        nlohmann::json& meshes = document["meshes"];
        for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
            nlohmann::json& primitives = meshes[mesh]["primitives"];
            for (std::size_t i = 0; i < primitives.size(); ++i) {
                const auto found = primitives[i].find("indices");
                if (found == primitives[i].end()) continue;
                const int accessor = found->get<int>();
                if (document["accessors"][static_cast<std::size_t>(accessor)].contains("bufferView")) continue;
                taken_.push_back({mesh, i, accessor});
                primitives[i].erase(found);
            }
        }
    }
    void putBack(tinygltf::Model& model) const {
        for (const Taken& one : taken_) model.meshes[one.mesh].primitives[one.primitive].indices = one.accessor;
    }

  private:
    struct Taken {
        std::size_t mesh, primitive;
        int accessor;
    };
    std::vector<Taken> taken_;
};

// `text`: JSON without buffers and images, of which the library has its own ideas.
void parseRest(const std::string& text, const std::string& file, tinygltf::Model& model) {
    tinygltf::TinyGLTF parser;
    std::string errors, warnings;
    bool isRead = false;
    try {
        isRead = parser.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned>(text.size()),
                                            std::string());
    } catch (const std::exception& error) { // of its containers, at what it does not check
        throw InputError(file + ": not a valid file of glTF: " + firstLine(error.what()));
    }
    if (!isRead) throw InputError(file + ": " + firstLine(errors));
}

} // namespace

void GltfFile::fail(const std::string& place, const std::string& message) const {
    throw InputError(path.string() + ": " + place + ": " + message);
}

std::span<const std::byte> GltfFile::view(int bufferView) const {
    if (const auto found = decoded.find(bufferView); found != decoded.end()) return found->second;
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(bufferView)];
    return buffers[static_cast<std::size_t>(view.buffer)].bytes.subspan(view.byteOffset, view.byteLength);
}

GltfFile readGltf(const fs::path& path) {
    GltfFile file;
    file.path = path;
    const std::string name = path.string();
    const auto content = std::make_shared<const std::vector<std::byte>>(readFile(path, kMaxGlbBytes));
    std::string rest;
    std::optional<BareIndices> bare;
    {
        nlohmann::json document = parseJson(textOf(*content, name), name);
        const JsonNode root(document, name);
        file.notices = checkGltf(root);
        BufferReader reader(path, content);
        if (const auto buffers = root.find("buffers"))
            buffers->forEachElement(
                [&](const JsonNode& buffer) { file.buffers.push_back(reader.read(buffer, file.buffers.empty())); });
        if (const auto images = root.find("images"))
            images->forEachElement([&](const JsonNode& image) { file.images.push_back(readImage(image)); });
        file.bytes = reader.bytes();
        file.notices.insert(file.notices.end(), reader.notices().begin(), reader.notices().end());
        document.erase("buffers");
        document.erase("images");
        bare.emplace(document);
        rest = document.dump();
    }
    parseRest(rest, name, file.model);
    bare->putBack(file.model);
    // checkGltf() compared with the lengths as stated.
    for (std::size_t i = 0; i < file.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = file.model.bufferViews[i];
        if (knowsMeshopt() && view.extensions.count("EXT_meshopt_compression") > 0) continue; // decodeMeshopt() looks
        if (view.byteOffset + view.byteLength > file.buffers[static_cast<std::size_t>(view.buffer)].bytes.size())
            file.fail("/bufferViews/" + std::to_string(i),
                      "its buffer has no uri, and there is no binary chunk for it");
    }
    return file;
}

std::span<const std::byte> GltfImages::encoded(std::uint32_t image) const {
    const std::string place = "/images/" + std::to_string(image);
    if (image >= file_.images.size())
        file_.fail(place, "the file has " + counted(file_.images.size(), "image", "images"));
    const GltfImage& source = file_.images[image];
    if (source.bufferView >= 0) return file_.view(source.bufferView);
    if (source.content.empty()) file_.fail(place, "is not inside the file");
    return source.content;
}

} // namespace rt::scene
