// Results of sweeps in their file: nothing that was stored is lost or there twice, and what is no such file is refused.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>

#include "scenarios/sweep/sweep_csv.hpp"
#include "scenarios/sweep/sweep_store.hpp"
#include "sim/image/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

using std::chrono::milliseconds;

SweepIdentity aStoredSweep(int samples) {
  SweepIdentity s{"hot days", "5a1e", "jet.yaml", "1.0", samples, {}, {}};
  s.factors = {{"distance", "km"}, {"haze \"thick\"", "", {"none", "rural, thin", "fog"}}, {"tilt", ""}};
  Measure range, python;
  range.names = {"range"}, range.units = {"m"};
  python.names = {"snr", "it's <odd>"};
  s.measures = {range, python};
  return s;
}

/// The same for a number, whoever makes it; every tenth failed, every seventh lacks a measure.
SweepRow storedRow(int sample) {
  std::mt19937_64 random(static_cast<unsigned>(sample));
  const auto number = [&] { return std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 100); };
  SweepRow r{sample, random(), {number(), static_cast<double>(random() % 3), -number()}, {number(), -number(), number()}, ""};
  if (sample % 7 == 3) r.measures[1] = NAN;
  if (sample % 10 == 4) r.measures.clear(), r.why = "no sun, \"" + std::to_string(sample) + "\"";
  return r;
}

std::string csvOfAll(const SweepIdentity& sweep) {
  std::vector<SweepRow> rows;
  for (int i = sweep.samples - 1; i >= 0; --i) rows.push_back(storedRow(i));
  return csvOf(sweep, rows);
}

template <class Error>
std::string refusalBy(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "nothing was refused";
}

bool saidIn(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

/// Exit status of what a process of its own did; 99 where it threw.
int endOfProcess(pid_t child) {
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

pid_t inAnotherProcess(const std::function<void()>& act) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    act();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    ::_exit(99);
  }
  ::_exit(0);
}

TEST(SweepStore, NumbersComeBackToTheBit) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(4);
  const std::vector<double> odd{-0.0, 5e-324, std::numeric_limits<double>::max(), INFINITY, -INFINITY, 0.1, 3.0, -9007199254740993.0, NAN};
  std::vector<SweepRow> put;
  for (int i = 0; i < 3; ++i) {
    const std::size_t k = static_cast<std::size_t>(3 * i);
    put.push_back({i, std::numeric_limits<std::uint64_t>::max() - static_cast<unsigned>(i), {odd[k], 2.0 - i, 1.0}, {odd[k], odd[k + 1], odd[k + 2]}, ""});
  }
  put.push_back({3, 0, {1.0, 1.0, 1.0}, {NAN, NAN, NAN}, "Sun's\nbelow; ü"});
  {
    SweepStore store(folder.path() / "s.db", sweep);
    for (int i : {2, 0, 3, 1}) store.put(put[static_cast<std::size_t>(i)]);
  }
  const SweepStore store(folder.path() / "s.db", sweep);
  const std::vector<SweepRow> rows = store.rows();
  ASSERT_EQ(rows.size(), put.size());
  for (std::size_t i = 0; i < put.size(); ++i) {
    EXPECT_EQ(rows[i].seed, put[i].seed);
    EXPECT_EQ(rows[i].why, put[i].why);
    EXPECT_EQ(rows[i].factors, put[i].factors);
    for (std::size_t m = 0; m < 3; ++m) {
      if (std::isnan(put[i].measures[m])) EXPECT_TRUE(std::isnan(rows[i].measures[m]));
      else EXPECT_EQ(std::bit_cast<std::uint64_t>(rows[i].measures[m]), std::bit_cast<std::uint64_t>(put[i].measures[m])) << put[i].measures[m];
    }
    EXPECT_EQ(csvOf(sweep, {store.row(static_cast<int>(i))}), csvOf(sweep, {put[i]}));
  }
}

TEST(SweepStore, TheFirstOfASampleStays) {
  const TemporaryFolder folder;
  SweepStore store(folder.path() / "s.db", aStoredSweep(8));
  for (int i : {3, 4, 3, 4}) store.put(storedRow(i));
  EXPECT_EQ(store.done(), (std::vector<char>{0, 0, 0, 1, 1, 0, 0, 0}));
  SweepRow other = storedRow(3);
  other.measures[2] = std::nextafter(other.measures[2], 0.0);
  EXPECT_THROW(store.put(other), std::logic_error);
  other = storedRow(4), other.why = "another";
  EXPECT_THROW(store.put(other), std::logic_error);
  // Of many rows none, where one is refused.
  EXPECT_THROW(store.put({storedRow(5), other}), std::logic_error);
  EXPECT_EQ(csvOf(aStoredSweep(8), store.rows()), csvOf(aStoredSweep(8), {storedRow(4), storedRow(3)}));
  EXPECT_THROW(store.row(5), std::out_of_range);
  EXPECT_THROW(store.put(storedRow(8)), std::invalid_argument) << "the sweep has 8";
}

TEST(SweepStore, TwoProcessesPutAtOnce) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(20);
  std::vector<pid_t> children;
  for (int p = 0; p < 2; ++p)
    children.push_back(inAnotherProcess([&] {
      SweepStore store(folder.path() / "s.db", sweep);  // both make it, too
      // Six samples are drawn by both.
      for (int i = p == 0 ? 0 : 7; i < (p == 0 ? 13 : 20); ++i) store.put(storedRow(i));
    }));
  for (pid_t child : children) EXPECT_EQ(endOfProcess(child), 0);
  EXPECT_EQ(csvOf(sweep, SweepStore(folder.path() / "s.db", sweep).rows()), csvOfAll(sweep));
}

// A killed process has lost nothing that put() returned from, and who goes on finds each sample once.
TEST(SweepStore, KilledAnywhereItGoesOn) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(40);
  const auto file = folder.path() / "s.db";
  std::mt19937 random(7);
  std::vector<char> told(40, 0);
  int kills = 0;
  for (bool ended = false; !ended; ++kills) {
    int way[2];
    ASSERT_EQ(::pipe(way), 0);
    const pid_t child = inAnotherProcess([&] {
      ::close(way[0]);
      SweepStore store(file, sweep);
      const std::vector<char> done = store.done();
      for (int i = 0; i < sweep.samples; ++i) {
        if (done[static_cast<std::size_t>(i)]) continue;
        store.put(storedRow(i));
        const char number = static_cast<char>(i);
        if (::write(way[1], &number, 1) != 1) ::_exit(1);
      }
    });
    ::close(way[1]);
    // Longer each time: a busy disk takes its time for each sample.
    ::usleep(static_cast<useconds_t>(1000 + random() % static_cast<unsigned>(4000 + 1000 * kills)));
    ::kill(child, SIGKILL);
    const int status = endOfProcess(child);
    ASSERT_TRUE(status == 0 || status == -SIGKILL) << status;
    ended = status == 0;
    for (char number; ::read(way[0], &number, 1) == 1;) ++told[static_cast<std::size_t>(number)];
    ::close(way[0]);
    const std::vector<char> done = SweepStore(file, sweep).done();
    for (std::size_t i = 0; i < done.size(); ++i) ASSERT_TRUE(done[i] || !told[i]) << "sample " << i << " was lost";
  }
  EXPECT_GT(kills, 1) << "no process was killed";
  EXPECT_LE(*std::max_element(told.begin(), told.end()), 1) << "a sample was drawn again";
  EXPECT_EQ(csvOf(sweep, SweepStore(file, sweep).rows()), csvOfAll(sweep));
}

TEST(SweepStore, AnotherSweepsFileIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.db";
  const SweepIdentity sweep = aStoredSweep(8);
  SweepStore(file, sweep).put(storedRow(1));
  const auto said = [&](const std::function<void(SweepIdentity&)>& change) {
    SweepIdentity other = sweep;
    change(other);
    const std::string text = refusalBy<UserError>([&] { SweepStore(file, other); });
    EXPECT_TRUE(saidIn(text, file.string())) << text;
    EXPECT_TRUE(saidIn(text, "; fix: ")) << text;
    return text;
  };
  EXPECT_TRUE(saidIn(said([](auto& s) { s.name = "cold days"; }), "its name is 'hot days', not 'cold days'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.sha256 = "77"; }), "have changed since"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.scenario = "sea.yaml"; }), "its scenario is 'jet.yaml'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.version = "1.1"; }), "its version is '1.0'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.samples = 9; }), "its number of samples is '8', not '9'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[0].name = "height"; }), "the factor 'distance' where this one has the factor 'height'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[0].unit = "m"; }), "in 'km', not in 'm'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[1].choices.pop_back(); }), "other choices"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors.pop_back(); }), "'tilt' where this one has the measure 'range'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.measures.pop_back(); }), "'snr' is none of this one's"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.measures[1].names.push_back("more"); }), "lacks the measure 'more'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.measures[0].units[0] = "km"; }), "'range' is in 'm', not in 'km'"));
  EXPECT_EQ(SweepStore(file, sweep).rows().size(), 1u);
  // A database of something else, and one of which a table was changed by hand.
  SqliteFile(folder.path() / "other.db", true, milliseconds(10)).run("CREATE TABLE birds(name)");
  EXPECT_TRUE(saidIn(refusalBy<UserError>([&] { SweepStore(folder.path() / "other.db", sweep); }), "other.db: is a database of something else"));
  SqliteFile(file, false, milliseconds(10)).run("ALTER TABLE samples ADD COLUMN more");
  EXPECT_TRUE(saidIn(refusalBy<UserError>([&] { SweepStore(file, sweep); }), "is damaged (the table 'samples' was changed)"));
}

TEST(SweepStore, UnitsAreLearntLater) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(8);
  SweepStore store(folder.path() / "s.db", sweep);
  store.learnUnits({"", "", "K"});
  store.learnUnits({"m", "", "K"});
  EXPECT_TRUE(saidIn(refusalBy<UserError>([&] { store.learnUnits({"", "", "degC"}); }), "in 'K', not in 'degC'"));
  const std::string csv = csvOf(SweepStore(folder.path() / "s.db", sweep).identity(), {});
  EXPECT_EQ(csv, "sample,seed,distance [km],\"haze \"\"thick\"\"\",tilt [1],range [m],snr [1],it's <odd> [K],why\n");
}

TEST(SweepStore, NamesThatMakeNoTable) {
  const TemporaryFolder folder;
  const auto said = [&](const std::function<void(SweepIdentity&)>& change) {
    SweepIdentity sweep = aStoredSweep(8);
    change(sweep);
    const std::string text = refusalBy<UserError>([&] { SweepStore(folder.path() / "s.db", sweep); });
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "s.db"));
    return text;
  };
  EXPECT_TRUE(saidIn(said([](auto& s) {
                       s.measures[1].names[0] = "Distance", s.measures[1].where = {"sweep.yaml", 12, 3, -1};
                     }),
                     "sweep.yaml:12:3: two columns of the results would be named 'Distance'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[0].name = "why"; }), "named 'why'"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[0].name = "a\nb"; }), "control character"));
  EXPECT_TRUE(saidIn(said([](auto& s) { s.factors[1].choices[2] = "none"; }), "a choice twice"));
  EXPECT_TRUE(saidIn(said([](auto& s) {
                       for (int i = 0; i < 2000; ++i) s.factors.push_back({"f" + std::to_string(i), ""});
                     }),
                     "1900 at most"));
}

std::string bytesOfFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Whatever is in a file, it is read or refused in a line that names it.
TEST(SweepStore, DamageIsRefused) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(60);
  std::vector<SweepRow> rows;
  for (int i = 0; i < 60; ++i) rows.push_back(storedRow(i));
  SweepStore(folder.path() / "whole.db", sweep).put(rows);
  const std::string whole = bytesOfFile(folder.path() / "whole.db"), wanted = csvOfAll(sweep);
  // "": read as it was.
  const auto saidOf = [&](const std::string& bytes) -> std::string {
    const std::string file = folder.put("damaged.db", bytes);
    try {
      return csvOf(sweep, SweepStore::existing(file, sweep, milliseconds(10)).rows()) == wanted ? "" : "other numbers";
    } catch (const UserError& e) {
      EXPECT_TRUE(saidIn(e.what(), file)) << e.what();
      EXPECT_TRUE(saidIn(e.what(), "; fix: ")) << e.what();
      return e.what();
    }
  };
  EXPECT_EQ(saidOf(whole), "");
  EXPECT_TRUE(saidIn(saidOf(""), "holds nothing yet"));
  for (std::size_t size = 1; size < whole.size(); size += 509) EXPECT_NE(saidOf(whole.substr(0, size)), "") << size << " bytes";
  std::mt19937 random(3);
  std::string noise(20000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  EXPECT_TRUE(saidIn(saidOf(noise), "is no SQLite database"));
  EXPECT_TRUE(saidIn(saidOf("sample,seed\n1,2\n"), "is no SQLite database"));
  // Zeros over a page, and bytes here and there: these may hit a number, or nothing that is used.
  int refused = 0;
  for (std::size_t page = 0; page + 4096 <= whole.size(); page += 4096) EXPECT_NE(saidOf(std::string(whole).replace(page, 4096, 4096, '\0')), "");
  for (int k = 0; k < 150; ++k) {
    std::string bytes = whole;
    for (int n = 0; n < 20; ++n) bytes[random() % bytes.size()] = static_cast<char>(random());
    const std::string said = saidOf(bytes);
    refused += said != "" && said != "other numbers";
  }
  EXPECT_GT(refused, 50);
}

TEST(SweepStore, SevenPartsAreOneRun) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(60);
  std::vector<std::filesystem::path> parts;
  for (int p = 0; p < 7; ++p) {
    parts.push_back(folder.path() / ("part" + std::to_string(p) + ".db"));
    std::vector<SweepRow> rows;
    for (int i = p; i < 60; i += 7) rows.push_back(storedRow(i));
    if (p == 2) rows.push_back(storedRow(0));  // drawn by two
    SweepStore(parts.back(), sweep).put(rows);
  }
  SweepStore(parts[5], sweep).learnUnits({"", "dB", ""});
  const auto into = folder.path() / "all.db";
  mergeStores(into, sweep, {parts[6], parts[1], parts[2]});
  mergeStores(into, sweep, parts);
  SweepIdentity told = sweep;
  setMeasureUnits(told, {"", "dB", ""});
  const SweepStore store(into, sweep);
  EXPECT_EQ(csvOf(store.identity(), store.rows()), csvOfAll(told));

  const auto refused = [&](const std::filesystem::path& part) {
    std::vector<std::filesystem::path> all = parts;
    all[3] = part;
    const std::string text = refusalBy<UserError>([&] { mergeStores(folder.path() / "none.db", sweep, all); });
    EXPECT_TRUE(saidIn(text, part.string())) << text;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "none.db"));
    return text;
  };
  EXPECT_TRUE(saidIn(refused(folder.path() / "lost.db"), "there is no such file"));
  EXPECT_TRUE(saidIn(refused(folder.put("cut.db", bytesOfFile(parts[3]).substr(0, 9000))), "is damaged"));
  SweepIdentity other = sweep;
  other.name = "cold days";
  SweepStore(folder.path() / "other.db", other).put(storedRow(3));
  EXPECT_TRUE(saidIn(refused(folder.path() / "other.db"), "another sweep"));
  SweepRow changed = storedRow(6);
  changed.measures[0] += 1.0;
  SweepStore(folder.path() / "changed.db", sweep).put(changed);
  EXPECT_TRUE(saidIn(refused(folder.path() / "changed.db"), "sample 6"));
}

TEST(SweepStore, WhatTheMachineCannotStoreIsSaid) {
  const TemporaryFolder folder;
  const SweepIdentity sweep = aStoredSweep(60);
  EXPECT_TRUE(saidIn(refusalBy<OutputError>([&] { SweepStore(folder.path() / "no" / "s.db", sweep); }), "create the folder first"));
  EXPECT_TRUE(saidIn(refusalBy<OutputError>([&] { SweepStore(folder.path(), sweep); }), "not a regular file"));
  const auto file = folder.path() / "s.db";
  SweepStore store(file, sweep, milliseconds(30));
  store.put(storedRow(0));
  {
    SqliteFile another(file, false, milliseconds(10));
    const SqliteTransaction writing(another, true);
    EXPECT_TRUE(saidIn(refusalBy<OutputError>([&] { store.put(storedRow(1)); }), "another process keeps the file locked"));
  }
  store.put(storedRow(1));
  // A disk that takes no more, as the limit of a file's size makes it.
  const pid_t child = inAnotherProcess([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlim_t size = std::filesystem::file_size(file);
    const rlimit limit{size, size};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    SweepStore full(file, sweep);
    for (int i = 0; i < 60; i += 10) {
      std::vector<SweepRow> some;
      for (int k = i; k < i + 10; ++k) some.push_back(storedRow(k));
      const std::string said = refusalBy<OutputError>([&] { full.put(some); });
      if (saidIn(said, "raise the file size limit")) ::_exit(full.rows().size() < 60u ? 7 : 8);
    }
  });
  EXPECT_EQ(endOfProcess(child), 7);
  const std::size_t kept = store.rows().size();
  EXPECT_GT(kept, 2u);
  std::vector<SweepRow> all;
  for (int i = 0; i < 60; ++i) all.push_back(storedRow(i));
  store.put(all);
  EXPECT_EQ(csvOf(sweep, store.rows()), csvOfAll(sweep));
  // Where it was removed meanwhile a sample would go nowhere.
  SweepStore lost(folder.path() / "lost.db", sweep);
  std::filesystem::remove(folder.path() / "lost.db");
  EXPECT_TRUE(saidIn(refusalBy<OutputError>([&] { lost.put(storedRow(3)); }), "was moved or removed meanwhile"));
}

TEST(SweepCsv, NumbersAndWords) {
  const SweepIdentity sweep = aStoredSweep(4);
  const std::vector<SweepRow> rows{{2, 18446744073709551615u, {0.1, 1.0, -0.0}, {100000.0, NAN, INFINITY}, ""},
                                   {0, 7, {1e-7, 0.0, 1e300}, {}, "no \"sun\", no moon"}};
  EXPECT_EQ(csvOf(sweep, rows),
            "sample,seed,distance [km],\"haze \"\"thick\"\"\",tilt [1],range [m],snr [1],it's <odd> [1],why\n"
            "0,7,1e-07,none,1e+300,,,,\"no \"\"sun\"\", no moon\"\n"
            "2,18446744073709551615,0.1,\"rural, thin\",-0,100000,,inf,\n");
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    const double v = std::bit_cast<double>(random());
    if (std::isnan(v)) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(numberThatReadsBack(v).c_str(), nullptr)), std::bit_cast<std::uint64_t>(v));
  }
}

}  // namespace
}  // namespace pitviper::test
