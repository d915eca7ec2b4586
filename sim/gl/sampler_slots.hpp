#pragma once
// What a program finds in the slots of its samplers that read buffers. Mesa leaves there what the program before had (update_shader_samplers() of
// st_atom_sampler.c), and llvmpipe compiles a program again for each combination of those: the first picture's would be another than the second's.

namespace pitviper {

/// Of textures read by texelFetch only: nearest, no mip levels.
void setNearest(unsigned texture);

/// Binds one sampler to all units of the current context, for what is read by texelFetch only, and draws once with it in all slots. It is of the nearest level,
/// as Mesa has it for textures of whole numbers whatever is asked for (st_convert_sampler()): all must be alike.
void fillSamplerSlots();

}  // namespace pitviper
