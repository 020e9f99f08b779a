// Rays against a scene, an array of them at a time, and the rays of its camera.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Shape/Surface.h"
#include "Python/Activity.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Scene.h"

namespace rt::python {
namespace {

namespace py = pybind11;
using namespace rt::shared;

constexpr std::size_t kRaysAtATime = 1024;

struct RayArguments {
    Rows origins, directions, tMax, time;
    std::size_t count;

    RayArguments(const py::object& o, const py::object& d, const py::object& t, const py::object& when)
        : origins(o, "origins", 3),
          directions(d, "directions", 3, Demand::UnitOr0),
          tMax(t, "t_max", 0, Demand::Distance),
          time(when, "time", 0, Demand::Fraction),
          count(commonCount({&origins, &directions, &tMax, &time})) {}
};

// Calls take(first, rays, tMax, n) for one batch after the other.
template <class Take>
void forEachBatch(const Scene& scene, const RayArguments& arguments, const Take& take) {
    std::vector<Ray> rays(std::min(arguments.count, kRaysAtATime));
    std::vector<float> tMax(rays.size());
    for (std::size_t first = 0; first < arguments.count; first += kRaysAtATime) {
        const std::size_t n = std::min(kRaysAtATime, arguments.count - first);
        for (std::size_t i = 0; i < n; ++i) {
            rays[i].origin = scene.toScene(arguments.origins.vec3(first + i));
            rays[i].direction = arguments.directions.vec3(first + i);
            rays[i].time = arguments.time.number(first + i);
            tMax[i] = std::min(arguments.tMax.number(first + i), kInfinity);
            if (isZero(rays[i].direction)) { // which hits nothing
                rays[i].direction = shared::vec3(0.0f, 0.0f, 1.0f);
                tMax[i] = 0.0f;
            }
        }
        take(first, rays.data(), tMax.data(), n);
    }
}

// What the rays hit, an array for each quantity.
struct HitArrays {
    NewFloats t, position, normal, shading, uv;
    NewArray<std::int32_t> kind, primitive, instance, material, light;

    explicit HitArrays(std::size_t n)
        : t(n),
          position(n, 3),
          normal(n, 3),
          shading(n, 3),
          uv(n, 2),
          kind(n),
          primitive(n),
          instance(n),
          material(n),
          light(n) {}

    // kNone becomes -1.
    static std::int32_t index(uint i) { return static_cast<std::int32_t>(i); }

    void miss(std::size_t i) {
        t.set(i, std::numeric_limits<float>::infinity());
        for (NewFloats* vectors : {&position, &normal, &shading}) vectors->set(i, shared::vec3(0.0f));
        uv.set(i, shared::vec2(0.0f, 0.0f));
        for (NewArray<std::int32_t>* indices : {&kind, &primitive, &instance, &material, &light}) indices->set(i, -1);
    }
    void meet(std::size_t i, const Scene& scene, const Ray& ray, const Hit& hit) {
        const Surface s = makeSurface(kFeatureAll, scene.view(), ray, hit);
        t.set(i, hit.t);
        position.set(i, scene.toWorld(s.position));
        normal.set(i, s.normal);
        shading.set(i, s.shading);
        uv.set(i, s.uv);
        kind.set(i, index(hit.kind));
        primitive.set(i, index(hit.primitive));
        instance.set(i, index(hit.instance));
        material.set(i, index(s.material));
        light.set(i, index(s.light));
    }
};

py::tuple intersect(const Scene& scene, const py::object& origins, const py::object& directions, const py::object& tMax,
                    const py::object& time) {
    const RayArguments arguments(origins, directions, tMax, time);
    HitArrays found(arguments.count);
    {
        const Released released;
        const accel::AccelView& accel = scene.accel();
        std::vector<Hit> hits(std::min(arguments.count, kRaysAtATime));
        forEachBatch(scene, arguments, [&](std::size_t first, const Ray* rays, const float* ends, std::size_t n) {
            accel::rayQuery().closest(accel, rays, ends, hits.data(), n);
            for (std::size_t i = 0; i < n; ++i)
                hits[i].t >= 0.0f ? found.meet(first + i, scene, rays[i], hits[i]) : found.miss(first + i);
        });
    }
    return py::make_tuple(found.t.array, found.kind.array, found.primitive.array, found.instance.array,
                          found.position.array, found.normal.array, found.shading.array, found.uv.array,
                          found.material.array, found.light.array);
}

py::array occluded(const Scene& scene, const py::object& origins, const py::object& directions, const py::object& tMax,
                   const py::object& time) {
    const RayArguments arguments(origins, directions, tMax, time);
    NewArray<bool> result(arguments.count);
    {
        const Released released;
        const accel::AccelView& accel = scene.accel();
        std::vector<std::uint8_t> hits(std::min(arguments.count, kRaysAtATime));
        forEachBatch(scene, arguments, [&](std::size_t first, const Ray* rays, const float* ends, std::size_t n) {
            accel::rayQuery().any(accel, rays, ends, hits.data(), n);
            for (std::size_t i = 0; i < n; ++i) result.set(first + i, hits[i] != 0);
        });
    }
    return result.array;
}

void requireBelow(const Words& words, std::uint32_t end) {
    for (std::size_t i = 0; i < words.count(); ++i)
        if (words.at(i) >= end)
            throw py::value_error(std::string(words.name()) + ": expected pixels from 0 to " + std::to_string(end - 1) +
                                  "; got " + std::to_string(words.at(i)));
}

py::tuple cameraRays(const Scene& scene, const py::object& x, const py::object& y, const py::object& uPixel,
                     const py::object& uLens) {
    const Words column(x, "x");
    const Words row(y, "y");
    const Rows pixel(uPixel, "u_pixel", 2, Demand::Fraction);
    const Rows lens(uLens, "u_lens", 2, Demand::Fraction);
    requireBelow(column, scene.params().width);
    requireBelow(row, scene.params().height);
    const std::size_t places = commonCount({&column, &row});
    const std::size_t samples = commonCount({&pixel, &lens});
    const bool areOne[] = {column.isOne() && row.isOne(), pixel.isOne() && lens.isOne()};
    if (!areOne[0] && !areOne[1] && places != samples)
        throw py::value_error("u_pixel: expected " + std::to_string(places) +
                              " rows, as many as x and y have, or one; got " + std::to_string(samples));
    const std::size_t count = areOne[0] ? samples : places;
    NewFloats origins(count, 3);
    NewFloats directions(count, 3);
    for (std::size_t i = 0; i < count; ++i) {
        const Ray ray =
            generateCameraRay(kFeatureAll, scene.camera(), uvec2(column.at(i), row.at(i)),
                              uvec2(scene.params().width, scene.params().height), pixel.vec2(i), lens.vec2(i), 0.0f);
        origins.set(i, scene.toWorld(ray.origin));
        directions.set(i, ray.direction);
    }
    return py::make_tuple(origins.array, directions.array);
}

} // namespace

void bindRays(py::module_& module) {
    module.def("intersect", &intersect);
    module.def("occluded", &occluded);
    module.def("camera_rays", &cameraRays);
}

} // namespace rt::python
