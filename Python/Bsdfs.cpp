// Scattering at surfaces of a scene's materials.
#include <cstddef>
#include <pybind11/pybind11.h>

#include "Common/Probe/Densities.h"
#include "Common/Shared/Path/Vertex.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Scene.h"

namespace rt::python {
namespace {

namespace py = pybind11;
using namespace rt::shared;

uint materialAt(const Scene& scene, const py::object& index) {
    return static_cast<uint>(
        indexArgument(index, "material", scene.compiled()->materials.size(), "the scene's materials"));
}

// A vertex at the origin of coordinates on a flat surface of this material.
Vertex vertexOn(const Scene& scene, uint material, const shared::vec3& normal, const shared::vec2& uv,
                const shared::vec3& wo) {
    Surface s{};
    s.normal = normal;
    s.shading = normal;
    s.uv = uv;
    s.uv2 = uv;
    s.color = shared::vec4(1.0f, 1.0f, 1.0f, 1.0f);
    s.material = material;
    s.light = kNone;
    return probe::vertexOn(scene, s, wo);
}

struct BsdfArguments {
    uint material;
    Rows normal, wo, uv;

    BsdfArguments(const Scene& scene, const py::object& index, const py::object& n, const py::object& o,
                  const py::object& at)
        : material(materialAt(scene, index)),
          normal(n, "normals", 3, Demand::UnitOr0),
          wo(o, "wo", 3, Demand::UnitOr0),
          uv(at, "uv", 2) {}
    bool isNowhere(std::size_t i) const { return isZero(normal.vec3(i)) || isZero(wo.vec3(i)); }
    Vertex vertex(const Scene& scene, std::size_t i) const {
        return vertexOn(scene, material, normal.vec3(i), uv.vec2(i), wo.vec3(i));
    }
};

py::tuple sampleBsdfs(const Scene& scene, const py::object& index, const py::object& normals,
                      const py::object& outgoing, const py::object& numbers, const py::object& at) {
    const BsdfArguments arguments(scene, index, normals, outgoing, at);
    const Rows u(numbers, "u", 2, Demand::Fraction);
    const std::size_t count = commonCount({&arguments.normal, &arguments.wo, &arguments.uv, &u});
    NewFloats wi(count, 3), weight(count, 3), pdf(count);
    NewArray<bool> delta(count), transmitted(count);
    forEachRow(count, [&](std::size_t i) {
        const BsdfSample s =
            arguments.isNowhere(i) ? absorbed() : sampleScattering(kFeatureAll, arguments.vertex(scene, i), u.vec2(i));
        wi.set(i, s.wi);
        weight.set(i, s.weight);
        pdf.set(i, s.pdf);
        delta.set(i, s.delta != 0u);
        transmitted.set(i, s.transmitted != 0u);
    });
    return py::make_tuple(wi.array, weight.array, pdf.array, delta.array, transmitted.array);
}

py::tuple evalBsdfs(const Scene& scene, const py::object& index, const py::object& normals, const py::object& outgoing,
                    const py::object& incoming, const py::object& at) {
    const BsdfArguments arguments(scene, index, normals, outgoing, at);
    const Rows wi(incoming, "wi", 3, Demand::UnitOr0);
    const std::size_t count = commonCount({&arguments.normal, &arguments.wo, &arguments.uv, &wi});
    NewFloats value(count, 3), pdf(count);
    forEachRow(count, [&](std::size_t i) {
        const bool isNone = arguments.isNowhere(i) || isZero(wi.vec3(i));
        const shared::vec4 f = isNone ? shared::vec4(0.0f, 0.0f, 0.0f, 0.0f)
                                      : evalScattering(kFeatureAll, arguments.vertex(scene, i), wi.vec3(i));
        value.set(i, shared::vec3(f));
        pdf.set(i, f.w);
    });
    return py::make_tuple(value.array, pdf.array);
}

} // namespace

void bindBsdfs(py::module_& module) {
    module.def("sample_bsdf", &sampleBsdfs);
    module.def("eval_bsdf", &evalBsdfs);
}

} // namespace rt::python
