#pragma once
// Results of a sweep in one file, kept sample by sample: what was stored stays, however a process ends, and is there once.
#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "scenarios/sweep/sqlite_file.hpp"
#include "scenarios/sweep/sweep_identity.hpp"

namespace pitviper {

/// A SQLite database: `samples` has a row for each sample (sample, seed, a column for each factor and measure by its name, why), `sweep` (key, value) and
/// `columns` (place, kind, name, unit, choices) say what they are of. A NaN is NULL, a choice its word; other numbers come back to the bit. Any number of
/// processes and threads may put into one file at once; a process made by fork() opens it anew.
/// It keeps the rollback journal, no write-ahead log: that one needs memory shared by all who have the file open, which machines on a network disk don't have.
/// Errors of all functions: UserError where the file is no database or damaged; OutputError where the disk is full, the file or its folder cannot be read or
/// written, or another process keeps it locked for longer than `patience`.
class SweepStore {
 public:
  /// Begins, or goes on with what is there. Errors: UserError also for another sweep's file, for names that make no table (refuseUnfitNames).
  SweepStore(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience = std::chrono::minutes(1));
  /// As it is: UserError where there is none, or nothing in it.
  static SweepStore existing(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience = std::chrono::minutes(1));

  /// The sweep, with those units of measures that are known by now.
  SweepIdentity identity() const;
  /// Units of all columns of measures, in their order; empty: not known. UserError where they are others than were known.
  void learnUnits(const std::vector<std::string>& units);

  /// By sample: 1 where it is stored, failed ones too.
  std::vector<char> done() const;
  /// On the disk when it returns. A failed sample's measures may be left out. A sample that is there already stays; std::logic_error where it is another.
  void put(const SweepRow& row);
  /// All of them, or after an error none.
  void put(const std::vector<SweepRow>& rows);
  /// As put, a failed sample's measures NaN. std::out_of_range where it is not stored.
  SweepRow row(int sample) const;
  /// All that are stored, by sample.
  std::vector<SweepRow> rows() const;

 private:
  SweepStore(const std::filesystem::path& file, const SweepIdentity& identity, std::chrono::milliseconds patience, bool mayMake);
  bool isEmpty();
  void make();
  void compare(bool mayLearn);
  void compareColumns();
  std::vector<std::string> knownUnits() const;
  /// Those that are not known. UserError where another is.
  std::vector<MeasureColumn> unitsToLearn(const std::vector<std::string>& units) const;
  SweepRow complete(SweepRow row) const;
  void insert(const SweepRow& row);
  SweepRow read(const SqliteStatement& row) const;

  mutable std::mutex mutex_;
  mutable SqliteFile file_;
  SweepIdentity identity_;
  std::size_t measures_;  ///< columns of them
};

/// Puts the rows of all `parts` into one file, all or after an error none. Parts may overlap where their rows are the same.
/// Errors: UserError that names the part that is missing, damaged, of another sweep, or has another row for a sample than another part.
void mergeStores(const std::filesystem::path& into, const SweepIdentity& identity, const std::vector<std::filesystem::path>& parts);

}  // namespace pitviper
