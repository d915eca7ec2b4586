// The jets of one plume: equal nozzles side by side, all along +x of the field. Where they overlap, mixture and excess speed add, to 1 at most: right where the
// excess is small, as it is where they have grown together.
//   Texels. An element is a piece of one nozzle's jet: the nozzle's place, how far on the first of what all share is; from and to which x, 0, 0. Then of all:
//     0 radius, length, where it begins to fade, 1/(length - that)     1 1/rowScale, 1/rowLogRatio, coreLength, 1/farLogRatio
//     2 coreRow, rowCount - 2, strength, elements                      3 flow, 4 cp, cpExcess, moles, molesExcess: see jet.glsl
//     5, 6 amounts of the first four gases per mole, and per density/pressure [1/K]; 7, 8 of the next four
//     9, 10 radii at both ends of four cones that bound it             11 length and end radius of the core, whether there are more than four gases, pieces of a nozzle
//     then the rows.
//@use sim/radiometry/glsl/chord.glsl
//@use materials/fields/glsl/jet.glsl

// Of the line at hand, of the first two nozzles that it meets: knots, measure within the core, scale; and from where to where.
Vec3 jetsPoint_ = Vec3(0.0), jetsDirection_ = Vec3(0.0);
Vec4 jetsKnotsA_ = Vec4(0.0), jetsKnotsB_ = Vec4(0.0);
Vec3 jetsMapA_ = Vec3(0.0), jetsMapB_ = Vec3(0.0);
Vec2 jetsEnds_ = Vec2(0.0), jetsMeasures_ = Vec2(0.0);
int jetsAt_ = -1, jetsMet_ = 0;
Vec2 jetsMixture_ = Vec2(0.0);  // of a step, of all nozzles so far

// Of a whole jet.
Vec2 jetsChord(int own, Vec3 place) {
  Vec4 first = fieldTexel(own + 9);
  Vec4 second = fieldTexel(own + 10);
  Real middle = 0.5 * fieldTexel(own).y;
  Vec3 p = q_ - Vec3(place.x + middle, place.y, place.z);
  Vec2 a = coneChord(p, d_, middle, first.x, first.y);
  Vec2 b = coneChord(p, d_, middle, first.z, first.w);
  Vec2 c = coneChord(p, d_, middle, second.x, second.y);
  Vec2 e = coneChord(p, d_, middle, second.z, second.w);
  if (!(a.y > a.x && b.y > b.x && c.y > c.x && e.y > e.x)) return Vec2(0.0, 0.0);
  return Vec2(max(max(a.x, b.x), max(c.x, e.x)), min(min(a.y, b.y), min(c.y, e.y)));
}

Vec2 fieldChord(int at) {
  Vec4 head = fieldTexel(at);
  Vec4 piece = fieldTexel(at + 1);
  Real x = q_.x - head.x;
  Vec2 slab = Vec2(-kFar, kFar);
  if (d_.x != 0.0) {
    Real a = (piece.x - x) / d_.x;
    Real b = (piece.y - x) / d_.x;
    slab = Vec2(min(a, b), max(a, b));
  } else if (x < piece.x || x > piece.y) {
    return Vec2(0.0, 0.0);
  }
  Vec2 whole = jetsChord(at + int(head.w), Vec3(head.x, head.y, head.z));
  return Vec2(max(whole.x, slab.x), min(whole.y, slab.y));
}

Real jetsMeasure(Real t) {
  Real sum = jetMeasure(jetSigma(t, Vec2(jetsMapA_.y, jetsMapA_.z)), jetsKnotsA_, jetsMapA_.x) / max(jetMeasure(jetsKnotsA_.w, jetsKnotsA_, jetsMapA_.x), 1.0e-20);
  if (jetsMet_ > 1) sum += jetMeasure(jetSigma(t, Vec2(jetsMapB_.y, jetsMapB_.z)), jetsKnotsB_, jetsMapB_.x) / max(jetMeasure(jetsKnotsB_.w, jetsKnotsB_, jetsMapB_.x), 1.0e-20);
  return sum;
}

void jetsLine(int at) {
  jetsPoint_ = q_;
  jetsDirection_ = d_;
  jetsEnds_ = Vec2(enter_, leave_);
  jetsAt_ = at;
  jetsMet_ = 0;
  int own = at + int(fieldTexel(at).w);
  int elements = int(fieldTexel(own + 2).w);
  Vec4 size = fieldTexel(own);
  Vec4 core = fieldTexel(own + 11);
  int pieces = int(core.w);
  for (int j = 0; j < elements; j += pieces) {
    if (jetsMet_ > 1) continue;
    Vec4 head = fieldTexel(own - 2 * elements + 2 * j);
    Vec2 chord = jetsChord(own, Vec3(head.x, head.y, head.z));
    if (!(chord.y > chord.x)) continue;
    Vec3 p = q_ - Vec3(head.x, head.y, head.z);
    Vec2 within = coneChord(p - Vec3(0.5 * core.x, 0.0, 0.0), d_, 0.5 * core.x, size.x, core.y);
    Real nearest = -dot(p, d_) / dot(d_, d_);
    Vec3 there = p + nearest * d_;
    Vec2 scale = Vec2(nearest, perT_ / sqrt(dot(there, there) + 4.0 * size.x * size.x));
    bool isMet = within.y > within.x;
    Vec4 knots;
    knots.x = jetSigma(chord.x, scale);
    knots.w = jetSigma(chord.y, scale);
    knots.y = isMet ? min(max(jetSigma(within.x, scale), knots.x), knots.w) : knots.w;
    knots.z = isMet ? min(max(jetSigma(within.y, scale), knots.y), knots.w) : knots.w;
    // An eighth of the steps at most: nothing changes within it.
    Real inside = knots.z - knots.y;
    Real outside = knots.y - knots.x + knots.w - knots.z;
    Real inCore = inside > 0.0 ? min(1.0, max(outside / (7.0 * inside), 1.0e-3)) : 1.0;
    Vec3 map = Vec3(inCore, scale.x, scale.y);
    if (jetsMet_ == 0) {
      jetsKnotsA_ = knots;
      jetsMapA_ = map;
    } else {
      jetsKnotsB_ = knots;
      jetsMapB_ = map;
    }
    jetsMet_ += 1;
  }
  if (jetsMet_ == 1) jetsMeasures_ = Vec2(jetMeasure(jetSigma(enter_, Vec2(jetsMapA_.y, jetsMapA_.z)), jetsKnotsA_, jetsMapA_.x),
                                       jetMeasure(jetSigma(leave_, Vec2(jetsMapA_.y, jetsMapA_.z)), jetsKnotsA_, jetsMapA_.x));
  if (jetsMet_ > 1) jetsMeasures_ = Vec2(jetsMeasure(enter_), jetsMeasure(leave_));
}

Real fieldCut(int at, Real s) {
  if (s <= 0.0) return enter_;
  if (s >= 1.0) return leave_;
  if (jetsAt_ != at || jetsPoint_ != q_ || jetsDirection_ != d_ || jetsEnds_ != Vec2(enter_, leave_)) jetsLine(at);
  Real wanted = jetsMeasures_.x + s * (jetsMeasures_.y - jetsMeasures_.x);
  if (jetsMet_ == 0 || !(jetsMeasures_.y > jetsMeasures_.x)) return enter_ + s * (leave_ - enter_);
  if (jetsMet_ == 1) return min(max(jetPlace(wanted, jetsKnotsA_, jetsMapA_.x, Vec2(jetsMapA_.y, jetsMapA_.z)), enter_), leave_);
  // Two nozzles: halving, then a straight line through what is left.
  Vec2 low = Vec2(enter_, jetsMeasures_.x);
  Vec2 high = Vec2(leave_, jetsMeasures_.y);
  for (int k = 0; k < 7; ++k) {
    Real middle = 0.5 * (low.x + high.x);
    Real there = jetsMeasure(middle);
    if (there < wanted) low = Vec2(middle, there);
    else high = Vec2(middle, there);
  }
  return low.x + (high.x - low.x) * (high.y > low.y ? (wanted - low.y) / (high.y - low.y) : 0.5);
}

void fieldAdd(int at, Real from, Real to) {
  Vec4 head = fieldTexel(at);
  Vec4 piece = fieldTexel(at + 1);
  int own = at + int(head.w);
  Vec3 p = q_ + (0.5 * (from + to)) * d_ - Vec3(head.x, head.y, head.z);
  Vec4 size = fieldTexel(own);
  if (p.x < piece.x || p.x >= piece.y) return;
  Vec4 counts = fieldTexel(own + 2);
  int i = int(min(max(jetRow(p.x, fieldTexel(own + 1), counts.x), 0.0), counts.y));
  Vec4 a = fieldTexel(own + 12 + i);
  Vec4 b = fieldTexel(own + 13 + i);
  Vec4 row = a + (p.x - a.x) / (b.x - a.x) * (b - a);
  Real left = min((size.y - p.x) * size.w, 1.0);
  Real present = counts.z * left * left * (3.0 - 2.0 * left);
  Vec2 here = present * jetMixture(row, size.x, sqrt(p.y * p.y + p.z * p.z));
  jetsMixture_ = weight_ > 0.0 ? Vec2(min(jetsMixture_.x + here.x, 1.0), min(jetsMixture_.y + here.y, 1.0)) : here;
  // Of all nozzles together, anew with each.
  Vec4 heat = fieldTexel(own + 4);
  Real temperature = jetTemperature(jetsMixture_, fieldTexel(own + 3), heat);
  weight_ = jetsMixture_.x * (to - from) * perT_;
  heat_ = weight_ * temperature;
  Real moles = weight_ / (heat.z + heat.w * jetsMixture_.x);
  Real density = moles / temperature;
  amountLow_ = moles * fieldTexel(own + 5) + density * fieldTexel(own + 6);
  if (fieldTexel(own + 11).z > 0.0) amountHigh_ = moles * fieldTexel(own + 7) + density * fieldTexel(own + 8);
}
