// RAII wrappers of SQLite statements and transactions that throw on errors. Private to
// lab/sweep/results/store*.cc.
#pragma once

#include <sqlite3.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace footfall::lab {

struct SqliteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class SqliteStatement {
 public:
  SqliteStatement(sqlite3* db, std::string_view sql) : db_(db) {
    if (sqlite3_prepare_v2(db, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr) !=
        SQLITE_OK) {
      throw SqliteError(sqlite3_errmsg(db));
    }
  }
  ~SqliteStatement() { sqlite3_finalize(statement_); }
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  // Binds the next `?`; after the last one call step() or run().
  SqliteStatement& bind(std::string_view text) {
    sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()),
                      SQLITE_TRANSIENT);
    return *this;
  }
  SqliteStatement& bind(double number) {
    sqlite3_bind_double(statement_, ++bound_, number);
    return *this;
  }
  SqliteStatement& bind(sqlite3_int64 number) {
    sqlite3_bind_int64(statement_, ++bound_, number);
    return *this;
  }
  SqliteStatement& bind_null() {
    sqlite3_bind_null(statement_, ++bound_);
    return *this;
  }

  // Advances to the next row; false after the last one.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) throw SqliteError(sqlite3_errmsg(db_));
    return false;
  }
  // Executes to the end and resets, so that new values can be bound.
  void run() {
    while (step()) {
    }
    sqlite3_reset(statement_);
    bound_ = 0;
  }

  std::string text(int column) const {
    const auto* bytes = sqlite3_column_text(statement_, column);
    return bytes == nullptr
               ? std::string()
               : std::string(reinterpret_cast<const char*>(bytes),  // NOLINT: as the library says
                             static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
  }
  double number(int column) const { return sqlite3_column_double(statement_, column); }
  sqlite3_int64 integer(int column) const { return sqlite3_column_int64(statement_, column); }

 private:
  sqlite3* db_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

// BEGIN in the constructor, COMMIT in commit(), else ROLLBACK in the destructor.
class SqliteTransaction {
 public:
  explicit SqliteTransaction(sqlite3* db) : db_(db) {
    SqliteStatement(db_, "BEGIN IMMEDIATE").run();
  }
  ~SqliteTransaction() {
    if (!done_) sqlite3_exec(db_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;
  void commit() {
    SqliteStatement(db_, "COMMIT").run();
    done_ = true;
  }

 private:
  sqlite3* db_;
  bool done_ = false;
};

}  // namespace footfall::lab
