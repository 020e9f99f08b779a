// What the statements of a material amount to: its model of illumination, `illum`, and what is said beside it.
#pragma once
#include <optional>

#include <glm/vec3.hpp>

#include "Common/Scene/Obj/MtlFile.h"

namespace rt::scene {

double maxComponent(const glm::dvec3& v);
// A colour or what is usual instead, with components in [0,1].
glm::dvec3 colorOf(const std::optional<glm::dvec3>& stated, const glm::dvec3& usual);

bool saysUnlit(const MtlMaterial& m);      // as bright as Kd: 0, unless it says how bright by Ke
bool hasNoHighlight(const MtlMaterial& m); // 0 and 1
bool isMirror(const MtlMaterial& m);       // 3, 5, 8, unless it reflects nothing or says by Pm how it does
bool isGlass(const MtlMaterial& m);        // 6, 7, and 4, 9 without Kd
bool hasDiffuse(const MtlMaterial& m);
bool isShiny(const MtlMaterial& m); // Ks counts
glm::dvec3 specularOf(const MtlMaterial& m);
bool saysMetallic(const MtlMaterial& m);
bool isLayered(const MtlMaterial& m); // sheen, clear coat
bool isBumpy(const MtlMaterial& m);
bool isSeeThrough(const MtlMaterial& m); // by d, Tr and their map
bool isFiltered(const MtlMaterial& m);   // what passes through has a colour
bool usesPbr(const MtlMaterial& m);      // the PBR extension

// The material without its maps. A black Kd beside a map is none, and as white as one that is not said.
MtlMaterial bareOf(MtlMaterial m);

} // namespace rt::scene
