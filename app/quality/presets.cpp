// presets.cpp: reads and writes presets and front as JSON.
#include "app/quality/presets.hpp"

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <system_error>

#include "app/quality/quality_json.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "roomradar presets";
constexpr int kFormatVersion = 1;
constexpr std::uintmax_t kMaxBytes = 1U << 20U;
constexpr std::size_t kMaxFront = 1000;
constexpr double kMostRatio = 1000.0;

/// Throws Error unless this is an object with no keys except those given.
void require_object(const Json& json, std::initializer_list<std::string_view> keys,
                    const std::string& where) {
  if (!json.is_object()) throw Error(where + ": is not a JSON object");
  for (const auto& item : json.items()) {
    bool is_known = false;
    std::string list;
    for (const std::string_view key : keys) {
      is_known |= key == item.key();
      list.append(list.empty() ? "" : ", ").append(key);
    }
    if (!is_known) throw Error(where + ": \"" + item.key() + "\" is not known; allowed are " + list);
  }
}

/// Returns the member, or an empty object if absent. By reference, because a copy recurses as deep as the
/// JSON.
const Json& member(const Json& json, const char* key) {
  static const Json kEmpty = Json::object();
  const auto found = json.find(key);
  return found == json.end() ? kEmpty : *found;
}

double number_of(const Json& json, const std::string& where) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) throw Error(where + ": is not a number");
  return json.get<double>();
}

Figures figures_of(const Json& json, const std::string& where) {
  if (!json.is_object()) throw Error(where + ": is not a JSON object of numbers");
  Figures figures;
  for (const auto& item : json.items())
    figures[item.key()] = number_of(item.value(), where + ": " + item.key());
  return figures;
}

Preset preset_of(const Json& json, const std::string& where) {
  require_object(json, {"scan", "run", "figures"}, where);
  return {scan_quality_of(member(json, "scan"), where + ": scan"),
          run_quality_of(member(json, "run"), where + ": run"),
          figures_of(member(json, "figures"), where + ": figures")};
}

std::array<double, kFrameParts> ratios_of(const Json& json, const std::string& where) {
  require_object(json, {"locate", "mesh", "physics", "compose"}, where);
  std::array<double, kFrameParts> ratios{1.0, 1.0, 1.0, 1.0};
  for (std::size_t part = 0; part < kFrameParts; ++part) {
    const std::string name(to_string(static_cast<FramePart>(part)));
    if (!json.contains(name)) continue;
    ratios[part] = number_of(json[name], where + ": " + name);
    if (!(ratios[part] > 0.0 && ratios[part] <= kMostRatio))
      throw Error(where + ": " + name + " = " + json[name].dump() + ": must be > 0, at most 1000");
  }
  return ratios;
}

int count_of(const Json& json, const std::string& where) {
  constexpr double kMost = 1e6;
  const double count = number_of(json, where);
  if (!(count >= 0.0 && count <= kMost && count == std::floor(count)))
    throw Error(where + " = " + json.dump() + ": must be a whole number, at most 1000000");
  return static_cast<int>(count);
}

FrontStep front_step_of(const Json& json, const std::string& where) {
  require_object(json, {"run", "part_ratios", "objects", "figures"}, where);
  return {run_quality_of(member(json, "run"), where + ": run"),
          ratios_of(member(json, "part_ratios"), where + ": part_ratios"),
          json.contains("objects") ? count_of(json["objects"], where + ": objects") : 0,
          figures_of(member(json, "figures"), where + ": figures")};
}

}  // namespace

Presets presets_of(std::string_view text, const std::string& where) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded() || !json.is_object() || !json.contains("format") || json["format"] != kFormat)
    throw Error(where + ": is not a file of presets, or is damaged");
  if (!json.contains("format_version") || json["format_version"] != kFormatVersion)
    throw Error(where + ": has another format version than " + std::to_string(kFormatVersion) +
                ", which this program reads");
  require_object(json, {"format", "format_version", "made_by", "presets", "front"}, where);
  Presets presets;
  const Json &made_by = member(json, "made_by"), &named = member(json, "presets");
  if (!made_by.is_object() || !named.is_object())
    throw Error(where + ": made_by and presets must be JSON objects");
  for (const auto& item : made_by.items()) {
    if (!item.value().is_string()) throw Error(where + ": made_by: " + item.key() + ": is not text");
    presets.made_by[item.key()] = item.value().get<std::string>();
  }
  for (const auto& item : named.items())
    presets.presets[item.key()] = preset_of(item.value(), where + ": " + item.key());
  if (!json.contains("front")) return presets;
  const Json& front = json["front"];
  if (!front.is_array() || front.size() > kMaxFront)
    throw Error(where + ": front: is not a list, or longer than " + std::to_string(kMaxFront));
  for (std::size_t i = 0; i < front.size(); ++i)
    presets.front.push_back(front_step_of(front[i], where + ": front[" + std::to_string(i) + "]"));
  return presets;
}

Presets read_presets(const fs::path& path) {
  return presets_of(read_bytes(path, "a file of presets", kMaxBytes), path.string());
}

void write_presets(const Presets& presets, const fs::path& path) {
  Json json = {{"format", kFormat}, {"format_version", kFormatVersion}, {"made_by", presets.made_by}};
  json["presets"] = Json::object();
  for (const auto& [name, preset] : presets.presets)
    json["presets"][name] = {
        {"scan", to_json(preset.scan)}, {"run", to_json(preset.run)}, {"figures", preset.figures}};
  json["front"] = Json::array();
  for (const FrontStep& step : presets.front) {
    Json ratios;
    for (std::size_t part = 0; part < kFrameParts; ++part)
      ratios[std::string(to_string(static_cast<FramePart>(part)))] = step.part_ratios[part];
    json["front"].push_back({{"run", to_json(step.run)},
                             {"part_ratios", ratios},
                             {"objects", step.objects},
                             {"figures", step.figures}});
  }
  AtomicFile file(path);
  file.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.commit();
}

fs::path presets_file(const std::string& given) {
  if (!given.empty()) return given;
  std::error_code fault;
  const fs::path folder = fs::read_symlink("/proc/self/exe", fault).parent_path();
  for (const fs::path& path :
       {folder / "presets.json", folder / ".." / "share" / "roomradar" / "presets.json"})
    if (fs::is_regular_file(path, fault)) return path.lexically_normal();
  throw Error("presets.json is neither beside the program in " + folder.string() +
              " nor where it is installed; give a file by --presets");
}

const Preset& preset_named(const Presets& presets, const std::string& name, const std::string& where) {
  const auto found = presets.presets.find(name);
  if (found != presets.presets.end()) return found->second;
  std::string names;
  for (const auto& [known, preset] : presets.presets) names.append(names.empty() ? "" : ", ").append(known);
  throw Error(where + ": has no preset \"" + name + "\"; it has " + names);
}

}  // namespace roomradar
