// azure_calibration.cpp: intrinsics normalised by the sensor's size, and the modes that crop and bin it.
#include "app/sources/datasets/azure_calibration.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "app/sources/datasets/recording_facts.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

/// Part of a sensor that a mode delivers: the binned sensor, from `left`, `top` on.
struct SensorMode {
  ImageSize image;
  int binned_width_px, binned_height_px, left_px, top_px;
};
constexpr std::array<SensorMode, 4> kDepthModes = {{
    {{320, 288}, 512, 512, 96, 90},      // narrow field of view, 2 x 2 binned
    {{640, 576}, 1024, 1024, 192, 180},  // narrow field of view
    {{512, 512}, 512, 512, 0, 0},        // wide field of view, 2 x 2 binned
    {{1024, 1024}, 1024, 1024, 0, 0},    // wide field of view
}};
constexpr std::array<SensorMode, 6> kColourModes = {{
    {{1280, 720}, 1280, 960, 0, 120},
    {{1920, 1080}, 1920, 1440, 0, 180},
    {{2560, 1440}, 2560, 1920, 0, 240},
    {{2048, 1536}, 2048, 1536, 0, 0},
    {{3840, 2160}, 3840, 2880, 0, 360},
    {{4096, 3072}, 4096, 3072, 0, 0},
}};

std::vector<double> numbers(const Json& object, const char* name, std::size_t count,
                            const std::string& where) {
  const Json& array = json_field(object, name, where);
  if (!array.is_array() || array.size() != count)
    throw Error(where + ": " + name + " must be " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const Json& each : array) {
    if (!each.is_number())
      throw Error(where + ": " + name + " must be " + std::to_string(count) + " numbers");
    values.push_back(each.get<double>());
  }
  return values;
}

/// Returns the entry of an array whose field `name` has this value.
const Json& entry_with(const Json& array, const char* name, const char* value, const std::string& where) {
  if (array.is_array())
    for (const Json& entry : array)
      if (entry.is_object() && entry.contains(name) && entry[name] == value) return entry;
  throw Error(where + ": contains no entry with " + name + " " + value);
}

/// Returns the transform to the sensor's frame from the device's, which is the depth camera's.
Eigen::Isometry3d sensor_pose(const Json& sensor, const std::string& where) {
  const Json& Rt = json_field(sensor, "Rt", where);
  const std::vector<double> r = numbers(Rt, "Rotation", 9, where), t_m = numbers(Rt, "Translation", 3, where);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto R = nearest_rotation(
      (Eigen::Matrix3d() << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]).finished());
  if (!R) throw Error(where + ": Rotation is not a rotation");
  T.linear() = *R;
  T.translation() << t_m[0], t_m[1], t_m[2];
  return T;
}

Intrinsics camera_of(const Json& camera, ImageSize size, std::span<const SensorMode> modes,
                     RationalLens& lens, const std::string& where) {
  for (const SensorMode& mode : modes) {
    if (mode.image != size) continue;
    const std::vector<double> p =
        numbers(json_field(camera, "Intrinsics", where), "ModelParameters", 14, where);
    lens = {.k1 = p[4], .k2 = p[5], .p1 = p[13], .p2 = p[12], .k3 = p[6], .k4 = p[7], .k5 = p[8], .k6 = p[9]};
    // Normalised coordinates count from the sensor's corner, roomradar's from the centre of its first pixel.
    return {size.width_px,
            size.height_px,
            p[2] * mode.binned_width_px,
            p[3] * mode.binned_height_px,
            p[0] * mode.binned_width_px - mode.left_px - 0.5,
            p[1] * mode.binned_height_px - mode.top_px - 0.5};
  }
  throw Error(where + ": no mode of the device has images of " + size_text(size.width_px, size.height_px));
}

}  // namespace

AzureCalibration read_azure_calibration(const std::string& text, ImageSize depth, const ImageSize* colour,
                                        const std::string& where) {
  const Json root = Json::parse(text.substr(0, text.find('\0')), nullptr, /*allow_exceptions=*/false);
  if (root.is_discarded() || !root.is_object()) throw Error(where + ": is not JSON; is it cut short?");
  const Json& information = json_field(root, "CalibrationInformation", where);
  const Json& cameras = json_field(information, "Cameras", where);

  AzureCalibration calibration;
  const Json& depth_json = entry_with(cameras, "Location", "CALIBRATION_CameraLocationD0", where);
  calibration.rig.depth_noise = kTimeOfFlightNoise;
  calibration.rig.depth_camera = camera_of(depth_json, depth, kDepthModes, calibration.depth_lens, where);
  const Eigen::Isometry3d T_depth_device = sensor_pose(depth_json, where);
  if (colour) {
    const Json& colour_json = entry_with(cameras, "Location", "CALIBRATION_CameraLocationPV0", where);
    calibration.rig.colour_camera =
        camera_of(colour_json, *colour, kColourModes, calibration.colour_lens, where);
    calibration.rig.T_colour_depth = sensor_pose(colour_json, where) * T_depth_device.inverse();
  }
  if (information.contains("InertialSensors")) {
    const Json& accelerometer = entry_with(information["InertialSensors"], "SensorType",
                                           "CALIBRATION_InertialSensorType_Accelerometer", where);
    calibration.R_depth_accelerometer =
        T_depth_device.linear() * sensor_pose(accelerometer, where).linear().transpose();
  }
  return calibration;
}

}  // namespace roomradar
