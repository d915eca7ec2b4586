// A cloud of drops on a regular grid, trilinear between nodes, lit as materials/fields/cloud_light.hpp says.
//   Texels: 0 first node, nodes along x   1 1/spacing, nodes along y   2 last node, nodes along z   3 to the sun, share of its disc
//   4 temperature at height 0 of the grid, what it falls by per metre, 0, 0; then the nodes, x fastest, three each: extinction at 0.55 um, optical depth to the
//   sun, U, aU; S_0 to S_3; aG, gradient of S_1 (sim/radiometry/glsl/cloud.glsl).
//@use sim/radiometry/glsl/cloud.glsl
const bool fieldMixes = false;

int cloudNode_ = 0;  // texel of the lowest corner's
int cloudY_ = 0, cloudZ_ = 0;  // to its neighbours', along x 3
Vec3 cloudPart_ = Vec3(0.0, 0.0, 0.0);
Vec3 cloudRate_ = Vec3(0.0, 0.0, 0.0);  // nodes per metre of the line
Vec4 cloudSlope_ = Vec4(0.0, 0.0, 0.0, 0.0);  // of what cloudAt() told last, per metre of the line
// Of the line at hand, at the ends of 32 even parts: optical depth from its near end; what has been seen of it, 0 to 1, by which it is cut.
Real cloudDepth_[33];
Real cloudSeen_[33];
// Sums over a step, by optical depth.
Vec4 cloudDepths_ = Vec4(0.0, 0.0, 0.0, 0.0);  // to the sun, to the eye, nn, 0
Vec4 cloudSun_ = Vec4(0.0, 0.0, 0.0, 0.0);
Vec4 cloudSunSlope_ = Vec4(0.0, 0.0, 0.0, 0.0);
Vec3 cloudAround_ = Vec3(0.0, 0.0, 0.0);
Vec3 cloudAroundSlope_ = Vec3(0.0, 0.0, 0.0);

Vec2 fieldChord(int at) {
  Vec4 low = fieldTexel(at);
  Vec4 high = fieldTexel(at + 2);
  Vec2 t = Vec2(-kFar, kFar);
  for (int k = 0; k < 3; ++k) {
    if (d_[k] != 0.0) {
      Real a = (low[k] - q_[k]) / d_[k];
      Real b = (high[k] - q_[k]) / d_[k];
      t = Vec2(max(t.x, min(a, b)), min(t.y, max(a, b)));
    } else if (q_[k] < low[k] || q_[k] > high[k]) {
      return Vec2(0.0, 0.0);
    }
  }
  return t.y > t.x ? t : Vec2(0.0, 0.0);
}

// The cell that a place of the line lies in; false outside.
bool cloudCell(int at, Real t) {
  Vec4 low = fieldTexel(at);
  Vec4 scale = fieldTexel(at + 1);
  Real up = fieldTexel(at + 2).w;
  Vec3 p = (q_ + t * d_ - Vec3(low.x, low.y, low.z)) * Vec3(scale.x, scale.y, scale.z);
  if (min(min(p.x, p.y), p.z) < 0.0 || p.x > low.w - 1.0 || p.y > scale.w - 1.0 || p.z > up - 1.0) return false;
  Vec3 node = Vec3(min(floor(p.x), low.w - 2.0), min(floor(p.y), scale.w - 2.0), min(floor(p.z), up - 2.0));
  cloudPart_ = p - node;
  cloudY_ = 3 * int(low.w);
  cloudZ_ = cloudY_ * int(scale.w);
  cloudNode_ = at + 5 + 3 * int(node.x) + cloudY_ * int(node.y) + cloudZ_ * int(node.z);
  return true;
}

Vec4 cloudAt(int more) {
  int n = cloudNode_ + more;
  Vec4 a = fieldTexel(n);
  Vec4 b = fieldTexel(n + cloudY_);
  Vec4 c = fieldTexel(n + cloudZ_);
  Vec4 e = fieldTexel(n + cloudY_ + cloudZ_);
  Vec4 ax = fieldTexel(n + 3) - a;
  Vec4 bx = fieldTexel(n + cloudY_ + 3) - b;
  Vec4 cx = fieldTexel(n + cloudZ_ + 3) - c;
  Vec4 ex = fieldTexel(n + cloudY_ + cloudZ_ + 3) - e;
  a += cloudPart_.x * ax;
  b += cloudPart_.x * bx;
  c += cloudPart_.x * cx;
  e += cloudPart_.x * ex;
  Vec4 low = a + cloudPart_.y * (b - a);
  Vec4 high = c + cloudPart_.y * (e - c);
  Vec4 lowX = ax + cloudPart_.y * (bx - ax);
  Vec4 highX = cx + cloudPart_.y * (ex - cx);
  cloudSlope_ = cloudRate_.x * (lowX + cloudPart_.z * (highX - lowX)) + cloudRate_.y * (b - a + cloudPart_.z * (e - c - b + a)) + cloudRate_.z * (high - low);
  return low + cloudPart_.z * (high - low);
}

// Extinction alone.
Real cloudThere(int at, Real t) {
  if (!cloudCell(at, t)) return 0.0;
  int n = cloudNode_;
  Real a = fieldTexel(n).x;
  Real b = fieldTexel(n + cloudY_).x;
  Real c = fieldTexel(n + cloudZ_).x;
  Real e = fieldTexel(n + cloudY_ + cloudZ_).x;
  a += cloudPart_.x * (fieldTexel(n + 3).x - a);
  b += cloudPart_.x * (fieldTexel(n + cloudY_ + 3).x - b);
  c += cloudPart_.x * (fieldTexel(n + cloudZ_ + 3).x - c);
  e += cloudPart_.x * (fieldTexel(n + cloudY_ + cloudZ_ + 3).x - e);
  Real low = a + cloudPart_.y * (b - a);
  return low + cloudPart_.z * (c + cloudPart_.y * (e - c) - low);
}

// A line is cut where equal parts of it have been seen: of a fifth by its length, of the rest by what is lost on the way in light of few scatterings.
void fieldLine(int at, int steps) {
  Vec4 scale = fieldTexel(at + 1);
  cloudRate_ = d_ * Vec3(scale.x, scale.y, scale.z) / perT_;
  Real each = (leave_ - enter_) / 32.0;
  cloudDepth_[0] = 0.0;
  for (int k = 0; k < 32; ++k) cloudDepth_[k + 1] = cloudDepth_[k] + each * perT_ * cloudThere(at, enter_ + (Real(k) + 0.5) * each);
  Real all = max(1.0 - exp(-min(0.4 * cloudDepth_[32], kExpLimit)), 1.0e-12);
  for (int k = 0; k < 33; ++k) cloudSeen_[k] = 0.2 * Real(k) / 32.0 + 0.8 * (1.0 - exp(-min(0.4 * cloudDepth_[k], kExpLimit))) / all;
}

Real fieldCut(Real s) {
  if (s <= 0.0) return enter_;
  if (s >= 1.0) return leave_;
  int low = 0;
  int high = 32;
  for (int k = 0; k < 5; ++k) {
    int middle = (low + high) / 2;
    if (cloudSeen_[middle] <= s * cloudSeen_[32]) low = middle;
    else high = middle;
  }
  Real part = (s * cloudSeen_[32] - cloudSeen_[low]) / max(cloudSeen_[low + 1] - cloudSeen_[low], 1.0e-12);
  return enter_ + (leave_ - enter_) * (Real(low) + min(max(part, 0.0), 1.0)) / 32.0;
}

// Optical depth from the near end of the line.
Real cloudBefore(Real t) {
  Real place = min(max((t - enter_) / max(leave_ - enter_, 1.0e-30), 0.0), 1.0) * 32.0;
  int low = int(min(floor(place), 31.0));
  return cloudDepth_[low] + (place - Real(low)) * (cloudDepth_[low + 1] - cloudDepth_[low]);
}

// By the middles of as many parts of a step as it passes nodes, 32 at most.
void fieldAdd(int at, Real from, Real to) {
  if (weight_ <= 0.0) {
    cloudDepths_ = Vec4(0.0, 0.0, 0.0, 0.0);
    cloudSun_ = Vec4(0.0, 0.0, 0.0, 0.0);
    cloudSunSlope_ = Vec4(0.0, 0.0, 0.0, 0.0);
    cloudAround_ = Vec3(0.0, 0.0, 0.0);
    cloudAroundSlope_ = Vec3(0.0, 0.0, 0.0);
  }
  Vec4 toSun = fieldTexel(at + 3);
  Vec4 warm = fieldTexel(at + 4);
  Real nodes = (to - from) * perT_ * max(max(max(cloudRate_.x, -cloudRate_.x), max(cloudRate_.y, -cloudRate_.y)), max(cloudRate_.z, -cloudRate_.z));
  int parts = int(min(max(nodes + 0.999, 1.0), 32.0));
  Real each = (to - from) / Real(parts);
  Vec3 along = d_ / perT_;
  for (int k = 0; k < parts; ++k) {
    Real t = from + (Real(k) + 0.5) * each;
    if (!cloudCell(at, t)) continue;
    Vec4 light = cloudAt(0);
    if (!(light.x > 0.0)) continue;
    Real length = each * perT_;
    Real weight = length * light.x;
    cloudAround_ += weight * Vec3(light.z, light.w, 0.0);
    cloudAroundSlope_ += length * Vec3(cloudSlope_.z, cloudSlope_.w, 0.0);
    cloudSun_ += weight * cloudAt(1);
    cloudSunSlope_ += length * cloudSlope_;
    Vec4 more = cloudAt(2);
    cloudAround_ += weight * Vec3(0.0, 0.0, more.x);
    cloudAroundSlope_ += length * Vec3(0.0, 0.0, cloudSlope_.x);
    Vec3 n = Vec3(more.y, more.z, more.w);
    Vec3 sun = Vec3(toSun.x, toSun.y, toSun.z);
    Real across = dot(n, along) * dot(n, sun) / max(dot(n, n), 1.0e-30);
    cloudDepths_ += weight * Vec4(light.y, cloudBefore(t), across, 0.0);
    weight_ += weight;
    heat_ += weight * (warm.x - warm.y * (q_.z + t * d_.z));
    lit_ += weight * toSun.w;
    amountLow_ += Vec4(weight, 0.0, 0.0, 0.0);
  }
}

CloudStep cloudStep() {
  Real per = 1.0 / max(weight_, 1.0e-30);
  CloudStep s;
  Vec4 sun = Vec4(max(per * cloudSun_.x, 1.0e-12), max(per * cloudSun_.y, 1.0e-12), max(per * cloudSun_.z, 1.0e-12), max(per * cloudSun_.w, 1.0e-12));
  s.depth = per * Vec2(cloudDepths_.x, cloudDepths_.y);
  s.sun = Vec4(log(sun.x), log(sun.y), log(sun.z), log(sun.w));
  s.sunSlope = per * cloudSunSlope_ / sun;
  s.around = per * cloudAround_;
  s.aroundSlope = per * cloudAroundSlope_;
  s.across = per * cloudDepths_.z;
  return s;
}
