#pragma once
// What a frame's header says of the sensor it is of: so that its numbers can be used without the scenario at hand.
#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

/// What other programs look for (OpenEXR, "Standard Optional Attributes"): `worldToCamera`, of row vectors in the scenario's local frame (east, north, up,
/// metres; the camera looks along -z, y up), `framesPerSecond`, `expTime` [s], `aperture` (F number); and `pitviper.date_utc` where the scenario has a date.
void addStandard(Frame& frame, const Simulation& simulation, const Camera& camera, const CameraState& eye);

/// Curves over `curve.<channel>.wavelength_um`: `.response`, and where there are any `.optics` and `.quantum_efficiency`.
/// Of counts, `calibration.<layer>.`: `gain_count_per_electron`, `offset_count`, `dark_electrons`, `own_electrons` (of the lens), `fill_factor`, and, on the
/// axis, in-band radiance of light that is even over the response, L = `radiance_per_count` x count + `radiance_at_0` [W/(m2 sr)]; of counts and of apparent
/// temperatures black bodies that fill a pixel on the axis: `.temperature_K` and beside it `.count`, or `.radiance` [the kernel's unit x W/(m2 sr)] where no
/// detector counts.
void addSensor(Frame& frame, const Camera& camera, const CameraState& eye);

}  // namespace pitviper
