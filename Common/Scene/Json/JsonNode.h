// A value of a JSON document that knows where it stands, so that every complaint names the file, the path and the
// value.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace rt::scene {

// Numbers of a scene stay within this, and lengths above its inverse: their fourth powers are finite and not 0 in
// single precision.
inline constexpr double kLargest = 1e9;

// Refers to its parent, which must outlive it. All readers throw InputError when the value is not of their kind.
class JsonNode {
  public:
    JsonNode(const nlohmann::json& document, const std::string& file) : value_(&document), file_(&file) {}
    // An element of an array whose value is kept elsewhere (JsonText.h).
    JsonNode(const nlohmann::json& value, const JsonNode& array, std::size_t index)
        : JsonNode(value, array, nullptr, index) {}

    const nlohmann::json& value() const { return *value_; }
    const std::string& file() const { return *file_; }
    std::string path() const; // "/objects/3/radius"

    // ---- structure
    // An object with none but these keys.
    void expectKeys(std::span<const char* const> allowed) const;
    void expectKeys(std::initializer_list<const char*> allowed) const {
        expectKeys(std::span(allowed.begin(), allowed.size()));
    }
    JsonNode at(const char* key) const; // must exist
    std::optional<JsonNode> find(const char* key) const;
    bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
    std::size_t arraySize() const; // must be an array
    JsonNode element(std::size_t index) const;
    template <typename Function> // (const std::string& key, const JsonNode& member), in the order of the keys
    void forEachMember(Function function) const;
    template <typename Function> // (const JsonNode& element)
    void forEachElement(Function function) const;

    // ---- values
    bool boolean() const;
    std::string string() const;
    std::string oneOf(std::initializer_list<const char*> allowed) const;
    double number() const;   // within +-kLargest
    double positive() const; // from 1 / kLargest to kLargest
    double within(double low, double high) const;
    std::uint32_t unsignedInteger() const;
    glm::dvec3 vector() const { return vectorWithin(-kLargest, kLargest); }
    glm::dvec3 vectorWithin(double low, double high) const; // each component
    // A flat array of numbers, a multiple of `width` of them.
    std::vector<double> numbers(std::size_t width) const;

    // "FILE: PATH: VALUE: must be EXPECTED"
    [[noreturn]] void failValue(const std::string& expected) const;
    // "FILE: PATH: MESSAGE"
    [[noreturn]] void fail(const std::string& message) const;

  private:
    JsonNode(const nlohmann::json& value, const JsonNode& parent, const char* key, std::size_t index)
        : value_(&value), file_(parent.file_), parent_(&parent), key_(key), index_(index) {}

    const nlohmann::json* value_;
    const std::string* file_;
    const JsonNode* parent_ = nullptr;
    const char* key_ = nullptr; // null: an element of an array
    std::size_t index_ = 0;
};

template <typename Function>
void JsonNode::forEachMember(Function function) const {
    if (!value_->is_object()) failValue("an object");
    for (const auto& [key, member] : value_->items()) function(key, JsonNode(member, *this, key.c_str(), 0));
}

template <typename Function>
void JsonNode::forEachElement(Function function) const {
    const std::size_t count = arraySize();
    for (std::size_t i = 0; i < count; ++i) function(element(i));
}

} // namespace rt::scene
