// recording_writer.cpp: writes frames as files, with one function per format.
#include "app/sources/recordings/recording_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string>
#include <system_error>
#include <utility>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestGap_s = 30.0;  // in fakenect's format

std::string fixed_6(double value) { return format_fixed(value, 6); }

/// Returns a stamp with six digits after the point, or as many as it takes to read back the same number.
std::string exact_stamp(double stamp_s) {
  const std::string text = fixed_6(stamp_s);
  return parse_number(text) == stamp_s ? text : format_exact(stamp_s);
}

/// Formats values with a space before each.
std::string spaced(std::initializer_list<double> values, int digits) {
  std::string text;
  for (const double value : values) text += ' ' + format_general(value, digits);
  return text;
}

/// Opens the list if needed, and adds a line.
void add_line(std::ofstream& list, const fs::path& path, const std::string& line, const char* heading = "") {
  if (!list.is_open()) {
    list.open(path);
    list << heading;
  }
  list << line << '\n' << std::flush;  // so only whole lines are on disk if the program crashes
  require_written(list, path);
}

bool same_cameras(const CameraRig& a, const CameraRig& b) {
  return a.depth_camera == b.depth_camera && a.colour_camera == b.colour_camera &&
         a.T_colour_depth.isApprox(b.T_colour_depth, 1e-9);
}

template <typename Pixel>
void require_size(const Image<Pixel>& image, const Intrinsics& camera, const std::string& where) {
  if (image.width != camera.width_px || image.height != camera.height_px)
    throw Error(where + " image is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                ", but its camera's intrinsics are for " + std::to_string(camera.width_px) + " x " +
                std::to_string(camera.height_px));
}

void require_fakenect_size(const Frame& frame, const fs::path& folder) {
  const auto fits = [](const auto& image) { return image.width == 640 && image.height == 480; };
  if (!fits(frame.depth_m) || (!frame.colour.empty() && !fits(frame.colour)))
    throw Error(folder.string() +
                ": fakenect replays images of 640 x 480 only; choose the format tum, 7scenes or rosbag");
}

}  // namespace

std::string_view to_string(RecordingFormat format) {
  switch (format) {
    case RecordingFormat::kTum:
      return "tum";
    case RecordingFormat::kSevenScenes:
      return "7scenes";
    case RecordingFormat::kFakenect:
      return "fakenect";
    case RecordingFormat::kRosBag:
      return "rosbag";
  }
  return "unknown";
}

RecordingWriter::RecordingWriter(fs::path folder, RecordingFormat format, bool are_calibrated)
    : folder_(std::move(folder)), format_(format), are_calibrated_(are_calibrated) {
  make_folder(folder_);
  std::error_code fault;
  if (!is_empty_folder(folder_, fault))
    throw Error(folder_.string() + ": is not empty; name a new folder for the recording");
  if (format_ == RecordingFormat::kRosBag) bag_ = std::make_unique<BagFrameWriter>(folder_ / "recording.bag");
  if (format_ != RecordingFormat::kTum) return;
  make_folder(folder_ / "depth");
}

void RecordingWriter::write(const Frame& frame) {
  const std::string where = folder_.string() + ": frame " + std::to_string(frame.index) + "'s ";
  require_valid(frame.depth_camera, (where + "depth camera").c_str());
  require_size(frame.depth_m, frame.depth_camera, where + "depth");
  if (!frame.colour.empty()) require_size(frame.colour, frame.colour_camera, where + "colour");
  if (format_ == RecordingFormat::kFakenect) require_fakenect_size(frame, folder_);
  if (frames_written_ > 0 && !(frame.stamp_s > last_stamp_s_))
    throw Error(where + "stamp " + fixed_6(frame.stamp_s) + " s is not later than the one before, " +
                fixed_6(last_stamp_s_) + " s");

  CameraRig rig{frame.depth_camera, {},           frame.T_colour_depth,
                are_calibrated_,    frame.timing, frame.depth_noise};
  if (frame.colour_camera.width_px > 0) rig.colour_camera = frame.colour_camera;
  if (!rig_) {
    rig_ = rig;
    write_camera_file(rig, folder_ / "camera.json");
  } else if (!same_cameras(rig, *rig_)) {
    throw Error(where + "cameras are not those of the first frame; a recording has one camera.json for all");
  }

  switch (format_) {
    case RecordingFormat::kTum:
      write_tum(frame);
      break;
    case RecordingFormat::kSevenScenes:
      write_seven_scenes(frame);
      break;
    case RecordingFormat::kFakenect:
      write_fakenect(frame);
      break;
    case RecordingFormat::kRosBag:
      bag_->write(frame);
      break;
  }
  last_stamp_s_ = frame.stamp_s;
  ++frames_written_;
}

void RecordingWriter::write_tum(const Frame& frame) {
  const std::string stamp = exact_stamp(frame.stamp_s);
  const std::string depth_file = "depth/" + fixed_6(frame.stamp_s) + ".png";
  write_depth_file(frame.depth_m, DepthEncoding::kTum, folder_ / depth_file);
  add_line(depth_list_, folder_ / "depth.txt", stamp + " " + depth_file, "# stamp_s file\n");
  if (!frame.colour.empty()) {
    const double colour_s = frame.stamp_s + frame.colour_after_depth_s;
    const std::string colour_file = "rgb/" + fixed_6(colour_s) + ".png";
    if (!colour_list_.is_open()) make_folder(folder_ / "rgb");
    write_colour_file(frame.colour, folder_ / colour_file);
    add_line(colour_list_, folder_ / "rgb.txt", exact_stamp(colour_s) + " " + colour_file,
             "# stamp_s file\n");
  }
  if (frame.T_world_camera) {
    const Eigen::Vector3d t = frame.T_world_camera->translation();
    const Eigen::Quaterniond q(frame.T_world_camera->linear());
    add_line(pose_list_, folder_ / "groundtruth.txt",
             stamp + spaced({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}, 12),
             "# stamp_s tx ty tz qx qy qz qw: camera to world, metres\n");
  }
  // Unknown gravity is written as zero; otherwise the reader would take it from a nearby frame.
  if (frame.down_camera || wrote_gravity_) {
    wrote_gravity_ = true;
    const Eigen::Vector3d a =
        frame.down_camera
            ? Eigen::Vector3d(acceleration_at_rest_g(*frame.down_camera) * kStandardGravity_m_s2)
            : Eigen::Vector3d::Zero();
    add_line(gravity_list_, folder_ / "accelerometer.txt", stamp + spaced({a.x(), a.y(), a.z()}, 9),
             "# stamp_s ax ay az: m/s^2; x left, y up, z forward\n");
  }
}

void RecordingWriter::write_seven_scenes(const Frame& frame) {
  const fs::path stem = folder_ / ("frame-" + format_frame_number(frames_written_));
  write_depth_file(frame.depth_m, DepthEncoding::kMillimetres, stem.string() + ".depth.png");
  if (frame.colour.empty())
    std::ofstream(stem.string() + ".color.none");  // marks it as absent, not lost
  else
    write_colour_file(frame.colour, stem.string() + ".color.png");
  std::string pose;
  const Eigen::Matrix4d matrix =
      frame.T_world_camera ? frame.T_world_camera->matrix() : Eigen::Matrix4d::Constant(std::nan(""));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      pose += format_general(matrix(row, column), 12) + (column < 3 ? '\t' : '\n');
  write_bytes(stem.string() + ".pose.txt", pose);
}

void RecordingWriter::write_fakenect(const Frame& frame) {
  const fs::path index_file = folder_ / "INDEX.txt";
  if (frames_written_ > 0 && frame.stamp_s - last_stamp_s_ > kLongestGap_s)
    left_out_s_ += frame.stamp_s - last_stamp_s_ - kLongestGap_s;
  const auto stamps_at = [this](double stamp_s) {
    stamp_s -= left_out_s_;
    const auto total_ticks = static_cast<std::int64_t>(std::llround(stamp_s * kKinectTicksPerSecond));
    return fixed_6(stamp_s) + "-" + std::to_string(static_cast<std::uint32_t>(total_ticks));
  };
  const std::string stamps = stamps_at(frame.stamp_s);

  // Gravity first: the reader assigns to a depth image the latest reading before it. Unknown gravity is
  // written as zero.
  if (frame.down_camera || wrote_gravity_) {
    wrote_gravity_ = frame.down_camera.has_value();
    const Eigen::Vector3d counts =
        frame.down_camera ? Eigen::Vector3d(acceleration_at_rest_g(*frame.down_camera) * kKinectCountsPerG)
                          : Eigen::Vector3d::Zero();
    const std::array<std::int16_t, 6> tilt_state = {static_cast<std::int16_t>(std::lround(counts.x())),
                                                    static_cast<std::int16_t>(std::lround(counts.y())),
                                                    static_cast<std::int16_t>(std::lround(counts.z()))};
    const fs::path file = folder_ / ("a-" + stamps + ".dump");
    write_bytes(file, {reinterpret_cast<const char*>(tilt_state.data()), sizeof tilt_state});
    add_line(depth_list_, index_file, file.filename().string());
  }
  const auto add_depth = [&] {
    write_depth_file(frame.depth_m, DepthEncoding::kKinectRaw, folder_ / ("d-" + stamps + ".pgm"));
    add_line(depth_list_, index_file, "d-" + stamps + ".pgm");
  };
  const auto add_colour = [&] {
    if (frame.colour.empty()) return;
    const std::string file = "r-" + stamps_at(frame.stamp_s + frame.colour_after_depth_s) + ".ppm";
    write_colour_file(frame.colour, folder_ / file);
    add_line(depth_list_, index_file, file);
  };
  // In order of arrival.
  if (frame.colour_after_depth_s < 0.0) add_colour();
  add_depth();
  if (!(frame.colour_after_depth_s < 0.0)) add_colour();
}

void RecordingWriter::close() {
  if (bag_) bag_->close();
  for (std::ofstream* list : {&depth_list_, &colour_list_, &pose_list_, &gravity_list_}) {
    if (!list->is_open()) continue;
    list->close();
    require_written(*list, folder_);
  }
}

}  // namespace roomradar
