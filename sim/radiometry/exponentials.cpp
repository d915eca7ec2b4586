#include "sim/radiometry/exponentials.hpp"

namespace pitviper {

PITVIPER_WIDE void exponentials(double* x, int count) { wide::exponential(x, count); }

}  // namespace pitviper
