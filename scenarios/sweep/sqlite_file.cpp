#include "scenarios/sweep/sqlite_file.hpp"

#include <sqlite3.h>

#include <cerrno>
#include <cmath>
#include <new>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

SqliteFile::SqliteFile(const std::filesystem::path& file, bool mayMake, std::chrono::milliseconds patience) : path_(file) {
  std::error_code failure;
  // SQLite would wait for ever at a pipe. An absolute path is never one of its own names (":memory:").
  if (std::filesystem::exists(file, failure) && !std::filesystem::is_regular_file(file, failure))
    throw OutputError(file, "exists and is not a regular file", 0, "choose another name");
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(std::filesystem::absolute(file).c_str(), &opened,
                                   SQLITE_OPEN_READWRITE | SQLITE_OPEN_EXRESCODE | SQLITE_OPEN_FULLMUTEX | (mayMake ? SQLITE_OPEN_CREATE : 0), nullptr);
  database_.reset(opened);
  if (!opened) throw std::bad_alloc();
  // Where a file may not be made SQLite tries to read it, and misses it.
  if (code != SQLITE_OK && sqlite3_system_errno(opened) == ENOENT && std::filesystem::exists(std::filesystem::absolute(file).parent_path(), failure))
    throw OutputError(file, "cannot make the file", EACCES);
  if (code != SQLITE_OK) refuse(code);
  sqlite3_busy_timeout(opened, static_cast<int>(patience.count()));
  // A file from elsewhere brings no functions of its own.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

void SqliteFile::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

void SqliteFile::run(const std::string& sql) {
  if (const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr); code != SQLITE_OK) refuse(code);
}

void SqliteFile::refuseDamaged(const std::string& how) const {
  throw UserError({path_.string(), 0, 0, -1}, "the database is damaged (" + how + ")", "what a sweep has stored",
                  "put a copy of it here, or remove it and run the sweep anew; `sqlite3 FILE .recover` shows what is left in it");
}

void SqliteFile::refuse(int code) const {
  int cause = sqlite3_system_errno(handle());
  // Of what failed when a transaction ended only the file itself knows the reason.
  if (cause == 0) sqlite3_file_control(handle(), "main", SQLITE_FCNTL_LAST_ERRNO, &cause);
  switch (code & 0xff) {
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    case SQLITE_NOTADB:
      throw UserError({path_.string(), 0, 0, -1}, "is no SQLite database", "a file that a sweep has made, or none", "give another name, or remove it");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL:
      throw OutputError(path_, "another process keeps the file locked", 0,
                        "end what else has it open and go on; on a network disk without locks give each process a part of its own on its own disk");
    case SQLITE_FULL:
      throw OutputError(path_, "cannot store the results", ENOSPC);
    case SQLITE_READONLY:
      if (code == SQLITE_READONLY_DBMOVED) throw OutputError(path_, "was moved or removed meanwhile", 0, "let it stay where it is, and go on");
      throw OutputError(path_, "cannot write the file or its folder", EACCES);
    case SQLITE_CANTOPEN:
      throw OutputError(path_, "cannot open the file, or what SQLite keeps beside it", cause != 0 ? cause : EACCES);
    case SQLITE_IOERR:
      throw OutputError(path_, "cannot read or write the file (SQLite's error " + std::to_string(code) + ")", cause != 0 ? cause : EIO);
    case SQLITE_PERM:
    case SQLITE_AUTH:
      throw OutputError(path_, "cannot open the file", EACCES);
    default:
      refuseDamaged(sqlite3_errmsg(handle()));
  }
}

SqliteStatement::SqliteStatement(SqliteFile& file, const std::string& sql) : file_(file) {
  sqlite3_stmt* made = nullptr;
  const int code = sqlite3_prepare_v2(file.handle(), sql.c_str(), static_cast<int>(sql.size()), &made, nullptr);
  statement_.reset(made);
  check(code);
}

void SqliteStatement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void SqliteStatement::check(int code) const {
  if (code != SQLITE_OK) file_.refuse(code);
}

void SqliteStatement::bind(int place, long long value) { check(sqlite3_bind_int64(statement_.get(), place, value)); }

void SqliteStatement::bind(int place, double value) {
  check(std::isnan(value) ? sqlite3_bind_null(statement_.get(), place) : sqlite3_bind_double(statement_.get(), place, value));
}

void SqliteStatement::bind(int place, const std::string& value) {
  check(sqlite3_bind_text64(statement_.get(), place, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  sqlite3_reset(statement_.get());  // gives its locks back
  file_.refuse(code);
}

void SqliteStatement::reset() {
  check(sqlite3_reset(statement_.get()));
  sqlite3_clear_bindings(statement_.get());
}

long long SqliteStatement::integer(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) file_.refuseDamaged("no whole number where one is due");
  return sqlite3_column_int64(statement_.get(), column);
}

double SqliteStatement::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_NULL) return NAN;
  if (type != SQLITE_FLOAT) file_.refuseDamaged("no number where one is due");
  return sqlite3_column_double(statement_.get(), column);
}

std::string SqliteStatement::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) file_.refuseDamaged("no text where one is due");
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  if (!text) throw std::bad_alloc();
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

SqliteTransaction::SqliteTransaction(SqliteFile& file, bool writes) : file_(file) { file_.run(writes ? "BEGIN IMMEDIATE" : "BEGIN"); }

SqliteTransaction::~SqliteTransaction() {
  if (sqlite3_get_autocommit(file_.handle()) == 0) sqlite3_exec(file_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqliteTransaction::keep() { file_.run("COMMIT"); }

std::string quotedName(const std::string& name) {
  std::string quoted = "\"";
  for (char c : name) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace pitviper
