// What a line shows beyond all that is seen through, taken through its steps, far to near: L <- through L + own. A group is things in the same piece of the
// line, where their depths a add up to A: what each adds alone, S (1 - exp(-a)), it adds there by E(A) / E(a), E(x) = (1 - exp(-x)) / x: exact where they are
// even on the piece. Where fields show a pixel is the sum of several goes, one for each of its lines through them; these are added up when all are told.
layout(local_size_x = 64) in;
//@constants
//@use sim/render/media/glsl/field_lines.glsl
layout(binding = 17) uniform usamplerBuffer lineSteps;
layout(binding = 18) uniform usamplerBuffer steps;
layout(binding = 19) uniform usamplerBuffer lines;
layout(binding = 23) uniform usamplerBuffer goes;
layout(binding = 22) uniform samplerBuffer passages;  // as listed_entry.glsl leaves them
uniform int first;  // go, or line where goes are added up
uniform int count;
uniform bool adding;
uniform ivec3 firstPassages;  // of panes, segments, fields
layout(std430, binding = 4) buffer Sums { vec4 sums[]; };  // of goes that share a pixel, target by target
//@each t TARGETS
layout(rgba32f, binding = {t}) uniform image2D spectrum{t};
//@end

const uint kJoined = 1u << 29;
int first_, end_;  // steps of the line
//@each t TARGETS
vec4 behind{t}_;                 // what is seen so far
vec4 through{t}_, added{t}_;     // of the group so far; the second: S A, summed
//@end

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

// One loop: a second within it would run in every turn of the first where a driver has no branches. All targets at once: what a passage has for them lies
// together, and memory is what this waits for.
void walk(int l) {
//@each t TARGETS
  through{t}_ = vec4(1.0);
  added{t}_ = vec4(0.0);
//@end
  bool alone = true;
  for (int s = first_; s < end_; ++s) {
    uint step = stepAt(s);
    int at = passageOf(step, l);
    bool more = (step & kJoined) != 0u;
    alone = alone && !more;
//@each t TARGETS
    {
      vec4 one = at >= 0 ? texelFetch(passages, at + 2 * {t}) : vec4(1.0), own = at >= 0 ? texelFetch(passages, at + 2 * {t} + 1) : vec4(0.0);
      through{t}_ *= one;
      added{t}_ += own / meanOf(one);
      behind{t}_ = more ? behind{t}_ : through{t}_ * behind{t}_ + (alone ? own : added{t}_ * meanOf(through{t}_));
      through{t}_ = more ? through{t}_ : vec4(1.0);
      added{t}_ = more ? added{t}_ : vec4(0.0);
    }
//@end
    alone = !more;
  }
}

void main() {
  if (gl_GlobalInvocationID.x >= uint(count)) return;
  int number = first + int(gl_GlobalInvocationID.x);
  uvec2 go = adding ? uvec2(uint(number), 0u) : uvec2(texelFetch(goes, 2 * number).x, texelFetch(goes, 2 * number + 1).x);
  uint pixel = texelFetch(lines, int(go.x)).x;
  ivec2 at = ivec2(pixel & 0xffffu, pixel >> 16);
  uvec4 of = texelFetch(lineSteps, int(go.x));
  if (adding) {
    if (of.w < 2u) return;
//@each t TARGETS
    behind{t}_ = vec4(0.0);
//@end
    for (uint g = 0u; g < of.w; ++g) {
//@each t TARGETS
      behind{t}_ += sums[(of.z + g) * uint(TARGETS) + {t}u];
//@end
    }
//@each t TARGETS
    imageStore(spectrum{t}, at, behind{t}_);
//@end
    return;
  }
  first_ = int(of.x);
  end_ = first_ + int(of.y);
  int l = go.y == 0xffffffffu ? -1 : int(go.y) - 1, through = linesOf(at);
  float share = go.y == 0xffffffffu ? 1.0 : l < 0 ? leftByLines(through) : shareOfLine(through, l);
//@each t TARGETS
  behind{t}_ = imageLoad(spectrum{t}, at);
//@end
  walk(l);
//@each t TARGETS
  if (of.w < 2u) imageStore(spectrum{t}, at, share * behind{t}_);
  else sums[number * TARGETS + {t}] = share * behind{t}_;
//@end
}
