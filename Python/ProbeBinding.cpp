// Maps of densities and light over the sphere of directions; the paths of a pixel.
#include <cstdint>
#include <optional>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "Common/Probe/DirectionMap.h"
#include "Common/Probe/PathsReport.h"
#include "Python/Activity.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Scene.h"

namespace rt::python {
namespace {

namespace py = pybind11;

probe::Strategy strategyNamed(const Scene& scene, const std::string& name) {
    const std::uint32_t lights = scene.compiled()->globals.lightCount;
    if (const auto strategy = probe::strategyOf(name, lights)) return *strategy;
    if (name.find_first_not_of("-0123456789") == std::string::npos)
        throw py::value_error("light: expected an index from 0 to " + std::to_string(std::int64_t{lights} - 1) +
                              " of the scene's lights; got " + name);
    throw py::value_error("strategy: expected bsdf, lights, mixture, mis or the index of a light; got " + name);
}

probe::Quantity quantityNamed(const std::string& name) {
    std::string known;
    for (const auto& row : probe::kQuantities) {
        if (row.name == name) return row.value;
        known += (known.empty() ? "" : ", ") + std::string(row.name);
    }
    throw py::value_error("show: expected one of " + known + "; got " + name);
}

// Runs it to its end. Throws what SignalWatch throws.
template <class Run>
void finish(Run& run) {
    for (SignalWatch watch; !run.isDone(); watch.look()) run.advance();
}

// The map and, in the scene's coordinates of the world, position, normal and wo. The pixel is one of the image's.
py::tuple probeMap(const Scene& scene, std::uint32_t x, std::uint32_t y, const std::string& strategyName,
                   std::uint32_t height, std::uint32_t side, const std::string& show, std::uint32_t paths,
                   std::uint32_t seed) {
    const probe::Strategy strategy = strategyNamed(scene, strategyName);
    const probe::MapSettings settings{quantityNamed(show), probe::Projection::Sphere, height, side, paths};
    std::optional<probe::Probe> at;
    std::string why;
    probe::DirectionMap map;
    {
        const Released released;
        at = probe::Probe::at(scene, x, y);
        if (at) why = at->whyNoDensity(strategy);
        if (at && why.empty()) {
            probe::MapBuilder builder(*at, strategy, settings, seed);
            finish(builder);
            map = builder.map();
        }
    }
    if (!at)
        throw py::value_error("x, y: expected a pixel that shows a surface; got " + std::to_string(x) + ", " +
                              std::to_string(y) + ", which shows none");
    if (!why.empty()) throw py::value_error("strategy: " + why);
    NewFloats values(map.values.size()), place(3, 3);
    for (std::size_t i = 0; i < map.values.size(); ++i) values.set(i, map.values[i]);
    place.set(0, at->position());
    place.set(1, at->vertex().shading);
    place.set(2, at->vertex().wo);
    return py::make_tuple(values.array, place.array);
}

// What ray-tracing-image paths --json prints.
std::string pixelPaths(const Scene& scene, std::uint32_t x, std::uint32_t y, std::uint32_t samples,
                       std::optional<std::uint32_t> selected) {
    const Released released;
    probe::PathsSettings settings;
    settings.samples = samples;
    settings.selected = selected;
    probe::PathsRun run(scene, scene.compiled()->camera, x, y, settings);
    finish(run);
    return probe::figuresOf(run.result(), {scene.compiled()->id, {x, y}, scene.options().settings}).dump();
}

} // namespace

void bindProbe(py::module_& module) {
    module.def("probe_map", &probeMap);
    module.def("pixel_paths", &pixelPaths);
}

} // namespace rt::python
