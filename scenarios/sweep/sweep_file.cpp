#include "scenarios/sweep/sweep_file.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "scenarios/sweep/factor_reader.hpp"
#include "scenarios/sweep/measure_reader.hpp"
#include "scenarios/sweep/sweep_draw.hpp"
#include "scenarios/sweep/yaml_line.hpp"
#include "sim/parameters/available_memory.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kMostFactors = 256;
/// Of what is left; the pictures need some as well.
constexpr double kShareOfMemory = 0.5;
constexpr std::uintmax_t kMostPythonBytes = 16u << 20;

const ParameterTable& sweepTable() {
  static const ParameterTable t{
      "sweep",
      "A file of its own, for `pitviper sweep`: a scenario drawn again and again with some of its keys at other values.",
      {required(text("sweep", "short name, for files and columns", &Sweep::name)),
       required(text("scenario", "file that is drawn, found from this file's folder")),
       withDefault(integer("seed", "of the design, and of each sample's own seed", 0, 9007199254740991LL, &Sweep::seed), "1"),
       integer("samples", "number of samples; of sobol_indices N, of which N (d + 2) are drawn with d factors; not of a grid or a table", 1, kMostSamples),
       withDefault(choice("design",
                          {{"random", Design::Random},
                           {"latin_hypercube", Design::LatinHypercube},
                           {"sobol", Design::Sobol},
                           {"sobol_indices", Design::SobolIndices},
                           {"grid", Design::Grid},
                           {"table", Design::Table}},
                          "independent points; one in each N-th of every factor; Sobol's sequence, balanced at powers of two; what variance-based indices are "
                          "worked out from (Saltelli 2010), balanced as well; all combinations; rows of a file",
                          &Sweep::kind),
                   "random"),
       text("table", "CSV file of `design: table`: a column `name [unit]` for each factor, further ones are not read"),
       withDefault(integer("frame", "number of the frame that is drawn", 0, 9999999, &Sweep::frame), "0"), required(list("vary", "factors", 1, kMostFactors)),
       map("set", "path: value, as of --set; `= expression` and `$name` by factors, within lists and maps too"),
       list("constraints",
            "comparisons of two expressions, `$range < 3 * $visibility`: of samples that break one others are drawn (random), or none (all else; "
            "sobol_indices has no constraints)",
            1, 256),
       list("measures",
            "what is taken of each picture; besides `predicted_error`, the largest that a plan expects of it, and `outside_limits`, 1 where it shows what "
            "plans were not made for",
            1, 1024),
       list("sinks", "where frames go, as of scenarios", 1, 64),
       withDefault(
           boolean("keep_frames", "each sample's frames stay in FOLDER/frames; with sinks, which are made of them, they do in any case", &Sweep::keepsFrames),
           "false")}};
  return t;
}

/// Two paths of which one is the other, or within it: what holds would be a matter of order.
void refuseNestedPaths(const std::map<std::string, Location>& places, const std::string& path, const Location& where) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1))
    if (const auto found = places.find(path.substr(0, dot)); found != places.end())
      throw UserError(where, "'" + path + "' is within '" + found->first + "', which is set too (" + found->second.text() + ")", "each key set once",
                      "write both into one value");
}

void checkPath(const std::string& path, const Location& where) {
  const bool empty = path.empty() || path.front() == '.' || path.back() == '.' || path.find("..") != std::string::npos;
  if (empty || path.find('=') != std::string::npos)
    throw UserError(where, "'" + readable(path.substr(0, 60)) + "' is no path", "keys, list numbers from 0, or names, joined by dots",
                    "write 'entities.jet.temperature'");
}

class SweepReader {
 public:
  explicit SweepReader(const std::filesystem::path& file) : file_(file), base_(file.parent_path()) {}

  Sweep read() {
    const Value tree = loadYaml(file_, {file_.string(), 0, 0, -1}, &sweep_.text);
    sweep_.file = file_.string();
    const Record r(tree, sweepTable());
    r.fill(sweep_);
    if (sweep_.name.find_first_of("/\n\t") != std::string::npos || sweep_.name == "." || sweep_.name == "..")
      throw UserError(r.where("sweep"), "a sweep cannot be called " + tokenOf(sweep_.name), "a name that a file can have", "write it in one line without '/'");
    readScenarioName(r);
    readFactors(r.value("vary"));
    readSets(r);
    refuseUnused();
    if (const Value* constraints = r.find("constraints")) readConstraints(*constraints);
    if (const Value* measures = r.find("measures")) readMeasures(*measures);
    Measure expected;
    expected.kind = Measure::Kind::Expected;
    expected.names = {"predicted_error", "outside_limits"};
    expected.units = {"1", "1"};
    sweep_.measures.push_back(std::move(expected));
    if (const Value* sinks = r.find("sinks")) sweep_.sinks = *sinks;
    makeDesign(r);
    sweep_.sha256 = sha256(sweep_.text);
    sweep_.draw = std::make_shared<const SweepDraw>(std::move(plan_));
    drawAll(*sweep_.draw, r);
    return std::move(sweep_);
  }

 private:
  void readScenarioName(const Record& r) {
    sweep_.scenario = base_ / r.text("scenario");
    if (!std::filesystem::is_regular_file(sweep_.scenario))
      throw UserError(r.where("scenario"), "there is no file '" + readable(sweep_.scenario.string()) + "'", "a scenario",
                      "check the name; it is found from the sweep's folder");
  }

  void readFactors(const Value& vary) {
    std::map<std::string, Location> names;
    for (const Value& entry : vary.items) {
      WrittenFactor f = readFactor(entry, sweep_.kind);
      if (const auto [first, isNew] = names.emplace(f.factor.name, f.where); !isNew)
        throw UserError(f.where, "two factors are called '" + f.factor.name + "' (" + first->second.text() + ")", "a name of its own for each",
                        "write 'name: " + f.factor.name + "_2'");
      sweep_.factors.push_back(f.factor);
      if (f.distribution) plan_.distributions.push_back(*f.distribution);
      written_.push_back(std::move(f));
    }
  }

  void addPath(const std::string& path, const Location& where) {
    checkPath(path, where);
    if (const auto [first, isNew] = paths_.emplace(path, where); !isNew)
      throw UserError(where, "'" + path + "' is set twice (" + first->second.text() + ")", "each key set once", "remove one of the two");
  }

  /// Keys of factors and `set`: what no factor changes is of all samples.
  void readSets(const Record& r) {
    for (const WrittenFactor& f : written_) {
      if (f.key.empty()) continue;
      addPath(f.key, f.keyPlace);
      Value value;
      value.kind = Value::Kind::Scalar;
      value.where = f.keyPlace;
      value.text = "$" + f.factor.name;
      used_.insert(f.factor.name);
      plan_.sets.emplace_back(f.key, std::move(value));
    }
    if (const Value* set = r.find("set"))
      for (std::size_t k = 0; k < set->entries.size(); ++k) {
        const auto& [path, value] = set->entries[k];
        addPath(path, set->keyPlaces[k]);
        const std::set<std::string> names = factorsIn(value, sweep_.factors);
        used_.insert(names.begin(), names.end());
        if (names.empty()) sweep_.sets.push_back(path + "=" + yamlLine(workedOut(value, {sweep_.factors, {}})));
        else plan_.sets.emplace_back(path, value);
      }
    for (const auto& [path, where] : paths_) refuseNestedPaths(paths_, path, where);
  }

  void refuseUnused() const {
    for (const WrittenFactor& f : written_)
      if (used_.count(f.factor.name) == 0)
        throw UserError(f.where, "nothing uses the factor '" + f.factor.name + "'", "a 'key' that it is for, or '$" + f.factor.name + "' under 'set'",
                        "write 'key: entities.jet.temperature', or remove it");
  }

  void readConstraints(const Value& constraints) {
    if (sweep_.kind == Design::SobolIndices)
      throw UserError(constraints.where, "constraints of the design sobol_indices, whose samples belong together", "none",
                      "write 'design: random', or choose factors that need none");
    for (const Value& c : constraints.items) plan_.constraints.push_back(readConstraint(c, sweep_.factors));
  }

  void readMeasures(const Value& measures) {
    std::map<std::string, Location> names;
    for (const WrittenFactor& f : written_) names.emplace(f.factor.name, f.where);
    std::set<std::filesystem::path> files;
    for (const Value& entry : measures.items) {
      sweep_.measures.push_back(readMeasure(entry, base_));
      const Measure& m = sweep_.measures.back();
      for (const std::string& name : m.names)
        if (const auto [first, isNew] = names.emplace(name, m.where); !isNew)
          throw UserError(m.where, "two columns are called '" + name + "' (" + first->second.text() + ")", "a name of its own for each", "write another name");
      if (m.kind == Measure::Kind::Python && files.insert(m.file).second)
        addHash(entry.find("python")->text, {.what = "a file of Python", .mostBytes = kMostPythonBytes}, m.where);
    }
  }

  /// `name`: as written, so that the text is the same wherever the sweep is called from.
  void addHash(const std::string& name, const FileWanted& wanted, const Location& askedAt) {
    sweep_.text += "\n--file " + name + " " + sha256(readWholeFile(base_ / name, wanted, askedAt));
  }

  void makeDesign(const Record& r) {
    const Design kind = sweep_.kind;
    const bool table = kind == Design::Table, grid = kind == Design::Grid;
    if (r.given("table") != table)
      throw UserError(r.where(table ? "design" : "table"), table ? "the design is a table, and none is named" : "a table beside another design",
                      "'design: table' and 'table: FILE.csv' together", table ? "write 'table: points.csv'" : "write 'design: table', or remove it");
    if (r.given("samples") == (table || grid))
      throw UserError(table || grid ? r.where("samples") : r.where(),
                      table  ? "samples of a table, whose rows they are"
                      : grid ? "samples of a grid, which has all combinations"
                             : "missing key 'samples' in sweep",
                      table || grid ? "no 'samples'" : "the number of samples", table || grid ? "remove it" : "add 'samples: 1000' here");
    plan_.seed = static_cast<std::uint64_t>(sweep_.seed);
    plan_.factors = sweep_.factors;
    plan_.drawnAgain = kind == Design::Random;
    if (table) readTable(r);
    else if (grid) makeGrid(r);
    else makeCube(r);
  }

  void makeGrid(const Record& r) {
    std::vector<int> levels;
    double size = 1.0;
    for (const Distribution& d : plan_.distributions) {
      levels.push_back(d.levels());
      size *= levels.back();
      if (size > static_cast<double>(kMostSamples))
        throw UserError(r.where("vary"), "a grid of more than 10 million combinations", "at most that many", "give the factors fewer values");
    }
    plan_.design = std::make_unique<const SampleDesign>(levels);
  }

  void makeCube(const Record& r) {
    const long long samples = r.integer("samples");
    const std::size_t d = sweep_.factors.size();
    if (sweep_.kind == Design::SobolIndices && samples * (static_cast<long long>(d) + 2) > kMostSamples)
      throw UserError(r.where("samples"), print("%lld samples of %zu factors are %lld pictures", samples, d, samples * (static_cast<long long>(d) + 2)),
                      "at most 10 million", "write fewer");
    double perSample_bytes = sizeof(Sample) + sizeof(double) * static_cast<double>(d);
    if (sweep_.kind == Design::LatinHypercube) perSample_bytes += sizeof(std::uint32_t) * static_cast<double>(d);
    refuseBeyondMemory(perSample_bytes, samples, r);
    plan_.design = std::make_unique<const SampleDesign>(sweep_.kind, plan_.seed, static_cast<int>(samples), d);
  }

  void readTable(const Record& r) {
    const FileWanted wanted{.what = "a CSV file with a column for each factor", .fix = "check the name; it is found from the sweep's folder"};
    // A row as a sample, with at least one text.
    const double perRow_bytes = sizeof(Sample) + sizeof(std::string) + 16.0 * static_cast<double>(sweep_.factors.size());
    const double most = std::min(static_cast<double>(kMostSamples), kShareOfMemory * availableMemory_bytes().value_or(1e18) / perRow_bytes);
    plan_.table = readCsvTable(base_ / r.text("table"), wanted, static_cast<std::size_t>(most), r.where("table"));
    addHash(r.text("table"), wanted, r.where("table"));
    const CsvTable& t = plan_.table;
    const Location head{t.file, t.columns[0].where.line, 1, -1};
    if (t.rows() == 0) throw UserError(head, "the table has no rows", "a row for each sample", "write some under its header");
    std::vector<std::string> names;
    for (const CsvColumn& column : t.columns) {
      if (std::find(names.begin(), names.end(), column.name) != names.end())
        throw UserError(column.where, "two columns are called " + tokenOf(column.name), "a name of its own for each", "remove one of the two");
      names.push_back(column.name);
    }
    for (SweepFactor& factor : plan_.factors) {
      const auto found = std::find(names.begin(), names.end(), factor.name);
      if (found == names.end()) {
        std::vector<std::string> shown;
        for (const std::string& name : names) shown.push_back(tokenOf(name));
        throw UserError(head, "the table has no column of the factor '" + factor.name + "', but " + listed(shown), "a column '" + factor.name + " [unit]'",
                        "add it, or call the factor as its column");
      }
      const auto c = static_cast<std::size_t>(found - names.begin());
      plan_.columns.push_back(c);
      const CsvColumn& column = t.columns[c];
      factor.unit = column.unit == "1" || column.unit == "-" ? "" : column.unit;
      if (!parseUnit(factor.unit)) throw UserError(column.where, "there is no unit " + tokenOf(column.unit), "a unit such as m, km/h, 1", "correct the unit");
      if (!factor.choices.empty() && !factor.unit.empty())
        throw UserError(column.where, "places of choices in " + tokenOf(column.unit), "[1]", "write '" + factor.name + " [1]'");
    }
    sweep_.factors = plan_.factors;
  }

  void drawAll(const SweepDraw& draw, const Record& r) {
    const long long size = draw.size();
    for (int number = 0; number < size; ++number) {
      std::optional<Sample> sample = draw.sample(number);
      if (!sample) continue;
      if (sweep_.samples.empty()) {
        double perSample_bytes = sizeof(Sample) + sizeof(double) * static_cast<double>(sample->values.size());
        for (const std::string& set : sample->sets) perSample_bytes += sizeof(std::string) + static_cast<double>(set.size());
        refuseBeyondMemory(perSample_bytes, size, r);
      }
      sweep_.samples.push_back(std::move(*sample));
    }
    if (sweep_.samples.empty())
      throw UserError(r.where("constraints"), "none of the " + std::to_string(size) + " samples meets the constraints", "constraints that some of them meet",
                      "loosen them, or draw the factors from where they hold");
  }

  static void refuseBeyondMemory(double perSample_bytes, long long count, const Record& r) {
    const double bytes = perSample_bytes * static_cast<double>(count), most = kShareOfMemory * availableMemory_bytes().value_or(1e18);
    if (bytes > most)
      throw UserError(r.given("samples") ? r.where("samples") : r.where("design"), print("%lld samples take %.2g GB", count, bytes * 1e-9),
                      print("at most %.2g GB, half of the memory that is left", most * 1e-9), "draw fewer, or several sweeps of other seeds");
  }

  std::filesystem::path file_, base_;
  Sweep sweep_;
  SweepDraw::Plan plan_;
  std::vector<WrittenFactor> written_;
  std::map<std::string, Location> paths_;
  std::set<std::string> used_;
};

}  // namespace

Sweep readSweep(const std::filesystem::path& file) { return SweepReader(file).read(); }

std::string sweepKeyReference() {
  std::string text;
  for (const ParameterTable& table :
       {sweepTable(), factorTable(), normalTable(), factorGridTable(), truthMeasureTable(), statisticMeasureTable(), pythonMeasureTable()})
    text += "\n" + describe(table);
  return text;
}

}  // namespace pitviper
