// The report of a sweep: a page that is whole, says what it is of, and draws every sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <random>
#include <string>
#include <string_view>

#include "scenarios/sweep/svg_drawing.hpp"
#include "scenarios/sweep/sweep_axis.hpp"
#include "scenarios/sweep/sweep_page.hpp"
#include "sim/parameters/read_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

SweepIdentity aReportedSweep(int samples) {
  SweepIdentity s{"jet <in> haze", "ab12", "jet.yaml", "1.0", samples, {}, {}};
  s.factors = {{"range", "km"}, {"haze & co", "", {"none", "rural", "\"urban\""}}, {"seen from", "deg"}, {"visibility", "km"}};
  Measure contrast, more;
  contrast.names = {"contrast <mw>"}, contrast.units = {"W/sr"};
  more.names = {"s/n & all", "constant"}, more.units = {"", "K"};
  s.measures = {contrast, more};
  return s;
}

std::vector<SweepRow> reportedRows(const SweepIdentity& sweep) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::vector<SweepRow> rows;
  for (int i = 0; i < sweep.samples; ++i) {
    SweepRow r{i, 1, {1.0 + 19.0 * uniform(random), std::floor(3.0 * uniform(random)), 180.0 * uniform(random), std::pow(10.0, 2.3 * uniform(random))}, {}, ""};
    const double signal = 300.0 * std::exp(-r.factors[0] / (3.0 + 0.2 * r.factors[3])) * (2.0 + std::cos(r.factors[2] / 57.3)) / (1.0 + r.factors[1]);
    r.measures = {signal, std::pow(10.0, 0.02 * signal) * std::exp(0.3 * normal(random)), 0.1};
    if (i % 50 == 7) r.measures[1] = i % 100 == 7 ? NAN : INFINITY;
    if (i % 90 == 9) r.measures.clear(), r.why = "sun & <moon> below";
    rows.push_back(r);
  }
  return rows;
}

/// The name of a tag whose attributes are all `name="value"`; nothing where it is no such tag. std::regex would take a stack frame for each character.
std::string tagName(std::string_view tag) {
  const auto letters = [&] {
    std::size_t n = 0;
    while (n < tag.size() && (std::isalnum(static_cast<unsigned char>(tag[n])) || tag[n] == '-' || tag[n] == ':')) ++n;
    const std::string word(tag.substr(0, n));
    tag.remove_prefix(n);
    return word;
  };
  const std::string name = letters();
  while (tag.starts_with(' ')) {
    tag.remove_prefix(1);
    if (letters().empty() || !tag.starts_with("=\"")) return "";
    const std::size_t end = tag.find('"', 2);
    if (end == tag.npos || tag.substr(0, end).find('<') != tag.npos) return "";
    tag.remove_prefix(end + 1);
  }
  return tag.empty() ? name : "";
}

/// What is wrong with a page's tags, quotes or entities; nothing where all is well.
std::string illFormed(std::string_view page) {
  std::vector<std::string> open;
  while (!page.empty()) {
    std::size_t used = 1;
    if (page.front() == '<') {
      const std::size_t end = page.find('>');
      if (end == page.npos) return "a tag does not end";
      used = end + 1;
      std::string_view tag = page.substr(1, end - 1);
      const bool closes = tag.starts_with('/'), isEmpty = tag.ends_with('/');
      if (closes) tag.remove_prefix(1);
      if (isEmpty) tag.remove_suffix(1);
      const std::string name = tagName(tag);
      if (name.empty()) return "no tag: " + std::string(tag.substr(0, 80));
      if (!closes && !isEmpty) open.push_back(name);
      if (closes && (open.empty() || open.back() != name)) return "closed without being open: " + name;
      if (closes) open.pop_back();
    } else if (page.front() == '&') {
      const std::string_view entity = page.substr(0, page.find(';') + 1);
      if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;") return "no entity: " + std::string(entity.substr(0, 80));
    }
    page.remove_prefix(used);
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

/// The page without what comes before its body, which is HTML only.
std::string bodyOf(const std::string& page) { return page.substr(page.find("<body>"), page.find("</html>") - page.find("<body>")); }

std::size_t timesIn(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(SweepPage, IsWholeAndNamesEverything) {
  EXPECT_EQ(illFormed("<b><p a=\"1\" b-c=\"/\">x &lt; y</p><path d=\"M0\"/></b>"), "");
  for (const char* bad : {"<p>", "<p></b>", "<p a=1></p>", "<p>a & b</p>", "<p a=\"<\"></p>", "a < b"}) EXPECT_NE(illFormed(bad), "") << bad;
  const TemporaryFolder folder;
  for (bool isSaltelli : {false, true}) {
    const SweepIdentity sweep = aReportedSweep(500);
    std::vector<SweepRow> rows = reportedRows(sweep);
    std::shuffle(rows.begin(), rows.end(), std::mt19937(2));
    const auto file = folder.path() / (isSaltelli ? "saltelli.html" : "random.html");
    writeSweepPage(file, sweep, rows, isSaltelli);
    const std::string page = readWholeFile(file, {}, {});
    EXPECT_EQ(illFormed(bodyOf(page)), "");
    for (const char* text :
         {"<h1>jet &lt;in&gt; haze</h1>", "contrast &lt;mw&gt; [W/sr]", "s/n &amp; all [1]", "constant [K]", "haze &amp; co", "&quot;urban&quot;",
          "sun &amp; &lt;moon&gt; below", "Of 500 samples 500 are stored, and of these 6 have failed.", "pitviper.scenario_sha256 = ab12;"})
      EXPECT_GT(timesIn(page, text), 0u) << text;
    for (const char* text : {"<script", "<moon>", "src=", "url(", "<link", "nan", "inf\""}) EXPECT_EQ(timesIn(page, text), 0u) << text;
    // http: the name of SVG's language only.
    EXPECT_EQ(timesIn(page, "http"), timesIn(page, "http://www.w3.org/2000/svg"));
    EXPECT_EQ(timesIn(page, "<svg"), 3u) << "one of each measure";
    // A dot for each of the 494 that did not fail, in 4 panels of 3 measures; 10 of the second have no number, or none that has a place.
    EXPECT_EQ(timesIn(page, "h0"), 4u * (494 + 484 + 494));
    EXPECT_EQ(timesIn(page, "first-order index") > 0, isSaltelli);
    std::reverse(rows.begin(), rows.end());
    writeSweepPage(file, sweep, rows, isSaltelli);
    EXPECT_EQ(readWholeFile(file, {}, {}), page) << "whatever the order of rows";
  }
}

TEST(SweepPage, OfFewSamplesOrMany) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "page.html";
  for (int samples : {0, 1, 5, 2500}) {
    const SweepIdentity sweep = aReportedSweep(samples);
    writeSweepPage(file, sweep, reportedRows(sweep), true);
    const std::string page = readWholeFile(file, {}, {});
    EXPECT_EQ(illFormed(bodyOf(page)), "") << samples;
    EXPECT_EQ(timesIn(page, "nothing to draw") > 0, samples == 0);
    EXPECT_EQ(timesIn(page, "Of 2472 samples 2000 are drawn as dots.") > 0, samples == 2500);
  }
  const MayReplace never = [](const std::filesystem::path&) { throw UserError({}, "it stays"); };
  EXPECT_THROW(writeSweepPage(file, aReportedSweep(0), {}, false, never), UserError);
}

TEST(SweepPage, Axes) {
  const SweepAxis linear = axisHolding(std::vector<double>{0.0, 5.0, 10.0, NAN, INFINITY});
  EXPECT_FALSE(linear.isLogarithmic);
  EXPECT_NEAR(linear.place(5.0), 0.5, 1e-12);
  EXPECT_NEAR(linear.place(10.0), 1.04 / 1.08, 1e-12) << "a margin of 4 %";
  EXPECT_TRUE(std::isnan(linear.place(INFINITY)));
  ASSERT_EQ(linear.ticks.size(), 6u);
  EXPECT_EQ(linear.ticks[1].label, "2");
  EXPECT_NEAR(linear.ticks[1].at, linear.place(2.0), 1e-12);
  const SweepAxis decades = axisHolding(std::vector<double>{1e-3, 1e-1, 1.0, 1e1, 1e7});
  EXPECT_TRUE(decades.isLogarithmic);
  EXPECT_NEAR(decades.place(1e2), 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(decades.place(-1.0)));
  EXPECT_EQ(decades.ticks.front().label, "0.001");
  EXPECT_EQ(decades.ticks.back().label, "10⁷");
  for (double same : {0.0, 1e-300, -7.0, 3e8}) EXPECT_NEAR(axisHolding(std::vector<double>{same, same}).place(same), 0.5, 1e-9) << same;
  EXPECT_TRUE(axisHolding(std::vector<double>{-1e308, 1e308}).ticks.empty());
  EXPECT_TRUE(axisHolding(std::vector<double>{NAN}).ticks.empty());
  const SweepAxis words = axisOfWords(SweepFactor{"sky", "", {"clear", "überall bewölkt"}}, 14);
  EXPECT_EQ(words.place(1.0), 0.75);
  EXPECT_EQ(words.ticks[0].label, "clear");
  EXPECT_EQ(words.ticks[1].label, "überal…");
}

}  // namespace
}  // namespace pitviper::test
