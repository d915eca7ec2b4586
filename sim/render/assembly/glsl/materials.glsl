// What a shader knows of a material.
struct MaterialShape {
  uvec4 counts;        // entries along angle 1, angle 2, view angle; first column entry
  uvec4 kinds;         // angle 1, angle 2; 1 where the emissivity follows Kirchhoff; first hemispherical entry
  vec4 scale;          // entries per radian along angle 1, angle 2, view angle
  ivec4 transmission;  // texture of T or -1; first entry of the transmittances; texture of E or -1
  ivec4 state;         // texture of its state, or -1: its temperature; entries
  vec4 stateScale;     // state of the first entry; entries per unit of it; of the second table of columns: entries per radian along its angles 1 and 2
  uvec4 second;        // of the second table of columns: entries along its angles 1 and 2; both angles, 8 angle 2 + angle 1; first entry
  uvec4 response;      // to light from all around: first entry; how many textures; view angles; for each texture 4 bits, a component that has it
};
// Behind these eight, of R1, R2, ...: (its lobe, from 1 on, or 0; its texture or -1; whether it is one; 1 where the texture is an
// image of the last one's), then what the lobe of each takes, then (factor, summand) of each image.
layout(binding = 10) uniform usamplerBuffer materials;
uvec4 materialTexel(uint material, int member) { return texelFetch(materials, (8 + 3 * COMPONENTS) * int(material) + member); }
ivec4 componentOf(uint material, int k) { return ivec4(materialTexel(material, 8 + k)); }
vec4 lobeOfComponent(uint material, int k) { return uintBitsToFloat(materialTexel(material, 8 + COMPONENTS + k)); }
vec2 imageOfComponent(uint material, int k) { return uintBitsToFloat(materialTexel(material, 8 + 2 * COMPONENTS + k)).xy; }
MaterialShape materialAt(uint material) {
  return MaterialShape(materialTexel(material, 0), materialTexel(material, 1), uintBitsToFloat(materialTexel(material, 2)), ivec4(materialTexel(material, 3)),
                       ivec4(materialTexel(material, 4)), uintBitsToFloat(materialTexel(material, 5)), materialTexel(material, 6), materialTexel(material, 7));
}
