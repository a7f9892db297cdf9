// sqlite_file.cpp: SQLite's library, restricted to reading.
#include "app/sources/containers/sqlite_file.hpp"

#include <sqlite3.h>

#include <algorithm>

#include "app/sources/containers/random_access_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kMaxValue_bytes = 1 << 29;

sqlite3_stmt* statement_of(void* pointer) { return static_cast<sqlite3_stmt*>(pointer); }

}  // namespace

std::int64_t SqliteRow::integer(int column) const {
  return sqlite3_column_int64(statement_of(statement_), column);
}
double SqliteRow::number(int column) const { return sqlite3_column_double(statement_of(statement_), column); }
std::string_view SqliteRow::bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_of(statement_), column);
  const int size = sqlite3_column_bytes(statement_of(statement_), column);
  return data ? std::string_view(static_cast<const char*>(data), static_cast<std::size_t>(size))
              : std::string_view{};
}

void SqliteFile::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

SqliteFile::SqliteFile(const std::filesystem::path& path) : name_(path.string()) {
  if (!is_sqlite(path)) throw Error(name_ + ": is not an SQLite database");
  sqlite3* database = nullptr;
  const int result = sqlite3_open_v2(name_.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
  database_.reset(database);
  if (result != SQLITE_OK) fail();
  // The database's own text must not run functions, and values are no longer than an image.
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kMaxValue_bytes);
}

void SqliteFile::fail() const {
  throw Error(name_ + ": cannot be read: " + (database_ ? sqlite3_errmsg(database_.get()) : "no memory"));
}

bool SqliteFile::has_tables(const std::vector<std::string>& names) const {
  std::vector<std::string> found;
  query("SELECT name, sql FROM sqlite_master WHERE type = 'table'", {}, [&](const SqliteRow& row) {
    if (row.bytes(1).starts_with("CREATE TABLE")) found.emplace_back(row.bytes(0));
  });
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::find(found.begin(), found.end(), name) != found.end();
  });
}

bool SqliteFile::has_column(const std::string& table, const std::string& column) const {
  bool found = false;
  query("PRAGMA table_info(" + table + ")", {},
        [&](const SqliteRow& row) { found = found || row.bytes(1) == column; });
  return found;
}

void SqliteFile::query(const std::string& sql, const std::vector<std::int64_t>& values,
                       const std::function<void(const SqliteRow&)>& use) const {
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &prepared, nullptr) != SQLITE_OK) fail();
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(prepared, sqlite3_finalize);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (sqlite3_bind_int64(prepared, static_cast<int>(i) + 1, values[i]) != SQLITE_OK) fail();
  for (;;) {
    const int result = sqlite3_step(prepared);
    if (result == SQLITE_DONE) return;
    if (result != SQLITE_ROW) fail();
    use(SqliteRow(prepared));
  }
}

std::string SqliteFile::read_up_to(const char* table, const char* column, std::int64_t row,
                                   std::uint64_t max_bytes) const {
  sqlite3_blob* opened = nullptr;
  if (sqlite3_blob_open(database_.get(), "main", table, column, row, 0, &opened) != SQLITE_OK) fail();
  const std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob(opened, sqlite3_blob_close);
  const int size = std::clamp(sqlite3_blob_bytes(opened), 0, kMaxValue_bytes);
  std::string bytes(std::min<std::uint64_t>(static_cast<std::uint64_t>(size), max_bytes), '\0');
  if (sqlite3_blob_read(opened, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK) fail();
  return bytes;
}

bool is_sqlite(const std::filesystem::path& path) {
  return begins_with(path, std::string_view("SQLite format 3\0", 16));
}

}  // namespace roomradar
