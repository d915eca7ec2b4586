#pragma once
// A database of SQLite in one file, and what its errors mean to a user.
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace pitviper {

/// Errors of all functions: UserError where the file is no database or damaged; OutputError where the disk is full, the file or its folder cannot be read or
/// written, or another process keeps it locked for longer than `patience`.
class SqliteFile {
 public:
  /// Opens; makes an empty one where there is none and `mayMake`. Nothing is read yet.
  SqliteFile(const std::filesystem::path& file, bool mayMake, std::chrono::milliseconds patience);
  const std::filesystem::path& path() const { return path_; }
  void run(const std::string& sql);
  [[noreturn]] void refuse(int code) const;
  [[noreturn]] void refuseDamaged(const std::string& how) const;
  sqlite3* handle() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> database_;
};

class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, const std::string& sql);
  /// Places count from 1. A NaN is stored as NULL.
  void bind(int place, long long value);
  void bind(int place, double value);
  void bind(int place, const std::string& value);
  /// True: there is a row.
  bool step();
  /// For another round with other values.
  void reset();
  /// Columns count from 0. What has another type than asked for is damage; NULL is NaN.
  long long integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code) const;
  SqliteFile& file_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Undone at its end unless kept.
class SqliteTransaction {
 public:
  /// `writes`: takes the lock for writing now, so that no two processes wait for each other.
  SqliteTransaction(SqliteFile& file, bool writes);
  ~SqliteTransaction();
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void keep();

 private:
  SqliteFile& file_;
};

/// `name` as SQL has it.
std::string quotedName(const std::string& name);

}  // namespace pitviper
