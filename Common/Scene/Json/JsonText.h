// The text of a JSON document. Mistakes are InputErrors that name file, line and column: syntax, numbers out of range,
// a key that appears twice in an object, values nested deeper than 256.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace rt::scene {

// A value that may hold long arrays. The library's destructor allocates memory in proportion to them, and ends the
// program where there is none; this one takes arrays and objects apart, which needs none.
class LargeJson {
  public:
    explicit LargeJson(nlohmann::json value = nullptr) : value_(std::move(value)) {}
    ~LargeJson();
    LargeJson(LargeJson&& other) noexcept : value_(std::exchange(other.value_, nullptr)) {}
    LargeJson& operator=(LargeJson&&) = delete;

    nlohmann::json& operator*() { return value_; }
    const nlohmann::json& operator*() const { return value_; }

  private:
    nlohmann::json value_;
};

nlohmann::json parseJson(std::string_view text, const std::string& file);

// A document of which one array, a member of the root, may be long: where it holds nothing but objects they are left
// out of the document and parsed one by one, as all at once take ten times the memory of the text.
class LongJson {
  public:
    // Text and file must outlive this.
    LongJson(std::string_view text, const std::string& file, std::string_view longArray);

    // With an empty array where elements are left out.
    LargeJson document() const;
    std::size_t elementCount() const { return elements_.size(); } // 0: none is left out
    LargeJson element(std::size_t index) const;

  private:
    std::string_view text_;
    const std::string& file_;
    std::vector<std::string_view> elements_; // of text_
};

} // namespace rt::scene
