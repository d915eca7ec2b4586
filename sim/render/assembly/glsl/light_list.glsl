// A body's row of lights: how many can matter to it, then of each its place or direction in the body frame with its radius; its number, first and count of the
// casters that can shade the body from it, and the square of the distance beyond which that does not matter; the same beyond which the light itself does not,
// in shade and in full sunshine.
// Places that are left over have the number -1.
layout(binding = 9) uniform samplerBuffer lights;
vec4 lightTexel(int at) { return texelFetch(lights, at); }
//@slot light_texels
int lightRow(Draw draw) { return int(draw.state.z) * (kLightTexels * LIGHTS + 1); }
int lightEntry(int row, int k) { return row + 1 + kLightTexels * k; }
