// A stage of a sensor that is a function of one output's picture at each cell.
//@constants
layout(binding = 0) uniform sampler2D picture;  // of one output, in its unit; row 0 is the film's top
uniform float parameters[16];
uniform int cellsPerPixel;
uniform int frameNumber;
uniform ivec2 last;  // cell of the picture
layout(location = 0) out float value;

float cell(ivec2 at) { return texelFetch(picture, clamp(at, ivec2(0), last), 0).r; }
//@slot stage

void main() { value = stageAt(ivec2(gl_FragCoord.xy)); }
