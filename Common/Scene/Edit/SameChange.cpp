#include "Common/Scene/Edit/SameChange.h"

#include <tuple>
#include <type_traits>

namespace rt::scene {

namespace {

// ---- what is changed of each kind ----------------------------------------------------------------------------------

constexpr auto membersOf(const SphereDesc*) {
    return std::tuple(&SphereDesc::center, &SphereDesc::radius, &SphereDesc::centerEnd, &SphereDesc::light);
}
constexpr auto membersOf(const QuadDesc*) {
    return std::tuple(&QuadDesc::corner, &QuadDesc::edgeU, &QuadDesc::edgeV, &QuadDesc::light);
}
constexpr auto membersOf(const BoxDesc*) {
    return std::tuple(&BoxDesc::min, &BoxDesc::max, &BoxDesc::light);
}
constexpr auto membersOf(const DiskDesc*) {
    return std::tuple(&DiskDesc::center, &DiskDesc::normal, &DiskDesc::radius, &DiskDesc::innerRadius,
                      &DiskDesc::light);
}
constexpr auto membersOf(const CylinderDesc*) {
    return std::tuple(&CylinderDesc::base, &CylinderDesc::top, &CylinderDesc::radius, &CylinderDesc::light);
}
constexpr auto membersOf(const SphereBoundary*) {
    return std::tuple(&SphereBoundary::center, &SphereBoundary::radius);
}
constexpr auto membersOf(const BoxBoundary*) {
    return std::tuple(&BoxBoundary::min, &BoxBoundary::max);
}
constexpr auto membersOf(const MediumDesc*) {
    return std::tuple(&MediumDesc::boundary, &MediumDesc::density, &MediumDesc::albedo);
}
constexpr auto membersOf(const PointLightDesc*) {
    return std::tuple(&PointLightDesc::position, &PointLightDesc::intensity);
}
constexpr auto membersOf(const SpotLightDesc*) {
    return std::tuple(&SpotLightDesc::position, &SpotLightDesc::direction, &SpotLightDesc::intensity,
                      &SpotLightDesc::innerAngle, &SpotLightDesc::outerAngle);
}
constexpr auto membersOf(const DirectionalLightDesc*) {
    return std::tuple(&DirectionalLightDesc::direction, &DirectionalLightDesc::irradiance);
}
constexpr auto membersOf(const Translate*) {
    return std::tuple(&Translate::offset);
}
constexpr auto membersOf(const Rotate*) {
    return std::tuple(&Rotate::axis, &Rotate::degrees);
}
constexpr auto membersOf(const Scale*) {
    return std::tuple(&Scale::factors);
}

// ---- values --------------------------------------------------------------------------------------------------------

template <typename Value>
void takeOver(const Value& before, const Value& after, Value& other);

template <typename... Kinds>
void takeOver(const std::variant<Kinds...>& before, const std::variant<Kinds...>& after,
              std::variant<Kinds...>& other) {
    if (before.index() != after.index() || other.index() != after.index()) return;
    std::visit([&]<typename Kind>(Kind& kind) { takeOver(std::get<Kind>(before), std::get<Kind>(after), kind); },
               other);
}

void takeOver(const std::optional<glm::dvec3>& before, const std::optional<glm::dvec3>& after,
              std::optional<glm::dvec3>& other) {
    if (before && after && other) takeOver(*before, *after, *other);
}

template <typename Value>
void takeOver(const Value& before, const Value& after, Value& other) {
    if constexpr (std::is_same_v<Value, glm::dvec3>) {
        for (int i = 0; i < 3; ++i)
            if (before[i] != after[i]) other[i] = after[i];
    } else if constexpr (std::is_arithmetic_v<Value>) {
        if (before != after) other = after;
    } else if constexpr (requires { membersOf(&other); }) {
        std::apply([&](auto... member) { (takeOver(before.*member, after.*member, other.*member), ...); },
                   membersOf(&other));
    }
}

} // namespace

void changeAlike(const ObjectDesc& before, const ObjectDesc& after, ObjectDesc& other) {
    takeOver(before.shape, after.shape, other.shape);
}

void changeAlike(const Transform& before, const Transform& after, Transform& other) {
    if (before.size() != after.size() || other.size() != after.size()) return;
    for (std::size_t i = 0; i < other.size(); ++i)
        if (before[i].index() != other[i].index()) return;
    for (std::size_t i = 0; i < other.size(); ++i) takeOver(before[i], after[i], other[i]);
}

} // namespace rt::scene
