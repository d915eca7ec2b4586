// The channels' spectral integral over a spectral image (buffered mode): step 6 of Duvenhage 2006 section 4.7 in a pass of its own.
//@constants
layout(std140, binding = 2) uniform WeightBlock { vec4 weight[WEIGHTS]; };
//@slot targets

void main() {
//@slot integrate
}
