// Light sampling: of one light's shape, and of the choice among all.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <pybind11/pybind11.h>

#include "Common/Probe/Densities.h"
#include "Common/Shared/Path/DirectLight.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Scene.h"

namespace rt::python {
namespace {

namespace py = pybind11;
using namespace rt::shared;

std::size_t lightIndex(const Scene& scene, const py::object& index) {
    return indexArgument(index, "light", scene.compiled()->globals.lightCount, "the scene's lights");
}

const Light& lightAt(const Scene& scene, const py::object& index) {
    return scene.compiled()->lights[lightIndex(scene, index)];
}

void requireLights(const Scene& scene) {
    if (scene.compiled()->globals.lightCount == 0)
        throw py::value_error("scene: expected one with lights to choose from; got one without");
}

// As far as light sampling looks at it.
Vertex vertexAt(const shared::vec3& position, const shared::vec3& normal) {
    Vertex v{};
    v.origin = position;
    v.shading = normal;
    return v;
}

py::tuple sampleLights(const Scene& scene, const py::object& index, const py::object& points, const py::object& normals,
                       const py::object& numbers, const py::object& when) {
    const Light& light = lightAt(scene, index);
    const Rows position(points, "points", 3);
    const Rows normal(normals, "normals", 3, Demand::UnitOr0);
    const Rows u(numbers, "u", 2, Demand::Fraction);
    const Rows time(when, "time", 0, Demand::Fraction);
    const std::size_t count = commonCount({&position, &normal, &u, &time});
    NewFloats direction(count, 3), distance(count), pdf(count), radiance(count, 3), point(count, 3), towards(count, 3);
    forEachRow(count, [&](std::size_t i) {
        const Vertex v = vertexAt(scene.toScene(position.vec3(i)), normal.vec3(i));
        LightSample s =
            sampleChosenLight(kFeatureAll, scene.view(), scene.params(), light, v, time.number(i), u.vec2(i));
        if (!(s.pdf > 0.0f)) s = noLightSample();
        direction.set(i, s.wi);
        distance.set(i, s.distance < kInfinity ? s.distance : std::numeric_limits<float>::infinity());
        pdf.set(i, s.pdf);
        radiance.set(i, s.radiance);
        point.set(i, s.pdf > 0.0f && s.distance < kInfinity ? scene.toWorld(s.point) : shared::vec3(0.0f));
        towards.set(i, s.normal);
    });
    return py::make_tuple(direction.array, distance.array, pdf.array, radiance.array, point.array, towards.array);
}

py::array lightPdfs(const Scene& scene, const py::object& index, const py::object& points, const py::object& normals,
                    const py::object& directions, const py::object& when) {
    const Light& light = lightAt(scene, index);
    const Rows position(points, "points", 3);
    const Rows normal(normals, "normals", 3, Demand::UnitOr0);
    const Rows direction(directions, "directions", 3, Demand::UnitOr0);
    const Rows time(when, "time", 0, Demand::Fraction);
    const std::size_t count = commonCount({&position, &normal, &direction, &time});
    NewFloats pdf(count);
    forEachRow(count, [&](std::size_t i) {
        const shared::vec3 d = direction.vec3(i);
        pdf.set(i, isZero(d) ? 0.0f
                             : probe::lightDensity(scene, light, scene.toScene(position.vec3(i)), normal.vec3(i),
                                                   time.number(i), d));
    });
    return pdf.array;
}

py::tuple chooseLights(const Scene& scene, const py::object& points, const py::object& normals,
                       const py::object& numbers) {
    requireLights(scene);
    const Rows position(points, "points", 3);
    const Rows normal(normals, "normals", 3, Demand::UnitOr0);
    const Rows u(numbers, "u", 2, Demand::Fraction);
    const std::size_t count = commonCount({&position, &normal, &u});
    NewArray<std::int32_t> light(count);
    NewFloats probability(count);
    forEachRow(count, [&](std::size_t i) {
        LightContext context = probe::contextAt(scene.toScene(position.vec3(i)), normal.vec3(i));
        const LightChoice choice = probe::chooseLightAt(scene, u.vec2(i), context);
        light.set(i, static_cast<std::int32_t>(choice.light));
        probability.set(i, choice.light == kNone ? 0.0f : choice.probability);
    });
    return py::make_tuple(light.array, probability.array);
}

py::array lightProbabilities(const Scene& scene, const py::object& index, const py::object& points,
                             const py::object& normals) {
    const std::size_t light = lightIndex(scene, index);
    const Rows position(points, "points", 3);
    const Rows normal(normals, "normals", 3, Demand::UnitOr0);
    const std::size_t count = commonCount({&position, &normal});
    NewFloats probability(count);
    forEachRow(count, [&](std::size_t i) {
        LightContext context = probe::contextAt(scene.toScene(position.vec3(i)), normal.vec3(i));
        probe::chooseLightAt(scene, shared::vec2(0.5f, 0.5f), context); // which leaves the sum of contributions
        probability.set(i, probe::probabilityOf(scene, static_cast<uint>(light), context));
    });
    return probability.array;
}

// Of all lights, as one is chosen and then sampled.
py::array lightSamplingPdfs(const Scene& scene, const py::object& points, const py::object& normals,
                            const py::object& directions, const py::object& when) {
    requireLights(scene);
    const Rows position(points, "points", 3);
    const Rows normal(normals, "normals", 3, Demand::UnitOr0);
    const Rows direction(directions, "directions", 3, Demand::UnitOr0);
    const Rows time(when, "time", 0, Demand::Fraction);
    const std::size_t count = commonCount({&position, &normal, &direction, &time});
    NewFloats pdf(count);
    forEachRow(count, [&](std::size_t i) {
        pdf.set(i, 0.0f);
        if (isZero(direction.vec3(i))) return;
        LightContext context = probe::contextAt(scene.toScene(position.vec3(i)), normal.vec3(i));
        probe::chooseLightAt(scene, shared::vec2(0.5f, 0.5f), context);
        pdf.set(i, probe::lightsDensity(scene, context, time.number(i), direction.vec3(i)));
    });
    return pdf.array;
}

} // namespace

void bindLights(py::module_& module) {
    module.def("sample_light", &sampleLights);
    module.def("light_pdf", &lightPdfs);
    module.def("choose_light", &chooseLights);
    module.def("light_probability", &lightProbabilities);
    module.def("light_sampling_pdf", &lightSamplingPdfs);
}

} // namespace rt::python
