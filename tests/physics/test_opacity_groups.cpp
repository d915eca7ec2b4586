#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/physics/group_scene.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

TEST(OpacityGroupsTrial, Curve) {
  const char* which = std::getenv("TRIAL");
  for (SceneBand band : {SceneBand::Midwave, SceneBand::MidwavePlume, SceneBand::Longwave, SceneBand::Shortwave}) {
    if (which && !std::strchr(which, '0' + static_cast<int>(band))) continue;
    const GroupScene& s = groupScene(band);
    const SpectralProblem train = drawProblem(s, {1, 5000, false}), fresh = drawProblem(s, {2, 10000, true});
    std::printf("%s: %zu fine, %zu spectra, %zu paths, %zu terms\n", s.name.c_str(), train.weight.size(), train.spectra.size(), train.paths.size(), train.products.size());
    if (std::getenv("BASE")) {
      const EvenBins bins(fresh);
      for (int n = 8; n <= 400; n = n * 5 / 4) std::printf("  even %d: samples %.4f bins %.4f\n", n, evenSamplesError(fresh, n), bins.error(n));
    }
    for (int n : std::getenv("ONE") ? std::vector<int>{std::atoi(std::getenv("ONE"))} : std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20}) {
      const auto t0 = std::chrono::steady_clock::now();
      FitEffort effort;
      if (std::getenv("ROUNDS")) effort.rounds = std::atoi(std::getenv("ROUNDS"));
      if (std::getenv("INNER")) effort.innerSteps = std::atoi(std::getenv("INNER"));
      if (std::getenv("WORK")) effort.workingProducts = std::atoi(std::getenv("WORK"));
      const GroupFit fit = fitGroups(train, n, effort);
      const double dt = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
      const GroupFit f = evaluateGroups(fresh, fit.groups);
      size_t members = 0;
      for (auto& g : fit.groups) members += g.members.size();
      std::printf("  %2d groups: train %.5f p99 %.5f fresh %.5f p99 %.5f  %.2f s  members %zu\n", n, fit.maximum, fit.p99, f.maximum, f.p99, dt, members);
      if (std::getenv("ONE")) {
        const SpectralProblem& dbg = std::getenv("FRESH") ? fresh : train;
        const size_t ni = dbg.weight.size();
        std::vector<std::pair<double, size_t>> worst;
        std::vector<double> errs;
        for (size_t m = 0; m < dbg.products.size(); ++m) {
          double fine = 0, plan = 0;
          for (auto& t : dbg.products[m].terms) {
            auto& sp = dbg.spectra[t.source]; auto& u = dbg.paths[t.path];
            for (size_t i = 0; i < ni; ++i) { double d = 0; for (size_t k = 0; k < u.size(); ++k) d += u[k] * dbg.extinction[k][i]; fine += t.coefficient * dbg.weight[i] * sp[i] * std::exp(-d); }
            for (auto& g : fit.groups) { double d = 0, mean = 0; for (size_t k = 0; k < u.size(); ++k) d += u[k] * g.extinction[k]; for (auto& [i, share] : g.members) mean += share * sp[i]; plan += t.coefficient * g.weight * mean * std::exp(-d); }
          }
          const double e = (plan - fine) / std::max(std::abs(fine), dbg.products[m].floor);
          errs.push_back(e);
          worst.push_back({-std::abs(e), m});
        }
        std::sort(worst.begin(), worst.end());
        for (size_t j = 0; j < 400; j += j < 20 ? 1 : 20) {
          size_t m = worst[j].second; auto& t = dbg.products[m].terms;
          auto& u = dbg.paths[t.back().path];
          std::printf("   %zu err %+.4f terms %zu src %d  U:", m, errs[m], t.size(), t[0].source);
          for (double v : u) std::printf(" %.3g", v);
          std::printf("\n");
        }
        for (auto& g : fit.groups) { std::printf("   w %.4f n %zu C:", g.weight, g.members.size()); for (double c : g.extinction) std::printf(" %.3g", c); std::printf("\n"); }
      }
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace pitviper::test
