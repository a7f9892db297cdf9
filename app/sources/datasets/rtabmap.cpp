// rtabmap.cpp: reads the database's tables, and RTAB-Map's binary format of cameras.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/rvl_depth.hpp"
#include "app/sources/containers/sqlite_file.hpp"
#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

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
/// (floats). Source: RTAB-Map, corelib/src/CameraModel.cpp, serialize(), and CameraModel.h, fx().
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
  (void)reader.take(static_cast<std::size_t>(r_count) * sizeof(double));
  std::array<double, 12> P{};
  reader.raw(P.data(), static_cast<std::size_t>(p_count) * sizeof(double));
  RtabmapCamera result;
  const bool is_rectified = p_count == 12 && P[0] > 0.0;  // P is of the stored images then, K and D are not
  if (is_rectified)
    result.camera = {head[4], head[5], P[0], P[5], P[2], P[6]};
  else
    result.camera = {head[4], head[5], K[0], K[4], K[2], K[5]};
  // Six coefficients are those of a fisheye lens; its images are stored rectified.
  if (!is_rectified && d_count != 6) result.lens = {D[0], D[1], D[2], D[3], D[4], D[5], D[6], D[7]};
  if (pose_count == 12) {
    if (const auto T = transform_of(reader.number<std::array<float, 12>>())) result.T_robot_camera = *T;
  }
  if (reader.left() > 0) throw Error(where + ": has several cameras; must be a recording of one camera");
  return result;
}

constexpr double kUnit_m = 0.001;
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

void decode_rtabmap_depth(const std::string& bytes, ImageSize size, double unit_m, const std::string& where,
                          DepthImage& depth_m) {
  const RtabmapDepth depth = parse_depth(bytes, where);
  const bool is_float =
      depth.is_inverse || (!depth.is_rvl && read_image_header(depth.image, where).channels == 4);
  // Floats are metres, and units 1 mm by the format: another unit scales both.
  const double factor = unit_m / kUnit_m;
  if (depth.is_inverse) unit_m = 1.0;
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
  if (is_float) scale_depth(factor, depth_m);
}

/// A node with a depth image: its session, its pose by the odometry of that session, and its camera.
struct Node {
  std::int64_t id = 0;
  std::int64_t session = 0;
  std::optional<Eigen::Isometry3d> T_odometry_robot{};
  std::optional<RtabmapCamera> camera{};  ///< unset: it is damaged or absent
};

/// Returns the values of a matrix that RTAB-Map compressed: a zlib stream, then rows, columns and OpenCV's
/// type as 32 bit integers. Empty if it is absent, damaged or of another type. Source: RTAB-Map,
/// corelib/src/Compression.cpp, compressData2() and uncompressData().
template <typename Value>
std::vector<Value> uncompressed_matrix(const std::string& bytes, std::int32_t type,
                                       const std::string& where) {
  constexpr std::size_t kTail_bytes = 12;
  std::array<std::int32_t, 3> tail{};
  if (bytes.size() < kTail_bytes) return {};
  std::memcpy(tail.data(), bytes.data() + bytes.size() - kTail_bytes, kTail_bytes);
  if (tail[0] < 1 || tail[1] < 1 || tail[2] != type) return {};
  const std::uint64_t size =
      sizeof(Value) * static_cast<std::uint64_t>(tail[0]) * static_cast<std::uint64_t>(tail[1]);
  try {
    const std::string raw = decompress(
        Compression::kZlib, std::string_view(bytes).substr(0, bytes.size() - kTail_bytes), size, where);
    std::vector<Value> values(raw.size() / sizeof(Value));
    std::memcpy(values.data(), raw.data(), values.size() * sizeof(Value));
    return values;
  } catch (const Error&) {
    return {};
  }
}

/// Returns the poses that RTAB-Map's optimisation of the whole graph gave, by node; empty if it was not
/// saved.
std::map<std::int64_t, Eigen::Isometry3d> optimised_poses(const SqliteFile& database) {
  constexpr std::int32_t kInt32 = 4, kFloat32 = 5;  // OpenCV's CV_32S and CV_32F
  std::map<std::int64_t, Eigen::Isometry3d> poses;
  if (!database.has_tables({"Admin"}) || !database.has_column("Admin", "opt_poses") ||
      !database.has_column("Admin", "opt_ids"))
    return poses;
  std::string id_bytes, pose_bytes;
  database.query("SELECT opt_ids, opt_poses FROM Admin", {}, [&](const SqliteRow& row) {
    id_bytes = row.bytes(0);
    pose_bytes = row.bytes(1);
  });
  const std::string where = database.name() + ": the optimised poses";
  const auto ids = uncompressed_matrix<std::int32_t>(id_bytes, kInt32, where);
  const auto values = uncompressed_matrix<float>(pose_bytes, kFloat32, where);
  if (values.size() != 12 * ids.size()) return poses;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::array<float, 12> m{};
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(12 * i), 12, m.begin());
    if (const auto T = transform_of(m)) poses.emplace(ids[i], *T);
  }
  return poses;
}

/// Sets the poses of the frames: those of the optimised graph. A node that is not in the graph gets its
/// odometry pose, moved like the nearest node of its session that is. Without an optimised graph, odometry
/// poses of one session only: each session has a world frame of its own.
void set_poses(const SqliteFile& database, const std::vector<Node>& nodes, RecordingFacts& facts) {
  const std::map<std::int64_t, Eigen::Isometry3d> optimised = optimised_poses(database);
  std::map<std::int64_t, std::size_t> frames_of_session;
  for (const Node& node : nodes) ++frames_of_session[node.session];
  const auto longest =
      std::max_element(frames_of_session.begin(), frames_of_session.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;
  std::map<std::int64_t, Eigen::Isometry3d> T_world_odometry;  // by session, of the last node in the graph
  for (const Node& node : nodes)
    if (const auto T = optimised.find(node.id); T != optimised.end() && node.T_odometry_robot)
      T_world_odometry.try_emplace(node.session, T->second * node.T_odometry_robot->inverse());
  std::size_t without = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = nodes[i];
    StatedFrame& frame = facts.frames[i];
    const auto T = optimised.find(node.id);
    if (T != optimised.end() && node.T_odometry_robot)
      T_world_odometry[node.session] = T->second * node.T_odometry_robot->inverse();
    const auto moved = T_world_odometry.find(node.session);
    if (T != optimised.end())
      frame.T_world_camera = T->second;
    else if (node.T_odometry_robot && moved != T_world_odometry.end())
      frame.T_world_camera = moved->second * *node.T_odometry_robot;
    else if (node.T_odometry_robot && optimised.empty() && node.session == longest)
      frame.T_world_camera = node.T_odometry_robot;
    else if (node.T_odometry_robot)
      ++without;
    else
      frame.pose_fault = "is no rigid transform";
  }
  if (frames_of_session.size() > 1)
    facts.notes.push_back(
        {"poses",
         "the database holds " + std::to_string(frames_of_session.size()) +
             " sessions, each with a world frame of its own; " +
             (optimised.empty()
                  ? "it has no optimised poses that join them, so "
                  : "the optimised poses join them" + std::string(without > 0 ? ", but " : "")) +
             (without > 0 ? std::to_string(without) + " frames are used without a pose" : ""),
         static_cast<std::int64_t>(without), "", without > 0});
}

/// Returns the first node whose camera has the size that most nodes' cameras have. Throws Error with `fault` if no
/// node has a camera.
std::size_t first_of_usual_camera(const std::vector<Node>& nodes, const std::string& fault) {
  std::map<std::pair<int, int>, std::size_t> nodes_of_size;
  for (const Node& node : nodes)
    if (node.camera) ++nodes_of_size[{node.camera->camera.width_px, node.camera->camera.height_px}];
  if (nodes_of_size.empty()) throw Error(fault);
  const auto usual = std::max_element(nodes_of_size.begin(), nodes_of_size.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto first = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) {
    return node.camera && std::pair(node.camera->camera.width_px, node.camera->camera.height_px) == usual->first;
  });
  return static_cast<std::size_t>(first - nodes.begin());
}

/// Notes nodes whose camera differs from the one that is used for all.
void note_other_cameras(const std::vector<Node>& nodes, const RtabmapCamera& used, RecordingFacts& facts) {
  constexpr double kLeast = 0.02;  // phones focus again for each image, by less
  std::int64_t other_size = 0, other_focal = 0;
  double most = 0.0;
  for (const Node& node : nodes) {
    if (!node.camera) continue;
    const Intrinsics& camera = node.camera->camera;
    if (camera.width_px != used.camera.width_px || camera.height_px != used.camera.height_px) {
      ++other_size;
      continue;
    }
    const double difference = std::abs(camera.fx_px / used.camera.fx_px - 1.0);
    if (difference < kLeast) continue;
    ++other_focal;
    most = std::max(most, difference);
  }
  if (other_size > 0)
    facts.notes.push_back({"camera",
                           std::to_string(other_size) + " of " + std::to_string(nodes.size()) +
                               " nodes have a camera of another size; their images are left out if they differ, too",
                           other_size, "", true});
  if (other_focal > 0)
    facts.notes.push_back({"camera",
                           "the focal length of " + std::to_string(other_focal) + " of " +
                               std::to_string(nodes.size()) + " nodes differs, by up to " +
                               format_readable(100.0 * most, 2) + " %; that of the first one is used for all",
                           other_focal, "--camera FILE", true});
}

/// The nodes with a depth image, by session and stamp.
struct NodeTable {
  std::vector<std::int64_t> rows{};  ///< per node: its row in the table Data
  std::vector<Node> nodes{};
  std::string camera_fault{};  ///< of the first camera that cannot be read
};

/// Reads the nodes, and adds a frame for each.
NodeTable read_nodes(const SqliteFile& database, std::vector<StatedFrame>& frames) {
  NodeTable table;
  // The oldest databases have one session only.
  const std::string session = database.has_column("Node", "map_id") ? "Node.map_id" : "0 * Node.id";
  database.query("SELECT Data.rowid, Node.stamp, Node.pose, length(Data.image), Node.id, " + session +
                     ", Data.calibration FROM Node JOIN Data ON Node.id = Data.id WHERE length(Data.depth) > "
                     "0 ORDER BY " +
                     session + ", Node.stamp, Node.id",
                 {}, [&](const SqliteRow& row) {
                   if (row.integer(3) > 0)
                     frames.push_back({.time = {row.number(1)}, .colour = table.rows.size()});
                   else
                     frames.push_back({.time = {row.number(1)}});
                   table.rows.push_back(row.integer(0));
                   table.nodes.push_back({row.integer(4), row.integer(5), pose_in(row.bytes(2)), {}});
                   try {
                     table.nodes.back().camera = read_camera(row.bytes(6), database.name());
                   } catch (const Error& fault) {
                     if (table.camera_fault.empty()) table.camera_fault = fault.what();
                   }
                 });
  return table;
}

/// The images of the nodes, which stay in the database.
struct NodeImages {
  std::shared_ptr<const SqliteFile> database;
  std::vector<std::int64_t> rows;  ///< as NodeTable::rows

  [[nodiscard]] std::string read(const char* column, std::size_t node) const {
    return database->read_up_to("Data", column, rows[node], std::uint64_t{1} << 29U);
  }
};

/// Returns the size of the first image that can be read, from the node `first` on, and the first fault of the
/// others.
/// @param has_image  callable that returns true if a node has an image in the column
/// @param size_of    callable that returns the size of an encoded image
template <typename HasImage, typename SizeOf>
std::pair<std::optional<ImageSize>, std::string> first_size(const NodeImages& images, const char* column,
                                                            std::size_t first, const HasImage& has_image,
                                                            const SizeOf& size_of) {
  std::string fault;
  for (std::size_t k = 0; k < images.rows.size(); ++k) {
    const std::size_t i = (first + k) % images.rows.size();
    if (!has_image(i)) continue;
    try {
      return {size_of(images.read(column, i)), fault};
    } catch (const Error& error) {
      if (fault.empty()) fault = error.what();
    }
  }
  return {std::nullopt, fault};
}

/// Sets the cameras of depth and colour: `camera`, scaled to the images.
/// @param colour_size  nullopt: no colour image can be read
void set_cameras(RtabmapCamera camera, ImageSize depth_size, std::optional<ImageSize> colour_size,
                 const std::string& where, RecordingFacts& facts) {
  if (camera.camera.width_px <= 0) {  // some drivers leave it out
    const ImageSize size = colour_size.value_or(depth_size);
    camera.camera.width_px = size.width_px;
    camera.camera.height_px = size.height_px;
  }
  require_valid(camera.camera, (where + ", camera").c_str());
  facts.rig.depth_camera = scaled_to_depth(camera.camera, depth_size, where);
  facts.depth_lens = camera.lens;
  facts.camera_source = "its table Data";
  facts.is_depth_registered = true;
  if (!colour_size) return;
  facts.rig.colour_camera = scaled_to_depth(camera.camera, *colour_size, where);
  facts.colour_lens = camera.lens;
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

RecordingFacts index_rtabmap(const std::filesystem::path& path) {
  const auto database = std::make_shared<const SqliteFile>(path);
  const std::string where = database->name();
  if (!database->has_column("Data", "calibration") || !database->has_column("Node", "stamp"))
    throw Error(where + ": is of an RTAB-Map before 0.18; open it once in a newer one, which converts it");

  RecordingFacts facts{.name = std::filesystem::canonical(path).string()};
  const NodeTable table = read_nodes(*database, facts.frames);
  const std::vector<Node>& nodes = table.nodes;
  if (nodes.empty()) throw Error(where + ": contains no node with a depth image");
  set_poses(*database, nodes, facts);
  const std::size_t first = first_of_usual_camera(nodes, table.camera_fault);
  const RtabmapCamera& camera = *nodes[first].camera;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    StatedFrame& frame = facts.frames[i];
    const RtabmapCamera& own = nodes[i].camera ? *nodes[i].camera : camera;
    if (frame.T_world_camera) frame.T_world_camera = *frame.T_world_camera * own.T_robot_camera;
  }
  note_other_cameras(nodes, camera, facts);

  const NodeImages images{database, table.rows};
  const auto [depth_size, depth_fault] = first_size(
      images, "depth", first, [](std::size_t) { return true; },
      [&](const std::string& bytes) { return depth_image_size(bytes, where + ": a depth image"); });
  if (!depth_size) throw Error(depth_fault);
  const std::optional<ImageSize> colour_size =
      first_size(
          images, "image", first, [&](std::size_t i) { return facts.frames[i].colour.has_value(); },
          [&](const std::string& bytes) { return image_size(bytes, where + ": a colour image"); })
          .first;
  set_cameras(camera, *depth_size, colour_size, where, facts);
  facts.depth_unit_m = kUnit_m;
  facts.read_depth = [images, size = *depth_size, where](std::size_t frame, double unit_m,
                                                         DepthImage& depth_m) {
    decode_rtabmap_depth(images.read("depth", frame), size, unit_m, where + ": a depth image", depth_m);
  };
  facts.read_colour = [images, where](std::size_t frame, ColourImage& image) {
    decode_colour(images.read("image", frame), where + ": a colour image", image);
  };
  return facts;
}

}  // namespace roomradar
