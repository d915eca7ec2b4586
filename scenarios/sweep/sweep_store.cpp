#include "scenarios/sweep/sweep_store.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace pitviper {
namespace {

constexpr const char* kFormat = "1";

std::vector<std::pair<std::string, std::string>> keysOf(const SweepIdentity& s) {
  return {{"format", kFormat},    {"name", s.name},    {"scenario", s.scenario}, {"samples", std::to_string(s.samples)},
          {"version", s.version}, {"sha256", s.sha256}};
}

/// Tables and the text that makes them, as sqlite_schema has it. Columns of numbers have no type: SQLite's REAL forgets the sign of -0.
std::map<std::string, std::string> tablesOf(const SweepIdentity& identity) {
  std::string samples = "CREATE TABLE samples(sample INTEGER PRIMARY KEY, seed TEXT";
  for (const SweepFactor& f : identity.factors) samples += ", " + quotedName(f.name) + (f.choices.empty() ? "" : " TEXT");
  for (const MeasureColumn& c : measureColumns(identity)) samples += ", " + quotedName(c.name);
  return {{"sweep", "CREATE TABLE sweep(key TEXT PRIMARY KEY, value TEXT)"},
          {"columns", "CREATE TABLE columns(place INTEGER PRIMARY KEY, kind TEXT, name TEXT, unit TEXT, choices TEXT)"},
          {"samples", samples + ", why TEXT)"}};
}

struct StoredColumn {
  std::string kind, name, unit, choices;
};

std::vector<StoredColumn> storedColumns(const SweepIdentity& identity) {
  std::vector<StoredColumn> columns;
  for (const SweepFactor& f : identity.factors) {
    std::string words;
    for (const std::string& word : f.choices) words += word + "\n";
    columns.push_back({"factor", f.name, f.unit, words});
  }
  for (const MeasureColumn& c : measureColumns(identity)) columns.push_back({"measure", c.name, c.unit, ""});
  return columns;
}

[[noreturn]] void refuseForeign(const std::filesystem::path& file, const std::string& differs, const std::string& fix) {
  throw UserError({file.string(), 0, 0, -1}, "holds the results of another sweep: " + differs, "results of this one, or no file", fix);
}

constexpr const char* kOtherFile = "give this sweep a file of its own, or remove that one";

bool sameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (std::isnan(x) && std::isnan(y)); });
}

bool sameRow(const SweepRow& a, const SweepRow& b) {
  return a.sample == b.sample && a.seed == b.seed && a.why == b.why && sameBits(a.factors, b.factors) && sameBits(a.measures, b.measures);
}

}  // namespace

SweepStore::SweepStore(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience)
    : SweepStore(file, identity, patience, true) {}

SweepStore SweepStore::existing(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure))
    throw UserError({file.string(), 0, 0, -1}, "there is no such file", "the results of a sweep", "run the sweep, or the part, that makes it");
  return {file, identity, patience, false};
}

SweepStore::SweepStore(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience, bool mayMake)
    : file_((refuseUnfitNames(identity, file.string()), file), mayMake, patience), identity_(identity), measures_(measureColumns(identity).size()) {
  // EXTRA: what is committed outlives a power failure too.
  file_.run("PRAGMA synchronous=EXTRA");
  if (isEmpty()) {
    if (!mayMake) throw UserError({file.string(), 0, 0, -1}, "holds nothing yet", "the results of a sweep", "run the sweep, or the part, that it was begun by");
    make();
  }
  compare(mayMake);
}

bool SweepStore::isEmpty() { return !SqliteStatement(file_, "SELECT 1 FROM sqlite_schema LIMIT 1").step(); }

void SweepStore::make() {
  SqliteTransaction all(file_, true);
  if (!isEmpty()) return;  // another process was first
  for (const auto& table : tablesOf(identity_)) file_.run(table.second);
  for (const auto& [key, value] : keysOf(identity_)) {
    SqliteStatement add(file_, "INSERT INTO sweep VALUES(?, ?)");
    add.bind(1, key), add.bind(2, value);
    add.step();
  }
  long long place = 0;
  for (const StoredColumn& c : storedColumns(identity_)) {
    SqliteStatement add(file_, "INSERT INTO columns VALUES(?, ?, ?, ?, ?)");
    add.bind(1, place++), add.bind(2, c.kind), add.bind(3, c.name), add.bind(4, c.unit), add.bind(5, c.choices);
    add.step();
  }
  all.keep();
}

void SweepStore::compare(bool mayLearn) {
  {
    SqliteTransaction all(file_, false);
    std::map<std::string, std::string> made;
    for (SqliteStatement s(file_, "SELECT name, sql FROM sqlite_schema WHERE type='table'"); s.step();) made[s.text(0)] = s.text(1);
    if (!made.contains("sweep") || !made.contains("samples"))
      throw UserError({file_.path().string(), 0, 0, -1}, "is a database of something else", "a file that a sweep has made, or none", "give another name");
    SqliteStatement check(file_, "PRAGMA quick_check(1)");
    if (!check.step()) file_.refuseDamaged("it cannot be checked");
    if (const std::string found = check.text(0); found != "ok") file_.refuseDamaged(found);
    std::map<std::string, std::string> stored;
    for (SqliteStatement s(file_, "SELECT key, value FROM sweep"); s.step();) stored[s.text(0)] = s.text(1);
    for (const auto& [key, value] : keysOf(identity_)) {
      if (!stored.contains(key)) file_.refuseDamaged("the sweep's " + key + " is missing");
      const std::string &there = stored[key], both = "its " + (key == "samples" ? "number of samples" : key) + " is '" + there + "', not '" + value + "'";
      if (there == value) continue;
      if (key == "format") refuseForeign(file_.path(), both, "use the version of this program that made it");
      if (key == "version") refuseForeign(file_.path(), both, "finish it with the version that began it, or begin anew in another file");
      if (key == "sha256") refuseForeign(file_.path(), "the files of the sweep or of its scenario have changed since", kOtherFile);
      refuseForeign(file_.path(), both, kOtherFile);
    }
    compareColumns();
    for (const auto& [name, sql] : tablesOf(identity_))
      if (made[name] != sql) file_.refuseDamaged("the table '" + name + "' was changed");
    // A trigger would change what is put.
    if (SqliteStatement(file_, "SELECT 1 FROM sqlite_schema WHERE type='trigger'").step()) file_.refuseDamaged("it has a trigger");
  }
  std::vector<std::string> given;
  for (const MeasureColumn& c : measureColumns(identity_)) given.push_back(c.unit);
  if (mayLearn) learnUnits(given);
  else unitsToLearn(given);
}

void SweepStore::compareColumns() {
  const std::vector<StoredColumn> wanted = storedColumns(identity_);
  std::size_t place = 0;
  for (SqliteStatement s(file_, "SELECT kind, name, unit, choices FROM columns ORDER BY place"); s.step(); ++place) {
    const std::string name = s.text(1);
    if (place >= wanted.size()) refuseForeign(file_.path(), "its " + s.text(0) + " '" + name + "' is none of this one's", kOtherFile);
    const StoredColumn& w = wanted[place];
    if (s.text(0) != w.kind || name != w.name)
      refuseForeign(file_.path(), "it has the " + s.text(0) + " '" + name + "' where this one has the " + w.kind + " '" + w.name + "'", kOtherFile);
    if (w.kind == "factor" && s.text(2) != w.unit)
      refuseForeign(file_.path(), "its factor '" + name + "' is in '" + s.text(2) + "', not in '" + w.unit + "'", kOtherFile);
    if (s.text(3) != w.choices) refuseForeign(file_.path(), "its factor '" + name + "' has other choices", kOtherFile);
  }
  if (place < wanted.size()) refuseForeign(file_.path(), "it lacks the " + wanted[place].kind + " '" + wanted[place].name + "'", kOtherFile);
}

std::vector<std::string> SweepStore::knownUnits() const {
  std::vector<std::string> units;
  for (SqliteStatement s(file_, "SELECT unit FROM columns WHERE kind='measure' ORDER BY place"); s.step();) units.push_back(s.text(0));
  return units;
}

SweepIdentity SweepStore::identity() const {
  const std::lock_guard lock(mutex_);
  SweepIdentity known = identity_;
  setMeasureUnits(known, knownUnits());
  return known;
}

std::vector<MeasureColumn> SweepStore::unitsToLearn(const std::vector<std::string>& units) const {
  const std::vector<std::string> known = knownUnits();
  const std::vector<MeasureColumn> columns = measureColumns(identity_);
  if (units.size() != columns.size()) throw std::invalid_argument("SweepStore::learnUnits: a unit for each column");
  std::vector<MeasureColumn> news;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (units[i].empty() || units[i] == known.at(i)) continue;
    if (!known[i].empty()) refuseForeign(file_.path(), "its measure '" + columns[i].name + "' is in '" + known[i] + "', not in '" + units[i] + "'", kOtherFile);
    news.push_back({columns[i].name, units[i]});
  }
  return news;
}

void SweepStore::learnUnits(const std::vector<std::string>& units) {
  const std::lock_guard lock(mutex_);
  if (unitsToLearn(units).empty()) return;
  SqliteTransaction all(file_, true);
  for (const MeasureColumn& c : unitsToLearn(units)) {
    SqliteStatement tell(file_, "UPDATE columns SET unit=? WHERE kind='measure' AND name=?");
    tell.bind(1, c.unit), tell.bind(2, c.name);
    tell.step();
  }
  all.keep();
}

std::vector<char> SweepStore::done() const {
  const std::lock_guard lock(mutex_);
  std::vector<char> stored(static_cast<std::size_t>(identity_.samples), 0);
  for (SqliteStatement s(file_, "SELECT sample FROM samples"); s.step();) {
    const long long sample = s.integer(0);
    if (sample < 0 || sample >= identity_.samples) file_.refuseDamaged("a sample that the sweep does not have");
    stored[static_cast<std::size_t>(sample)] = 1;
  }
  return stored;
}

SweepRow SweepStore::complete(SweepRow row) const {
  if (!row.why.empty() && row.measures.empty()) row.measures.assign(measures_, NAN);
  if (row.sample < 0 || row.sample >= identity_.samples || row.factors.size() != identity_.factors.size() || row.measures.size() != measures_)
    throw std::invalid_argument("SweepStore::put: sample " + std::to_string(row.sample) + " does not fit the sweep");
  return row;
}

void SweepStore::insert(const SweepRow& row) {
  std::string places = "?, ?, ?";
  for (std::size_t i = 0; i < row.factors.size() + row.measures.size(); ++i) places += ", ?";
  SqliteStatement add(file_, "INSERT INTO samples VALUES(" + places + ") ON CONFLICT(sample) DO NOTHING RETURNING sample");
  int place = 0;
  add.bind(++place, static_cast<long long>(row.sample));
  add.bind(++place, std::to_string(row.seed));
  for (std::size_t i = 0; i < row.factors.size(); ++i) {
    const SweepFactor& f = identity_.factors[i];
    if (f.choices.empty()) add.bind(++place, row.factors[i]);
    else add.bind(++place, choiceWord(f, row.factors[i]));
  }
  for (double m : row.measures) add.bind(++place, m);
  add.bind(++place, row.why);
  bool added = false;
  while (add.step()) added = true;
  if (added) return;
  SqliteStatement there(file_, "SELECT * FROM samples WHERE sample=?");
  there.bind(1, static_cast<long long>(row.sample));
  if (!there.step() || !sameRow(read(there), row))
    throw std::logic_error(file_.path().string() + ": sample " + std::to_string(row.sample) + " is stored already, with another result");
}

void SweepStore::put(const SweepRow& row) {
  const SweepRow whole = complete(row);
  const std::lock_guard lock(mutex_);
  insert(whole);  // a statement alone is a transaction
}

void SweepStore::put(const std::vector<SweepRow>& rows) {
  const std::lock_guard lock(mutex_);
  SqliteTransaction all(file_, true);
  for (const SweepRow& r : rows) insert(complete(r));
  all.keep();
}

SweepRow SweepStore::read(const SqliteStatement& s) const {
  SweepRow row;
  int column = 0;
  const long long sample = s.integer(column++);
  if (sample < 0 || sample >= identity_.samples) file_.refuseDamaged("a sample that the sweep does not have");
  row.sample = static_cast<int>(sample);
  const std::string seed = s.text(column++);
  const auto end = seed.data() + seed.size();
  if (const auto parsed = std::from_chars(seed.data(), end, row.seed); parsed.ec != std::errc() || parsed.ptr != end)
    file_.refuseDamaged("a seed is no number");
  for (const SweepFactor& f : identity_.factors) {
    if (f.choices.empty()) {
      row.factors.push_back(s.number(column++));
      continue;
    }
    const auto word = std::find(f.choices.begin(), f.choices.end(), s.text(column++));
    if (word == f.choices.end()) file_.refuseDamaged("'" + f.name + "' has no such choice");
    row.factors.push_back(static_cast<double>(word - f.choices.begin()));
  }
  for (std::size_t i = 0; i < measures_; ++i) row.measures.push_back(s.number(column++));
  row.why = s.text(column);
  return row;
}

SweepRow SweepStore::row(int sample) const {
  const std::lock_guard lock(mutex_);
  SqliteStatement s(file_, "SELECT * FROM samples WHERE sample=?");
  s.bind(1, static_cast<long long>(sample));
  if (!s.step()) throw std::out_of_range("SweepStore::row: sample " + std::to_string(sample) + " is not stored");
  return read(s);
}

std::vector<SweepRow> SweepStore::rows() const {
  const std::lock_guard lock(mutex_);
  std::vector<SweepRow> all;
  for (SqliteStatement s(file_, "SELECT * FROM samples ORDER BY sample"); s.step();) all.push_back(read(s));
  return all;
}

void mergeStores(const std::filesystem::path& into, const SweepIdentity& identity, const std::vector<std::filesystem::path>& parts) {
  struct Found {
    SweepRow row;
    const std::filesystem::path* part;
  };
  std::map<int, Found> found;
  std::vector<std::vector<std::string>> units;
  const auto take = [&](const SweepStore& store, const std::filesystem::path& part) {
    for (SweepRow& row : store.rows()) {
      const auto [there, isNew] = found.try_emplace(row.sample, Found{row, &part});
      if (!isNew && !sameRow(there->second.row, row))
        throw UserError({part.string(), 0, 0, -1}, "its sample " + std::to_string(row.sample) + " is another than that of " + there->second.part->string(),
                        "the same result for the same sample", "merge one of the two, and draw what it lacks");
    }
    std::vector<std::string>& of = units.emplace_back();
    for (const MeasureColumn& c : measureColumns(store.identity())) of.push_back(c.unit);
  };
  for (const std::filesystem::path& part : parts) take(SweepStore::existing(part, identity), part);
  SweepStore whole(into, identity);
  take(whole, into);
  std::vector<SweepRow> rows;
  for (auto& [sample, f] : found) rows.push_back(std::move(f.row));
  for (const std::vector<std::string>& of : units) whole.learnUnits(of);
  whole.put(rows);
}

}  // namespace pitviper
