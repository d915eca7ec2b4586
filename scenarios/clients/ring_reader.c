/* Prints what comes through a pitviper stream's shared memory, and how long it was on its way.
 *
 *   cc -O2 -I sim/stream/ring scenarios/clients/ring_reader.c -o ring_reader
 *   pitviper stream scenarios/jet_and_sky.yaml --endless &
 *   ./ring_reader /pitviper
 */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>

#include "pitviper_stream.h"

static int later(const void* a, const void* b) {
  const int64_t x = *(const int64_t*)a, y = *(const int64_t*)b;
  return (x > y) - (x < y);
}

int main(int count, char** words) {
  const char* name = count > 1 ? words[1] : "/pitviper";
  enum { KEPT = 100000 };
  static int64_t ages[KEPT];
  int64_t tai_minus_utc = 0, age;
  uint64_t frames = 0, torn = 0;
  struct pitviper_stream stream;
  const struct pitviper_stream_frame* frame;
  struct timespec now;
  if (pitviper_stream_open(&stream, name) != 0) {
    fprintf(stderr, "%s: %s: is 'pitviper stream' running?\n", name, strerror(errno));
    return 1;
  }
  printf("%s, camera %s, %u x %u pixels, %u layers, first %s [%s]\n", stream.header->scenario, stream.header->camera, stream.header->width, stream.header->height,
         stream.header->layers, stream.header->layer[0].name, stream.header->layer[0].unit);
  while ((frame = pitviper_stream_next(&stream, 5000)) != NULL) {
    clock_gettime(CLOCK_TAI, &now);
    age = (int64_t)now.tv_sec * 1000000000 + now.tv_nsec - frame->sent_tai_ns;
    /* Where the system does not know its leap seconds pitviper adds them: 37. */
    if (frames == 0 && age < -10000000000) tai_minus_utc = 37000000000;
    age += tai_minus_utc;
    if (frames < KEPT) ages[frames] = age;
    ++frames;
    if (!pitviper_stream_held(&stream, frame)) ++torn;
  }
  printf("%llu frames, %llu lost, %llu overwritten while they were read\n", (unsigned long long)frames, (unsigned long long)stream.lost, (unsigned long long)torn);
  if (frames > 0) {
    const uint64_t kept = frames < KEPT ? frames : KEPT;
    qsort(ages, kept, sizeof *ages, later);
    printf("sent to here: median %.3f ms, largest %.3f ms\n", 1e-6 * (double)ages[kept / 2], 1e-6 * (double)ages[kept - 1]);
  }
  pitviper_stream_close(&stream);
  return 0;
}
