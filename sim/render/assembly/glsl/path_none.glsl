// No air. The functions of the slot `path`, as every path model has them:
//   AirPath                 what is known of the air on a way
//   airFromCamera(range)    along the pixel's ray, as far as a range [m] (kFar: to its end)
//   airBeyond(...)          the same a stretch further on: the way as far as the far end of the stretch, from where the near one ends
//   airToSun, airToLight    both legs of reflected light: the camera's and that from a point at a height
//   pathTransmittance(i, .) of node i;  pathRadiance(i, .) of the camera's way
//   pathDepth, pathInside   optical depth and radiance, as seen from the camera, of a stretch between two ways of the camera
//   pathSeen(i, ., radiance)  what leaves the end of the way, through its air, and the air itself where it is not added per channel
struct AirPath {
  float none;
};
AirPath airFromCamera(float range) { return AirPath(0.0); }
AirPath airBeyond(AirPath near, float nearRange, float height, float sinElevation, float length) { return near; }
AirPath airToSun(AirPath camera, float height) { return camera; }
AirPath airToLight(AirPath camera, float height, float sinElevation, float distance) { return camera; }
Real pathTransmittance(int i, AirPath p) { return 1.0; }
Real pathRadiance(int i, AirPath p) { return 0.0; }
Real pathDepth(int i, AirPath near, AirPath far) { return 0.0; }
Real pathInside(int i, AirPath near, AirPath far) { return 0.0; }
Real pathSeen(int i, AirPath p, Real radiance) { return radiance; }
