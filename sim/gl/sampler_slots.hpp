#pragma once
// What a program finds in the slots of its samplers that read buffers. Mesa leaves there what the program before had (update_shader_samplers() of
// st_atom_sampler.c), and llvmpipe compiles a program again for each combination of those: the first picture's would be another than the second's.

namespace pitviper {

/// Of textures read by texelFetch only: nearest, no mip levels. All of a context's are alike, or slots differ by what was drawn before.
void setNearest(unsigned texture);

/// Draws once with such a texture in all slots of the current context.
void fillSamplerSlots();

}  // namespace pitviper
