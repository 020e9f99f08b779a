// What the Python module consists of, a function for each subject: each adds its names to the module.
#pragma once
#include <pybind11/pybind11.h>

namespace rt::python {

void bindErrors(pybind11::module_& module);
void bindActivities(pybind11::module_& module); // what the interpreter's end waits for
void bindFlags(pybind11::module_& module);      // what render() and compile() take
void bindScene(pybind11::module_& module);      // scenes, authored and compiled
void bindFilm(pybind11::module_& module);       // renders
void bindRays(pybind11::module_& module);       // intersection, camera rays
void bindLights(pybind11::module_& module);     // light sampling
void bindBsdfs(pybind11::module_& module);      // scattering
void bindProbe(pybind11::module_& module);      // maps of densities
void bindSampler(pybind11::module_& module);    // random numbers
void bindShapes(pybind11::module_& module);     // solid angles of shapes alone
void bindImages(pybind11::module_& module);     // files, metrics, tone curves

} // namespace rt::python
