// object_file.cpp: scales models, and rejects implausible sizes.
#include "app/objects/object_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>

#include "app/objects/teapot.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr int kTeapotTessellation = 10;  // 6,320 triangles: looks smooth at arm's length
constexpr double kTeapotHeight_m = 0.15;

constexpr double kSmallest_m = 0.005;
constexpr double kLargest_m = 5.0;
constexpr double kPartOfRoom = 0.5;
constexpr double kPlainSize_m = 0.3;
// Sizes of things that stand in a room.
constexpr double kPlausibleLeast_m = 0.02, kPlausibleMost_m = 2.0;

/// Returns the longest side of the box around all vertices.
float longest_side_m(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  return box.sizes().maxCoeff();
}

std::string length_words(double length_m) {
  return length_m < 0.01 ? format_readable(1000.0 * length_m, 3) + " mm"
                         : format_readable(length_m, 3) + " m";
}

/// Returns the end of the sentence: the option to paste, and why.
std::string cure(double longest_m, double most_m, const std::string& option) {
  struct Unit {
    const char* name;
    double in_m;
  };
  for (const Unit& unit : {Unit{"millimetres", 0.001}, Unit{"centimetres", 0.01}}) {
    const double size_m = longest_m * unit.in_m;
    if (size_m < kPlausibleLeast_m || size_m > std::min(kPlausibleMost_m, most_m)) continue;
    return std::string("; if its unit is ") + unit.name + ", use " + option + format_readable(size_m, 3);
  }
  return "; give it a size in metres, such as " + option + format_readable(std::min(kPlainSize_m, most_m), 2);
}

}  // namespace

Model object_model(const ObjectSource& source) {
  Model model;
  if (source.mesh == "teapot")
    model.mesh = utah_teapot(kTeapotTessellation, kTeapotHeight_m);
  else
    model = read_model(source.mesh, source.up, source.origin);
  if (source.mesh == "teapot" && source.up) stand_up(model.mesh, *source.up);
  if (!source.size_m) return model;
  const float longest_m = longest_side_m(model.mesh);
  if (!(longest_m > 0.0F)) throw Error(source.mesh + ": all vertices are in one place; it cannot be scaled");
  const float scale = static_cast<float>(*source.size_m) / longest_m;
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex *= scale;
  model.mesh.origin *= static_cast<double>(scale);
  return model;
}

Mesh object_mesh(const std::string& name_or_path, double size_m) {
  ObjectSource source{.mesh = name_or_path};
  if (size_m > 0.0) source.size_m = size_m;
  return object_model(source).mesh;
}

void require_sensible_size(const Model& model, const ObjectSource& source, const SizeCheck& check) {
  const bool is_copy = std::filesystem::path(source.mesh).extension() == kModelCopyExtension;  // has its size
  if (source.size_m || source.mesh == "teapot" || is_copy) return;
  const double longest_m = static_cast<double>(longest_side_m(model.mesh));
  const double most_m = check.room_m > 0.0 ? std::min(kLargest_m, kPartOfRoom * check.room_m) : kLargest_m;
  if (longest_m >= kSmallest_m && longest_m <= most_m) return;
  const std::string fault = longest_m < kSmallest_m  ? ", less than 5 mm"
                            : longest_m > kLargest_m ? ", more than 5 m"
                                                     : ", more than half of the room, which is " +
                                                           length_words(check.room_m) + " long";
  throw Error(source.mesh + ": its longest side is " + length_words(longest_m) + fault +
              cure(longest_m, most_m, check.option));
}

}  // namespace roomradar
