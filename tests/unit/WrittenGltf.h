// Scenes that are written as glTF, checked as a validator of the format would, and read again.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Session/SceneOutput.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/TempFolder.h"

namespace rt::scene {

inline std::string writtenText(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::uint32_t writtenWord(const std::string& text, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, text.data() + at, 4);
    return word;
}

// The JSON and the buffer of a file.
struct WrittenFile {
    nlohmann::json document;
    std::string buffer;
};

inline WrittenFile readWritten(const std::filesystem::path& path) {
    const std::string text = writtenText(path);
    if (path.extension() == ".gltf") {
        nlohmann::json document = nlohmann::json::parse(text);
        const std::filesystem::path buffer = path.parent_path() / (path.stem().string() + ".bin");
        return {document, std::filesystem::exists(buffer) ? writtenText(buffer) : std::string()};
    }
    EXPECT_EQ(writtenWord(text, 8), text.size());
    const std::size_t length = writtenWord(text, 12);
    EXPECT_EQ(length % 4, 0u);
    return {nlohmann::json::parse(text.substr(20, length)),
            text.size() > 20 + length ? text.substr(28 + length) : std::string()};
}

inline void expectFiniteNumbers(const nlohmann::json& value) {
    EXPECT_TRUE(!value.is_number() || std::isfinite(value.get<double>()));
    EXPECT_FALSE(value.is_null()) << "what JSON writes for a number that is not finite";
    if (value.is_structured())
        for (const nlohmann::json& inner : value) expectFiniteNumbers(inner);
}

// What a validator of the format asks of accessors and of what refers to them.
class GltfValidity {
  public:
    explicit GltfValidity(const WrittenFile& written) : document_(written.document), buffer_(written.buffer) {}

    void expect() const {
        expectFiniteNumbers(document_);
        if (document_.contains("buffers")) {
            EXPECT_EQ(document_["buffers"].size(), 1u);
            const std::size_t length = document_["buffers"][0]["byteLength"];
            EXPECT_LE(length, buffer_.size());
            EXPECT_GE(length + 3, buffer_.size());
        }
        for (const nlohmann::json& mesh : list("meshes"))
            for (const nlohmann::json& primitive : mesh["primitives"]) expectPrimitive(primitive);
        for (const nlohmann::json& view : list("bufferViews")) {
            EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
            EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), buffer_.size());
        }
        for (const char* array : {"nodes", "meshes", "accessors", "bufferViews", "materials", "textures", "images"})
            EXPECT_FALSE(document_.contains(array) && document_[array].empty()) << array;
        expectTree();
        std::set<std::string> used;
        addExtensions(document_, used);
        const nlohmann::json stated = document_.value("extensionsUsed", nlohmann::json::array());
        EXPECT_EQ(std::set<std::string>(stated.begin(), stated.end()), used);
        EXPECT_FALSE(document_.contains("extensionsRequired"));
    }

  private:
    nlohmann::json list(const char* array) const { return document_.value(array, nlohmann::json::array()); }

    std::vector<float> floats(const nlohmann::json& accessor, std::size_t width) const {
        EXPECT_EQ(accessor["componentType"], 5126);
        const nlohmann::json& view = document_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        EXPECT_EQ(view["target"], 34962);
        std::vector<float> values(width * accessor["count"].get<std::size_t>());
        EXPECT_EQ(view["byteLength"], values.size() * 4);
        std::memcpy(values.data(), buffer_.data() + view["byteOffset"].get<std::size_t>(), values.size() * 4);
        EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }));
        return values;
    }

    static void expectUnit(const std::vector<float>& values, std::size_t stride) {
        double farthest = 0;
        for (std::size_t i = 0; i < values.size(); i += stride)
            farthest = std::max(farthest, std::abs(std::hypot(values[i], values[i + 1], values[i + 2]) - 1.0));
        EXPECT_LT(farthest, 0.005);
    }

    void expectPrimitive(const nlohmann::json& primitive) const {
        const nlohmann::json& accessors = document_["accessors"];
        const nlohmann::json& attributes = primitive["attributes"];
        const nlohmann::json& position = accessors[attributes["POSITION"].get<std::size_t>()];
        const std::vector<float> positions = floats(position, 3);
        for (std::size_t c = 0; c < 3; ++c) {
            float least = std::numeric_limits<float>::infinity(), most = -least;
            for (std::size_t i = c; i < positions.size(); i += 3) {
                least = std::min(least, positions[i]);
                most = std::max(most, positions[i]);
            }
            EXPECT_EQ(position["min"][c].get<float>(), least);
            EXPECT_EQ(position["max"][c].get<float>(), most);
        }
        for (const auto& [name, index] : attributes.items()) {
            const nlohmann::json& accessor = accessors[index.get<std::size_t>()];
            EXPECT_EQ(accessor["count"], position["count"]) << name;
            if (name == "NORMAL") expectUnit(floats(accessor, 3), 3);
            if (name == "TANGENT") expectUnit(floats(accessor, 4), 4);
        }
        const nlohmann::json& indices = accessors[primitive["indices"].get<std::size_t>()];
        EXPECT_EQ(indices["count"].get<std::size_t>() % 3, 0u);
        const nlohmann::json& view = document_["bufferViews"][indices["bufferView"].get<std::size_t>()];
        EXPECT_EQ(view["target"], 34963);
        const bool areShort = indices["componentType"] == 5123;
        const std::size_t count = position["count"];
        EXPECT_EQ(areShort, count <= 65535);
        const std::size_t corners = indices["count"], width = areShort ? 2 : 4, start = view["byteOffset"];
        std::uint32_t largest = 0;
        for (std::size_t i = 0; i < corners; ++i) {
            std::uint32_t corner = 0;
            std::memcpy(&corner, buffer_.data() + start + width * i, width);
            largest = std::max(largest, corner);
        }
        EXPECT_LT(largest, count);
    }

    // That every node has one parent and all are reached.
    void expectTree() const {
        std::vector<int> parents(list("nodes").size());
        for (const nlohmann::json& root : document_["scenes"][0]["nodes"]) ++parents[root.get<std::size_t>()];
        for (const nlohmann::json& node : list("nodes"))
            for (const nlohmann::json& child : node.value("children", nlohmann::json::array()))
                ++parents[child.get<std::size_t>()];
        for (const int count : parents) EXPECT_EQ(count, 1);
    }

    static void addExtensions(const nlohmann::json& value, std::set<std::string>& names) {
        if (value.is_object() && value.contains("extensions"))
            for (const auto& [name, unused] : value["extensions"].items()) names.insert(name);
        if (value.is_structured())
            for (const nlohmann::json& inner : value) addExtensions(inner, names);
    }

    const nlohmann::json& document_;
    const std::string& buffer_;
};

class WrittenGltf : public testing::Test {
  protected:
    // Written, checked, and read again.
    SceneDesc again(const SceneDesc& scene, const std::string& name = "again.glb") {
        const std::filesystem::path file = folder.path() / name;
        notices = app::writeScene(file.string(), scene);
        GltfValidity(readWritten(file)).expect();
        return loadGltfScene(file);
    }
    nlohmann::json documentOf(const std::string& name) const { return readWritten(folder.path() / name).document; }
    SceneDesc parse(const std::string& text) const { return parseScene(text, "scene.json", folder.path()); }
    bool isNoticed(const std::string& part) const {
        return std::any_of(notices.begin(), notices.end(),
                           [&](const std::string& notice) { return notice.find(part) != std::string::npos; });
    }
    test::TempFolder folder;
    std::vector<std::string> notices;
};

} // namespace rt::scene
