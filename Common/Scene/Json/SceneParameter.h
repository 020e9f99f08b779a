// A parameter of a texture or a material as scene files have it: the reader, the writer and the tests of the schema
// follow from it and from the type of the member that it is read into.
#pragma once
#include <string>
#include <type_traits>
#include <vector>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

template <class T>
concept IsEnumeration = std::is_enum_v<T>;

// The type of the member says what else it may be: components of a colour lie in [0,1], a string is the name of a file.
struct SceneParameter {
    const char* name;
    bool isRequired; // else a new record's value stands where a file says nothing
    const char* help = "";
    double minimum = -kLargest; // numbers
    double maximum = kLargest;
    const std::vector<std::string>& (*choices)() = nullptr; // strings; enumerations, in the order of their values
    const char* section = nullptr;                          // strings: the name of one of its members instead
};

inline constexpr double kSmallest = 1 / kLargest;

} // namespace rt::scene
