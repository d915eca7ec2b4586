// What `bench --accuracy` calls an error, from pixels with known differences, and what it makes of its rows.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/commands/accuracy_report.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

using test::blackBodyBand;

// A thousandth of what is bright stands in for a pixel darker than that.
TEST(AccuracyError, RelativeToThePixelOrToAThousandthOfTheScene) {
  std::vector<double> wanted(1000, 2.0), drawn(1000, 2.02);
  wanted[3] = 0.0, drawn[3] = 0.001;
  wanted[4] = 1e-3, drawn[4] = 1e-3;
  drawn[5] = 1.98;
  const ChannelErrors e = ChannelReference(Spectrum::band(0.5, 0.6), wanted).errors(drawn);
  EXPECT_NEAR(e.relative.median, 0.01, 1e-12);
  EXPECT_NEAR(e.relative.percentile99, 0.01, 1e-12);
  EXPECT_NEAR(e.relative.maximum, 0.001 / 0.002, 1e-12);
  EXPECT_FALSE(e.kelvin) << "no body is that cold and that bright in visible light";
}

// What sends a pixel a photon in hours there is nothing to be off by: a channel as dark as that is not held to itself.
TEST(AccuracyError, OfWhatIsDarkerThanAnyDetectorSees) {
  // A band of 0.1 um: a floor of 1e-15 W/(m2 sr); in photons a joule (a kernel 4e18 times as large) as much larger.
  for (const double unit : {1.0, 4e18}) {
    const Spectrum band = Spectrum::band(0.5, 0.6) * unit;
    const auto largest = [&](double l) {
      return ChannelReference(band, std::vector<double>(100, unit * l)).errors(std::vector<double>(100, 1.1 * unit * l)).relative.maximum;
    };
    EXPECT_NEAR(largest(1e-20), 1e-6, 1e-9);
    EXPECT_NEAR(largest(1e-14), 0.1, 1e-9);
  }
}

// Against the classical series of the band's radiance; its slope by a difference of 0.02 K.
TEST(AccuracyError, AsATemperatureDifferenceOfBodiesNearThoseOfTheEarth) {
  for (const auto& [low, high] : {std::pair{3.0, 5.0}, {8.0, 12.0}})
    for (double t : {252.3, 300.0, 328.8}) {
      const double l = blackBodyBand(low, high, t), slope = (blackBodyBand(low, high, t + 0.01) - blackBodyBand(low, high, t - 0.01)) / 0.02;
      const ChannelErrors e = ChannelReference(Spectrum::band(low, high), {l, blackBodyBand(low, high, 400.0)}).errors(std::vector{l + 0.2 * slope, 0.0});
      ASSERT_TRUE(e.kelvin);
      EXPECT_NEAR(e.kelvin->maximum, 0.2, 0.2 * 3e-4) << "slope, linear between 1 K steps: " << low << " um " << t << " K";
    }
  const double warm = blackBodyBand(8.0, 12.0, 331.0), cold = blackBodyBand(8.0, 12.0, 249.0);
  EXPECT_FALSE(ChannelReference(Spectrum::band(8.0, 12.0), {warm, cold}).errors(std::vector{warm, cold}).kelvin);
}

AccuracyReport known() {
  AccuracyReport r;
  r.heading = "a scene";
  for (const AccuracySetting& s : accuracyLadder()) {
    AccuracyRow row{s, 12, 80.0, {}};
    row.channels.push_back({"mw",
                            5,
                            s.kind == AccuracySetting::Kind::Planned ? std::optional(0.9 * s.sampling.accuracy) : std::nullopt,
                            {{0.001, 0.002, 0.004}, ErrorFigures{0.01, 0.02, 0.3}}});
    row.channels.push_back({"vis", 7, {}, {{0.003, 0.005, 0.006}, {}}});
    r.rows.push_back(row);
  }
  return r;
}

TEST(AccuracyReport, TheLadderHasWhatIsCompared) {
  const auto ladder = accuracyLadder();
  std::vector<double> accuracies;
  std::vector<int> even;
  for (const auto& s : ladder) {
    if (s.kind == AccuracySetting::Kind::Planned) accuracies.push_back(s.sampling.accuracy);
    else EXPECT_EQ(s.sampling.accuracy, 0.0);
    if (s.kind == AccuracySetting::Kind::Even) {
      EXPECT_EQ(s.sampling.spacing, Spacing::Even);
      even.push_back(s.sampling.samples);
    }
  }
  EXPECT_EQ(accuracies, (std::vector{0.1, 0.03, 0.01, 0.003, 0.001}));
  EXPECT_EQ(even, (std::vector{4, 8, 16, 32, 64, 128, 256, 340}));
}

TEST(AccuracyReport, TablesCsvAndCharts) {
  AccuracyReport report = known();
  report.missing.push_back("even 340: too many");
  const std::string text = accuracyTables(report);
  EXPECT_NE(text.find("| 1 % | 80.0 | 12 | 5 | 0.90 | 0.10 / 0.20 / 0.40 | 7 | | 0.30 / 0.50 / 0.60 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| even 16 | 10 / 20 / 300 |"), std::string::npos) << text;
  EXPECT_NE(text.find("not drawn: even 340: too many"), std::string::npos);
  const std::string csv = accuracyCsv(report);
  const auto columns = std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n')), ',');
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_EQ(lines, 1 + 2 * static_cast<std::ptrdiff_t>(report.rows.size()));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), lines * columns);
  EXPECT_NE(csv.find("\nplanned,0.3 %,0.003,,80,12,mw,5,0.0027,0.001,0.002,0.004,0.01,0.02,0.3\n"), std::string::npos) << csv;
  const auto charts = accuracyCharts(report);
  ASSERT_EQ(charts.size(), 2u);
  for (const auto& s : charts[1].series) {
    EXPECT_GE(s.y.size(), 2u) << s.name;
    for (double y : s.y) EXPECT_NEAR(y, 0.5, 1e-12);
  }
}

TEST(AccuracyReport, AnotherSizeOfFilmHasTheSameField) {
  Pinhole p{256, 128, 0.05, 20e-6, 20e-6, 0.01};
  const double right = p.tanX(p.width), top = p.tanY(0);
  resizeFilm(p, 64);
  EXPECT_EQ(p.width, 64);
  EXPECT_EQ(p.height, 32);
  EXPECT_DOUBLE_EQ(p.tanX(p.width), right);
  EXPECT_DOUBLE_EQ(p.tanY(0), top);
}

}  // namespace
}  // namespace pitviper
