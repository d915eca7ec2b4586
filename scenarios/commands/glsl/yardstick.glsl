// The fixed yardstick of `bench`: a bare loop over 16 wavelengths with 16 channels out. Per wavelength one RGBA32F 3-D table read,
// one exponential, the two path terms and four vec4 multiply-adds. It measures the machine, not the renderer; never change it.
layout(location = 0) out vec4 c0;
layout(location = 1) out vec4 c1;
layout(location = 2) out vec4 c2;
layout(location = 3) out vec4 c3;
layout(binding = 0) uniform sampler3D columns;
layout(binding = 1) uniform sampler2D constants;  // per wavelength: extinction, path radiance, source, 0; then four weights
uniform vec2 angles;

void main() {
  float range = 1.0 + 0.001 * gl_FragCoord.x;
  c0 = c1 = c2 = c3 = vec4(0.0);
  for (int i = 0; i < 16; ++i) {
    vec4 node = texelFetch(constants, ivec2(i, 0), 0);
    vec4 table = textureLod(columns, vec3((float(i) + 0.5) / 16.0, angles + 0.0001 * gl_FragCoord.xy), 0.0);
    float tau = exp(-node.x * range);
    float radiance = dot(table, vec4(node.z)) * tau + node.y * (1.0 - tau);
    c0 += texelFetch(constants, ivec2(i, 1), 0) * radiance;
    c1 += texelFetch(constants, ivec2(i, 2), 0) * radiance;
    c2 += texelFetch(constants, ivec2(i, 3), 0) * radiance;
    c3 += texelFetch(constants, ivec2(i, 4), 0) * radiance;
  }
}
