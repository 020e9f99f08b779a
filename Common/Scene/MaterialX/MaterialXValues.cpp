#include "Common/Scene/MaterialX/MaterialXValues.h"

#include <cmath>

#include "Common/Core/Printable.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

std::size_t countOf(std::string_view type) {
    const char last = type.empty() ? '1' : type.back();
    return last >= '2' && last <= '4' ? static_cast<std::size_t>(last - '0') : 1;
}

} // namespace

std::optional<glm::dvec4> materialXValue(std::string_view text, std::string_view type) {
    if (type == "boolean") return std::nullopt;
    glm::dvec4 value(1);
    std::size_t count = 0;
    for (bool isLast = false; !isLast; ++count) {
        const std::size_t comma = text.find(',');
        isLast = comma == text.npos;
        const std::optional<double> number = numberOf(trimmed(text.substr(0, comma)));
        if (count == 4 || !number || !std::isfinite(*number)) return std::nullopt;
        value[static_cast<glm::length_t>(count)] = *number;
        if (!isLast) text.remove_prefix(comma + 1);
    }
    if (count != countOf(type) && !type.empty()) return std::nullopt;
    return count == 1 ? glm::dvec4(value.x) : value;
}

std::string materialXExpectation(std::string_view type) {
    if (type == "boolean") return "a number";
    const std::size_t count = countOf(type);
    return count == 1 ? "a number" : std::to_string(count) + " numbers between commas";
}

std::string materialXPlace(const XmlElement& element) {
    const std::string* name = element.find("name");
    const std::string text = "<" + printable(element.name, 100);
    return name != nullptr ? text + " \"" + printable(*name, 100) + "\">" : text + ">";
}

bool isSrgb(std::string_view space) {
    return space == "srgb_texture" || space == "srgb" || space == "sRGB";
}

bool isLinear(std::string_view space) {
    return space.empty() || space == "lin_rec709" || space == "lin_rec709_scene" || space == "none" || space == "raw" ||
           space == "Raw" || space == "linear";
}

// IEC 61966-2-1.
glm::dvec4 decodedSrgb(const glm::dvec4& color) {
    glm::dvec4 linear = color; // with the opacity as it is
    for (glm::length_t c = 0; c < 3; ++c)
        linear[c] = color[c] <= 0.04045 ? color[c] / 12.92 : std::pow((color[c] + 0.055) / 1.055, 2.4);
    return linear;
}

} // namespace rt::scene
