// A file of glTF 2.0 in the making: its JSON, its one buffer, and files beside it.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

namespace rt::scene {

using OrderedJson = nlohmann::ordered_json;

inline OrderedJson arrayOf(const glm::dvec3& v) {
    return OrderedJson::array({v.x, v.y, v.z});
}

// What is left out and why, each once.
class GltfNotices {
  public:
    void add(const std::string& line) { lines_.insert(line); }
    // Of materials or textures, which are counted: `kind "name" and 2 more: notice`.
    void add(const std::string& kind, const std::string& name, const std::string& notice) {
        named_[{kind, notice}].insert(name);
    }
    // Of which glTF has no word: "one medium", "3 media".
    void leaveOut(const char* one, const char* many, std::size_t count = 1);

    std::vector<std::string> lines() const; // the first names all that was left out

  private:
    std::map<std::string, std::pair<std::string, std::size_t>> counts_; // of many, by what one of them is called
    std::set<std::string> lines_;
    std::map<std::pair<std::string, std::string>, std::set<std::string>> named_; // by kind and notice
};

class GltfDocument {
  public:
    // Which may be .glb, with everything inside, or .gltf, with buffer and images beside.
    explicit GltfDocument(std::filesystem::path file);

    // Returns the index in an array of the document.
    int add(const char* array, OrderedJson element);
    // The same for the array of an extension of the document.
    int addOf(const char* extension, const char* array, OrderedJson element);
    void use(const std::string& extension) { used_.insert(extension); }
    OrderedJson& root() { return root_; }

    // Accessors of vertices; `hasBounds`: says what the least and largest components are.
    int addVertices(std::span<const glm::vec2> values);
    int addVertices(std::span<const glm::vec3> values, bool hasBounds = false);
    int addVertices(std::span<const glm::vec4> values);
    // Of as few bytes as the number of vertices allows.
    int addIndices(std::span<const glm::uvec3> triangles, std::size_t vertices);

    // PNG or JPEG; of its name that of the file is made, if it is one beside.
    int addImage(std::span<const std::byte> content, const std::string& name);

    // Replaces the files, the one that names the others last. Throws RenderError.
    void write();

  private:
    int addView(std::span<const std::byte> bytes, int target);
    int addAccessor(std::span<const std::byte> bytes, int target, OrderedJson accessor);
    std::string nameBeside(const std::string& name, const std::string& ending);
    void writeBinary(const std::string& text);

    const std::filesystem::path file_;
    const bool isBinary_;
    const std::string stem_; // begins the names of files beside
    OrderedJson root_;
    std::vector<std::byte> buffer_;
    std::set<std::string> used_; // extensions
    std::map<std::filesystem::path, std::vector<std::byte>> beside_;
    std::set<std::string> names_; // of files beside, in lower case
};

// A file name as part of a URI.
std::string toUri(const std::string& name);

} // namespace rt::scene
