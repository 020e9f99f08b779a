// What the tests of tables of scene files know of parameters: a value that none has by default, and its schema.
#pragma once
#include <array>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Scene/Json/SceneParameter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::test {

using Json = nlohmann::json;
using scene::ColorOrTexture;
using scene::NumberOrTexture;
using scene::SceneParameter;

// ---- values --------------------------------------------------------------------------------------------------------

inline Json sample(const SceneParameter& p, const std::string&) {
    return p.choices ? Json(p.choices().back()) : p.section ? Json("other") : Json("none.jpg");
}
inline Json sample(const SceneParameter&, const glm::dvec3&) {
    return {0.125, 0.25, 0.5};
}
inline Json sample(const SceneParameter&, const std::array<double, 6>&) {
    return {2, 0, 0.5, 0, -2, 0.25};
}
inline Json sample(const SceneParameter&, const ColorOrTexture&) {
    return "other";
}
inline Json sample(const SceneParameter&, const NumberOrTexture&) {
    return {{"texture", "other"}, {"channel", "alpha"}, {"factor", 0.75}};
}
inline Json sample(const SceneParameter&, bool usual) {
    return !usual;
}
inline Json sample(const SceneParameter& p, double) {
    const double value = p.maximum >= 2.5 ? 2.5 : 0.25 * p.minimum + 0.75 * p.maximum;
    EXPECT_GE(value, p.minimum);
    return value;
}
inline Json sample(const SceneParameter& p, const std::optional<double>&) {
    return sample(p, 0.0);
}
inline Json sample(const SceneParameter& p, std::uint32_t) {
    return p.maximum >= 7 ? 7u : static_cast<std::uint32_t>(p.maximum);
}
inline Json sample(const SceneParameter& p, const std::optional<std::uint32_t>&) {
    return sample(p, 0u);
}
template <scene::IsEnumeration Enumeration>
Json sample(const SceneParameter& p, Enumeration) {
    return p.choices().back();
}

// ---- schemas -------------------------------------------------------------------------------------------------------

inline Json schemaOf(const SceneParameter& p, const std::string&) {
    return p.choices ? Json{{"enum", p.choices()}} : Json{{"type", "string"}};
}
inline Json schemaOf(const SceneParameter&, const glm::dvec3&) {
    return {{"$ref", "#/definitions/color"}};
}
inline Json schemaOf(const SceneParameter&, const std::array<double, 6>&) {
    return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 6}, {"maxItems", 6}};
}
inline Json schemaOf(const SceneParameter&, const ColorOrTexture&) {
    return {{"$ref", "#/definitions/color_or_texture"}};
}
inline Json schemaOf(const SceneParameter&, const NumberOrTexture&) {
    return {{"$ref", "#/definitions/number_or_texture"}};
}
inline Json schemaOf(const SceneParameter&, bool usual) {
    return {{"type", "boolean"}, {"default", usual}};
}
inline Json schemaOf(const SceneParameter& p, const std::optional<double>&) {
    return {{"type", "number"}, {"minimum", p.minimum}, {"maximum", p.maximum}};
}
inline Json schemaOf(const SceneParameter& p, double usual) {
    Json schema = schemaOf(p, std::optional<double>());
    if (!p.isRequired) schema["default"] = usual;
    return schema;
}
inline Json schemaOf(const SceneParameter& p, const std::optional<std::uint32_t>&) {
    return {{"type", "integer"}, {"minimum", p.minimum}, {"maximum", p.maximum}};
}
inline Json schemaOf(const SceneParameter& p, std::uint32_t usual) {
    Json schema = schemaOf(p, std::optional<std::uint32_t>());
    schema["default"] = usual;
    return schema;
}
template <scene::IsEnumeration Enumeration>
Json schemaOf(const SceneParameter& p, Enumeration) {
    return {{"enum", p.choices()}};
}

// With the help of its row. What stands beside a reference is ignored by validators.
inline Json described(const SceneParameter& p, Json schema) {
    if (!*p.help) return schema;
    if (schema.contains("$ref")) schema = {{"allOf", Json::array({schema})}};
    schema["description"] = p.help;
    return schema;
}

} // namespace rt::test
