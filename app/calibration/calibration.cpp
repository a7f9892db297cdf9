// calibration.cpp: evaluates the depth correction's grid, and reads and writes the file.
#include "app/calibration/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/sources/formats/camera_rig_json.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;
constexpr const char* kFormat = "roomradar calibration";
constexpr int kVersion = 1;
constexpr int kMostNodes = 256;  // per side
constexpr double kLargestOffset_per_m = 0.2;

Json json_of(const Lens& lens) {
  return {{"k1", lens.k1}, {"k2", lens.k2}, {"p1", lens.p1}, {"p2", lens.p2}, {"k3", lens.k3}};
}

Lens lens_from(const Json& json, const std::string& where) {
  return {json_number(json, "k1", where), json_number(json, "k2", where), json_number(json, "p1", where),
          json_number(json, "p2", where), json_number(json, "k3", where)};
}

void require_lens(const Lens& lens, const Intrinsics& camera, const std::string& where) {
  for (const double x_px : {0.0, camera.width_px - 1.0})
    for (const double y_px : {0.0, camera.height_px - 1.0}) {
      const PlanePoint<double> p{(x_px - camera.cx_px) / camera.fx_px, (y_px - camera.cy_px) / camera.fy_px};
      const PlanePoint<double> there = distorted(p, lens);
      if (!(std::hypot(there.x - p.x, there.y - p.y) <= 0.5 * std::hypot(p.x, p.y)))
        throw Error(where + ": would move a corner of the image by more than half of its distance from the " +
                    "middle; no lens does");
    }
}

void require_correction(const DepthCorrection& correction, const std::string& where) {
  if (!(correction.inverse_scale > 0.5 && correction.inverse_scale < 2.0))
    throw Error(where + ": inverse_scale must be between 0.5 and 2");
  for (const double offset_per_m : correction.offset_per_m)
    if (!(std::abs(offset_per_m) <= kLargestOffset_per_m))
      throw Error(where + ": each of offset_per_m must be a number between -0.2 and 0.2");
}

int nodes_from(const Json& json, const char* name, const std::string& where) {
  const double value = json_number(json, name, where);
  if (!(value == 0.0 || (value >= 2.0 && value <= kMostNodes && value == std::floor(value))))
    throw Error(where + ": " + name + " must be 0 or a whole number in 2.." + std::to_string(kMostNodes));
  return static_cast<int>(value);
}

DepthCorrection correction_from(const Json& json, const std::string& where) {
  DepthCorrection correction;
  correction.inverse_scale = json_number(json, "inverse_scale", where);
  correction.columns = nodes_from(json, "columns", where);
  correction.rows = nodes_from(json, "rows", where);
  const Json& offsets = json_field(json, "offset_per_m", where);
  const auto nodes = static_cast<std::size_t>(correction.columns) * static_cast<std::size_t>(correction.rows);
  if (!offsets.is_array() || offsets.size() != nodes || (correction.columns == 0) != (correction.rows == 0))
    throw Error(where + ": offset_per_m must be a list of columns times rows numbers");
  for (const Json& offset : offsets) {
    if (!offset.is_number())
      throw Error(where + ": each of offset_per_m must be a number between -0.2 and 0.2");
    correction.offset_per_m.push_back(offset.get<double>());
  }
  return correction;
}

}  // namespace

GridPlace grid_place(int columns, int rows, int width_px, int height_px, double x_px, double y_px) {
  const auto along = [](int nodes, int size_px, double at_px, int& node, double& part) {
    const double at = std::clamp(at_px * (nodes - 1) / std::max(size_px - 1, 1), 0.0, nodes - 1.0);
    node = std::min(static_cast<int>(at), nodes - 2);
    part = at - node;
  };
  GridPlace place;
  along(columns, width_px, x_px, place.column, place.right);
  along(rows, height_px, y_px, place.row, place.down);
  return place;
}

double offset_per_m(const DepthCorrection& correction, int width_px, int height_px, double x_px,
                    double y_px) {
  if (correction.columns == 0) return 0.0;
  const GridPlace at = grid_place(correction.columns, correction.rows, width_px, height_px, x_px, y_px);
  const double* up = correction.offset_per_m.data() + at.row * correction.columns + at.column;
  const double* down = up + correction.columns;
  return (1.0 - at.down) * ((1.0 - at.right) * up[0] + at.right * up[1]) +
         at.down * ((1.0 - at.right) * down[0] + at.right * down[1]);
}

Calibration read_calibration(const std::filesystem::path& path) {
  const std::string name = path.string();
  const Json root = parse_json_of_format(path, kFormat, kVersion);
  Calibration calibration;
  calibration.rig = rig_from_json(root, name);
  calibration.depth_lens = lens_from(json_field(root, "depth_lens", name), name + ", depth_lens");
  if (calibration.rig.colour_camera)
    calibration.colour_lens = lens_from(json_field(root, "colour_lens", name), name + ", colour_lens");
  calibration.depth_correction =
      correction_from(json_field(root, "depth_correction", name), name + ", depth_correction");
  require_valid(calibration, name);
  return calibration;
}

void require_valid(const Calibration& calibration, const std::string& where) {
  require_lens(calibration.depth_lens, calibration.rig.depth_camera, where + ", depth_lens");
  if (calibration.rig.colour_camera)
    require_lens(calibration.colour_lens, *calibration.rig.colour_camera, where + ", colour_lens");
  require_correction(calibration.depth_correction, where + ", depth_correction");
}

void write_calibration(const Calibration& calibration, const std::filesystem::path& path) {
  Json root = json_of(calibration.rig);
  root["format"] = kFormat;
  root["version"] = kVersion;
  root["depth_lens"] = json_of(calibration.depth_lens);
  if (calibration.rig.colour_camera) root["colour_lens"] = json_of(calibration.colour_lens);
  const DepthCorrection& correction = calibration.depth_correction;
  root["depth_correction"] = {{"inverse_scale", correction.inverse_scale},
                              {"columns", correction.columns},
                              {"rows", correction.rows},
                              {"offset_per_m", correction.offset_per_m}};
  write_json(root, path);
}

}  // namespace roomradar
