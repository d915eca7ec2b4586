// The entry of a list that a fragment works out, and what it leaves there: of each four nodes the transmittance of a thing that is seen through and what it
// adds to what lies behind it, L <- through L + own.
flat in ivec2 batch;  // first entry, entries
layout(rgba32f, binding = 0) writeonly uniform imageBuffer passages;
uniform int firstPassage;  // of the list

int listedEntry() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 15;
  return batch.x + min(((p.y & 12) + (p.x >> 2)) * 16 + (p.y & 3) * 4 + (p.x & 3), batch.y - 1);
}
void storePassage(int passage, int four, vec4 through, vec4 own) {
  int at = 2 * (TARGETS * (firstPassage + passage) + four);
  imageStore(passages, at, through);
  imageStore(passages, at + 1, own);
}
