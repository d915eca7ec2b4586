#include "sensors/noise_components.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {

double NoiseCube::mean() const {
  double sum = 0.0;
  for (const auto& f : frames_)
    for (float v : f) sum += static_cast<double>(v);
  return sum / static_cast<double>(frames_.size() * width_ * height_);
}

double NoiseCube::temporal() const {
  double all = 0.0;
  const double n = static_cast<double>(frames_.size());
  for (std::size_t p = 0; p < width_ * height_; ++p) {
    double sum = 0.0, off = 0.0;
    for (const auto& f : frames_) sum += static_cast<double>(f[p]);
    for (const auto& f : frames_) off += (static_cast<double>(f[p]) - sum / n) * (static_cast<double>(f[p]) - sum / n);
    all += off / (n - 1.0);
  }
  return std::sqrt(all / static_cast<double>(width_ * height_));
}

std::array<NoiseComponent, 7> NoiseCube::components() const {
  const std::size_t T = frames_.size(), V = height_, H = width_;
  const double t = static_cast<double>(T), v = static_cast<double>(V), h = static_cast<double>(H), whole = mean();
  // Means of what is left of the three directions.
  std::vector<double> ofT(T, 0.0), ofV(V, 0.0), ofH(H, 0.0), ofTV(T * V, 0.0), ofTH(T * H, 0.0), ofVH(V * H, 0.0);
  for (std::size_t i = 0; i < T; ++i)
    for (std::size_t y = 0; y < V; ++y)
      for (std::size_t x = 0; x < H; ++x) {
        const double value = static_cast<double>(frames_[i][y * H + x]) - whole;
        ofT[i] += value / (v * h), ofV[y] += value / (t * h), ofH[x] += value / (t * v);
        ofTV[i * V + y] += value / h, ofTH[i * H + x] += value / v, ofVH[y * H + x] += value / t;
      }
  // Mean squares of what each leaves beyond those before it, by degrees of freedom (analysis of variance, three ways without repeats).
  double st = 0.0, sv = 0.0, sh = 0.0, stv = 0.0, sth = 0.0, svh = 0.0, stvh = 0.0;
  const auto square = [](double x) { return x * x; };
  for (double x : ofT) st += square(x);
  for (double x : ofV) sv += square(x);
  for (double x : ofH) sh += square(x);
  for (std::size_t i = 0; i < T; ++i)
    for (std::size_t y = 0; y < V; ++y) stv += square(ofTV[i * V + y] - ofT[i] - ofV[y]);
  for (std::size_t i = 0; i < T; ++i)
    for (std::size_t x = 0; x < H; ++x) sth += square(ofTH[i * H + x] - ofT[i] - ofH[x]);
  for (std::size_t y = 0; y < V; ++y)
    for (std::size_t x = 0; x < H; ++x) svh += square(ofVH[y * H + x] - ofV[y] - ofH[x]);
  for (std::size_t i = 0; i < T; ++i)
    for (std::size_t y = 0; y < V; ++y)
      for (std::size_t x = 0; x < H; ++x)
        stvh += square(static_cast<double>(frames_[i][y * H + x]) - whole - ofTV[i * V + y] - ofTH[i * H + x] - ofVH[y * H + x] + ofT[i] + ofV[y] + ofH[x]);
  const double dt = t - 1.0, dv = v - 1.0, dh = h - 1.0;
  const double mt = st * v * h / dt, mv = sv * t * h / dv, mh = sh * t * v / dh, mtv = stv * h / (dt * dv), mth = sth * v / (dt * dh),
               mvh = svh * t / (dv * dh), mtvh = stvh / (dt * dv * dh);
  // Of independent mean squares a difference has the sum of their variances, 2 m^2 / degrees.
  const auto of = [&](double variance, double scale, std::initializer_list<std::pair<double, double>> parts) {
    double error = 0.0;
    for (const auto& [m, degrees] : parts) error += 2.0 * m * m / degrees;
    const double sigma = std::sqrt(std::max(variance, 0.0)), ofVariance = std::sqrt(error) / scale;
    return NoiseComponent{sigma, sigma * sigma > ofVariance ? ofVariance / (2.0 * sigma) : std::sqrt(ofVariance)};
  };
  const double atv = dt * dv, ath = dt * dh, avh = dv * dh, all = dt * dv * dh;
  return {of((mt - mtv - mth + mtvh) / (v * h), v * h, {{mt, dt}, {mtv, atv}, {mth, ath}, {mtvh, all}}),
          of((mv - mtv - mvh + mtvh) / (t * h), t * h, {{mv, dv}, {mtv, atv}, {mvh, avh}, {mtvh, all}}),
          of((mh - mth - mvh + mtvh) / (t * v), t * v, {{mh, dh}, {mth, ath}, {mvh, avh}, {mtvh, all}}),
          of((mtv - mtvh) / h, h, {{mtv, atv}, {mtvh, all}}),
          of((mth - mtvh) / v, v, {{mth, ath}, {mtvh, all}}),
          of((mvh - mtvh) / t, t, {{mvh, avh}, {mtvh, all}}),
          of(mtvh, 1.0, {{mtvh, all}})};
}

}  // namespace pitviper
