// object_options.cpp: takes apart "FILE,size=S,up=A,at=X,Y,Z".
#include "app/cli/options/object_options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "app/cli/options/option_checks.hpp"

namespace roomradar {
namespace {

constexpr double kLeastSize_m = 0.001, kMostSize_m = 10.0;
constexpr double kMostCoordinate_m = 1e6;
constexpr auto kKeys = [] {
  std::array<std::string_view, 3 + kMaterialFields.size()> keys = {"size", "up", "at"};
  for (std::size_t i = 0; i < kMaterialFields.size(); ++i) keys[3 + i] = kMaterialFields[i].name;
  return keys;
}();

[[noreturn]] void fail(const std::string& text, const std::string& fault) {
  throw CLI::ValidationError("--object " + text + ": " + fault);
}

/// Returns the position of the next ",size=", ",up=" or another key; npos if there is none.
std::size_t next_key(std::string_view text, std::size_t from) {
  std::size_t first = std::string_view::npos;
  for (const std::string_view key : kKeys)
    first = std::min(first, text.find("," + std::string(key) + "=", from));
  return first;
}

/// Returns the first word of a ",word=" in the text; empty if there is none.
std::string key_in(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  for (std::size_t comma = text.find(','); comma != std::string_view::npos;
       comma = text.find(',', comma + 1)) {
    std::size_t end = comma + 1;
    while (end < text.size() && is_letter(text[end])) ++end;
    if (end > comma + 1 && end < text.size() && text[end] == '=')
      return std::string(text.substr(comma + 1, end - comma - 1));
  }
  return {};
}

/// Throws CLI::ValidationError if there is a ",word=" of none of the known words in the text.
void refuse_unknown_key(const std::string& text, std::string_view part) {
  const std::string key = key_in(part);
  if (key.empty()) return;
  std::string known;
  for (const std::string_view one : kKeys) known += (known.empty() ? "" : ", ") + std::string(one) + "=";
  fail(text, "there is no " + key + "=; the keys are " + known);
}

double number_of(const std::string& text, const std::string& word, double low, double high,
                 const std::string& wanted) {
  double value = 0.0;
  if (CLI::detail::lexical_cast(word, value) && value >= low && value <= high) return value;
  fail(text, wanted + ", not \"" + word + "\"");
}

UpAxis axis_of(const std::string& option, const std::string& word) {
  if (const auto up = up_axis_of(word)) return *up;
  throw CLI::ValidationError(option + ": the axis that points up must be " + std::string(kUpAxisWords) +
                             ", not \"" + word + "\"");
}

Eigen::Vector3d point_of(const std::string& text, const std::string& words) {
  const std::string wanted = "at= needs three numbers X,Y,Z in metres";
  std::vector<std::string> parts = CLI::detail::split(words, ',');
  if (parts.size() != 3) fail(text, wanted + ", not \"" + words + "\"");
  Eigen::Vector3d point;
  for (int i = 0; i < 3; ++i)
    point[i] =
        number_of(text, parts[static_cast<std::size_t>(i)], -kMostCoordinate_m, kMostCoordinate_m, wanted);
  return point;
}

void take_value(const std::string& text, const std::string& key, const std::string& value,
                ObjectOption& object) {
  const bool is_again = (key == "size" && object.source.size_m) || (key == "up" && object.source.up) ||
                        (key == "at" && object.at_world);
  if (is_again) fail(text, key + "= is given twice");
  refuse_unknown_key(text, value);
  for (const MaterialField& field : kMaterialFields) {
    if (key != field.name) continue;
    std::optional<double>& number = object.material.*field.value;
    if (number) fail(text, key + "= is given twice");
    number = number_of(text, value, field.least, field.most, key + "= must be " + field.wanted);
    return;
  }
  if (key == "size")
    object.source.size_m =
        number_of(text, value, kLeastSize_m, kMostSize_m, "size= must be between 0.001 and 10 (metres)");
  else if (key == "up")
    object.source.up = axis_of("--object " + text, value);
  else
    object.at_world = point_of(text, value);
}

ObjectOption object_of(const std::string& text) {
  ObjectOption object{.text = text};
  std::size_t at = next_key(text, 0);
  object.source.mesh = text.substr(0, at);
  if (object.source.mesh.empty()) fail(text, "names no mesh; must be MESH[,size=M][,up=AXIS][,at=X,Y,Z]");
  std::error_code ignored;
  if (!std::filesystem::exists(object.source.mesh, ignored)) refuse_unknown_key(text, object.source.mesh);
  while (at != std::string::npos) {
    const std::size_t equals = text.find('=', at);
    const std::size_t end = next_key(text, equals);
    take_value(text, text.substr(at + 1, equals - at - 1),
               text.substr(equals + 1, end == std::string::npos ? end : end - equals - 1), object);
    at = end;
  }
  if (object.material.mass_kg && object.material.density_kg_m3)
    fail(text, "mass= and density= exclude each other");
  return object;
}

}  // namespace

void add_object_options(CLI::App& command, ObjectOptions& options) {
  command
      .add_option(
          "--object", options.texts,
          "virtual object: teapot (built in), or a .glb, .gltf, .obj, .ply, .stl or .dae file; may be\n"
          "given several times. After the name may follow, each with a comma: size=M, the longest\n"
          "side (m); up=AXIS, the file's axis that points up (x, y, z, -x, -y, -z); at=X,Y,Z, a point\n"
          "of the map (m) 5 cm above which it is dropped, else over a level surface in view;\n"
          "mass=KG or density=KG/M3 (default: 1000 kg/m3, an open mesh 5 kg/m2); friction=F, 0..10\n"
          "(default: 0.5); restitution=E, 0..1 (default: 0):\n"
          "--object chair.glb,size=0.9,up=y,at=0.4,-0.1,0.75 (default: teapot)")
      ->allow_extra_args(false)
      ->type_name("MESH[,size=M][,up=AXIS][,at=X,Y,Z]");
  command
      .add_option("--object-size", options.size_m,
                  "longest side of objects without their own size=\n"
                  "(default: as in the file, whose numbers are metres unless it states a unit)")
      ->check(within(kLeastSize_m, kMostSize_m, "metres"))
      ->type_name("M");
  command
      .add_option("--object-up", options.up,
                  "axis that points up in the files of objects without their own up=: x, y, z, -x, -y or -z\n"
                  "(default: y for .glb, .gltf and .obj, z for .ply and .stl, as stated in a .dae)")
      ->type_name("AXIS");
}

std::vector<ObjectOption> objects_of(const ObjectOptions& options) {
  std::vector<ObjectOption> objects;
  for (const std::string& text : options.texts) objects.push_back(object_of(text));
  if (objects.empty()) objects.push_back(object_of("teapot"));
  for (ObjectOption& object : objects) {
    if (!object.source.size_m) object.source.size_m = options.size_m;
    if (!object.source.up && options.up)
      object.source.up = axis_of("--object-up " + *options.up, *options.up);
  }
  return objects;
}

}  // namespace roomradar
