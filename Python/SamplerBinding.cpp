// The random numbers that renders use.
#include <cstddef>
#include <pybind11/pybind11.h>

#include "Common/Shared/Base/Random.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Scene.h"

namespace rt::python {
namespace {

namespace py = pybind11;

// Pixels are numbered row by row from the top.
py::array samples(const Scene& scene, const py::object& pixels, const py::object& indices, const py::object& dimensions,
                  const py::object& replicates) {
    const Words pixel(pixels, "pixel");
    const Words index(indices, "sample");
    const Words dimension(dimensions, "dimension");
    const Words replicate(replicates, "replicate");
    const std::size_t count = commonCount({&pixel, &index, &dimension, &replicate});
    NewFloats u(count, 2);
    forEachRow(count, [&](std::size_t i) {
        const shared::Sampler s = shared::makeSampler(scene.params(), pixel.at(i), replicate.at(i), index.at(i));
        u.set(i, shared::sample2D(s, dimension.at(i)));
    });
    return u.array;
}

} // namespace

void bindSampler(py::module_& module) {
    module.def("samples", &samples);
    py::dict dimensions;
    dimensions["pixel"] = shared::kDimensionPixel;
    dimensions["lens"] = shared::kDimensionLens;
    dimensions["time"] = shared::kDimensionTime;
    dimensions["camera_dimensions"] = shared::kCameraDimensions;
    dimensions["per_vertex"] = shared::kDimensionsPerVertex;
    dimensions["light"] = shared::kDimensionLight;
    dimensions["bsdf"] = shared::kDimensionBsdf;
    dimensions["roulette"] = shared::kDimensionRoulette;
    dimensions["selection"] = shared::kDimensionSelection;
    module.attr("sample_dimensions") = dimensions;
}

} // namespace rt::python
