// Errors of the libraries as exceptions of Python, with the texts that the programs print.
#include <exception>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Python/Activity.h"
#include "Python/Bindings.h"

namespace rt::python {
namespace {

namespace py = pybind11;

// Never freed: exceptions may still be on their way when the module goes.
struct ErrorTypes {
    py::object error, usage, input, render, noDevice;
};
ErrorTypes* types = nullptr;

py::object makeType(py::module_& module, const char* name, const py::object& bases, const char* description) {
    const std::string full = std::string("raytracing.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), description, bases.ptr(), nullptr);
    if (type == nullptr) throw py::error_already_set();
    auto object = py::reinterpret_steal<py::object>(type);
    module.attr(name) = object;
    return object;
}

const py::object& typeOf(ExitCode code) {
    switch (code) {
        case ExitCode::Usage:
            return types->usage;
        case ExitCode::Input:
            return types->input;
        case ExitCode::Failure:
            return types->render;
        case ExitCode::NoDevice:
            return types->noDevice;
        case ExitCode::Done:
        case ExitCode::Different:
        case ExitCode::Interrupted:
            break;
    }
    return types->error;
}

void translate(std::exception_ptr pointer) {
    try {
        if (pointer) std::rethrow_exception(std::move(pointer));
    } catch (const Error& error) {
        const py::object value = typeOf(error.code())(error.what());
        value.attr("exit_code") = static_cast<int>(error.code());
        PyErr_SetObject(typeOf(error.code()).ptr(), value.ptr());
    } catch (const Interrupted&) {
        if (threadMustEnd())
            PyErr_SetNone(PyExc_SystemExit); // which ends a thread without a word
        else
            PyErr_SetString(PyExc_KeyboardInterrupt, "interrupted");
    }
}

} // namespace

void bindErrors(py::module_& module) {
    types = new ErrorTypes;
    const py::object runtime = py::reinterpret_borrow<py::object>(PyExc_RuntimeError);
    const py::object value = py::reinterpret_borrow<py::object>(PyExc_ValueError);
    types->error = makeType(module, "Error", py::make_tuple(runtime),
                            "One line that names the flag or file, the place, the value and what is allowed. exit_code "
                            "is the code with which the programs end for it.");
    types->error.attr("exit_code") = static_cast<int>(ExitCode::Failure);
    types->usage = makeType(module, "UsageError", py::make_tuple(types->error, value), "A flag or its value.");
    types->input = makeType(module, "InputError", py::make_tuple(types->error, value),
                            "A missing or invalid scene, asset, reference or checkpoint.");
    types->render =
        makeType(module, "RenderError", py::make_tuple(types->error), "A device, a render or an output has failed.");
    types->noDevice = makeType(module, "NoDeviceError", py::make_tuple(types->error), "No suitable device.");
    for (const ExitCode code : {ExitCode::Usage, ExitCode::Input, ExitCode::NoDevice})
        typeOf(code).attr("exit_code") = static_cast<int>(code); // also of what the package itself raises
    py::register_exception_translator(&translate);
}

} // namespace rt::python
