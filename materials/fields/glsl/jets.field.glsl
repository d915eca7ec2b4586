// The jets of one plume: equal nozzles side by side, all along +x of the field. Where they overlap, mixture and excess speed add, to 1 at most: right where the
// excess is small, as it is where they have grown together.
//   Texels. An element is a nozzle: its place, how far on the first of what all share is. Then of all:
//     0 radius, length, where it begins to fade, 1/(length - that)     1 1/rowScale, 1/rowLogRatio, coreLength, 1/farLogRatio
//     2 coreRow, rowCount - 2, strength, nozzles                       3 flow, 4 cp, cpExcess, moles, molesExcess: see jet.glsl
//     5 which of the amounts are moles, 6 which are density/pressure [1/K]: 1 there
//     7, 8 radii at both ends of four cones that bound it              9 length, end radius, first radius of the core, ramp: half of the stretch around its
//     nozzle on which it begins
//     then the rows.
//@use sim/radiometry/glsl/chord.glsl
//@use materials/fields/glsl/jet.glsl
//@use materials/fields/glsl/cuts.glsl

const bool fieldMixes = false;

// Of the line at hand, in sigma: its ends; where it enters and leaves the uniform cores of two nozzles at most, and how many steps end there. t and scale of
// sigma; steps.
Vec2 jetsEnds_ = Vec2(0.0);
Vec4 jetsKnots_ = Vec4(0.0);
Vec4 jetsSteps_ = Vec4(0.0);
Vec3 jetsMap_ = Vec3(0.0);
Real jetsPresent_ = 0.0;        // of a step, of that of all nozzles so far that has begun and faded least: what there is of it
Vec3 jetsMixture_ = Vec3(0.0);  // of a step, of all nozzles so far: mixture fraction, excess speed, what has not faded of the first

Vec2 fieldChord(int at) {
  Vec4 place = fieldTexel(at);
  int own = at + int(place.w);
  Vec4 first = fieldTexel(own + 7);
  Vec4 second = fieldTexel(own + 8);
  Real length_ = fieldTexel(own).y;
  Real ramp = fieldTexel(own + 9).w;
  Real half_ = 0.5 * (length_ + ramp);
  Vec3 p = q_ - Vec3(place.x + 0.5 * (length_ - ramp), place.y, place.z);
  Vec2 a = coneChord(p, d_, half_, first.x, first.y);
  Vec2 b = coneChord(p, d_, half_, first.z, first.w);
  Vec2 c = coneChord(p, d_, half_, second.x, second.y);
  Vec2 e = coneChord(p, d_, half_, second.z, second.w);
  if (!(a.y > a.x && b.y > b.x && c.y > c.x && e.y > e.x)) return Vec2(0.0, 0.0);
  return Vec2(max(max(a.x, b.x), max(c.x, e.x)), min(min(a.y, b.y), min(c.y, e.y)));
}

// Takes the cores in the order of the line, parts that overlap once.
Vec4 jetsCores(Vec4 cores, Vec2 next) {
  if (!(next.y > next.x)) return cores;
  if (!(cores.y > cores.x)) return Vec4(next.x, next.y, cores.z, cores.w);
  Vec2 first = next.x < cores.x ? next : Vec2(cores.x, cores.y);
  Vec2 second = next.x < cores.x ? Vec2(cores.x, cores.y) : next;
  return Vec4(first.x, first.y, max(second.x, first.y), max(second.y, first.y));
}

// How a line from enter_ to leave_ is cut: evenly in sigma, of its nozzle or of a place between several, but that steps end where cores do, which have an
// eighth of them at most: nothing changes within.
void fieldLine(int at, int steps) {
  int own = at + int(fieldTexel(at).w);
  int nozzles = int(fieldTexel(own + 2).w);
  Vec4 size = fieldTexel(own);
  Vec4 core = fieldTexel(own + 9);
  Real low = kFar;
  Real high = -kFar;
  Real wide = 0.0;
  Vec4 cores = Vec4(leave_, leave_, leave_, leave_);
  for (int j = 0; j < nozzles; ++j) {
    Vec4 head = fieldTexel(own - nozzles + j);
    Vec2 chord = fieldChord(own - nozzles + j);
    if (!(chord.y > chord.x)) continue;
    Vec3 p = q_ - Vec3(head.x, head.y, head.z);
    Real nearest = -dot(p, d_) / dot(d_, d_);
    Vec3 there = p + nearest * d_;
    low = min(low, nearest);
    high = max(high, nearest);
    wide = max(wide, sqrt(dot(there, there) + 4.0 * size.x * size.x) / perT_);
    Vec2 within = coneChord(p - Vec3(0.5 * (core.w + core.x), 0.0, 0.0), d_, 0.5 * (core.x - core.w), core.z, core.y);
    if (core.x > core.w && within.y > within.x) cores = jetsCores(cores, Vec2(max(within.x, enter_), min(within.y, leave_)));
  }
  Vec2 scale = high >= low ? Vec2(0.5 * (low + high), 1.0 / max(wide, 0.5 * (high - low))) : Vec2(0.5 * (enter_ + leave_), 1.0 / max(leave_ - enter_, 1.0e-6));
  jetsEnds_ = Vec2(cutSigma(enter_, scale), cutSigma(leave_, scale));
  Vec4 k = Vec4(cutSigma(cores.x, scale), cutSigma(cores.y, scale), cutSigma(cores.z, scale), cutSigma(cores.w, scale));
  Real inside = k.y - k.x + k.w - k.z;
  Real outside = jetsEnds_.y - jetsEnds_.x - inside;
  Real inCore = inside > 0.0 ? min(1.0, max(outside / (7.0 * inside), 1.0e-3)) : 1.0;
  Real per = Real(steps) / max(outside + inCore * inside, 1.0e-20);
  // Each stretch has a step at least where there are enough.
  Real least = steps > 5 ? 1.0 : 0.0;
  Vec4 n;
  n.x = floor(per * (k.x - jetsEnds_.x) + 0.5);
  if (k.x > jetsEnds_.x) n.x = max(n.x, least);
  n.y = max(floor(per * (k.x - jetsEnds_.x + inCore * (k.y - k.x)) + 0.5), n.x + (k.y > k.x ? least : 0.0));
  n.z = max(floor(per * (k.z - jetsEnds_.x - (1.0 - inCore) * (k.y - k.x)) + 0.5), n.y + (k.z > k.y && k.w > k.z ? least : 0.0));
  n.w = max(floor(per * (k.w - jetsEnds_.x - (1.0 - inCore) * inside) + 0.5), n.z + (k.w > k.z ? least : 0.0));
  // What is behind the last core has what is left, and a step at least.
  if (jetsEnds_.y > k.w) n.w = min(n.w, Real(steps) - least);
  n.z = min(n.z, n.w - (k.w > k.z ? least : 0.0));
  n.y = min(n.y, n.z);
  n.x = min(n.x, n.y - (k.y > k.x ? least : 0.0));
  jetsKnots_ = k;
  jetsSteps_ = n;
  jetsMap_ = Vec3(scale.x, scale.y, Real(steps));
}

Real fieldCut(Real s) {
  if (s <= 0.0) return enter_;
  if (s >= 1.0) return leave_;
  Real x = floor(s * jetsMap_.z + 0.5);
  Vec2 n = Vec2(0.0, jetsSteps_.x);
  Vec2 k = Vec2(jetsEnds_.x, jetsKnots_.x);
  if (x > jetsSteps_.x) {
    n = Vec2(jetsSteps_.x, jetsSteps_.y);
    k = Vec2(jetsKnots_.x, jetsKnots_.y);
  }
  if (x > jetsSteps_.y) {
    n = Vec2(jetsSteps_.y, jetsSteps_.z);
    k = Vec2(jetsKnots_.y, jetsKnots_.z);
  }
  if (x > jetsSteps_.z) {
    n = Vec2(jetsSteps_.z, jetsSteps_.w);
    k = Vec2(jetsKnots_.z, jetsKnots_.w);
  }
  if (x > jetsSteps_.w) {
    n = Vec2(jetsSteps_.w, jetsMap_.z);
    k = Vec2(jetsKnots_.w, jetsEnds_.y);
  }
  Real sigma = n.y > n.x ? k.x + (k.y - k.x) * (x - n.x) / (n.y - n.x) : k.y;
  return min(max(cutPlace(sigma, Vec2(jetsMap_.x, jetsMap_.y)), enter_), leave_);
}

void fieldAdd(int at, Real from, Real to) {
  Vec4 head = fieldTexel(at);
  int own = at + int(head.w);
  Vec3 p = q_ + (0.5 * (from + to)) * d_ - Vec3(head.x, head.y, head.z);
  Vec4 size = fieldTexel(own);
  Real ramp = fieldTexel(own + 9).w;
  if (p.x <= -ramp || p.x >= size.y) return;
  Vec4 counts = fieldTexel(own + 2);
  Real x = max(p.x, 0.0);
  int i = int(min(max(jetRow(x, fieldTexel(own + 1), counts.x), 0.0), counts.y));
  Vec4 a = fieldTexel(own + 10 + i);
  Vec4 b = fieldTexel(own + 11 + i);
  Vec4 row = a + (x - a.x) / (b.x - a.x) * (b - a);
  Real left = min((size.y - p.x) * size.w, 1.0);
  Real begun = min(0.5 * (p.x + ramp) / ramp, 1.0);
  Real present = counts.z * left * left * (3.0 - 2.0 * left) * begun * begun * (3.0 - 2.0 * begun);
  Vec2 here = jetMixture(row, size.x, sqrt(p.y * p.y + p.z * p.z));
  jetsMixture_ = (weight_ > 0.0 ? jetsMixture_ : Vec3(0.0)) + Vec3(here.x, here.y, present * here.x);
  jetsPresent_ = weight_ > 0.0 ? max(jetsPresent_, present) : present;
  jetsMixture_ = Vec3(min(jetsMixture_.x, 1.0), min(jetsMixture_.y, 1.0), min(jetsMixture_.z, jetsPresent_));
  // Of all nozzles together, anew with each.
  Vec4 heat = fieldTexel(own + 4);
  Real temperature = jetTemperature(Vec2(jetsMixture_.x, jetsMixture_.y), fieldTexel(own + 3), heat);
  weight_ = jetsMixture_.z * (to - from) * perT_;
  heat_ = weight_ * temperature;
  Real moles = weight_ / (heat.z + heat.w * jetsMixture_.x);
  amountLow_ = moles * fieldTexel(own + 5) + (moles / temperature) * fieldTexel(own + 6);
}
