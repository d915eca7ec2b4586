//@use sim/radiometry/glsl/ground.glsl
// Depth [m] at which the ground ends a ray that meets no body.
float groundDepth() { return groundRange(view.up.w, sinElevation_, view.earth.x) / rayLength_; }
