// camera_rig.cpp: reads and writes camera.json, and reads camera-intrinsics.txt.
#include "app/sources/formats/camera_rig.hpp"

#include <cmath>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;
constexpr const char* kFormat = "roomradar camera";
constexpr int kVersion = 1;
constexpr std::uintmax_t kLargestCameraFile_bytes = 1 << 20;

}  // namespace

std::string read_json_text(const std::filesystem::path& path) {
  return read_bytes(path, "a file about cameras", kLargestCameraFile_bytes);
}

const Json& json_field(const Json& object, const char* name, const std::string& where) {
  if (!object.is_object() || !object.contains(name))
    throw Error(where + ": the field '" + name + "' is missing");
  return object[name];
}

double json_number(const Json& object, const char* name, const std::string& where) {
  const Json& value = json_field(object, name, where);
  if (!value.is_number()) throw Error(where + ": " + name + " is not a number");
  return value.get<double>();
}

namespace {

int size_px(const Json& object, const char* name, const std::string& where) {
  const double value = json_number(object, name, where);
  if (!(value >= 1 && value <= 16384 && value == std::floor(value)))
    throw Error(where + ": " + name + " must be a whole number in 1..16384");
  return static_cast<int>(value);
}

Intrinsics intrinsics_from(const Json& object, const std::string& where) {
  const Intrinsics camera{size_px(object, "width_px", where),  size_px(object, "height_px", where),
                          json_number(object, "fx_px", where), json_number(object, "fy_px", where),
                          json_number(object, "cx_px", where), json_number(object, "cy_px", where)};
  require_valid(camera, where.c_str());
  return camera;
}

Json json_of(const Intrinsics& camera) {
  return {{"width_px", camera.width_px}, {"height_px", camera.height_px}, {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},       {"cx_px", camera.cx_px},         {"cy_px", camera.cy_px}};
}

Eigen::Isometry3d pose_from(const Json& rows, const std::string& where) {
  Eigen::Matrix4d matrix;
  const bool is_4_by_4 = rows.is_array() && rows.size() == 4;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      if (!is_4_by_4 || !rows[row].is_array() || rows[row].size() != 4 || !rows[row][column].is_number())
        throw Error(where + ": must be four rows of four numbers");
      matrix(row, column) = rows[row][column].get<double>();
    }
  const auto rotation = nearest_rotation(matrix.topLeftCorner<3, 3>());
  if (!rotation || !matrix.allFinite() || !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)))
    throw Error(where + ": must be a rigid transform: a rotation, a shift in metres, and 0 0 0 1 below");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  // A rotation is read to the bit as it stands, so that a recording's copy gives the same map.
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  pose.linear() = (R - *rotation).cwiseAbs().maxCoeff() < 1e-14 ? R : *rotation;
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

/// Returns a time of least_s to 0.1 s.
double time_s(const Json& object, const char* name, double least_s, const std::string& where) {
  constexpr double kMost_s = 0.1;
  const double value_s = json_number(object, name, where);
  if (!(value_s >= least_s && value_s <= kMost_s))
    throw Error(where + ": " + name + " = " + format_fixed(value_s, 6) + ": must be " +
                format_fixed(least_s, 6) + " to " + format_fixed(kMost_s, 6) + " s");
  return value_s;
}

SensorTiming timing_from(const Json& object, const std::string& where) {
  return {time_s(object, "depth_readout_s", 0.0, where), time_s(object, "colour_readout_s", 0.0, where),
          time_s(object, "colour_delay_s", -0.1, where)};
}

DepthNoise noise_from(const Json& object, const std::string& where) {
  const auto number = [&](const char* name) { return static_cast<float>(json_number(object, name, where)); };
  const DepthNoise noise{number("base_m"), number("linear"), number("quadratic_per_m"), number("from_m"),
                         number("grazing")};
  if (!is_valid(noise))
    throw Error(where +
                ": is not a valid noise model: base_m must be above 0, all values at least 0 and at most 1, "
                "from_m at most 10");
  return noise;
}

}  // namespace

Json parse_json_of_format(const std::filesystem::path& path, const char* format, int version) {
  const std::string name = path.string();
  Json root = Json::parse(read_json_text(path), nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded()) throw Error(name + ": is not JSON; is it cut short?");
  if (!root.is_object() || !root.contains("format")) {
    const auto command = root.is_object() ? root.find("command") : root.end();
    const bool is_report = root.is_object() && command != root.end() && command->is_string();
    throw Error(
        name + ": is not a " + format + ": the field 'format' is missing" +
        (is_report ? "; the file is the report of `roomradar " + command->get<std::string>() + "`" : ""));
  }
  const Json& said = root["format"];
  if (said != format)
    throw Error(name + ": 'format' is " + (said.is_string() ? said.dump() : "not a string") + "; must be \"" +
                format + "\"");
  if (json_number(root, "version", name) != version)
    throw Error(name + ": has version " + json_field(root, "version", name).dump() +
                "; this program reads version " + std::to_string(version));
  return root;
}

CameraRig rig_from_json(const Json& root, const std::string& name) {
  CameraRig rig;
  rig.depth_camera = intrinsics_from(json_field(root, "depth", name), name + ", depth");
  if (root.contains("colour")) rig.colour_camera = intrinsics_from(root["colour"], name + ", colour");
  if (root.contains("T_colour_depth"))
    rig.T_colour_depth = pose_from(root["T_colour_depth"], name + ", T_colour_depth");
  if (root.contains("timing")) rig.timing = timing_from(root["timing"], name + ", timing");
  if (root.contains("depth_noise")) rig.depth_noise = noise_from(root["depth_noise"], name + ", depth_noise");
  return rig;
}

Json json_of(const CameraRig& rig) {
  Json root = {{"depth", json_of(rig.depth_camera)}};
  if (rig.colour_camera) {
    root["colour"] = json_of(*rig.colour_camera);
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row) {
      const Eigen::RowVector4d r = rig.T_colour_depth.matrix().row(row);
      rows.push_back({r[0], r[1], r[2], r[3]});
    }
    root["T_colour_depth"] = rows;
  }
  const SensorTiming& timing = rig.timing;
  if (timing != SensorTiming{})
    root["timing"] = {{"depth_readout_s", timing.depth_readout_s},
                      {"colour_readout_s", timing.colour_readout_s},
                      {"colour_delay_s", timing.colour_delay_s}};
  const DepthNoise& noise = rig.depth_noise;
  if (noise != DepthNoise{})
    root["depth_noise"] = {{"base_m", noise.base_m},
                           {"linear", noise.linear},
                           {"quadratic_per_m", noise.quadratic_per_m},
                           {"from_m", noise.from_m},
                           {"grazing", noise.grazing}};
  return root;
}

void write_json(const Json& root, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << root.dump(2) << '\n';
  file.commit();
}

CameraRig read_camera_file(const std::filesystem::path& path) {
  const Json root = parse_json_of_format(path, kFormat, kVersion);
  CameraRig rig = rig_from_json(root, path.string());
  rig.was_calibrated = said_calibrated(root, path.string());
  return rig;
}

void write_camera_file(const CameraRig& rig, const std::filesystem::path& path) {
  Json root = json_of(rig);
  root["format"] = kFormat;
  root["version"] = kVersion;
  if (rig.was_calibrated) root["calibrated"] = true;
  write_json(root, path);
}

Intrinsics read_intrinsics_matrix(const std::filesystem::path& path, int width_px, int height_px) {
  const std::string name = path.string();
  std::string text = read_json_text(path);
  for (char& c : text)  // as NumPy and MATLAB print a matrix
    if (c == ',' || c == ';' || c == '[' || c == ']') c = ' ';
  std::vector<double> m = parse_numbers(text, name);
  if (m.size() == 12 || m.size() == 16)  // the first three columns and rows
    m = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
  if (m.size() != 9)
    throw Error(name + ": has " + std::to_string(m.size()) + " numbers; must be a 3 x 3 matrix");
  if (m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    throw Error(name + ": must be of the form fx 0 cx / 0 fy cy / 0 0 1");
  const Intrinsics camera{width_px, height_px, m[0], m[4], m[2], m[5]};
  if (std::abs(camera.cx_px - width_px / 2.0) > width_px / 5.0 ||
      std::abs(camera.cy_px - height_px / 2.0) > height_px / 5.0) {
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << name << ": the principal point (" << camera.cx_px << ", " << camera.cy_px
            << ") fits images of about " << std::lround(2 * camera.cx_px) << " x "
            << std::lround(2 * camera.cy_px) << ", but the depth images are " << width_px << " x "
            << height_px << "; give the intrinsics of these images, or a camera.json";
    throw Error(message.str());
  }
  require_valid(camera, name.c_str());
  return camera;
}

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& almost) {
  if (!almost.allFinite()) return std::nullopt;
  const Eigen::Matrix3d rotation = nearest_orthogonal(almost);
  if (rotation.determinant() < 0 || (rotation - almost).cwiseAbs().maxCoeff() > 0.01) return std::nullopt;
  return rotation;
}

}  // namespace roomradar
