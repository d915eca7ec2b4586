// A flow on a regular grid, trilinear between nodes.
//   Texels: 0 first node, nodes along x   1 1/spacing, nodes along y   2 last node, nodes along z   3, 4 a gas's share in what weighs temperatures
//   5 texels of a node, 0, 0, 0; then the nodes, x fastest: temperature and the first three gases; the next four.
const bool fieldMixes = false;

int gridNode_ = 0;  // texel of the lowest corner's
int gridX_ = 0, gridY_ = 0, gridZ_ = 0;  // to its neighbours'
Vec3 gridPart_ = Vec3(0.0);

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

void fieldLine(int at, int steps) {}

Real fieldCut(Real s) { return s <= 0.0 ? enter_ : s >= 1.0 ? leave_ : enter_ + s * (leave_ - enter_); }

Vec4 gridAlongX(int texel) { return fieldTexel(texel) + gridPart_.x * (fieldTexel(texel + gridX_) - fieldTexel(texel)); }

Vec4 gridAt(int more) {
  Vec4 a = gridAlongX(gridNode_ + more);
  Vec4 b = gridAlongX(gridNode_ + gridY_ + more);
  Vec4 c = gridAlongX(gridNode_ + gridZ_ + more);
  Vec4 e = gridAlongX(gridNode_ + gridY_ + gridZ_ + more);
  Vec4 low = a + gridPart_.y * (b - a);
  return low + gridPart_.z * (c + gridPart_.y * (e - c) - low);
}

// By the middles of as many parts of a step as it passes nodes, 32 at most.
void fieldAdd(int at, Real from, Real to) {
  Vec4 low = fieldTexel(at);
  Vec4 scale = fieldTexel(at + 1);
  Vec4 high = fieldTexel(at + 2);
  Vec4 first = fieldTexel(at + 3);
  Vec4 second = fieldTexel(at + 4);
  int wide = int(fieldTexel(at + 5).x);
  Vec3 per = d_ * Vec3(scale.x, scale.y, scale.z);
  Real nodes = (to - from) * max(max(max(per.x, -per.x), max(per.y, -per.y)), max(per.z, -per.z));
  int parts = int(min(max(nodes + 0.999, 1.0), 32.0));
  Real each = (to - from) / Real(parts);
  gridX_ = wide;
  gridY_ = wide * int(low.w);
  gridZ_ = gridY_ * int(scale.w);
  for (int k = 0; k < parts; ++k) {
    Vec3 p = (q_ + (from + (Real(k) + 0.5) * each) * d_ - Vec3(low.x, low.y, low.z)) * Vec3(scale.x, scale.y, scale.z);
    if (min(min(p.x, p.y), p.z) < 0.0 || p.x > low.w - 1.0 || p.y > scale.w - 1.0 || p.z > high.w - 1.0) continue;
    Vec3 node = Vec3(min(floor(p.x), low.w - 2.0), min(floor(p.y), scale.w - 2.0), min(floor(p.z), high.w - 2.0));
    gridPart_ = p - node;
    gridNode_ = at + 6 + int(node.x) * gridX_ + int(node.y) * gridY_ + int(node.z) * gridZ_;
    Real length = each * perT_;
    Vec4 here = gridAt(0);
    Vec4 next = wide > 1 ? gridAt(1) : Vec4(0.0);
    Real weight = length * (here.y * first.x + here.z * first.y + here.w * first.z + dot(next, second) + 1.0e-12);
    weight_ += weight;
    heat_ += weight * here.x;
    amountLow_ += length * Vec4(here.y, here.z, here.w, next.x);
    amountHigh_ += length * Vec4(next.y, next.z, next.w, 0.0);
  }
}
