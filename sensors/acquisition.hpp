#pragma once
// Detection, recognition and identification of a target by an observer, over its range.
//
// Johnson: N cycles of the highest frequency that is resolved at the target's apparent difference lie across it, N = f(dT tau(R)) h / R, h the root of its
// area;
//   P = (N / N50)^E / (1 + (N / N50)^E), E = 2.7 + 0.7 N / N50.
// Source: J. Johnson, Image Intensifier Symposium (1958); probability: J. A. Ratches, Opt. Eng. 15, 525 (1976); target and cycles: STANAG 4347 (2.3 m x 2.3 m,
// 2 K; 1, 3, 6). TTP: V = sqrt(A) / R integral over frequencies at which C > CTF(f) of sqrt(C / CTF(f)) df (geometric mean of both directions), C / CTF = (pi /
// 4) dT tau(R) / MRTD(f);
//   P = (V / V50)^E / (1 + (V / V50)^E), E = 1.51 + 0.24 V / V50.
// Source: R. H. Vollmerhausen, E. Jacobs, R. G. Driggers, "New metric for predicting target acquisition performance", Opt. Eng. 43, 2806 (2004). V50 as is
// customary for vehicles (2, 7.5, 13). Its integral ends at half a cycle a pixel: what is seen of frequencies beyond is not counted.
#include <array>
#include <functional>

#include "sensors/resolvable.hpp"

namespace pitviper {

struct AcquiredTarget {
  double width_m = 2.3, height_m = 2.3, difference_K = 2.0;
  double area_m2() const { return width_m * height_m; }
};

/// Of an air, mean over the channel's band, from 1 at range 0.
using Transmittance = std::function<double(double range_m)>;

enum class Criterion { Johnson, Ttp };
inline constexpr std::array<const char*, 3> kTasks{"detection", "recognition", "identification"};
/// N50 or V50 of each task.
const std::array<double, 3>& neededFor(Criterion criterion);

/// N or V.
double seenOf(const Resolving& camera, const AcquiredTarget& target, Criterion criterion, double range_m, double transmittance);
/// Of a task that needs so much, with so much.
double probabilityOf(Criterion criterion, double seen, double needed);
/// Where so much is seen; 0: nowhere from 1 m on, infinite: as far as 1000 km.
double rangeOf(const Resolving& camera, const AcquiredTarget& target, Criterion criterion, double needed, const Transmittance& air);

}  // namespace pitviper
