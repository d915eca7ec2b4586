#pragma once
// The parameter tables of a scenario: what the reader accepts is what the key reference says.
#include <vector>

#include "materials/lights.hpp"
#include "materials/media.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper::tables {

const ParameterTable& scenario();
const ParameterTable& entryOfList();
const ParameterTable& repeat();
const ParameterTable& render();
const ParameterTable& origin();
const ParameterTable& refraction();
const ParameterTable& time();
const ParameterTable& limits();
const ParameterTable& accuracy();
const ParameterTable& airLibrary();
const ParameterTable& background();
const ParameterTable& ground();
const ParameterTable& sun();
const ParameterTable& ambient();
const ParameterTable& gradientEntry();
const ParameterTable& environmentMap();
const ParameterTable& environmentLayer();
const ParameterTable& material();
const ParameterTable& temperatureState();
ParameterTable medium(const MediumModel& model);
/// The medium that a material's map asks for, or null. Errors: UserError where it is a surface too.
const MediumModel* mediumOf(const Value& material);
const ParameterTable& texture();
const ParameterTable& emission();
const ParameterTable& transmission();
ParameterTable light(const LightModel& model);
const ParameterTable& entity();
const ParameterTable& part();
const ParameterTable& shape();
const ParameterTable& waypoint();
const ParameterTable& geodetic();
const ParameterTable& camera();
const ParameterTable& sensorFile();
const ParameterTable& cameraPreset();
const ParameterTable& film();
const ParameterTable& channel();
const ParameterTable& spectral();
const ParameterTable& spectralImage();
const ParameterTable& sensor();
const ParameterTable& probe();

/// All of them and the spectrum, in the order of the key reference.
std::vector<ParameterTable> all();

}  // namespace pitviper::tables
