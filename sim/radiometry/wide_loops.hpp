#pragma once
// Loops over many numbers, compiled for processors with wider registers (AVX2) as well and chosen when the program is loaded. Products and sums are not fused
// in either, so that both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define PITVIPER_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PITVIPER_WIDE
#endif
