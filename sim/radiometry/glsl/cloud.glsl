// A cloud of drops, lit by sun, sky and ground: what a place sends towards the eye, by numbers of it that hold at all wavelengths and by the drops' optics at
// one. Shared by GLSL (float) and C++ (double).
//   f = g^2, c = 1 - w f, w' = w (1 - f)/c, g' = g/(1 + g): delta scaling; w albedo, g asymmetry of single scattering, e extinction over that at 0.55 um
//   J = w' exp(sum l_i ln S_i) scattered sunlight [1/sr per irradiance of 1], l_i Lagrange's weights of x(w) = sqrt((1 - w)/(1 - 0.6 w g)) at cloudAlbedos();
//   Js = U/cosh(aU y), Jg = (1 - U)/cosh(aG y) light of an even sky and ground of 1, y = x(w)/x(0.8); 1 - Js - Jg that of drops of a radiance of 1.
//   Sunlight turned once:  K = b HG(G, cos)/(1 + 0.314 u), b = exp(-c e tauSun), u = w f e (tauSun + tauEye), G = g^(1 + 0.455 u): what is turned forward on
//     its way widens and thins the phase function.
//   Light turned again goes towards the eye by J + 3 g' H; H flux along the line / 4 pi: D dJ/dtau, D = 1/(3 c (1 - w' g')), and of sunlight what the beam
//     drives along the lit face, 1.07 w'g'/(1 - w'g') b/(4 pi)(nn + s (cos - nn)), s = min(0.223 + 0.928 c e tauSun, 4); nn = (n.line)(n.sun), n of grad J.
//   Source per depth of extinction e: w E (K + (1 - f)(J + 3 g' H)) + w sum L_k (1 - f)(J_k + 3 g' H_k) + (1 - w) B; the line sees it through exp(-c depth).
//   In an enclosure of one temperature it is c B: exactly the black body's radiance comes out.
// Source: delta scaling: Joseph, Wiscombe, Weinman 1976, J. Atmos. Sci. 33, 2452; P1: Ishimaru 1978; phase function: Henyey and Greenstein 1941; x(w) and the
//   constants: fitted to a Monte Carlo over four clouds (largest vertical depths 8 to 100), two suns and nine views, held against others.
// Valid: g 0.75 to 0.9. Means over pictures within 4 % of the Monte Carlo (worst view 13 %), thermal within 2 %; thin edges in the light of the sky alone up to
//   70 %, deep inside an absorbing cloud 20 % of next to nothing. No rainbow, no glory.

// Of a step of a line.
struct CloudStep {
  Vec2 depth;        // optical depth at 0.55 um to the sun, and in the cloud to the eye
  Vec4 sun;          // ln S_i
  Vec4 sunSlope;     // of these by the optical depth at 0.55 um, away from the eye
  Vec3 around;       // U, aU, aG
  Vec3 aroundSlope;  // the same of these
  Real across;       // nn
};

// At a wavelength.
struct CloudOptics {
  Real extinction;  // c e
  Real albedo;
  Real asymmetry;
  Real scaledAlbedo;
  Real scaledAsymmetry;
  Vec4 weight;      // l_i
  Real coordinate;  // y
};

// That at which the fall of the light of sky and ground is kept.
const Real kCloudDarkest = 0.8;

// Those at which scattered sunlight is kept.
PHYSICS Vec4 cloudAlbedos() { return Vec4(1.0, 0.985, 0.93, 0.75); }

// c: of the extinction, what a line of sight sees.
PHYSICS Real cloudScale(Real albedo, Real asymmetry) { return 1.0 - albedo * asymmetry * asymmetry; }

PHYSICS Real cloudCoordinate(Real albedo, Real asymmetry) { return sqrt(max(1.0 - albedo, 0.0) / (1.0 - 0.6 * albedo * asymmetry)); }

// By its weights, as they are told by cloudOptics().
PHYSICS CloudOptics cloudOpticsBy(Real extinction, Real albedo, Real asymmetry, Vec4 weight, Real coordinate) {
  CloudOptics o;
  o.extinction = extinction;
  o.albedo = albedo;
  o.asymmetry = asymmetry;
  o.scaledAlbedo = albedo * (1.0 - asymmetry * asymmetry) / cloudScale(albedo, asymmetry);
  o.scaledAsymmetry = asymmetry / (1.0 + asymmetry);
  o.weight = weight;
  o.coordinate = coordinate;
  return o;
}

PHYSICS CloudOptics cloudOptics(Real extinction, Real albedo, Real asymmetry) {
  Vec4 albedos = cloudAlbedos();
  Real x = cloudCoordinate(albedo, asymmetry);
  Vec4 at = Vec4(cloudCoordinate(albedos.x, asymmetry), cloudCoordinate(albedos.y, asymmetry), cloudCoordinate(albedos.z, asymmetry),
                 cloudCoordinate(albedos.w, asymmetry));
  Vec4 weight = Vec4(1.0, 1.0, 1.0, 1.0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (j != i) weight[i] = weight[i] * ((x - at[j]) / (at[i] - at[j]));
  return cloudOpticsBy(extinction, albedo, asymmetry, weight, x / cloudCoordinate(kCloudDarkest, asymmetry));
}

// Share of an even light that reaches a place, and how that changes: value, slope.
PHYSICS Vec2 cloudReaching(Real share, Real fall, Real shareSlope, Real fallSlope, Real coordinate) {
  Real e = exp(-min(fall * coordinate, kExpLimit));
  Real inverse = 1.0 / (1.0 + e * e);
  Real left = 2.0 * e * inverse;
  return Vec2(share * left, left * (shareSlope - share * fallSlope * coordinate * (1.0 - e * e) * inverse));
}

// Source per scaled depth, which is what a line is weakened by: for an irradiance of the sun of 1 [1/sr], and the rest [W/(m2 sr um)], of an even radiance of
// the sky above and of the ground below, and of black drops. cosSun: between the line and the direction to the sun.
PHYSICS Vec2 cloudSource(CloudStep s, CloudOptics o, Real above, Real below, Real black, Real cosSun) {
  Real g = o.asymmetry;
  Real peak = g * g;
  Real c = 1.0 - o.albedo * peak;
  Real beam = exp(-min(o.extinction * s.depth.x, kExpLimit));
  Real perDepth = c / o.extinction;  // 1/e
  Real u = o.albedo * peak * (s.depth.x + s.depth.y) / perDepth;
  Real wide = exp((1.0 + 0.455 * u) * log(max(g, 1.0e-3)));
  Real bend = 1.0 + wide * wide - 2.0 * wide * cosSun;
  Real once = beam * (1.0 - wide * wide) / (12.566370614359172 * max(bend * sqrt(bend), 1.0e-9) * (1.0 + 0.314 * u));
  Real wg = o.scaledAlbedo * o.scaledAsymmetry;
  Real diffusion = perDepth / (3.0 * c * (1.0 - wg));
  // No place is brighter than the sun's light all turned to one side.
  Real sun = o.scaledAlbedo * exp(min(max(dot(o.weight, s.sun), -kExpLimit), 0.0));
  Real side = min(0.223 + 0.928 * o.extinction * s.depth.x, 4.0);
  Real pushed = 1.07 * wg / (1.0 - wg) * beam / 12.566370614359172 * (s.across + side * (cosSun - s.across));
  Real flux = min(max(diffusion * sun * dot(o.weight, s.sunSlope) + pushed, -0.462 * sun), 0.678 * sun);
  Real forward = 3.0 * o.scaledAsymmetry;
  Vec2 sky = cloudReaching(s.around.x, s.around.y, s.aroundSlope.x, s.aroundSlope.y, o.coordinate);
  Vec2 ground = cloudReaching(1.0 - s.around.x, s.around.z, -s.aroundSlope.x, s.aroundSlope.z, o.coordinate);
  Real fromSky = forward * min(max(diffusion * sky.y, -0.5 * sky.x), 0.5 * sky.x);
  Real fromGround = forward * min(max(diffusion * ground.y, -0.5 * ground.x), 0.5 * ground.x);
  // What drops send has the flux that the others lack, so that all of one radiance have none.
  Real again = above * (sky.x + fromSky) + below * (ground.x + fromGround) + black * (1.0 - sky.x - ground.x - fromSky - fromGround);
  return Vec2(o.albedo * (once + (1.0 - peak) * (sun + forward * flux)), o.scaledAlbedo * c * again + (1.0 - o.albedo) * black) / c;
}
