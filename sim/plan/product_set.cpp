#include "sim/plan/product_set.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/parameters/on_threads.hpp"

namespace pitviper {
namespace {

/// Of terms, paths, spectra, products for errors and for slopes, so many keep a thread busy for longer than it takes to start one.
constexpr size_t kLeastTerms = 512, kLeastPaths = 1024, kLeastSpectra = 128, kLeastProducts = 64, kLeastSlopes = 16;

void require(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("spectral problem: " + what);
}

bool allFinite(const std::vector<double>& values, double least) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return std::isfinite(v) && v >= least; });
}

void check(const SpectralProblem& p) {
  constexpr double kAny = -std::numeric_limits<double>::max();
  const size_t n = p.weight.size();
  require(n > 0, "no wavelengths");
  require(p.wavelength_um.empty() || p.wavelength_um.size() == n, "wavelengths and weights differ in number");
  require(allFinite(p.weight, 0.0), "a weight is negative or not finite");
  for (const auto& s : p.spectra) require(s.size() == n && allFinite(s, kAny), "a spectrum of another length, or not finite");
  for (const auto& c : p.extinction) require(c.size() == n && allFinite(c, 0.0), "extinction of another length, negative or not finite");
  for (const auto& u : p.paths) require(u.size() == p.extinction.size() && allFinite(u, 0.0), "amounts of another length, negative or not finite");
  const auto within = [](int index, size_t count) { return index >= 0 && static_cast<size_t>(index) < count; };
  for (const auto& product : p.products) {
    require(std::isfinite(product.floor) && product.floor >= 0.0, "a floor is negative or not finite");
    for (const ProductTerm& t : product.terms) {
      bool good = t.count >= 1 && t.count <= kMostFactors && within(t.path, p.paths.size()) && std::isfinite(t.coefficient);
      for (int f = 0; good && f < t.count; ++f) good = within(t.spectrum[static_cast<size_t>(f)], p.spectra.size());
      require(good, "a term with an index out of range, or a coefficient that is not finite");
    }
  }
}

/// Old index -> new one in the order of first use; -1 where unused.
class Renumbering {
 public:
  explicit Renumbering(size_t count) : newIndex_(count, -1) {}
  int operator()(int old) {
    int& n = newIndex_[static_cast<size_t>(old)];
    if (n < 0) {
      n = static_cast<int>(used.size());
      used.push_back(old);
    }
    return n;
  }
  std::vector<int> used;

 private:
  std::vector<int> newIndex_;
};

}  // namespace

ProductSet::ProductSet(const SpectralProblem& p) {
  check(p);
  wavelengths = static_cast<int>(p.weight.size());
  for (size_t i = 0; i < p.weight.size(); ++i)
    if (p.weight[i] > 0.0) fineIndex.push_back(static_cast<int>(i));
  const auto n = static_cast<Eigen::Index>(fineIndex.size());
  const auto at = [&](const std::vector<double>& values, Eigen::Index i) { return values[static_cast<size_t>(fineIndex[static_cast<size_t>(i)])]; };
  weight.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) weight[i] = at(p.weight, i);
  extinction.resize(n, static_cast<Eigen::Index>(p.extinction.size()));
  for (Eigen::Index k = 0; k < extinction.cols(); ++k)
    for (Eigen::Index i = 0; i < n; ++i) extinction(i, k) = at(p.extinction[static_cast<size_t>(k)], i);

  Renumbering source(p.spectra.size()), path(p.paths.size());
  std::vector<double> floors;
  firstTerm.push_back(0);
  for (const SpectralProduct& product : p.products) {
    for (ProductTerm t : product.terms) {
      for (int f = 0; f < t.count; ++f) t.spectrum[static_cast<size_t>(f)] = source(t.spectrum[static_cast<size_t>(f)]);
      t.path = path(t.path);
      require(t.tag >= 0, "a tag below 0");
      terms.push_back(t);
    }
    firstTerm.push_back(static_cast<int>(terms.size()));
    floors.push_back(product.floor);
  }
  weighted.resize(n, static_cast<Eigen::Index>(source.used.size()));
  for (Eigen::Index s = 0; s < weighted.cols(); ++s)
    for (Eigen::Index i = 0; i < n; ++i) weighted(i, s) = weight[i] * at(p.spectra[static_cast<size_t>(source.used[static_cast<size_t>(s)])], i);
  amounts.resize(extinction.cols(), static_cast<Eigen::Index>(path.used.size()));
  for (Eigen::Index u = 0; u < amounts.cols(); ++u)
    for (Eigen::Index k = 0; k < amounts.rows(); ++k) amounts(k, u) = p.paths[static_cast<size_t>(path.used[static_cast<size_t>(u)])][static_cast<size_t>(k)];
  for (Eigen::Index u = 0; u < amounts.cols(); ++u) sparse.add(amounts.col(u).data(), columnCount());
  compress();
  integrate(floors);
}

// Gram-Schmidt with the column worst represented as the next direction: surfaces times Planck's law at many temperatures are few shapes.
void ProductSet::compress() {
  Eigen::MatrixXd rest = weighted;
  Eigen::VectorXd size = weighted.colwise().norm();
  const Eigen::Index most = std::min(weighted.rows(), weighted.cols());
  basis.resize(weighted.rows(), most);
  mix.resize(most, weighted.cols());
  Eigen::Index rank = 0;
  for (; rank < most; ++rank) {
    Eigen::Index worst = 0;
    const double left = (rest.colwise().norm().transpose().array() / size.array().max(1e-300)).maxCoeff(&worst);
    if (!(left > kBasisError)) break;
    basis.col(rank) = rest.col(worst).normalized();
    mix.row(rank).noalias() = basis.col(rank).transpose() * rest;
    rest.noalias() -= basis.col(rank) * mix.row(rank);
  }
  mix.conservativeResize(rank, Eigen::NoChange);
  weightSize = weight.norm();
  basis.conservativeResize(Eigen::NoChange, hasProducts() ? rank + 1 : rank);
  if (basis.cols() > rank) basis.col(rank) = weight / weightSize;
}

// Path by path, so that the transmittances of all paths need not be kept.
void ProductSet::integrate(const std::vector<double>& floors) {
  std::vector<int> order(terms.size()), productOf(terms.size());
  for (int m = 0; m + 1 < static_cast<int>(firstTerm.size()); ++m)
    for (int t = firstTerm[static_cast<size_t>(m)]; t < firstTerm[static_cast<size_t>(m) + 1]; ++t) productOf[static_cast<size_t>(t)] = m;
  for (size_t t = 0; t < order.size(); ++t) order[t] = static_cast<int>(t);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return terms[static_cast<size_t>(a)].path < terms[static_cast<size_t>(b)].path; });
  int tags = 0;
  for (const ProductTerm& t : terms) tags = std::max(tags, t.tag + 1);
  // Spectra without the weights, of those that are multiplied.
  Eigen::MatrixXd plain(weighted.rows(), hasProducts() ? weighted.cols() : 0);
  for (Eigen::Index s = 0; s < plain.cols(); ++s) plain.col(s) = weighted.col(s).array() / weight.array();
  std::vector<double> values(terms.size());
  onStretches(order.size(), kLeastTerms, [&](size_t from, size_t to) {
    Eigen::VectorXd tau;
    int current = -1;
    for (size_t n = from; n < to; ++n) {
      const ProductTerm& t = terms[static_cast<size_t>(order[n])];
      if (t.path != current) {
        current = t.path;
        tau = (-(extinction * amounts.col(current)).array()).exp();
      }
      Eigen::ArrayXd product = weighted.col(t.spectrum[0]).array() * tau.array();
      for (int f = 1; f < t.count; ++f) product *= plain.col(t.spectrum[static_cast<size_t>(f)]).array();
      values[static_cast<size_t>(order[n])] = t.coefficient * product.sum();
    }
  });
  parts = Eigen::MatrixXd::Zero(tags, static_cast<Eigen::Index>(floors.size()));
  for (int index : order) parts(terms[static_cast<size_t>(index)].tag, productOf[static_cast<size_t>(index)]) += values[static_cast<size_t>(index)];
  fine = parts.colwise().sum();
  scale.resize(fine.size());
  for (Eigen::Index m = 0; m < fine.size(); ++m) {
    const double size = std::max(std::abs(fine[m]), floors[static_cast<size_t>(m)]);
    scale[m] = size > std::numeric_limits<double>::min() ? 1.0 / size : 0.0;
  }
}

ProductSet ProductSet::subset(const std::vector<int>& products) const {
  ProductSet s;
  s.wavelengths = wavelengths;
  s.fineIndex = fineIndex;
  s.weight = weight;
  s.extinction = extinction;
  s.fine.resize(static_cast<Eigen::Index>(products.size()));
  s.scale.resize(s.fine.size());
  Renumbering source(static_cast<size_t>(sourceCount())), path(static_cast<size_t>(pathCount()));
  s.firstTerm.push_back(0);
  for (size_t j = 0; j < products.size(); ++j) {
    const auto m = static_cast<size_t>(products[j]);
    s.fine[static_cast<Eigen::Index>(j)] = fine[products[j]];
    s.scale[static_cast<Eigen::Index>(j)] = scale[products[j]];
    for (int t = firstTerm[m]; t < firstTerm[m + 1]; ++t) {
      ProductTerm term = terms[static_cast<size_t>(t)];
      for (int f = 0; f < term.count; ++f) term.spectrum[static_cast<size_t>(f)] = source(term.spectrum[static_cast<size_t>(f)]);
      term.path = path(term.path);
      s.terms.push_back(term);
    }
    s.firstTerm.push_back(static_cast<int>(s.terms.size()));
  }
  s.weighted.resize(fineCount(), static_cast<Eigen::Index>(source.used.size()));
  for (Eigen::Index i = 0; i < s.weighted.cols(); ++i) s.weighted.col(i) = weighted.col(source.used[static_cast<size_t>(i)]);
  s.basis = basis;
  s.weightSize = weightSize;
  s.mix.resize(mix.rows(), s.weighted.cols());
  for (Eigen::Index i = 0; i < s.mix.cols(); ++i) s.mix.col(i) = mix.col(source.used[static_cast<size_t>(i)]);
  s.amounts.resize(columnCount(), static_cast<Eigen::Index>(path.used.size()));
  for (Eigen::Index i = 0; i < s.amounts.cols(); ++i) s.amounts.col(i) = amounts.col(path.used[static_cast<size_t>(i)]);
  for (Eigen::Index u = 0; u < s.amounts.cols(); ++u) s.sparse.add(s.amounts.col(u).data(), columnCount());
  return s;
}

bool ProductSet::hasProducts() const {
  return std::any_of(terms.begin(), terms.end(), [](const ProductTerm& t) { return t.count > 1; });
}

GroupMoments ProductSet::moments(const GroupState& state) const {
  GroupMoments m;
  m.groups = static_cast<int>(state.share.rows());
  const int padded = paddedGroups(m.groups);
  const auto filled = [&](const Eigen::MatrixXd& of) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(padded, of.cols());
    all.topRows(m.groups) = of;
    return all;
  };
  const Eigen::MatrixXd share = filled(state.share), depths = filled(state.extinction);
  m.source.resize(padded, weighted.cols());
  onStretches(static_cast<size_t>(sourceCount()), kLeastSpectra, [&](size_t from, size_t to) {
    const auto column = static_cast<Eigen::Index>(from);
    averages(share.data(), weighted.col(column).data(), fineCount(), static_cast<int>(to - from), padded, m.source.col(column).data());
  });
  m.weight.resize(padded);
  averages(share.data(), weight.data(), fineCount(), 1, padded, m.weight.data());
  m.transmittance.resize(padded, pathCount());
  onStretches(static_cast<size_t>(pathCount()), kLeastPaths, [&](size_t from, size_t to) {
    transmittances(sparse, static_cast<int>(from), static_cast<int>(to), depths.data(), padded, m.transmittance.data());
  });
  return m;
}

namespace {

// A group that lost all its weight gives nothing: its sources are 0 too.
Eigen::ArrayXd inverse(const Eigen::VectorXd& weight) { return (weight.array() > 0.0).select(1.0 / weight.array(), 0.0); }

// Of a term, per group: value = transmittance x S_1 x (S_2 / W) x (S_3 / W) ..., S_f sums of weight x share x spectrum, W the group's weight.
class TermValue {
 public:
  TermValue(const GroupMoments& at, const Eigen::ArrayXd& perWeight, const ProductTerm& term)
      : source_(at.source.data()), perWeight_(perWeight.data()), groups_(at.source.rows()), term_(term) {}
  /// The product of all spectra but one (-1: of all), without the transmittance.
  void spectraBut(int left, Eigen::ArrayXd& out) const {
    double* p = out.data();
    const auto column = [&](int f) { return source_ + groups_ * term_.spectrum[static_cast<size_t>(f)]; };
    if (term_.count == 1 && left < 0) {
      const double* a = column(0);
      for (Eigen::Index g = 0; g < groups_; ++g) p[g] = a[g];
      return;
    }
    if (term_.count == 2) {
      if (left < 0) {
        const double *a = column(0), *b = column(1);
        for (Eigen::Index g = 0; g < groups_; ++g) p[g] = a[g] * b[g] * perWeight_[g];
      } else {
        const double* a = column(1 - left);
        for (Eigen::Index g = 0; g < groups_; ++g) p[g] = a[g] * perWeight_[g];
      }
      return;
    }
    for (Eigen::Index g = 0; g < groups_; ++g) {
      double product = 1.0;
      for (int f = 0; f < term_.count; ++f) {
        if (f != left) product *= column(f)[g];
        if (f > 0) product *= perWeight_[g];
      }
      p[g] = product;
    }
  }

 private:
  const double *source_, *perWeight_;
  Eigen::Index groups_;
  const ProductTerm& term_;
};

}  // namespace

Eigen::VectorXd ProductSet::errors(const GroupMoments& at) const {
  const Eigen::ArrayXd perWeight = inverse(at.weight);
  Eigen::VectorXd e(size());
  onStretches(static_cast<size_t>(size()), kLeastProducts, [&](size_t from, size_t to) {
    Eigen::ArrayXd product(at.weight.size());
    for (size_t m = from; m < to; ++m) {
      double sum = 0.0;
      for (int t = firstTerm[m]; t < firstTerm[m + 1]; ++t) {
        const ProductTerm& term = terms[static_cast<size_t>(t)];
        const auto tau = at.transmittance.col(term.path);
        if (term.count == 1) {
          sum += term.coefficient * at.source.col(term.spectrum[0]).dot(tau);
          continue;
        }
        TermValue(at, perWeight, term).spectraBut(-1, product);
        sum += term.coefficient * (product * tau.array()).sum();
      }
      const auto at_m = static_cast<Eigen::Index>(m);
      e[at_m] = scale[at_m] * (sum - fine[at_m]);
    }
  });
  return e;
}

// Group by group in the inner loops: a term's derivatives by a spectrum's averages go to the shapes that make up the spectrum.
GroupSlopes ProductSet::slopes(const GroupMoments& at) const {
  const Eigen::ArrayXd perWeight = inverse(at.weight);
  const Eigen::Index padded = at.source.rows(), groups = at.groups, shapes = mix.rows(), columns = amounts.rows();
  GroupSlopes out{Eigen::MatrixXd::Zero(basis.cols() * groups, size()), Eigen::MatrixXd::Zero(columns * groups, size())};
  const double* w = perWeight.data();
  onStretches(static_cast<size_t>(size()), kLeastSlopes, [&](size_t from, size_t to) {
    Eigen::ArrayXd product(padded), own(padded), byWeight(groups);
    const auto addTo = [&](double* averages, int source) {
      const double *d = own.data(), *m = mix.data() + shapes * source;
      for (Eigen::Index r = 0; r < shapes; ++r, averages += groups)
        for (Eigen::Index g = 0; g < groups; ++g) averages[g] += m[r] * d[g];
    };
    for (auto m = static_cast<int>(from); m < static_cast<int>(to); ++m) {
      double* averages = out.average.col(m).data();
      byWeight.setZero();
      for (int t = firstTerm[static_cast<size_t>(m)]; t < firstTerm[static_cast<size_t>(m) + 1]; ++t) {
        const ProductTerm& term = terms[static_cast<size_t>(t)];
        const double c = scale[m] * term.coefficient;
        const double* tau = at.transmittance.data() + padded * term.path;
        const TermValue value(at, perWeight, term);
        value.spectraBut(-1, product);
        product *= c * at.transmittance.col(term.path).array();
        for (int f = 0; f < term.count; ++f) {
          if (term.count == 1)
            for (Eigen::Index g = 0; g < groups; ++g) own[g] = c * tau[g];
          else {
            value.spectraBut(f, own);
            for (Eigen::Index g = 0; g < groups; ++g) own[g] *= c * tau[g];
          }
          addTo(averages, term.spectrum[static_cast<size_t>(f)]);
        }
        if (term.count > 1)
          for (Eigen::Index g = 0; g < groups; ++g) byWeight[g] -= (term.count - 1) * w[g] * product[g];
        const double* amount = amounts.data() + columns * term.path;
        double* depths = out.extinction.col(m).data();
        for (Eigen::Index k = 0; k < columns; ++k, depths += groups)
          if (amount[k] != 0.0)
            for (Eigen::Index g = 0; g < groups; ++g) depths[g] -= amount[k] * product[g];
      }
      if (basis.cols() > shapes) out.average.col(m).tail(groups) = weightSize * byWeight.matrix();
    }
  });
  return out;
}

std::pair<double, double> errorFigures(const Eigen::VectorXd& errors) {
  if (errors.size() == 0) return {0.0, 0.0};
  std::vector<double> sizes(static_cast<size_t>(errors.size()));
  for (size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::abs(errors[static_cast<Eigen::Index>(i)]);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(sizes.size()))) - 1;
  std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
  return {*std::max_element(sizes.begin(), sizes.end()), sizes[static_cast<size_t>(rank)]};
}

}  // namespace pitviper
