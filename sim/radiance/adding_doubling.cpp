#include "sim/radiance/adding_doubling.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

/// Thinner layers send what they emit straight out: by then differences of what comes in and goes out have lost their digits.
constexpr double kNoDepth = 1e-6;
/// Optical depth of a layer to the sun, where none of its light gets through: of whatever lies in the earth's shadow.
constexpr double kFarthest = 1e9;
/// What an azimuth term may be of the mean and count as nothing.
constexpr double kFaint = 1e-5;
/// Doublings of a layer; one of 1e6 takes 36.
constexpr int kMostDoublings = 64;

/// A layer with its forward peak taken off.
struct Scaled {
  double depth, albedo;
  std::vector<double> moments;
  double albedoTimes(int l) const { return l < static_cast<int>(moments.size()) ? albedo * moments[static_cast<std::size_t>(l)] : 0.0; }
};

Scaled scaled(const PlaneLayer& layer, int streams) {
  const auto n = static_cast<std::size_t>(streams);
  const double peak = layer.moments.size() > n ? layer.moments[n] : 0.0;
  Scaled s{layer.depth * (1.0 - layer.albedo * peak), 0.0, {}};
  const double left = 1.0 - layer.albedo * peak;
  s.albedo = left > 0.0 ? layer.albedo * (1.0 - peak) / left : 0.0;
  for (std::size_t l = 0; l < std::min(n, layer.moments.size()); ++l) s.moments.push_back(peak < 1.0 ? (layer.moments[l] - peak) / (1.0 - peak) : 0.0);
  return s;
}

/// Sunlight with its forward peak, by edge.
struct Beam {
  std::vector<double> depth;  ///< to the sun; at most kFarthest
  std::vector<double> at;     ///< irradiance on a plane that faces it
};

/// Directions of most light there is: known to the compiler.
constexpr int kUsual = 4;
/// Room for so many without asking for memory; more are rare, and slow.
constexpr int kFew = 12;

/// Products and inverses of small matrices, in loops whose length is known. Those inverted here are 1 - R R and the like of light that is sent to and fro, or 1
/// and something positive: their diagonal leads, and no pivot needs to be looked for.
template <int n>
void multiply(const double* a, const double* b, double* out) {
  for (int j = 0; j < n; ++j) {
    double sum[n] = {};
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < n; ++i) sum[i] += a[k * n + i] * b[j * n + k];
    for (int i = 0; i < n; ++i) out[j * n + i] = sum[i];
  }
}
/// Gauss and Jordan's way, in place.
template <int n>
void invert(double* a) {
  for (int k = 0; k < n; ++k) {
    const double pivot = 1.0 / a[k * n + k];
    a[k * n + k] = 1.0;
    for (int i = 0; i < n; ++i) a[k * n + i] *= pivot;
    for (int j = 0; j < n; ++j) {
      if (j == k) continue;
      const double factor = a[j * n + k];
      a[j * n + k] = 0.0;
      for (int i = 0; i < n; ++i) a[j * n + i] -= factor * a[k * n + i];
    }
  }
}
template <class Square>
Square times(const Square& a, const Square& b) {
  Square out(a.rows(), a.cols());
  if constexpr (Square::RowsAtCompileTime == kUsual) {
    out.noalias() = a * b;
    return out;
  }
  switch (a.rows()) {
    case 6:
      multiply<6>(a.data(), b.data(), out.data());
      break;
    case 8:
      multiply<8>(a.data(), b.data(), out.data());
      break;
    case 12:
      multiply<12>(a.data(), b.data(), out.data());
      break;
    default:
      out.noalias() = a.lazyProduct(b);
  }
  return out;
}
template <class Square>
Square inverseOf(Square of) {
  if constexpr (Square::RowsAtCompileTime == kUsual) return of.inverse();
  switch (of.rows()) {
    case 6:
      invert<6>(of.data());
      break;
    case 8:
      invert<8>(of.data());
      break;
    case 12:
      invert<12>(of.data());
      break;
    default:
      return Eigen::MatrixXd(of).partialPivLu().inverse();
  }
  return of;
}

/// One azimuth term of all layers. Count, Most: of directions, or Eigen::Dynamic.
template <int Count, int Most>
class Mode {
 public:
  using Square = Eigen::Matrix<double, Count, Count, 0, Most, Most>;
  using Column = Eigen::Matrix<double, Count, 1, 0, Most, 1>;
  using Row = Eigen::Matrix<double, 1, Count, Eigen::RowMajor, 1, Most>;
  using Pair = Eigen::Matrix<double, Count, 2, 0, Most, 2>;  ///< of the sun, thermal

  Mode(const PlaneLayers& layers, const std::vector<Scaled>& scaled, const Beam& beam, int m, const Streams& streams, std::span<const double> sines,
       std::span<const double> weights)
      : all_(layers), scaled_(scaled), beam_(beam), m_(m), streams_(streams.all), thin_(streams.thin), count_(static_cast<Eigen::Index>(sines.size())) {
    sine_ = Eigen::Map<const Eigen::VectorXd>(sines.data(), count_);
    weight_ = Eigen::Map<const Eigen::VectorXd>(weights.data(), count_);
    lambda_.resize(count_, streams_ - m);
    std::vector<double> row(static_cast<std::size_t>(streams_ - m));
    for (Eigen::Index i = 0; i < count_; ++i) {
      legendreTerms(sines[static_cast<std::size_t>(i)], m, streams_, row.data());
      for (int l = m; l < streams_; ++l) lambda_(i, l - m) = row[static_cast<std::size_t>(l - m)];
    }
    sun_.resize(static_cast<std::size_t>(streams_ - m));
    legendreTerms(-layers.sunSine, m, streams_, sun_.data());
  }

  void run(LayerLight& out) {
    const std::size_t edges = all_.layers.size() + 1;
    own_.resize(edges - 1), between_.resize(edges - 1), below_.resize(edges), fromBelow_.resize(edges);
    ground();
    for (std::size_t k = edges - 1; k-- > 0;) {
      own_[k] = layer(k);
      const Layer& l = own_[k];
      // What goes down at its lower edge, of what comes in from above and of what is sent on the way.
      between_[k] = inverseOf<Square>(one() - times(l.back, below_[k + 1]));
      const Square up = times<Square>(times(l.through, below_[k + 1]), between_[k]);
      below_[k] = l.back + times(up, l.through);
      fromBelow_[k] = l.up + l.through * fromBelow_[k + 1] + up * (l.back * fromBelow_[k + 1] + l.down);
    }
    Pair down = Pair::Zero(count_, 2);
    if (m_ == 0) down.col(1).setConstant(all_.spaceRadiance);
    for (std::size_t k = 0; k < edges; ++k) {
      const Pair up = below_[k] * down + fromBelow_[k];
      put(k, up, down, out);
      if (k + 1 == edges) break;
      const Layer& l = own_[k];
      const Pair next = between_[k] * (l.through * down + l.back * fromBelow_[k + 1] + l.down);
      down = next;
    }
  }

 private:
  /// A layer alone: what it sends back and lets through of what comes in, and what leaves it at its upper and lower edge besides.
  struct Layer {
    Square back, through;
    Pair up, down;
  };
  Square one() const { return Square::Identity(count_, count_); }

  void ground() {
    Square& g = below_.back();
    g = Square::Zero(count_, count_);
    fromBelow_.back() = Pair::Zero(count_, 2);
    if (m_ != 0) return;
    g.rowwise() = (2.0 * all_.groundAlbedo * sine_.cwiseProduct(weight_)).transpose();
    fromBelow_.back().col(0).setConstant(all_.groundAlbedo / kPi * std::max(all_.sunSine, 0.0) * beam_.at.back());
    fromBelow_.back().col(1).setConstant(all_.groundEmission);
  }

  Layer layer(std::size_t k) const {
    const Scaled& s = scaled_[k];
    const PlaneLayer& given = all_.layers[k];
    Layer out;
    const double first = beam_.at[k], fall = std::min(beam_.depth[k + 1] - beam_.depth[k], kFarthest);
    int doublings = 0;
    if (s.albedo > 0.0 && s.depth > 0.0) {
      const double thin = thin_ * sine_.minCoeff();
      doublings = std::clamp(static_cast<int>(std::ceil(std::log2(s.depth / thin))), 0, kMostDoublings);
      const double thinnest = s.depth * std::exp2(-doublings);
      thinLayer(s, thinnest, first, fall * std::exp2(-doublings), out);
      // Of what comes in from each direction, by sine and weight: what stays in the layer.
      Row absorbed = 0.5 * thinnest * (1.0 - s.albedo) * weight_.transpose() * (one() + out.back + out.through);
      double fallen = fall * std::exp2(-doublings);
      for (int d = 0; d < doublings; ++d, fallen *= 2.0) {
        const Square inside = inverseOf<Square>(one() - times(out.back, out.back)), on = times(out.through, inside);
        const double left = std::exp(-fallen);
        const Column up = out.up.col(0) + on * (left * out.up.col(0) + out.back * out.down.col(0)),
                     down = left * out.down.col(0) + on * (out.down.col(0) + left * (out.back * out.up.col(0)));
        out.up.col(0) = up, out.down.col(0) = down;
        if (m_ == 0) {
          const Row more = absorbed + absorbed * out.back, between = more * inside;
          absorbed += between * out.through;
        }
        const Square back = out.back + times<Square>(on, times(out.back, out.through));
        out.through = times(on, out.through), out.back = back;
        if (m_ == 0) balance(absorbed, out);
      }
    } else {
      out.back = Square::Zero(count_, count_);
      out.through = (-s.depth * sine_.cwiseInverse()).array().exp().matrix().asDiagonal();
      out.up = out.down = Pair::Zero(count_, 2);
    }
    out.up.col(1).setZero(), out.down.col(1).setZero();
    if (m_ == 0) emitted(s, given.blackAbove, given.blackBelow, out);
    return out;
  }

  /// What is sent back, let through and absorbed adds up to what comes in: else rounding would, doubled forty times, be as matter that shines.
  void balance(const Row& absorbed, Layer& out) const {
    for (Eigen::Index j = 0; j < count_; ++j) {
      const double in = weight_[j] * sine_[j];
      if (!(in > 0.0)) continue;
      const double leaves = weight_.cwiseProduct(sine_).dot(out.back.col(j) + out.through.col(j)), wanted = std::max(in - absorbed[j], 0.0);
      // Of what hardly leaves, the difference has no digits.
      if (!(wanted > 0.5 * in)) continue;
      out.back.col(j) *= wanted / leaves, out.through.col(j) *= wanted / leaves;
    }
  }

  /// w / M sum of (2 l + 1) chi_l Lambda Lambda W over l + m even, or odd.
  Square parity(const Scaled& s, int odd) const {
    Square sum = Square::Zero(count_, count_);
    for (int l = m_ + odd; l < streams_; l += 2) {
      const double strength = s.albedoTimes(l) * (2.0 * l + 1.0);
      if (strength != 0.0) sum.noalias() += strength * lambda_.col(l - m_) * lambda_.col(l - m_).transpose();
    }
    return sine_.cwiseInverse().asDiagonal() * sum * weight_.asDiagonal();
  }
  Square inverseSines() const { return Square(sine_.cwiseInverse().asDiagonal()); }

  /// By the mean of both edges (diamond): sums and differences of up and down part.
  void thinLayer(const Scaled& s, double depth, double beam, double fall, Layer& out) const {
    const Square even = 0.5 * depth * (inverseSines() - parity(s, 0)), odd = 0.5 * depth * (inverseSines() - parity(s, 1));
    const Square ofSum = inverseOf<Square>(one() + even), ofDifference = inverseOf<Square>(one() + odd);
    const Square sum = times<Square>(ofSum, one() - even), difference = -times<Square>(ofDifference, one() - odd);
    out.back = 0.5 * (sum + difference), out.through = 0.5 * (sum - difference);
    // The sun's: X / M.
    Column x[2] = {Column::Zero(count_), Column::Zero(count_)};
    for (int l = m_; l < streams_; ++l) x[(l - m_) % 2] += s.albedoTimes(l) * (2.0 * l + 1.0) * sun_[static_cast<std::size_t>(l - m_)] * lambda_.col(l - m_);
    const double strength = 2.0 * depth * beam * physics::meanDecay(fall) * (m_ == 0 ? 1.0 : 2.0) / (4.0 * kPi);
    const Column both = ofSum * (strength * x[0].cwiseQuotient(sine_)), apart = ofDifference * (strength * x[1].cwiseQuotient(sine_));
    out.up.setZero(count_, 2), out.down.setZero(count_, 2);
    out.up.col(0) = 0.5 * (both + apart), out.down.col(0) = 0.5 * (both - apart);
  }

  /// B linear in depth: B +- u solves the equation, u = B' (the matrix of differences)^-1 1; what leaves is that less what of it would have come in.
  void emitted(const Scaled& s, double above, double below, Layer& out) const {
    if (above == 0.0 && below == 0.0) return;
    if (s.depth < kNoDepth) {
      const Column sent = 0.5 * (above + below) * (1.0 - s.albedo) * s.depth * sine_.cwiseInverse();
      out.up.col(1) = out.down.col(1) = sent;
      return;
    }
    Column u = Column::Zero(count_);
    if (above != below) u = Eigen::MatrixXd(inverseSines() - parity(s, 1)).partialPivLu().solve(Eigen::VectorXd::Constant(count_, (below - above) / s.depth));
    const Column downAbove = Column::Constant(count_, above) - u, upBelow = Column::Constant(count_, below) + u;
    out.up.col(1) = Column::Constant(count_, above) + u - out.back * downAbove - out.through * upBelow;
    out.down.col(1) = Column::Constant(count_, below) - u - out.through * downAbove - out.back * upBelow;
  }

  void put(std::size_t edge, const Pair& up, const Pair& down, LayerLight& out) const {
    const auto directions = static_cast<std::size_t>(count_);
    for (Eigen::Index i = 0; i < count_; ++i) {
      const std::size_t at = (edge * static_cast<std::size_t>(out.shape.azimuths) + static_cast<std::size_t>(m_)) * directions + static_cast<std::size_t>(i);
      out.solarUp[at] = up(i, 0), out.solarDown[at] = down(i, 0);
      if (m_ == 0)
        out.thermalUp[edge * directions + static_cast<std::size_t>(i)] = up(i, 1),
                                          out.thermalDown[edge * directions + static_cast<std::size_t>(i)] = down(i, 1);
    }
    for (int l = m_; l < streams_; ++l) {
      const double sign = (l - m_) % 2 == 0 ? 1.0 : -1.0;
      const Eigen::Matrix<double, 1, 2> sum = 2.0 * kPi * (weight_.cwiseProduct(lambda_.col(l - m_))).transpose() * (up + sign * down);
      out.solar[edge * static_cast<std::size_t>(out.shape.moments()) + static_cast<std::size_t>(out.shape.at(l, m_))] = sum[0];
      if (m_ == 0) out.thermal[edge * static_cast<std::size_t>(streams_) + static_cast<std::size_t>(l)] = sum[1];
    }
    if (m_ != 0) return;
    const Column flux = 2.0 * kPi * weight_.cwiseProduct(sine_);
    out.fluxUp[edge] = flux.dot(up.rowwise().sum()), out.fluxDown[edge] = flux.dot(down.rowwise().sum());
  }

  const PlaneLayers& all_;
  const std::vector<Scaled>& scaled_;
  const Beam& beam_;
  int m_, streams_;
  double thin_;
  Eigen::Index count_;
  Column sine_, weight_;
  Eigen::MatrixXd lambda_;
  std::vector<double> sun_;
  std::vector<Layer> own_;
  std::vector<Square> between_, below_;
  std::vector<Pair> fromBelow_;
};

template <int Count, int Most>
void runModes(const PlaneLayers& layers, const std::vector<Scaled>& scaled, const Beam& beam, const Streams& streams, std::span<const double> weights,
              LayerLight& out) {
  const int azimuths = layers.irradiance > 0.0 ? out.shape.azimuths : 1;
  const std::size_t moments = static_cast<std::size_t>(out.shape.moments()), edges = layers.layers.size() + 1;
  // Terms fall as powers of the phase function's moments: after two that are faint beside the mean all are.
  int faint = 0;
  for (int m = 0; m < azimuths && faint < 2; ++m) {
    Mode<Count, Most>(layers, scaled, beam, m, streams, out.sines, weights).run(out);
    bool matters = m < 2;
    for (std::size_t k = 0; k < edges && !matters; ++k)
      for (int l = m; l < out.shape.streams && !matters; ++l)
        matters = (2.0 * l + 1.0) * std::abs(out.solar[k * moments + static_cast<std::size_t>(out.shape.at(l, m))]) > kFaint * out.solar[k * moments];
    faint = matters ? 0 : faint + 1;
  }
}

}  // namespace

namespace {

/// Of the recursion from degree to degree, [m][l]: what the last one counts, and the one before.
struct Recursion {
  static constexpr int kMost = 64;
  double last[kMost][kMost] = {}, before[kMost][kMost] = {}, first[kMost] = {1.0};
  Recursion() {
    for (int m = 0; m < kMost; ++m) {
      if (m > 0) first[m] = first[m - 1] * std::sqrt((2.0 * m - 1.0) / (2.0 * m));
      for (int l = m; l < kMost; ++l) {
        const double next = std::sqrt(static_cast<double>((l + 1 - m) * (l + 1 + m)));
        last[m][l] = (2.0 * l + 1.0) / next, before[m][l] = std::sqrt(static_cast<double>((l - m) * (l + m))) / next;
      }
    }
  }
};

}  // namespace

void legendreTerms(double mu, int m, int count, double* into) {
  static const Recursion recursion;
  const double across = std::sqrt(std::max(1.0 - mu * mu, 0.0));
  double here = recursion.first[m], before = 0.0;
  for (int k = 0; k < m; ++k) here *= across;
  for (int l = m; l < count; ++l) {
    into[l - m] = here;
    const double next = recursion.last[m][l] * mu * here - recursion.before[m][l] * before;
    before = here, here = next;
  }
}

LayerLight lightIn(const PlaneLayers& given, const Streams& streams) {
  LayerLight out;
  out.shape = {streams.all, std::clamp(streams.azimuths, 1, streams.all)};
  std::vector<double> weights;
  for (const QuadratureNode& n : gaussLegendre(streams.all / 2, 0.0, 1.0)) out.sines.push_back(n.x), weights.push_back(n.weight);
  for (double s : streams.sines) out.sines.push_back(s), weights.push_back(0.0);
  std::vector<Scaled> layers;
  for (const PlaneLayer& l : given.layers) layers.push_back(scaled(l, streams.all));
  const std::size_t edges = layers.size() + 1, directions = out.sines.size();
  // As much less is lost on the way through each layer as its depth is less without the peak.
  Beam beam;
  std::vector<double> bare;  // the sun alone
  double depth = given.sunDepth.empty() ? 0.0 : std::min(given.sunDepth.front(), kFarthest), own = depth;
  for (std::size_t k = 0; k < edges; ++k) {
    beam.depth.push_back(depth), beam.at.push_back(given.irradiance * std::exp(-depth)), bare.push_back(given.irradiance * std::exp(-own));
    if (k + 1 == edges) break;
    const double before = own;
    own = given.sunDepth.empty() ? own + given.layers[k].depth / std::max(given.sunSine, 1e-9) : std::clamp(given.sunDepth[k + 1], before, kFarthest);
    depth += (own - before) * (given.layers[k].depth > 0.0 ? layers[k].depth / given.layers[k].depth : 1.0);
  }
  const auto moments = static_cast<std::size_t>(out.shape.moments()), azimuths = static_cast<std::size_t>(out.shape.azimuths);
  out.solar.assign(edges * moments, 0.0);
  out.thermal.assign(edges * static_cast<std::size_t>(streams.all), 0.0);
  for (auto* v : {&out.solarUp, &out.solarDown}) v->assign(edges * azimuths * directions, 0.0);
  for (auto* v : {&out.thermalUp, &out.thermalDown}) v->assign(edges * directions, 0.0);
  for (auto* v : {&out.fluxUp, &out.fluxDown}) v->assign(edges, 0.0);
  if (directions == kUsual) runModes<kUsual, kUsual>(given, layers, beam, streams, weights, out);
  else if (directions <= kFew) runModes<Eigen::Dynamic, kFew>(given, layers, beam, streams, weights, out);
  else runModes<Eigen::Dynamic, Eigen::Dynamic>(given, layers, beam, streams, weights, out);
  // What goes on nearly as the sun does counts as the sun's within the layers; it is no less light that is turned and that falls.
  if (!(given.irradiance > 0.0)) return out;
  for (std::size_t k = 0; k < edges; ++k) (given.sunSine > 0.0 ? out.fluxDown : out.fluxUp)[k] += std::abs(given.sunSine) * (beam.at[k] - bare[k]);
  std::vector<double> sun(static_cast<std::size_t>(streams.all));
  for (int m = 0; m < out.shape.azimuths; ++m) {
    legendreTerms(-given.sunSine, m, streams.all, sun.data());
    for (std::size_t k = 0; k < edges; ++k)
      for (int l = m; l < streams.all; ++l)
        out.solar[k * moments + static_cast<std::size_t>(out.shape.at(l, m))] +=
            (m == 0 ? 1.0 : 2.0) * sun[static_cast<std::size_t>(l - m)] * (beam.at[k] - bare[k]);
  }
  return out;
}

void turnedTo(double mu, double cosAzimuth, const LayerLight::Shape& shape, std::span<double> into) {
  const double azimuth = std::acos(std::clamp(cosAzimuth, -1.0, 1.0));
  double* at = into.data();
  for (int m = 0; m < shape.azimuths; ++m) {
    legendreTerms(mu, m, shape.streams, at);
    const double round = m == 0 ? 1.0 : std::cos(m * azimuth);
    for (int l = m; l < shape.streams; ++l, ++at) *at *= (2.0 * l + 1.0) / (4.0 * kPi) * round;
  }
}

}  // namespace pitviper
