// sqlite_file.hpp: reads tables of an untrusted SQLite database.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;

namespace roomradar {

/// A row of a query's result. Callers read each column as the type that they expect.
class SqliteRow {
 public:
  explicit SqliteRow(void* statement) : statement_(statement) {}
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double number(int column) const;
  /// Text or bytes; empty for null. Valid until the next row.
  [[nodiscard]] std::string_view bytes(int column) const;

 private:
  void* statement_;
};

/// A database, opened for reading only. Values are limited to 512 MB. Not thread safe.
class SqliteFile {
 public:
  /// Throws Error naming the file if it is not an SQLite database.
  explicit SqliteFile(const std::filesystem::path& path);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns true if the database has tables with all these names. Views and virtual tables do not count.
  [[nodiscard]] bool has_tables(const std::vector<std::string>& names) const;
  /// Returns true if the table has the column.
  [[nodiscard]] bool has_column(const std::string& table, const std::string& column) const;
  /// Calls use(row) for each row of the query's result. Binds `values` to the query's parameters (?). Throws
  /// Error naming the file if the database is damaged or lacks a column.
  void query(const std::string& sql, const std::vector<std::int64_t>& values,
             const std::function<void(const SqliteRow&)>& use) const;
  /// Returns the first max_bytes bytes of the value in a row and column, or the whole value if it is shorter.
  /// Does not read the rest of the value.
  [[nodiscard]] std::string read_up_to(const char* table, const char* column, std::int64_t row,
                                       std::uint64_t max_bytes) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  [[noreturn]] void fail() const;
  std::string name_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// Returns true if the file begins with SQLite's header string.
[[nodiscard]] bool is_sqlite(const std::filesystem::path& path);

}  // namespace roomradar
