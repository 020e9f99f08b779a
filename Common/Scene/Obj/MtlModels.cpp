#include "Common/Scene/Obj/MtlModels.h"

#include <algorithm>
#include <initializer_list>

#include <glm/common.hpp>

namespace rt::scene {

namespace {

bool is(const MtlMaterial& m, std::initializer_list<int> models) {
    return m.illumination && std::ranges::count(models, *m.illumination) > 0;
}

bool saysLight(const MtlMaterial& m) {
    return m.emissionMap || (m.emission && maxComponent(*m.emission) > 0);
}

} // namespace

double maxComponent(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 colorOf(const std::optional<glm::dvec3>& stated, const glm::dvec3& usual) {
    return glm::clamp(stated.value_or(usual), 0.0, 1.0);
}

bool saysUnlit(const MtlMaterial& m) {
    return is(m, {0}) && !saysLight(m);
}

bool hasNoHighlight(const MtlMaterial& m) {
    return is(m, {0, 1});
}

bool hasDiffuse(const MtlMaterial& m) {
    return m.diffuseMap || (m.diffuse && maxComponent(*m.diffuse) > 0);
}

bool isGlass(const MtlMaterial& m) {
    return is(m, {6, 7}) || (is(m, {4, 9}) && !hasDiffuse(m));
}

bool saysMetallic(const MtlMaterial& m) {
    return m.metallic || m.metallicMap;
}

bool isLayered(const MtlMaterial& m) {
    return m.sheen.value_or(0) > 0 || m.sheenMap || m.clearcoat.value_or(0) > 0;
}

bool isBumpy(const MtlMaterial& m) {
    return m.normalMap || m.bumpMap;
}

bool isSeeThrough(const MtlMaterial& m) {
    return m.opacity.value_or(1) < 1 || m.opacityMap;
}

bool usesPbr(const MtlMaterial& m) {
    return saysMetallic(m) || m.roughness || m.roughnessMap || isLayered(m);
}

glm::dvec3 specularOf(const MtlMaterial& m) {
    return colorOf(m.specular, glm::dvec3(m.specularMap ? 1 : 0));
}

bool isShiny(const MtlMaterial& m) {
    return maxComponent(specularOf(m)) > 0 && !hasNoHighlight(m);
}

bool isMirror(const MtlMaterial& m) {
    return is(m, {3, 5, 8}) && isShiny(m) && !saysMetallic(m);
}

MtlMaterial bareOf(MtlMaterial m) {
    if (m.diffuseMap && (!m.diffuse || *m.diffuse == glm::dvec3(0))) m.diffuse = glm::dvec3(1);
    for (MtlMap* map : {&m.diffuseMap, &m.specularMap, &m.emissionMap, &m.opacityMap, &m.normalMap, &m.bumpMap,
                        &m.roughnessMap, &m.metallicMap, &m.sheenMap})
        *map = {};
    return m;
}

bool isFiltered(const MtlMaterial& m) {
    const glm::dvec3 filter = m.filter.value_or(glm::dvec3(1));
    return isSeeThrough(m) && filter != glm::dvec3(1) && filter != glm::dvec3(0);
}

} // namespace rt::scene
