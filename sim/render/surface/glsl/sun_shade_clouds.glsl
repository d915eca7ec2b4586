// What clouds of drops let through of the sun: their optical depth at 0.55 um, read where the point lies, by what drops take at a node of a unit of it
// (sim/model/sun_shade.hpp).
layout(binding = 28) uniform samplerBuffer sunShadeGrid;  // nodes along three axes, then depths, the first fastest
float shadeDepth_;

void prepareSunShade() {
  vec3 point = ray_ * (range_ / rayLength_);
  vec3 nodes = vec3(texelFetch(sunShadeGrid, 0).x, texelFetch(sunShadeGrid, 1).x, texelFetch(sunShadeGrid, 2).x);
  vec4 x = texelFetch(viewTexels, 9), y = texelFetch(viewTexels, 10), z = texelFetch(viewTexels, 11);
  vec3 at = clamp(vec3(dot(x.xyz, point) + x.w, dot(y.xyz, point) + y.w, dot(z.xyz, point) + z.w), vec3(0.0), nodes - 1.0);
  vec3 low = min(floor(at), nodes - 2.0), part = at - low;
  int alongY = int(nodes.x), alongZ = alongY * int(nodes.y), n = 3 + int(low.x) + alongY * int(low.y) + alongZ * int(low.z);
  vec4 near = vec4(texelFetch(sunShadeGrid, n).x, texelFetch(sunShadeGrid, n + alongY).x, texelFetch(sunShadeGrid, n + alongZ).x,
                   texelFetch(sunShadeGrid, n + alongY + alongZ).x);
  vec4 far = vec4(texelFetch(sunShadeGrid, n + 1).x, texelFetch(sunShadeGrid, n + alongY + 1).x, texelFetch(sunShadeGrid, n + alongZ + 1).x,
                  texelFetch(sunShadeGrid, n + alongY + alongZ + 1).x);
  vec4 rows = mix(near, far, part.x);
  vec2 planes = mix(rows.xz, rows.yw, part.y);
  shadeDepth_ = mix(planes.x, planes.y, part.z);
}

Real sunShade(int i) { return exp(-shadeDepth_ * nodes.nodeLight[i * LIGHT_GROUPS + LIGHTS / 4][LIGHTS % 4]); }
