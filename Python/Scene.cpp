#include "Python/Scene.h"

#include <cstddef>
#include <iterator>
#include <memory>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Python/Activity.h"
#include "Python/Bindings.h"

namespace rt::python {

namespace py = pybind11;

namespace {

// The text of a scene file that says what `source`, an id or a file, holds.
std::string sceneText(const std::string& source) {
    const Released released;
    return scene::toJson(app::loadScene(source));
}

app::SceneRequest requestOf(const app::Options& options, const std::string& source) {
    return {source, options.oneSidedLights, options.camera, options.assetsBelow, options.moment};
}

std::shared_ptr<Scene> compileSource(const std::string& source, const app::Options& options) {
    const Released released;
    const Interruptible interruptible(endOfThread());
    const app::Stopwatch watch;
    auto compiled = app::compile(requestOf(options, source));
    return std::make_shared<Scene>(std::move(compiled), options, watch.seconds());
}

// Of the text of a scene file; `name` stands in errors, `folder` is where files are looked for first.
std::shared_ptr<Scene> compileText(const std::string& text, const std::string& name, const std::string& folder,
                                   const app::Options& options) {
    const Released released;
    const Interruptible interruptible(endOfThread());
    const app::Stopwatch watch;
    auto compiled = app::compile(scene::parseScene(text, name, folder), requestOf(options, name));
    return std::make_shared<Scene>(std::move(compiled), options, watch.seconds());
}

void replaceFile(const std::string& file, const std::string& text) {
    const Released released;
    AtomicFile out(file);
    out.stream() << text;
    out.commit();
}

const char* kindOf(const shared::Light& light) {
    static constexpr const char* kKinds[] = {"sphere", "quad",     "triangle", "sky",  "ellipsoid",
                                             "disk",   "cylinder", "point",    "spot", "directional"};
    static_assert(std::size(kKinds) == shared::kLightDirectional + 1);
    return kKinds[light.kind];
}

py::dict describeLight(const Scene& scene, const shared::Light& light) {
    const auto numbers = [](const shared::vec3& v) { return py::make_tuple(v.x, v.y, v.z); };
    py::dict result;
    result["kind"] = kindOf(light);
    const bool isSky = light.kind == shared::kLightSky;
    if (!isSky && light.kind != shared::kLightDirectional) result["position"] = numbers(scene.toWorld(light.position));
    const bool isFlat = light.kind == shared::kLightQuad || light.kind == shared::kLightTriangle;
    if (isFlat) {
        result["edge_u"] = numbers(light.edgeU);
        result["edge_v"] = numbers(light.edgeV);
        result["normal"] = numbers(light.normal);
        result["both_sides"] = light.sides == shared::kSidesBoth;
    }
    if (light.kind == shared::kLightSphere) result["radius"] = light.radius;
    if (!isSky) result["area"] = light.area;
    result["emission"] = numbers(light.emission);
    result["power_share"] = light.selection;
    return result;
}

py::list describeLights(const Scene& scene) {
    py::list lights;
    for (std::size_t i = 0; i < scene.compiled()->globals.lightCount; ++i)
        lights.append(describeLight(scene, scene.compiled()->lights[i]));
    return lights;
}

} // namespace

void bindScene(py::module_& module) {
    py::class_<Scene, std::shared_ptr<Scene>>(module, "Compiled")
        .def_property_readonly("id", [](const Scene& scene) { return scene.compiled()->id; })
        .def_property_readonly("title", [](const Scene& scene) { return scene.compiled()->title; })
        .def_property_readonly("notices", [](const Scene& scene) { return scene.compiled()->notices; })
        .def_property_readonly("materials", [](const Scene& scene) { return scene.compiled()->materialNames; })
        .def_property_readonly("lights", &describeLights)
        .def_property_readonly("width", [](const Scene& scene) { return scene.options().settings.width; })
        .def_property_readonly("height", [](const Scene& scene) { return scene.options().settings.height; })
        .def_property_readonly("seconds", &Scene::seconds)
        .def("with_options", &Scene::with)
        .def_property_readonly("primitives", [](const Scene& scene) {
            const scene::CompiledScene& s = *scene.compiled();
            return py::make_tuple(s.spheres.size(), s.quads.size(), s.triangles.size());
        });
    module.def("scene_text", &sceneText);
    module.def("compile_source", &compileSource);
    module.def("compile_text", &compileText);
    module.def("replace_file", &replaceFile);
    module.def("list_scenes", [] { return app::listScenes(true); });
}

} // namespace rt::python
