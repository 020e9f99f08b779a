// Scenes whose radiance is known in closed form.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::test {

// A scene with nothing but a camera in `from` that looks at `at` through a field of view of `fov` degrees.
scene::SceneDesc emptyScene(glm::dvec3 from, glm::dvec3 at, double fov);

// Grey, emitting from both sides.
scene::MaterialDesc lambertian(double albedo, double emission = 0);

// Camera inside of a closed shell, a cube or a sphere, whose walls emit `emission` and reflect `albedo`.
scene::SceneDesc shell(bool box, double albedo, double emission);
// What it sees after `depth` vertices.
double enclosureRadiance(double albedo, double emission, int depth);

// A unit sphere of this material under a sky of radiance 1.
scene::SceneDesc inWhiteSky(const scene::MaterialDesc& material);

// A floor of this material under that sky, seen at this cosine.
scene::SceneDesc floorInWhiteSky(const scene::MaterialDesc& material, double cosine);

// Where it meets light at grazing angles, white sheen of this roughness over white sends out all of it.
scene::MaterialDesc whiteSheen(double roughness);
scene::MaterialDesc roughGlass(double ior, double roughness);

inline constexpr double kFloorAlbedo = 0.7;

// A black ball of radius 1 that stands under a sky of radiance 1 on a white floor of this half size, tilted, seen at
// `x` from where they touch; and what is seen there.
enum class HugeFloor { Quad, Triangles, Box };
scene::SceneDesc ballOnFloor(HugeFloor floor, double halfSize, double x);
double skyBesideBall(double x);

// The floor y = 0 around the origin, looked at from the side, and a material "light" of radiance (3, 2, 1).
scene::SceneDesc floorScene();

// A sphere of radiance 1 that also reflects, under this transform, seen as large from `distance` as from anywhere:
// nothing else lights it, so that it is seen at 1.
scene::SceneDesc lampAlone(const scene::Transform& transform, double distance);
// Flat, sheared and mirrored ones for it.
std::vector<scene::Transform> lampTransforms();

// Lambert's polygon formula for a receiver in the origin with normal +y, per radiance; all vertices above the horizon.
double polygonIrradiance(std::span<const glm::dvec3> vertices);

// floorScene() under a lamp of radiance (3, 2, 1) that is partly clear, for each reason and shape there is.
struct ClearLamp {
    const char* what;
    scene::SceneDesc desc;
    double formFactor; // pi times the irradiance at the origin, per radiance
};
std::vector<ClearLamp> clearLamps();

// Punctual lights of every kind that shine on the origin of floorScene(): one light a scene.
std::vector<scene::ObjectDesc> punctualLights();
// `count` of all kinds, above, below and beside the floor.
std::vector<scene::ObjectDesc> manyPunctualLights(std::uint32_t count);
// floorScene() under them, small and seen from above: rounding hardly moves the point that is lit, so that the
// irradiance is that of the origin within 1e-5.
scene::SceneDesc floorUnder(const std::vector<scene::ObjectDesc>& lights);
// Irradiance at the origin of a surface with the normal +y from those of `objects` that are punctual lights, with
// nothing in between.
glm::dvec3 punctualIrradiance(const std::vector<scene::ObjectDesc>& objects);

} // namespace rt::test
