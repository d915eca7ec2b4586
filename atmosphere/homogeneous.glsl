// Homogeneous air: an absorber's amount is the length of the way below the air's top.
//@use atmosphere/air_length.glsl
float airLength(float height_m, float sinElevation, float range_m) {
  return layerLength(height_m, sinElevation, range_m, view.earth.y, view.earth.x);
}

//@use atmosphere/one_amount.glsl
