#include "Python/Flags.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Manual/Page.h"
#include "Python/Bindings.h"

namespace rt::python {
namespace {

namespace py = pybind11;

std::mutex parsersMutex;

// Made once each, as that takes much longer than to read a line. The mutex is the caller's.
app::OptionParser& parserOf(const std::string& program) {
    static std::map<std::string, std::unique_ptr<app::OptionParser>> parsers;
    std::unique_ptr<app::OptionParser>& parser = parsers[program];
    if (!parser) parser = std::make_unique<app::OptionParser>(program, true);
    return *parser;
}

// Of each flag: its names, what it takes ("" of a switch), its help and whether it may be said again.
py::list describeFlags(const std::string& program) {
    manual::Page page;
    {
        const std::scoped_lock lock(parsersMutex);
        page = parserOf(program).page();
    }
    py::list list;
    for (const manual::Flag& flag : page.flags) {
        std::string help = flag.help;
        for (const manual::Term& choice : flag.choices) help += "\n    " + choice.name + ": " + choice.help;
        list.append(py::make_tuple(flag.names, flag.value, help, flag.isRepeatable));
    }
    return list;
}

} // namespace

app::Options parseFlags(const std::string& program, const std::vector<std::string>& arguments) {
    std::ostream nowhere(nullptr);
    const std::scoped_lock lock(parsersMutex);
    std::optional<app::Options> options = parserOf(program).parse(arguments, nowhere);
    if (!options) throw UsageError("--help, --help-all, --version: of the programs; see help(raytracing.render)");
    if (options->command != app::Command::Render)
        throw UsageError(
            "--list-scenes, --list-devices, --export-scene: of the programs; a script calls "
            "raytracing.scenes, raytracing.devices and Scene.save");
    if (options->window) throw UsageError("--window: a script renders without one");
    return *std::move(options);
}

void bindFlags(py::module_& module) {
    py::class_<app::Options>(module, "Options")
        .def_property_readonly("program", [](const app::Options& options) { return options.program; })
        .def_property_readonly("quiet", [](const app::Options& options) { return options.quiet; })
        .def_property_readonly("one_sided_lights", [](const app::Options& options) { return options.oneSidedLights; })
        .def_property_readonly("camera", [](const app::Options& options) { return options.camera; })
        .def_property_readonly("assets_below", [](const app::Options& options) { return options.assetsBelow; });
    module.def("flags", &describeFlags);
    module.def("parse_flags", &parseFlags);
}

} // namespace rt::python
