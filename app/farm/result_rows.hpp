// result_rows.hpp: rows of results as a JSON file. A command that splits its work into jobs reads the files
// that the jobs write.
#pragma once
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Returns the number, or "nan", "inf" or "-inf", since JSON only has finite numbers.
nlohmann::json json_number(double value);
/// Returns the number that json_number() wrote. Throws an exception if the value has another form.
double number_of(const nlohmann::json& value);

/// Writes an array. Numbers are read back exactly. Throws Error if the file cannot be written.
/// @param kind  plural of the rows' name, such as "scenarios"
void write_result_rows(const std::string& kind, const nlohmann::json& rows,
                       const std::filesystem::path& path);

/// Returns the array that write_result_rows() wrote. Throws Error if the file cannot be read, or has another
/// form or kind.
nlohmann::json read_result_rows(const std::string& kind, const std::filesystem::path& path);

/// Returns the rows of a file, each converted by `row_from`. Throws Error if the file cannot be read, or if
/// `row_from` throws an exception.
template <typename Row, typename RowFrom>
std::vector<Row> read_result_rows(const std::string& kind, const std::filesystem::path& path,
                                  const RowFrom& row_from) {
  const nlohmann::json array = read_result_rows(kind, path);
  try {
    std::vector<Row> rows;
    for (const nlohmann::json& row : array) rows.push_back(row_from(row));
    return rows;
  } catch (const std::exception& error) {
    throw Error(path.string() + ": is not a file with results of " + kind + ": " + error.what());
  }
}

}  // namespace roomradar
