// rtabmap.cpp: reads the database's tables, and RTAB-Map's binary format of cameras.
#include "app/sources/datasets/rtabmap.hpp"

#include <array>
#include <memory>

#include "app/sources/containers/rvl_depth.hpp"
#include "app/sources/containers/sqlite_file.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns the transform of 12 floats, row by row; nullopt if it is not rigid.
std::optional<Eigen::Isometry3d> transform_of(const std::array<float, 12>& m) {
  return rigid_transform(
      Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(m.data()).cast<double>());
}

std::optional<Eigen::Isometry3d> pose_in(std::string_view bytes) {
  std::array<float, 12> m{};
  if (bytes.size() != sizeof m) return std::nullopt;
  std::memcpy(m.data(), bytes.data(), sizeof m);
  return transform_of(m);
}

/// A camera and its pose on the robot.
struct RtabmapCamera {
  Intrinsics camera;
  RationalLens lens;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// Reads a camera: 11 integers (version, kind, size, counts), then K, D, R, P (doubles) and its pose
/// (floats).
RtabmapCamera read_camera(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where + ": a camera");
  const auto head = reader.number<std::array<std::int32_t, 11>>();
  const std::int32_t kind = head[3], k_count = head[6], d_count = head[7], r_count = head[8],
                     p_count = head[9], pose_count = head[10];
  if (head[0] < 0 || head[0] > 1000 || kind != 0 || k_count != 9 || d_count < 0 || d_count > 14 ||
      (r_count != 0 && r_count != 9) || (p_count != 0 && p_count != 12) ||
      (pose_count != 0 && pose_count != 12))
    throw Error(where + ": its camera is of a stereo pair, of an RTAB-Map before 0.18, or damaged");
  const auto K = reader.number<std::array<double, 9>>();
  std::array<double, 14> D{};
  reader.raw(D.data(), static_cast<std::size_t>(d_count) * sizeof(double));
  (void)reader.take(static_cast<std::size_t>(r_count + p_count) * sizeof(double));
  RtabmapCamera result;
  result.camera = {head[4], head[5], K[0], K[4], K[2], K[5]};
  // Six coefficients are those of a fisheye lens; its images are stored rectified.
  if (d_count != 6) result.lens = {D[0], D[1], D[2], D[3], D[4], D[5], D[6], D[7]};
  if (pose_count == 12) {
    if (const auto T = transform_of(reader.number<std::array<float, 12>>())) result.T_robot_camera = *T;
  }
  if (reader.left() > 0) throw Error(where + ": has several cameras; must be a recording of one camera");
  return result;
}

constexpr std::string_view kRvlSignature = "DEPTHRVL", kInverseSignature = "DEPTHINV";

/// Depth image of a node. Its signatures are of RTAB-Map, corelib/src/Compression.cpp, compressImage():
/// DEPTHINV, two floats, and a depth image of either other kind, which holds quantised inverse depth;
/// DEPTHRVL and 16 bit in RVL, the default; none and a PNG.
struct RtabmapDepth {
  std::string_view image;  ///< after the signatures
  bool is_rvl = false;
  bool is_inverse = false;
  float a = 0.0F, b = 0.0F;  ///< of inverse depth
};

RtabmapDepth parse_depth(std::string_view bytes, const std::string& where) {
  RtabmapDepth depth{.image = bytes};
  if (depth.image.starts_with(kInverseSignature)) {
    ByteReader reader(depth.image.substr(kInverseSignature.size()), where);
    depth.is_inverse = true;
    depth.a = reader.number<float>();
    depth.b = reader.number<float>();
    depth.image = reader.take(reader.left());
  }
  depth.is_rvl = depth.image.starts_with(kRvlSignature);
  if (depth.is_rvl) depth.image.remove_prefix(kRvlSignature.size());
  return depth;
}

ImageSize image_size(std::string_view bytes, const std::string& where) {
  const ImageHeader header = read_image_header(bytes, where);
  return {header.width_px, header.height_px};
}

ImageSize depth_image_size(const std::string& bytes, const std::string& where) {
  const RtabmapDepth depth = parse_depth(bytes, where);
  if (!depth.is_rvl) return image_size(depth.image, where);
  const RvlSize size = read_rvl_size(depth.image, where);
  return {size.width_px, size.height_px};
}

void decode_rtabmap_depth(const std::string& bytes, ImageSize size, const std::string& where,
                          DepthImage& depth_m) {
  const RtabmapDepth depth = parse_depth(bytes, where);
  const double unit_m = depth.is_inverse ? 1.0 : 0.001;
  if (depth.is_rvl) {
    Image<std::uint16_t> units;
    decode_rvl(depth.image, {size.width_px, size.height_px}, where, units);
    convert_depth(units, unit_m, where, depth_m);
  } else if (read_image_header(depth.image, where).channels == 4) {
    decode_float_png(depth.image, where, depth_m);
  } else {
    decode_depth_png(depth.image, static_cast<float>(1.0 / unit_m), where, depth_m);
  }
  if (depth.is_inverse) convert_inverse_depth(depth.a, depth.b, depth_m);
}

}  // namespace

bool is_rtabmap(const std::filesystem::path& path) {
  if (path.extension() != ".db" || !is_sqlite(path)) return false;
  try {
    return SqliteFile(path).has_tables({"Node", "Data", "Link"});
  } catch (const Error&) {
    return false;
  }
}

IndexedRecording index_rtabmap(const std::filesystem::path& path) {
  const auto database = std::make_shared<const SqliteFile>(path);
  const std::string where = database->name();
  if (!database->has_column("Data", "calibration") || !database->has_column("Node", "stamp"))
    throw Error(where + ": is of an RTAB-Map before 0.18; open it once in a newer one, which converts it");

  IndexedRecording recording{.name = std::filesystem::canonical(path).string()};
  std::vector<std::int64_t> rows;
  std::vector<double> stamps_s;
  database->query(
      "SELECT Data.rowid, Node.stamp, Node.pose, length(Data.image) FROM Node JOIN Data ON Node.id = Data.id "
      "WHERE length(Data.depth) > 0 ORDER BY Node.stamp, Node.id",
      {}, [&](const SqliteRow& row) {
        rows.push_back(row.integer(0));
        stamps_s.push_back(row.number(1));
        recording.frames.push_back(
            {.has_colour = row.integer(3) > 0, .T_world_camera = pose_in(row.bytes(2))});
      });
  if (rows.empty()) throw Error(where + ": contains no node with a depth image");
  set_stamps(stamps_s, recording.frames);

  const auto read = [database](const char* column, std::int64_t row) {
    return database->read_up_to("Data", column, row, std::uint64_t{1} << 29U);
  };
  RtabmapCamera camera = read_camera(read("calibration", rows.front()), where);
  for (IndexedFrame& frame : recording.frames)
    if (frame.T_world_camera) frame.T_world_camera = *frame.T_world_camera * camera.T_robot_camera;
  const ImageSize depth_size = depth_image_size(read("depth", rows.front()), where + ": a depth image");
  const bool has_colour = recording.frames.front().has_colour;
  const ImageSize colour_size =
      has_colour ? image_size(read("image", rows.front()), where + ": a colour image") : depth_size;
  if (camera.camera.width_px <= 0) {  // some drivers leave it out
    camera.camera.width_px = colour_size.width_px;
    camera.camera.height_px = colour_size.height_px;
  }
  require_valid(camera.camera, (where + ", camera").c_str());
  recording.rig.depth_camera = scaled_to_depth(camera.camera, depth_size, where);
  recording.depth_lens = camera.lens;
  if (has_colour) {
    recording.rig.colour_camera = scaled_to_depth(camera.camera, colour_size, where);
    recording.colour_lens = camera.lens;
  }
  recording.read_depth = [read, rows, depth_size, where](std::size_t frame, DepthImage& depth_m) {
    decode_rtabmap_depth(read("depth", rows[frame]), depth_size, where + ": a depth image", depth_m);
  };
  recording.read_colour = [read, rows, where](std::size_t frame, ColourImage& image) {
    decode_colour(read("image", rows[frame]), where + ": a colour image", image);
  };
  return recording;
}

}  // namespace roomradar
