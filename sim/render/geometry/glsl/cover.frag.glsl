// The nearest depth where the classes have none: there is nothing to draw over.
layout(binding = 18) uniform sampler2D classes;

void main() {
  if (texelFetch(classes, ivec2(gl_FragCoord.xy), 0).x < 1.0) discard;
  gl_FragDepth = 1.0;
}
