#pragma once
// The parts of the extension module _pitviper: a function a part, called once when it is imported.
#include <pybind11/pybind11.h>

namespace pitviper {

void bindErrors(pybind11::module_& module);
void bindFrames(pybind11::module_& module);
void bindPhysics(pybind11::module_& module);
void bindScenes(pybind11::module_& module);

}  // namespace pitviper
