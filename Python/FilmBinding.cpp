// Renders: the engines that there are, and films.
#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>

#include "Common/App/Options/OptionValues.h"
#include "Common/Render/Names.h"
#include "Common/Render/Progress.h"
#include "Python/Activity.h"
#include "Python/Arrays.h"
#include "Python/Bindings.h"
#include "Python/Engines.h"
#include "Python/ScriptedFilm.h"

namespace rt::python {
namespace {

namespace py = pybind11;
using WhileOthersRun = py::call_guard<Released>;

// Makes an array of what `make` gives while other threads of Python run.
template <class Make>
py::array arrayOf(const Make& make) {
    image::Image image;
    {
        const Released released;
        image = make();
    }
    return toArray(std::move(image));
}

std::optional<std::string> advance(ScriptedFilm& film, double seconds) {
    const Released released(&film.cancelFlag());
    const std::optional<app::StopReason> reason = film.advance(seconds);
    return reason ? std::optional(app::nameOf(app::kStopReasons, *reason)) : std::nullopt;
}

py::tuple progress(ScriptedFilm& film) {
    app::ProgressState state;
    {
        const Released released;
        state = film.progress();
    }
    return py::make_tuple(state.samplesDone, state.samplesTotal, state.pixels, state.seconds,
                          app::describeProgress(state));
}

} // namespace

void bindFilm(py::module_& module) {
    py::class_<ScriptedFilm>(module, "Film")
        .def(py::init<const std::shared_ptr<Scene>&, app::Options>(), WhileOthersRun())
        .def("advance", &advance)
        .def("cancel", &ScriptedFilm::cancel)
        .def("write", &ScriptedFilm::write, WhileOthersRun())
        .def("save", &ScriptedFilm::save, WhileOthersRun())
        .def("statistics", &ScriptedFilm::statistics, WhileOthersRun())
        .def("progress", &progress)
        .def("image", [](ScriptedFilm& film) { return arrayOf([&] { return film.image(); }); })
        .def("aov",
             [](ScriptedFilm& film, const std::string& name) {
                 const app::Aov aov = app::parseChoice("--aov", name, app::kAovs);
                 return arrayOf([&] { return film.aov(aov); });
             })
        .def_property_readonly("width", &ScriptedFilm::width)
        .def_property_readonly("height", &ScriptedFilm::height)
        .def_property_readonly("checkpoint_file", &ScriptedFilm::checkpointFile);
    py::list aovs;
    for (const auto& row : app::kAovs) aovs.append(std::string(row.name));
    module.attr("aov_names") = py::tuple(aovs);
    module.attr("has_gpu") = hasGpuEngine();
    module.def("has_hardware_device", &hasHardwareDevice, WhileOthersRun());
    module.def("describe_devices", &describeDevices, WhileOthersRun());
}

} // namespace rt::python
