#include "Common/Scene/Gltf/GltfFile.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <optional>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Gltf/GltfCheck.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxGlbBytes = std::numeric_limits<std::uint32_t>::max(); // of .glb, by its header

// "%20" is a space.
std::string decodedUri(const std::string& uri) {
    const auto digit = [](char c) -> int {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool isEscape = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
        text += isEscape ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
        if (isEscape) i += 2;
    }
    return text;
}

// What the parser asks for while it runs; it knows no exceptions.
struct FileReader {
    fs::path path;
    std::uint64_t bytes = 0;
    std::exception_ptr error;
};

bool readBuffer(std::vector<unsigned char>* out, std::string* message, const std::string& file, void* user) {
    FileReader& reader = *static_cast<FileReader*>(user);
    try {
        const std::vector<std::byte> content = readFile(file, kMaxGlbBytes);
        out->resize(content.size());
        std::memcpy(out->data(), content.data(), content.size());
        reader.bytes += content.size();
        return true;
    } catch (...) {
        reader.error = std::current_exception();
        *message += "cannot be read";
        return false;
    }
}

// Images stay as they are encoded: those of buffer views there, those of data URIs here.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                 int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// Later versions ask for the size as well.
template <typename Callbacks>
void setSizeCallback(Callbacks& callbacks) {
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& file, void*) {
            std::error_code error;
            *size = static_cast<std::size_t>(fs::file_size(file, error));
            return !error;
        };
}

tinygltf::FsCallbacks callbacksFor(FileReader& reader) {
    tinygltf::FsCallbacks callbacks{};
    // The parser also looks in the working directory, which is no place for a scene's files.
    callbacks.FileExists = [](const std::string& file, void*) { return fs::path(file).is_absolute(); };
    callbacks.ExpandFilePath = [](const std::string& file, void*) { return file; };
    callbacks.ReadWholeFile = readBuffer;
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    setSizeCallback(callbacks);
    callbacks.user_data = &reader;
    return callbacks;
}

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
    constexpr std::size_t kHeader = 20;
    constexpr std::uint32_t kJson = 0x4e4f534a;
    if (bytes.size() < kHeader) throw InputError(file + ": ends within the header of a .glb file");
    if (const std::uint32_t version = wordAt(bytes, 4); version != 2)
        throw InputError(file + ": version " + std::to_string(version) + " of the .glb format: must be 2");
    if (const std::uint32_t length = wordAt(bytes, 8); length > bytes.size())
        throw InputError(file + ": has " + std::to_string(bytes.size()) + " bytes of the " + std::to_string(length) +
                         " that its header states");
    const std::uint32_t length = wordAt(bytes, 12);
    if (wordAt(bytes, 16) != kJson || length > bytes.size() - kHeader)
        throw InputError(file + ": the first chunk is not JSON of a length that the file has");
    return {text + kHeader, length};
}

std::string firstLine(const std::string& message) {
    return printable(message.substr(0, message.find('\n')));
}

} // namespace

void GltfFile::fail(const std::string& place, const std::string& message) const {
    throw InputError(path.string() + ": " + place + ": " + message);
}

std::span<const std::byte> GltfFile::view(int bufferView) const {
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(bufferView)];
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

fs::path besideGltf(const fs::path& path, const std::string& uri) {
    const std::string text = decodedUri(uri);
    const fs::path name(text);
    const bool hasScheme = text.find(':') != text.npos; // also a drive's letter
    if (text.empty() || hasScheme || text.find('\0') != text.npos || name.is_absolute())
        throw InputError(path.string() + ": \"" + printable(uri, 200) + "\": must be the relative path of a file");
    return (fs::absolute(path).parent_path() / name).lexically_normal();
}

GltfFile readGltf(const fs::path& path) {
    GltfFile file;
    file.path = path;
    const std::string name = path.string();
    const std::vector<std::byte> content = readFile(path, kMaxGlbBytes);
    const std::string_view text = textOf(content, name);
    {
        const nlohmann::json document = parseJson(text, name);
        const JsonNode root(document, name);
        file.notices = checkGltf(root);
        if (const auto buffers = root.find("buffers"))
            buffers->forEachElement([&](const JsonNode& buffer) {
                const auto uri = buffer.find("uri");
                if (uri && uri->string().rfind("data:", 0) != 0) besideGltf(path, uri->string());
            });
    }
    FileReader reader{path, content.size(), nullptr};
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(callbacksFor(reader));
    parser.SetImageLoader(keepEncoded, nullptr);
    const std::string folder = fs::absolute(path).parent_path().string();
    std::string errors, warnings;
    bool isRead = false;
    try {
        const auto* bytes = reinterpret_cast<const unsigned char*>(content.data());
        isRead = isBinary(content) ? parser.LoadBinaryFromMemory(&file.model, &errors, &warnings, bytes,
                                                                 static_cast<unsigned>(content.size()), folder)
                                   : parser.LoadASCIIFromString(&file.model, &errors, &warnings, text.data(),
                                                                static_cast<unsigned>(text.size()), folder);
    } catch (const std::exception& error) { // of its containers, at what it does not check
        throw InputError(name + ": not a valid file of glTF: " + firstLine(error.what()));
    }
    if (reader.error) std::rethrow_exception(reader.error);
    if (!isRead) throw InputError(name + ": " + firstLine(errors));
    // checkGltf() compared with the lengths as stated.
    const auto buffers = file.model.buffers.size();
    for (const tinygltf::BufferView& view : file.model.bufferViews)
        if (static_cast<std::size_t>(view.buffer) >= buffers ||
            view.byteOffset + view.byteLength > file.model.buffers[static_cast<std::size_t>(view.buffer)].data.size())
            throw InputError(name + ": /bufferViews: one ends beyond its buffer");
    file.bytes = reader.bytes;
    return file;
}

std::span<const std::byte> GltfImages::encoded(std::uint32_t image) const {
    const std::string place = "/images/" + std::to_string(image);
    if (image >= file_.model.images.size())
        file_.fail(place, "there are " + std::to_string(file_.model.images.size()) + " images");
    const tinygltf::Image& source = file_.model.images[image];
    if (source.bufferView >= 0) return file_.view(source.bufferView);
    if (source.image.empty()) file_.fail(place, "lies in a file of its own");
    return std::as_bytes(std::span(source.image));
}

} // namespace rt::scene
