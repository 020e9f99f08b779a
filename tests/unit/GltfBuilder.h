// Small files of glTF, made of values.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

namespace rt::scene {

// A PNG of 2 x 1 pixels: (200, 100, 50) of opacity 128, and white of opacity 0.
inline const std::vector<unsigned char> kPng = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00,
    0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4, 0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00, 0x11, 0x49,
    0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x38, 0x91, 0x62, 0xd4, 0xf0, 0xff, 0xff, 0x7f, 0x06, 0x00, 0x15, 0xa8, 0x04,
    0xdc, 0x02, 0x4b, 0xb3, 0x19, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

class GltfBuilder {
  public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};

    // Appends to the one buffer; returns the number of the view.
    template <typename T>
    int addView(const std::vector<T>& values, int stride = 0) {
        while (bytes_.size() % 4 != 0) bytes_.push_back(0);
        const std::size_t start = bytes_.size();
        bytes_.resize(start + values.size() * sizeof(T));
        std::memcpy(bytes_.data() + start, values.data(), values.size() * sizeof(T));
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", values.size() * sizeof(T)}};
        if (stride != 0) view["byteStride"] = stride;
        return add("bufferViews", view);
    }
    int addAccessor(int view, int componentType, const char* type, std::size_t count, std::size_t offset = 0) {
        return add("accessors", {{"bufferView", view},
                                 {"byteOffset", offset},
                                 {"componentType", componentType},
                                 {"type", type},
                                 {"count", count}});
    }
    // Of numbers that follow each other.
    template <typename T>
    int addAccessor(const std::vector<T>& values, const char* type) {
        const std::string name = type;
        const std::size_t width = name == "SCALAR" ? 1 : static_cast<std::size_t>(name.back() - '0');
        return addAccessor(addView(values), componentType<T>(), type, values.size() / width);
    }
    int add(const char* array, const nlohmann::json& element) {
        json[array].push_back(element);
        return static_cast<int>(json[array].size()) - 1;
    }
    // A mesh of one primitive.
    int addMesh(const nlohmann::json& primitive) { return add("meshes", {{"primitives", {primitive}}}); }
    // A node of the default scene.
    int addNode(const nlohmann::json& node) {
        const int index = add("nodes", node);
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }
    // The triangle (0,0,0), (1,0,0), (0,1,0) with texture coordinates; returns its primitive.
    nlohmann::json triangle() {
        const int positions = addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        const int uvs = addAccessor(std::vector<float>{0, 1, 1, 1, 0, 0}, "VEC2");
        return {{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}}};
    }

    std::string binary() const {
        nlohmann::json document = json;
        std::vector<unsigned char> padded = bytes_;
        while (padded.size() % 4 != 0) padded.push_back(0);
        if (!padded.empty()) document["buffers"][0]["byteLength"] = bytes_.size();
        std::string text = document.dump();
        while (text.size() % 4 != 0) text += ' ';
        std::string file = "glTF";
        const std::size_t total = 20 + text.size() + (padded.empty() ? 0 : 8 + padded.size());
        for (const std::size_t word : {std::size_t{2}, total, text.size(), std::size_t{0x4e4f534a}})
            appendWord(file, word);
        file += text;
        if (padded.empty()) return file;
        appendWord(file, padded.size());
        appendWord(file, 0x004e4942);
        file.append(reinterpret_cast<const char*>(padded.data()), padded.size());
        return file;
    }
    std::filesystem::path save(const std::filesystem::path& path) const {
        write(path, binary());
        return path;
    }
    // As text whose buffer lies in a file beside it.
    std::filesystem::path saveWithBuffer(const std::filesystem::path& path, const std::string& uri,
                                         const std::filesystem::path& buffer) const {
        nlohmann::json document = json;
        document["buffers"][0] = {{"byteLength", bytes_.size()}, {"uri", uri}};
        write(path, document.dump());
        write(buffer, std::string(reinterpret_cast<const char*>(bytes_.data()), bytes_.size()));
        return path;
    }
    static void write(const std::filesystem::path& path, const std::string& content) {
        std::ofstream(path, std::ios::binary) << content;
    }

  private:
    template <typename T>
    static int componentType() {
        if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
        if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
        if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
        if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
        if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
        return 5126;
    }
    static void appendWord(std::string& file, std::size_t word) {
        for (int i = 0; i < 4; ++i) file += static_cast<char>(word >> 8 * i & 0xff);
    }

    std::vector<unsigned char> bytes_;
};

} // namespace rt::scene
