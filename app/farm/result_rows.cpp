// result_rows.cpp: {"format": "roomradar KIND", "version": 1, "KIND": [...]}
#include "app/farm/result_rows.hpp"

#include <cmath>
#include <limits>

#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

constexpr int kFileVersion = 1;
constexpr std::uintmax_t kLargestFile_bytes = std::uintmax_t{1} << 31U;

}  // namespace

Json json_number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}

double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const auto& text = value.get_ref<const std::string&>();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (text == "inf" || text == "-inf") return text == "inf" ? kInfinity : -kInfinity;
  if (text != "nan") throw Error("'" + text + "' is not a number");
  return std::numeric_limits<double>::quiet_NaN();
}

void write_result_rows(const std::string& kind, const Json& rows, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << Json{{"format", "roomradar " + kind}, {"version", kFileVersion}, {kind, rows}} << '\n';
  file.commit();
}

Json read_result_rows(const std::string& kind, const std::filesystem::path& path) {
  const std::string text = read_bytes(path, "results of " + kind, kLargestFile_bytes);
  try {
    Json json = Json::parse(text);
    if (json.at("format") != "roomradar " + kind || json.at("version") != kFileVersion ||
        !json.at(kind).is_array())
      throw Error("its format, version or rows differ");
    return std::move(json.at(kind));
  } catch (const std::exception& error) {
    throw Error(path.string() + ": is not a file with results of " + kind + ": " + error.what());
  }
}

}  // namespace roomradar
