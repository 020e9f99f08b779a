#include "Python/Scene.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "Common/App/Session/SceneSource.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Python/Bindings.h"

namespace rt::python {

namespace py = pybind11;

Scene::Scene(std::shared_ptr<const scene::CompiledScene> compiled, app::Options options, double seconds)
    : compiled_(std::move(compiled)), options_(std::move(options)), seconds_(seconds) {
    const scene::CompiledScene& s = *compiled_;
    app::settleImageSize(options_, s.id, s.defaults.aspect);
    for (std::size_t i = 0; i < srgbToLinear_.size(); ++i) {
        const double encoded = static_cast<double>(i) / 255.0;
        srgbToLinear_[i] =
            static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    view_ = shared::viewOf(s, s.globals);
    view_.srgbToLinear = srgbToLinear_.data();
    const app::RenderSettings& settings = options_.settings;
    features_ = app::renderFeatures(s, s.camera, settings);
    params_ = app::makeRenderParams(s, settings);
    camera_ = scene::makeCamera(s.camera, settings.width, settings.height, s.origin);
}

std::shared_ptr<Scene> Scene::with(app::Options options) const {
    auto scene = std::make_shared<Scene>(compiled_, std::move(options), 0.0);
    scene->accel_ = accel_;
    return scene;
}

const accel::AccelView& Scene::accel() const {
    const std::scoped_lock lock(accel_->mutex);
    if (!accel_->built) {
        const scene::CompiledScene& s = *compiled_;
        const accel::AccelInput input{s.spheres,   s.sphereMotions, s.quads,    s.positions,
                                      s.triangles, s.geometries,    s.instances};
        accel_->built = accel::CpuAccel::build(input, {});
    }
    return accel_->built->view();
}

shared::vec3 Scene::toScene(const shared::vec3& world) const {
    return shared::vec3(glm::dvec3(world) - compiled_->origin);
}

shared::vec3 Scene::toWorld(const shared::vec3& scene) const {
    return shared::vec3(glm::dvec3(scene) + compiled_->origin);
}

namespace {

// The text of a scene file that says what `source`, an id or a file, holds.
std::string sceneText(const std::string& source) {
    const py::gil_scoped_release released;
    return scene::toJson(app::loadScene(source));
}

app::SceneRequest requestOf(const app::Options& options, const std::string& source) {
    return {source, options.oneSidedLights, options.camera, options.assetsBelow};
}

std::shared_ptr<Scene> compileSource(const std::string& source, const app::Options& options) {
    const py::gil_scoped_release released;
    const app::Stopwatch watch;
    auto compiled = app::compile(requestOf(options, source));
    return std::make_shared<Scene>(std::move(compiled), options, watch.seconds());
}

// Of the text of a scene file; `name` stands in errors, `folder` is where files are looked for first.
std::shared_ptr<Scene> compileText(const std::string& text, const std::string& name, const std::string& folder,
                                   const app::Options& options) {
    const py::gil_scoped_release released;
    const app::Stopwatch watch;
    auto compiled = app::compile(scene::parseScene(text, name, folder), requestOf(options, name));
    return std::make_shared<Scene>(std::move(compiled), options, watch.seconds());
}

const char* kindOf(const shared::Light& light) {
    static constexpr const char* kKinds[] = {"sphere",    "quad",  "triangle", "sky",
                                             "ellipsoid", "point", "spot",     "directional"};
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
    module.def("list_scenes", [] { return app::listScenes(true); });
}

} // namespace rt::python
