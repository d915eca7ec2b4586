// Puts what a line meets in order, near to far, and cuts the line where something begins or ends. It leaves steps, far to near: panes, segments in media, slabs
// of fields. Where a field lies in something else an interval is cut into pieces, and what is in one of them is one group.
layout(local_size_x = 64) in;
//@use sim/render/assembly/glsl/view_block.glsl
//@use sim/render/assembly/glsl/draws.glsl
//@use sim/render/geometry/glsl/hit_kinds.glsl
//@use sim/render/media/glsl/field_lines.glsl
layout(binding = 17) uniform usamplerBuffer heads;
layout(binding = 18) uniform usamplerBuffer hits;
layout(binding = 19) uniform usamplerBuffer lines;
layout(std430, binding = 3) writeonly buffer FieldEntries { uvec4 fieldEntries[]; };  // pixel, which of its lines, passage of the farthest slab, its words
// 1 + next hit; 1 + next that the line is in; of a field: passage of its farthest slab; its words
layout(std430, binding = 6) buffer Links { uvec4 links[]; };
layout(std430, binding = 8) buffer Totals { uint totals[]; };   // as numbered below; from kTotals on of each field entries, and where these begin
layout(std430, binding = 9) buffer Events { uvec4 events[]; };  // 2 (1 + hit), + 1: it ends there; its place
layout(std430, binding = 10) writeonly buffer LineSteps { uvec4 lineSteps[]; };  // first, number; first go, number
// kind << 30, 1 << 29: of one group with the next; number in its list, or a field's passage
layout(std430, binding = 11) writeonly buffer Steps { uint steps[]; };
layout(std430, binding = 12) writeonly buffer Panes { uvec4 panes[]; };        // pixel, draw, triangle
layout(std430, binding = 13) writeonly buffer Segments { uvec4 segments[]; };  // pixel, its words; depth of its near end, its length
layout(std430, binding = 14) buffer Words { uint words[]; };  // of a segment: number of media, their rows; of a field on a line: number of slabs, near ends
layout(std430, binding = 15) writeonly buffer Goes { uvec2 goes[]; };  // line; of a field's lines which, 0: beside them, all ones: the pixel as one
uniform int filmWidth;
uniform int firstLine;
uniform int lineCount;
uniform int firstField;  // draw of the first
uniform ivec4 room;      // events, steps, panes or segments, words
const int kEvents = 0, kSteps = 1, kPanes = 2, kSegments = 3, kWords = 4, kFieldPassages = 5, kGoes = 6;
const int kMostEvents = 7, kMostSteps = 8, kMostWords = 9, kTotals = 10;  // of a line
const int kPieces = 16;
const uint kCamera = 0xffffffffu;

// Depth of a place as (what its plane has, what that lost by rounding, t from there): differences keep their digits.
vec3 placeOf(uint draw, float t) { return vec3(drawMember(draw, 2).w, drawMember(draw, 5).x, t); }
float apart(vec3 a, vec3 b) { return (a.z - b.z) + ((b.x - a.x) + (b.y - a.y)); }
float depthOf(vec3 place) { return (place.z - place.x) - place.y; }

uvec4 hitAt(uint number) { return texelFetch(hits, int(number) - 1); }
uint kindOf(uvec4 hit) { return hit.x >> 30; }
uint drawOf(uvec4 hit) { return hit.x & 0x3fffffffu; }
vec3 placeAt(uint event) { return uintBitsToFloat(events[event].yzw); }

uint first_, events_;  // of the line
uint inside_;          // 1 + the last hit that the line is in; meshed media stay, with how often they were entered

// Whether an event stands after another; in doubt by what it is of, so that the order is the same in every run.
bool isAfter(uvec4 a, uvec4 b) {
  float d = apart(uintBitsToFloat(a.yzw), uintBitsToFloat(b.yzw));
  if (d != 0.0 || a.x == kCamera || b.x == kCamera) return d > 0.0 || (d == 0.0 && b.x == kCamera);
  uvec4 p = hitAt(a.x >> 1), q = hitAt(b.x >> 1);
  if (p.x != q.x) return p.x > q.x;
  return kindOf(p) == kBorder && p.z != q.z ? p.z > q.z : kindOf(p) == kPane ? p.w > q.w : a.x > b.x;
}

void addEvent(uvec4 event) { events[first_ + events_++] = event; }

// Shell's method with Knuth's gaps: a line with many events takes few rounds, one with two a single comparison.
void sortEvents() {
  uint gap = 1u;
  while (3u * gap + 1u < events_) gap = 3u * gap + 1u;
  for (; gap > 0u; gap /= 3u)
    for (uint e = gap; e < events_; ++e) {
      uvec4 event = events[first_ + e];
      uint at = e;
      for (; at >= gap && isAfter(events[first_ + at - gap], event); at -= gap) events[first_ + at] = events[first_ + at - gap];
      events[first_ + at] = event;
    }
}

// A meshed medium that the line has met, by one of its hits; 0: none.
uint meshOf(uint draw) {
  uint h = inside_;
  for (; h != 0u; h = links[h - 1u].y) {
    uvec4 hit = hitAt(h);
    if (kindOf(hit) == kBorder && drawOf(hit) == draw) break;
  }
  return h;
}

// Who leaves more often than enters has the camera inside.
void beginInside(uint head) {
  inside_ = 0u;
  for (uint h = head; h != 0u; h = links[h - 1u].x) {
    uvec4 hit = hitAt(h);
    if (kindOf(hit) != kBorder) continue;
    uint mesh = meshOf(drawOf(hit));
    if (mesh == 0u) {
      mesh = h;
      links[h - 1u].yw = uvec2(inside_, 0u);
      inside_ = h;
    }
    links[mesh - 1u].w += hit.z != 0u ? 1u : 0xffffffffu;
  }
  for (uint h = inside_; h != 0u; h = links[h - 1u].y) links[h - 1u].w = uint(max(int(links[h - 1u].w), 0));
}

void pass(uvec4 event) {
  if (event.x == kCamera) return;
  uint h = event.x >> 1;
  uvec4 hit = hitAt(h);
  if (kindOf(hit) == kPane) return;
  if (kindOf(hit) == kBorder) {
    links[meshOf(drawOf(hit)) - 1u].w += hit.z != 0u ? 0xffffffffu : 1u;
  } else if ((event.x & 1u) == 0u) {
    links[h - 1u].y = inside_;
    inside_ = h;
  } else if (inside_ == h) {
    inside_ = links[h - 1u].y;
  } else {
    uint before = inside_;
    while (links[before - 1u].y != h) before = links[before - 1u].y;
    links[before - 1u].y = links[h - 1u].y;
  }
}

// How often the line is in what a hit is of, where that is a medium: a mesh may enclose a place twice.
uint mediaOf(uint h, uvec4 hit) { return kindOf(hit) == kMedium ? 1u : kindOf(hit) == kBorder ? uint(max(int(links[h - 1u].w), 0)) : 0u; }

void main() {
  if (gl_GlobalInvocationID.x >= uint(lineCount)) return;
  uint line = uint(firstLine) + gl_GlobalInvocationID.x, pixel = texelFetch(lines, int(line)).x;
  ivec2 at = ivec2(pixel & 0xffffu, pixel >> 16);
  uint head = texelFetch(heads, at.y * filmWidth + at.x).x;
  int lineOf = linesOf(at), through = countOfLines(lineOf);
  uint number = 0u, mesh = 0u;
  for (uint h = head; h != 0u; h = links[h - 1u].x) {
    uvec4 hit = hitAt(h);
    number += kindOf(hit) == kMedium || kindOf(hit) == kField ? 2u : 1u;
    if (kindOf(hit) == kBorder) mesh = h;
  }
  if (mesh != 0u) ++number;
  first_ = atomicAdd(totals[kEvents], number);
  if (first_ + number > uint(room.x)) return;
  events_ = 0u;
  if (mesh != 0u) {
    vec3 camera = placeOf(drawOf(hitAt(mesh)), 0.0);
    camera.z = camera.x + camera.y;
    addEvent(uvec4(kCamera, floatBitsToUint(camera)));
  }
  for (uint h = head; h != 0u; h = links[h - 1u].x) {
    uvec4 hit = hitAt(h);
    addEvent(uvec4(2u * h, floatBitsToUint(placeOf(drawOf(hit), uintBitsToFloat(hit.y)))));
    if (kindOf(hit) == kMedium || kindOf(hit) == kField) addEvent(uvec4(2u * h + 1u, floatBitsToUint(placeOf(drawOf(hit), uintBitsToFloat(hit.z)))));
    if (kindOf(hit) == kField) links[h - 1u].w = 0u;
  }
  sortEvents();
  atomicMax(totals[kMostEvents], number);

  // How much there is.
  uint stepCount = 0u, paneCount = 0u, segmentCount = 0u, wordCount = 0u;
  beginInside(head);
  for (uint e = first_; e < first_ + number; ++e) {
    uvec4 event = events[e];
    pass(event);
    if (event.x != kCamera && kindOf(hitAt(event.x >> 1)) == kPane) ++paneCount;
    if (e + 1u == first_ + number || !(apart(placeAt(e + 1u), placeAt(e)) > 0.0)) continue;
    uint media = 0u, fields = 0u;
    for (uint h = inside_; h != 0u; h = links[h - 1u].y) {
      uvec4 hit = hitAt(h);
      media += mediaOf(h, hit);
      if (kindOf(hit) == kField) ++fields;
    }
    uint pieces = fields > 0u && media + fields > 1u ? uint(kPieces) : 1u;
    if (media > 0u) {
      segmentCount += pieces;
      wordCount += 1u + media;
    }
    stepCount += pieces * (fields + (media > 0u ? 1u : 0u));
    for (uint h = inside_; h != 0u; h = links[h - 1u].y)
      if (kindOf(hitAt(h)) == kField) links[h - 1u].w += pieces;
  }
  stepCount += paneCount;
  uint step = atomicAdd(totals[kSteps], stepCount) + stepCount, pane = paneCount > 0u ? atomicAdd(totals[kPanes], paneCount) : 0u,
       segment = segmentCount > 0u ? atomicAdd(totals[kSegments], segmentCount) : 0u;
  for (uint h = head; h != 0u; h = links[h - 1u].x)
    if (kindOf(hitAt(h)) == kField) wordCount += 1u + links[h - 1u].w;
  uint word = wordCount > 0u ? atomicAdd(totals[kWords], wordCount) : 0u;
  bool fields = false;
  for (uint h = head; h != 0u; h = links[h - 1u].x) fields = fields || (kindOf(hitAt(h)) == kField && links[h - 1u].w > 0u);
  uint beside = fields && leftByLines(lineOf) > 0.0 ? 1u : 0u, goCount = fields ? uint(through) + beside : 1u, go = atomicAdd(totals[kGoes], goCount);
  lineSteps[line] = uvec4(step - stepCount, stepCount, go, goCount);
  for (uint g = 0u; g < goCount; ++g) goes[go + g] = uvec2(line, fields ? g + 1u - beside : 0xffffffffu);
  atomicMax(totals[kMostSteps], stepCount);
  atomicMax(totals[kMostWords], wordCount);
  bool fits = step <= uint(room.y) && pane + paneCount <= uint(room.z) && segment + segmentCount <= uint(room.z) && word + wordCount <= uint(room.w);
  for (uint h = head; h != 0u; h = links[h - 1u].x) {
    uvec4 hit = hitAt(h);
    if (kindOf(hit) != kField || links[h - 1u].w == 0u) continue;
    uint slabs = links[h - 1u].w, passage = atomicAdd(totals[kFieldPassages], slabs * uint(through)), field = drawOf(hit) - uint(firstField),
         entry = atomicAdd(totals[kTotals + 2 * int(field)], uint(through)) + totals[kTotals + 2 * int(field) + 1];
    for (int l = 0; l < through; ++l) fieldEntries[entry + uint(l)] = uvec4(pixel, uint(l), passage + uint(l), word);
    links[h - 1u].zw = uvec2(passage, word);
    if (fits) {
      words[word] = slabs;
      words[word + slabs] = 0u;  // slabs told so far, from the near end on
    }
    word += 1u + slabs;
  }
  if (!fits) return;

  beginInside(head);
  for (uint e = first_; e < first_ + number; ++e) {
    uvec4 event = events[e];
    pass(event);
    if (event.x != kCamera) {
      uvec4 hit = hitAt(event.x >> 1);
      if (kindOf(hit) == kPane) {
        panes[pane] = uvec4(pixel, drawOf(hit), hit.w, 0u);
        steps[--step] = pane++;
      }
    }
    if (e + 1u == first_ + number) break;
    vec3 near = placeAt(e);
    float length = apart(placeAt(e + 1u), near);
    if (!(length > 0.0)) continue;
    uint media = 0u, fields = 0u;
    for (uint h = inside_; h != 0u; h = links[h - 1u].y) {
      uvec4 hit = hitAt(h);
      for (uint n = mediaOf(h, hit); n > 0u; --n) words[word + ++media] = drawTexel(drawOf(hit), 3).x;
      if (kindOf(hit) == kField) ++fields;
    }
    uint pieces = fields > 0u && media + fields > 1u ? uint(kPieces) : 1u;
    for (uint k = 0u; k < pieces; ++k) {
      float each = length / float(pieces), from = float(k) * each;
      uint join = 0u;
      if (media > 0u) {
        segments[segment] = uvec4(pixel, word, floatBitsToUint(depthOf(near) + from), floatBitsToUint(each));
        steps[--step] = 1u << 30 | segment++;
        join = 1u << 29;
      }
      for (uint h = inside_; h != 0u; h = links[h - 1u].y) {
        uvec4 hit = hitAt(h);
        if (kindOf(hit) != kField) continue;
        uvec2 own = links[h - 1u].zw;
        uint slabs = words[own.y], told = words[own.y + slabs], slab = slabs - 1u - told;
        words[own.y + slabs] = told + 1u;
        if (slab + 1u < slabs) {
          vec3 plane = placeOf(drawOf(hit), 0.0);
          words[own.y + 1u + slab] = floatBitsToUint(-apart(plane, near) + from);
        }
        steps[--step] = 2u << 30 | join | (own.x + slab * uint(through));
        join = 1u << 29;
      }
    }
    if (media > 0u) {
      words[word] = media;
      word += 1u + media;
    }
  }
}
