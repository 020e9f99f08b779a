// The extension module raytracing._core. What users see is in Python/raytracing, which describes arguments and results;
// everything here takes and gives plain arrays.
#include <pybind11/pybind11.h>
#include <string>

#include "Common/Core/BuildInfo.h"
#include "Common/Core/Paths.h"
#include "Python/Bindings.h"

PYBIND11_MODULE(_core, module) {
    using namespace rt::python;
    bindErrors(module);
    bindActivities(module);
    bindFlags(module);
    bindScene(module);
    bindFilm(module);
    bindRays(module);
    bindLights(module);
    bindBsdfs(module);
    bindProbe(module);
    bindSampler(module);
    bindShapes(module);
    bindImages(module);
    module.attr("version") = rt::programVersion();
    module.attr("version_text") = rt::versionText("raytracing");
    module.def("find_assets_around", [](const std::string& file) { rt::findAssetsAround(file); });
}
