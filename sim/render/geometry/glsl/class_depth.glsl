// The depth of a class of surfaces by what a pixel needs: as PixelClasses::depthOf().
const int kSunAlone = 0, kUnshadowed = 1, kEveryLight = 2;
const float kNextClass = 1.0 / 16.0;

// Of its class, and that of its class with every light.
vec2 classesOf(uint draw) { return drawMember(draw, 5).yz; }

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
