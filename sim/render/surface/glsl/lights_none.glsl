// Nothing shines on the scene.
void prepareLights() {
  lightCos_ = 0.0;
  lightDistance2_ = 1.0;
}
Vec3 toLight(int l) { return normal_; }
Real reflectedLight(int i) { return 0.0; }
