// What a line shows beyond all that is seen through, taken through its steps, far to near: L <- through L + own. A group, things in the same piece of the line,
// is passed in both orders and the mean of both taken: right to the third power of its depths. Where fields show, a pixel is the sum of its lines.
layout(local_size_x = 64) in;
//@constants
//@use sim/render/glsl/field_lines.glsl
layout(binding = 17) uniform usamplerBuffer lineSteps;
layout(binding = 18) uniform usamplerBuffer steps;
layout(binding = 19) uniform usamplerBuffer lines;
layout(binding = 22) uniform samplerBuffer passages;  // as listed_entry.glsl leaves them
uniform int firstLine;
uniform int lineCount;
uniform ivec3 firstPassages;  // of panes, segments, fields
//@each t TARGETS
layout(rgba32f, binding = {t}) uniform image2D spectrum{t};
//@end

const uint kJoined = 1u << 29;
int first_, end_;  // steps of the line
bool fields_;      // are among them

uint stepAt(int s) { return texelFetch(steps, s).x; }

// Beyond a step on a line of the pixel; -1: beside all fields.
vec4 passed(vec4 behind, uint step, int l, int four) {
  int kind = int(step >> 30);
  if (kind == 2 && l < 0) return behind;
  int at = 2 * (TARGETS * (firstPassages[kind] + int(step & (kJoined - 1u)) + (kind == 2 ? l : 0)) + four);
  return texelFetch(passages, at) * behind + texelFetch(passages, at + 1);
}

vec4 seen(vec4 behind, int l, int four) {
  for (int s = first_; s < end_; ++s) {
    uint step = stepAt(s);
    if ((step & kJoined) == 0u) {
      behind = passed(behind, step, l, four);
      continue;
    }
    int last = s;
    while ((stepAt(last) & kJoined) != 0u) ++last;
    vec4 forth = behind, back = behind;
    for (int k = s; k <= last; ++k) {
      forth = passed(forth, stepAt(k), l, four);
      back = passed(back, stepAt(last + s - k), l, four);
    }
    behind = 0.5 * (forth + back);
    s = last;
  }
  return behind;
}

vec4 ofPixel(vec4 behind, int lines, int four) {
  if (!fields_) return seen(behind, -1, four);
  float left = leftByLines(lines);
  int count = countOfLines(lines);
  vec4 sum = left > 0.0 ? left * seen(behind, -1, four) : vec4(0.0);
  for (int l = 0; l < count; ++l) sum += shareOfLine(lines, l) * seen(behind, l, four);
  return sum;
}

void main() {
  if (gl_GlobalInvocationID.x >= uint(lineCount)) return;
  int line = firstLine + int(gl_GlobalInvocationID.x);
  uint pixel = texelFetch(lines, line).x;
  ivec2 at = ivec2(pixel & 0xffffu, pixel >> 16);
  first_ = int(texelFetch(lineSteps, 2 * line).x);
  end_ = first_ + int(texelFetch(lineSteps, 2 * line + 1).x);
  fields_ = false;
  for (int s = first_; s < end_; ++s) fields_ = fields_ || stepAt(s) >> 30 == 2u;
  int through = linesOf(at);
//@each t TARGETS
  imageStore(spectrum{t}, at, ofPixel(imageLoad(spectrum{t}, at), through, {t}));
//@end
}
