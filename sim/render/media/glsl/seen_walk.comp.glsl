// What a line shows beyond all that is seen through, taken through its steps, far to near: L <- through L + own. A group is things in the same piece of the
// line, where their depths a add up to A: what each adds alone, S (1 - exp(-a)), it adds there by E(A) / E(a), E(x) = (1 - exp(-x)) / x: exact where they are
// even on the piece. Where fields show, a pixel is the sum of its lines, some of them at a time: llvmpipe ends all loops of an invocation after 65535 rounds in
// all (LP_MAX_TGSI_LOOP_ITERATIONS), without a word.
layout(local_size_x = 64) in;
//@constants
//@use sim/render/media/glsl/field_lines.glsl
layout(binding = 17) uniform usamplerBuffer lineSteps;
layout(binding = 18) uniform usamplerBuffer steps;
layout(binding = 19) uniform usamplerBuffer lines;
layout(binding = 22) uniform samplerBuffer passages;  // as listed_entry.glsl leaves them
uniform int firstLine;
uniform int lineCount;
uniform ivec3 firstPassages;  // of panes, segments, fields
uniform int firstOfPixel;     // of its lines
uniform int atOnce;           // so many of them
layout(std430, binding = 4) buffer Sums { vec4 sums[]; };
uniform int four;  // nodes that are passed: of one target
layout(rgba32f, binding = 0) uniform image2D spectrum;

const uint kJoined = 1u << 29;
int first_, end_;  // steps of the line

uint stepAt(int s) { return texelFetch(steps, s).x; }

// The entry of a step on a line of the pixel; -1: beside all fields, where one of them has none.
int passageOf(uint step, int l) {
  int kind = int(step >> 30);
  return kind == 2 && l < 0 ? -1 : 2 * TARGETS * (firstPassages[kind] + int(step & (kJoined - 1u)) + (kind == 2 ? l : 0));
}

// E of the depth that lets through so much.
vec4 meanOf(vec4 through) {
  vec4 lost = 1.0 - through, series = 1.0 - lost * (0.5 + lost * (1.0 / 12.0 + lost * (1.0 / 24.0)));
  return mix(lost / -log(clamp(through, vec4(1.0e-30), vec4(0.999))), series, lessThan(lost, vec4(0.05)));
}

vec4 seen(vec4 behind, int l) {
  for (int s = first_; s < end_; ++s) {
    int at = passageOf(stepAt(s), l);
    if ((stepAt(s) & kJoined) == 0u) {
      if (at >= 0) behind = texelFetch(passages, at + 2 * four) * behind + texelFetch(passages, at + 2 * four + 1);
      continue;
    }
    int last = s;
    vec4 through = vec4(1.0), own = vec4(0.0);
    for (bool more = true; more; ++last) {
      more = (stepAt(last) & kJoined) != 0u;
      at = passageOf(stepAt(last), l);
      if (at >= 0) through *= texelFetch(passages, at + 2 * four);
    }
    for (int k = s; k < last; ++k) {
      at = passageOf(stepAt(k), l);
      if (at >= 0) own += texelFetch(passages, at + 2 * four + 1) / meanOf(texelFetch(passages, at + 2 * four));
    }
    behind = through * behind + own * meanOf(through);
    s = last - 1;
  }
  return behind;
}

// Lines from firstOfPixel on are added; what is not all of them yet waits in `sums`.
vec4 ofPixel(vec4 behind, int lines, int count, vec4 sum) {
  if (count == 0) return seen(behind, -1);
  float left = leftByLines(lines);
  if (firstOfPixel == 0) sum = left > 0.0 ? left * seen(behind, -1) : vec4(0.0);
  for (int l = firstOfPixel; l < min(count, firstOfPixel + atOnce); ++l) sum += shareOfLine(lines, l) * seen(behind, l);
  return sum;
}

void main() {
  if (gl_GlobalInvocationID.x >= uint(lineCount)) return;
  int line = firstLine + int(gl_GlobalInvocationID.x);
  uint pixel = texelFetch(lines, line).x;
  ivec2 at = ivec2(pixel & 0xffffu, pixel >> 16);
  first_ = int(texelFetch(lineSteps, 2 * line).x);
  end_ = first_ + int(texelFetch(lineSteps, 2 * line + 1).x);
  bool fields = false;
  for (int s = first_; s < end_; ++s) fields = fields || stepAt(s) >> 30 == 2u;
  int through = linesOf(at), count = fields ? countOfLines(through) : 0;
  if (firstOfPixel > 0 && firstOfPixel >= count) return;
  bool last = firstOfPixel + atOnce >= count;
  int own = TARGETS * int(gl_GlobalInvocationID.x) + four;
  vec4 sum = ofPixel(imageLoad(spectrum, at), through, count, firstOfPixel > 0 ? sums[own] : vec4(0.0));
  if (last) imageStore(spectrum, at, sum);
  else sums[own] = sum;
}
