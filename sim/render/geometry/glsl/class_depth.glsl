// The depth of a class of surfaces by what a pixel needs: as PixelClasses::depthOf().
const int kSunAlone = 0, kUnshadowed = 1, kEveryLight = 2;
const float kNextClass = 1.0 / 16.0;

// Of its class, and that of its class with every light. The latter has added 2 x what any place of it may need: 1 the sun alone, 2 unshadowed, 4 every light;
// what none needs is not drawn.
vec2 classesOf(uint draw) {
  vec2 own = drawMember(draw, 5).yz;
  return vec2(own.x, own.y - 2.0 * floor(0.5 * own.y));
}

// The least that the draw may need and that is no less than a need of its surroundings; else the most.
int needOf(uint draw, int need) {
  int mayNeed = int(0.5 * drawMember(draw, 5).z), least = 1 << need, more = mayNeed & ~(least - 1);
  return more == 0 ? findMSB(mayNeed) : findLSB(more);
}

float depthOfClass(vec2 own, int demand) {
  return own.x == own.y || demand == kSunAlone ? own.x : demand == kUnshadowed ? own.x + kNextClass : own.y;
}

// The draw that the pixel sees: what meets no body and goes down ends at the ground.
uint drawSeen(uint draw) {
  if (GROUND >= 0 && draw == 0u) {
    prepareRay(gl_FragCoord.xy);
    if (groundRange(view.up.w, sinElevation_, view.earth.x) < kFar) return uint(max(GROUND, 0));
  }
  return draw;
}
