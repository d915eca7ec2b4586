// Areas and solid angles between pixel, fragment, point light and aperture. Shared by GLSL (float) and C++ (double).
// Source: Duvenhage 2006, sections 4.5 and 4.7, with cos(theta_v) restored (the paper's step 5 drops it).

// Plain solid angle of a small pixel on a flat film [sr]: w = a cos^3(psi), a = (pitch / focal length)^2.
PHYSICS Real pixelSolidAngle(Real pitchOverFocalSquared, Real cosPsi) {
  return pitchOverFocalSquared * cosPsi * cosPsi * cosPsi;
}

// Fragment area by back projection [m2], un-foreshortened: A = w_pix R^2 / cos(theta_v). Grows without bound at grazing view;
// radiance never needs it (A and cos(theta_v) cancel), it is a truth layer.
PHYSICS Real fragmentArea(Real pixelSolidAngle_sr, Real range_m, Real cosView) {
  return pixelSolidAngle_sr * range_m * range_m / max(cosView, 1.0e-6);
}

// Solid angle of the fragment seen from a point light [sr]: w1 = A cos(theta_l) / d^2.
PHYSICS Real fragmentFromLight(Real area_m2, Real cosLight, Real distanceSquared_m2) {
  return area_m2 * cosLight / distanceSquared_m2;
}

// Solid angle of the aperture seen from the fragment [sr]: w2 = A_ap cos(psi) / R^2.
PHYSICS Real apertureFromFragment(Real apertureArea_m2, Real cosPsi, Real range_m) {
  return apertureArea_m2 * cosPsi / (range_m * range_m);
}

// Irradiance per unit intensity on a surface element from a point light: cos(theta_l) / d^2 [1/m2]. The distance is bounded
// below by the light's own radius, inside which a point is no longer a model of it.
PHYSICS Real pointIrradianceFactor(Real cosLight, Real distanceSquared_m2, Real radius_m) {
  return max(cosLight, 0.0) / max(distanceSquared_m2, radius_m * radius_m);
}
