/* Frames of a pitviper stream in shared memory: the layout, and all that a reader needs, in C11 (C++ too). No library: copy this file.
 *
 * One POSIX shared memory object a camera, of the user alone (mode 0600): a header, then `slots` slots of equal size, each a frame's record and its layers. One
 * process writes; any number read, and map it for reading only: nothing that a reader does, dying included, is seen by the writer or by others.
 * All integers and floats are of the machine's own order.
 *
 * The writer, for its k-th frame (k from 0), in slot k % slots:  lock = 2k + 1;  record and layers;  lock = 2k + 2;  published = k + 1;  wake = low 32 bits of
 * that, and a futex wake on it. A reader of frame k: lock must be 2k + 2 before it looks and after (it may use the pixels in place, and asks at the end whether
 * they held). A slot is written again `slots` frames later.
 *
 *   struct pitviper_stream s;
 *   if (pitviper_stream_open(&s, "/pitviper.tracker") != 0) ...            errno says why
 *   const struct pitviper_stream_frame* f;
 *   while ((f = pitviper_stream_next(&s, 1000)) != NULL) {                  1000 ms; NULL: none came, or the stream has ended (s.ended)
 *     const uint16_t* counts = pitviper_stream_pixels(&s, f, 0);            row by row from the top
 *     ...
 *     if (!pitviper_stream_held(&s, f)) ...                                 overwritten meanwhile: too slow
 *   }
 *   pitviper_stream_close(&s);
 */
#ifndef PITVIPER_STREAM_H
#define PITVIPER_STREAM_H

#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PITVIPER_STREAM_MAGIC "pitviper"
#define PITVIPER_STREAM_VERSION 1u
#define PITVIPER_STREAM_LAYERS 16

enum { PITVIPER_UINT16 = 0, PITVIPER_FLOAT32 = 1 };

/* Bits of a frame's `flags`. */
enum {
  PITVIPER_LATE = 1,           /* sent after it was due */
  PITVIPER_REPEATED = 2,       /* the picture before, in place of one that was not ready */
  PITVIPER_OUTSIDE_LIMITS = 4, /* shows what its plan was not made for */
  PITVIPER_SATURATED = 8       /* a layer of counts holds its highest, or a detector's well is full; temperatures and signals to noise are NaN there */
};

struct pitviper_stream_layer {
  char name[64];          /* "mw.counts" */
  char unit[32];          /* of its values: "count", "W/(m2 sr)" */
  char radiance_unit[32]; /* of offset + gain x value; empty: the layer is not told as one */
  uint32_t type;          /* PITVIPER_UINT16 or PITVIPER_FLOAT32 */
  uint32_t maximum;       /* highest value of UINT16 */
  uint64_t offset;        /* of its pixels from the beginning of a slot [byte] */
};

struct pitviper_stream_header {
  char magic[8];
  uint32_t version, header_bytes; /* slot 0 begins at header_bytes */
  uint64_t slot_bytes, total_bytes;
  uint32_t slots, layers, width, height;
  int64_t writer_pid;
  double rate_hz; /* of simulation time */
  char program[32], scenario[128], camera[64];
  struct pitviper_stream_layer layer[PITVIPER_STREAM_LAYERS];
  /* What changes. */
  uint64_t published; /* frames so far */
  uint32_t wake;      /* a futex: low 32 bits of `published`; changes once more where the stream ends */
  uint32_t ended;
};

/* Times: *_tai_ns of the wall clock, TAI since 1970; others simulation time. */
struct pitviper_stream_frame {
  uint64_t lock;
  uint64_t sequence;   /* ticks of the stream from 0: one that is left out was dropped */
  uint64_t host_frame; /* as the host's last command said; 0: none */
  uint64_t flags;
  int64_t time_ns, exposure_start_ns, exposure_end_ns;
  int64_t render_start_tai_ns, render_end_tai_ns, due_tai_ns, sent_tai_ns; /* due: 0 in lockstep */
  int64_t pose_age_ns;             /* of the newest command in it when drawing began; -1: it has none */
  uint64_t dropped, late, repeated; /* so far */
  double accuracy, predicted_error; /* relative: asked of its plan (0: none), and expected of the worst channel */
  double position_ecef_m[3], latitude_deg, longitude_deg, height_m;
  double orientation_ecef_wxyz[4]; /* camera's body axes to ECEF: x is the line of sight, y left, z up */
  double sight_ecef[3];            /* unit vector */
  double truth_column_px, truth_row_px; /* of the middle of what it looks at, from the top left corner; NaN: not in front of it */
  double exposure_s;
  double gain[PITVIPER_STREAM_LAYERS], offset[PITVIPER_STREAM_LAYERS]; /* radiance = offset + gain x value, on the axis */
};

struct pitviper_stream {
  const struct pitviper_stream_header* header;
  uint64_t next; /* frame to be read */
  uint64_t lost; /* frames that were overwritten before they were read */
  int ended;
};

/* 0, or -1 and errno (ENOENT: none, or its writer is no more; EPROTO: of another version, or no stream). Reading begins with the next frame that comes. */
static inline int pitviper_stream_open(struct pitviper_stream* s, const char* name) {
  struct stat status;
  int file;
  void* at;
  const struct pitviper_stream_header* h;
  memset(s, 0, sizeof *s);
  file = shm_open(name, O_RDONLY, 0);
  if (file < 0) return -1;
  if (fstat(file, &status) != 0 || (size_t)status.st_size < sizeof *h) {
    close(file);
    errno = EPROTO;
    return -1;
  }
  at = mmap(NULL, (size_t)status.st_size, PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (at == MAP_FAILED) return -1;
  h = (const struct pitviper_stream_header*)at;
  if (memcmp(h->magic, PITVIPER_STREAM_MAGIC, sizeof h->magic) != 0 || h->version != PITVIPER_STREAM_VERSION || h->total_bytes != (uint64_t)status.st_size ||
      h->slots == 0 || h->layers > PITVIPER_STREAM_LAYERS || h->header_bytes + h->slots * h->slot_bytes > h->total_bytes) {
    munmap(at, (size_t)status.st_size);
    errno = EPROTO;
    return -1;
  }
  if (h->ended || (kill((pid_t)h->writer_pid, 0) != 0 && errno == ESRCH)) {
    munmap(at, (size_t)status.st_size);
    errno = ENOENT;
    return -1;
  }
  s->header = h;
  s->next = __atomic_load_n(&h->published, __ATOMIC_ACQUIRE);
  return 0;
}

static inline void pitviper_stream_close(struct pitviper_stream* s) {
  if (s->header) munmap((void*)(uintptr_t)s->header, (size_t)s->header->total_bytes);
  s->header = NULL;
}

static inline const struct pitviper_stream_frame* pitviper_stream_slot(const struct pitviper_stream* s, uint64_t k) {
  return (const struct pitviper_stream_frame*)(const void*)((const char*)s->header + s->header->header_bytes + k % s->header->slots * s->header->slot_bytes);
}

/* The next frame, in its place; NULL where none comes within the time (below 0: for ever), or s->ended. Frames that it was too slow for are counted as lost. */
static inline const struct pitviper_stream_frame* pitviper_stream_next(struct pitviper_stream* s, int timeout_ms) {
  struct timespec now, left;
  int64_t until = 0, t;
  unsigned slices = 0;
  clock_gettime(CLOCK_MONOTONIC, &now);
  until = (int64_t)now.tv_sec * 1000000000 + now.tv_nsec + (int64_t)timeout_ms * 1000000;
  for (;;) {
    const uint32_t wake = __atomic_load_n(&s->header->wake, __ATOMIC_ACQUIRE);
    /* Before `published`: a last frame is not missed. */
    const uint32_t ended = __atomic_load_n(&s->header->ended, __ATOMIC_ACQUIRE);
    const uint64_t published = __atomic_load_n(&s->header->published, __ATOMIC_ACQUIRE);
    while (s->next < published) {
      /* The slot that is written next is not safe to begin with. */
      const uint64_t oldest = published >= s->header->slots ? published - s->header->slots + 1 : 0;
      const struct pitviper_stream_frame* f;
      if (s->next < oldest) s->lost += oldest - s->next, s->next = oldest;
      f = pitviper_stream_slot(s, s->next);
      if (__atomic_load_n(&f->lock, __ATOMIC_ACQUIRE) == 2 * s->next + 2) return ++s->next, f;
      s->lost += 1, s->next += 1;
    }
    /* A writer that was killed cannot say so: who waits looks for it once a second. */
    if (ended || (slices > 1 && kill((pid_t)s->header->writer_pid, 0) != 0 && errno == ESRCH)) return s->ended = 1, (const struct pitviper_stream_frame*)NULL;
    clock_gettime(CLOCK_MONOTONIC, &now);
    t = until - ((int64_t)now.tv_sec * 1000000000 + now.tv_nsec);
    if (timeout_ms >= 0 && t <= 0) return NULL;
    if (timeout_ms < 0 || t > 1000000000) t = 1000000000;
    ++slices;
    left.tv_sec = (time_t)(t / 1000000000), left.tv_nsec = (long)(t % 1000000000);
    syscall(SYS_futex, &s->header->wake, FUTEX_WAIT, wake, &left, NULL, 0);
  }
}

/* Row by row from the top: uint16_t or float, as the layer's type says. */
static inline const void* pitviper_stream_pixels(const struct pitviper_stream* s, const struct pitviper_stream_frame* f, unsigned layer) {
  return (const char*)(const void*)f + s->header->layer[layer].offset;
}

/* Whether the frame that next() gave is still the one it was. */
static inline int pitviper_stream_held(const struct pitviper_stream* s, const struct pitviper_stream_frame* f) {
  (void)s;
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return __atomic_load_n(&f->lock, __ATOMIC_RELAXED) == 2 * s->next;
}

#ifdef __cplusplus
}
#endif
#endif
