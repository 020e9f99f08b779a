// Maps of densities over the sphere of directions.
#include <cstdint>
#include <optional>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "Common/Probe/Probe.h"
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

// The map and, in the scene's coordinates of the world, position, normal and wo. The pixel is one of the image's.
py::tuple probeMap(const Scene& scene, std::uint32_t x, std::uint32_t y, const std::string& strategyName,
                   std::uint32_t height, std::uint32_t side) {
    const probe::Strategy strategy = strategyNamed(scene, strategyName);
    std::optional<probe::Probe> at;
    std::string why;
    probe::DirectionMap map;
    {
        const py::gil_scoped_release released;
        at = probe::Probe::at(scene, x, y);
        if (at) why = at->whyNoDensity(strategy);
        if (at && why.empty()) map = probe::mapOf(*at, strategy, height, side);
    }
    if (!at)
        throw py::value_error("x, y: expected a pixel that shows a surface; got " + std::to_string(x) + ", " +
                              std::to_string(y) + ", which shows none");
    if (!why.empty()) throw py::value_error("strategy: " + why);
    NewFloats density(map.density.size()), place(3, 3);
    for (std::size_t i = 0; i < map.density.size(); ++i) density.set(i, map.density[i]);
    place.set(0, at->position());
    place.set(1, at->vertex().shading);
    place.set(2, at->vertex().wo);
    return py::make_tuple(density.array, place.array);
}

} // namespace

void bindProbe(py::module_& module) {
    module.def("probe_map", &probeMap);
}

} // namespace rt::python
