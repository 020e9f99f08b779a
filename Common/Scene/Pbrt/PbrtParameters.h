// The parameters of a directive, as "float radius" 2: lists of values with a type and a name.
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/Pbrt/PbrtNumbers.h"
#include "Common/Scene/Pbrt/PbrtPlace.h"

namespace rt::scene {

struct PbrtColorSpace;

enum class PbrtType { Number, Integer, Text, Bool, Point2, Vector3, Spectrum, Rgb, Blackbody, Texture };

struct PbrtParameter {
    PbrtType type = PbrtType::Number;
    std::string typeName, name; // as they were written
    PbrtPlace place;
    mutable std::vector<double> numbers;        // of all but integers
    mutable PbrtLongList longList;              // instead, where they are more than kShortList
    mutable std::vector<std::int32_t> integers; // also truth values
    std::vector<std::string> texts;
    const PbrtColorSpace* space = nullptr; // of Rgb: the one in use there
    mutable bool isUsed = false;

    static constexpr std::size_t kShortList = std::size_t{1} << 16; // only meshes have more
    std::size_t count() const { return numbers.size() + longList.size(); }
    void addNumber(double number);

    std::string label() const { return '"' + typeName + ' ' + name + '"'; }
    [[noreturn]] void fail(const std::string& message) const { place.fail(label() + ": " + message); }
};

// The type of this name; unset: there is none. kPbrtTypes: all names, for messages.
std::optional<PbrtType> pbrtTypeOf(std::string_view name);
extern const char* const kPbrtTypes;

// Looks parameters up by name; what was looked up in vain or never is told by who asks. All throw InputError where a
// value is not of the kind that is asked for.
class PbrtParameters {
  public:
    std::string what; // whose: `Shape "sphere"`
    PbrtPlace place;
    std::vector<PbrtParameter> list;

    // The first of the name; null: there is none. What has further ones, as defaults, counts those as used, too.
    const PbrtParameter* find(std::string_view name) const;
    const PbrtParameter* find(std::string_view name, PbrtType type) const; // fails where it has another type
    bool has(std::string_view name) const { return find(name) != nullptr; }

    double number(std::string_view name, double usual) const; // finite
    double number(std::string_view name, double usual, double least, double most) const;
    int integer(std::string_view name, int usual) const;
    bool boolean(std::string_view name, bool usual) const;
    std::string string(std::string_view name, const std::string& usual) const;
    // One of the list, or it fails naming all.
    std::string oneOf(std::string_view name, const std::string& usual,
                      std::initializer_list<const char*> allowed) const;
    glm::dvec3 vector(std::string_view name, const glm::dvec3& usual) const; // finite
    // Flat arrays; empty: there is none. They may be all of a file, so that nothing is left where they were.
    template <class Real>
    std::vector<glm::vec<3, Real>> takeVectors(std::string_view name) const;
    template <class Real>
    std::vector<glm::vec<2, Real>> takePairs(std::string_view name) const;
    bool isLong(std::string_view name) const; // of single precision

    [[noreturn]] void fail(const std::string& message) const { place.fail(what + ": " + message); }
    std::vector<const PbrtParameter*> unused() const;
};

// Within +-kLargest; fails where it is not.
double pbrtFinite(const PbrtParameter& parameter, double value);

} // namespace rt::scene
