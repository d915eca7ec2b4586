// What light asks of a surface besides its columns.
Vec3 exponents_;

// Angular lobes of the three components for a light.
Vec3 lobes(Vec3 toLight) {
  return Vec3(exponents_.x > 0.0 ? lobe(exponents_.x, normal_, toLight, toViewer_) : 1.0,
              exponents_.y > 0.0 ? lobe(exponents_.y, normal_, toLight, toViewer_) : 1.0,
              exponents_.z > 0.0 ? lobe(exponents_.z, normal_, toLight, toViewer_) : 1.0);
}
