// keyframe_database_file.cpp: reads and writes the keyframe database as one binary file.
//
// All numbers are little-endian. Header: "RRPLACES", version (u32), number of views (u32). Each view: frame
// index (i64), pose (12 f64: rotation by rows, translation), preview camera (2 u32, 4 f64), preview depth
// (u16 per pixel), number of features (u32), their points (3 f32 each), their descriptors (32 bytes each),
// number of patches (u32), patches. Each patch: point, normal and direction (3 f32 each), size (u8),
// descriptor (32 bytes). The file ends with the FNV-1a hash (u64) of all bytes before it.
#include "mapping/localization/keyframe_database_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMagic = "RRPLACES";
constexpr std::uint32_t kVersion = 2;           // version 1 had no patches
constexpr std::uint32_t kMaxPreview_px = 4096;  // per side
constexpr double kMaxPlace_m = 1e5;             // a map reaches at most 32,768 voxels of 1 m

void put_place(std::string& out, const MapKeyframe& place) {
  put(out, place.frame_index);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) put(out, place.T_world_camera.linear()(row, column));
  }
  for (int row = 0; row < 3; ++row) put(out, place.T_world_camera.translation()(row));
  put(out, static_cast<std::uint32_t>(place.preview_camera.width_px));
  put(out, static_cast<std::uint32_t>(place.preview_camera.height_px));
  for (const double number : {place.preview_camera.fx_px, place.preview_camera.fy_px,
                              place.preview_camera.cx_px, place.preview_camera.cy_px}) {
    put(out, number);
  }
  put(out, place.preview_depth_mm.pixels.data(), place.preview_depth_mm.pixels.size());
  put(out, static_cast<std::uint32_t>(place.descriptors.size()));
  for (const Eigen::Vector3f& p : place.points_camera) put(out, p.data(), 3);
  for (const Descriptor& bits : place.descriptors) put(out, bits.data(), bits.size());
  put(out, static_cast<std::uint32_t>(place.patches.size()));
  for (const SurfacePatch& patch : place.patches) {
    for (const Eigen::Vector3f* v : {&patch.point, &patch.normal, &patch.along}) put(out, v->data(), 3);
    put(out, patch.size);
    put(out, patch.bits.data(), patch.bits.size());
  }
}

SurfacePatch take_patch(BinaryReader& in) {
  SurfacePatch patch;
  for (Eigen::Vector3f* v : {&patch.point, &patch.normal, &patch.along}) {
    in.take(v->data(), 3, "patches");
    if (!v->allFinite()) in.fail("a patch's position is not a number");
  }
  constexpr float kUnit = 1e-3F;
  if (std::abs(patch.normal.norm() - 1.0F) > kUnit || std::abs(patch.along.norm() - 1.0F) > kUnit ||
      std::abs(patch.normal.dot(patch.along)) > kUnit)
    in.fail("a patch's directions are not two at right angles");
  patch.size = in.take<std::uint8_t>("patches");
  if (patch.size >= kPatchSizes) in.fail("a patch of size " + std::to_string(patch.size));
  in.take(patch.bits.data(), patch.bits.size(), "patches");
  return patch;
}

/// Takes the number of items that follow, and fails unless all of them are there.
std::uint32_t take_count(BinaryReader& in, const char* what, std::size_t item_bytes) {
  const auto count = in.take<std::uint32_t>(what);
  if (count > static_cast<std::uint32_t>(kMostDescribed))
    in.fail("a view of " + std::to_string(count) + " " + what);
  in.require(count, item_bytes, what);
  return count;
}

MapKeyframe take_place(BinaryReader& in) {
  MapKeyframe place;
  place.frame_index = in.take<std::int64_t>("frame index");
  std::array<double, 12> pose{};
  in.take(pose.data(), pose.size(), "pose");
  if (!std::all_of(pose.begin(), pose.end(), [](double x) { return std::isfinite(x); })) {
    in.fail("a view's pose is not a number");
  }
  place.T_world_camera.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.data());
  place.T_world_camera.translation() = Eigen::Map<const Eigen::Vector3d>(pose.data() + 9);
  if (!(place.T_world_camera.translation().cwiseAbs().maxCoeff() <= kMaxPlace_m))
    in.fail("a view's pose is 100 km away and more, where no map reaches");
  if (!is_rigid(place.T_world_camera, 1e-6)) in.fail("a view's pose is not a rotation");

  const auto width = in.take<std::uint32_t>("preview size"), height = in.take<std::uint32_t>("preview size");
  if (width > kMaxPreview_px || height > kMaxPreview_px) {
    in.fail("a preview of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  std::array<double, 4> camera{};
  in.take(camera.data(), camera.size(), "preview camera");
  place.preview_camera = {
      static_cast<int>(width), static_cast<int>(height), camera[0], camera[1], camera[2], camera[3]};
  require_valid(place.preview_camera, (in.path() + ": a preview's camera").c_str());
  in.require(std::size_t{width} * height, sizeof(std::uint16_t), "preview depth");
  place.preview_depth_mm.resize(static_cast<int>(width), static_cast<int>(height));
  in.take(place.preview_depth_mm.pixels.data(), place.preview_depth_mm.pixels.size(), "preview depth");

  const std::uint32_t features = take_count(in, "features", 3 * sizeof(float) + sizeof(Descriptor));
  place.points_camera.resize(features);
  place.descriptors.resize(features);
  for (Eigen::Vector3f& p : place.points_camera) {
    in.take(p.data(), 3, "feature points");
    if (!p.allFinite()) in.fail("a feature's point is not a number");
  }
  for (Descriptor& bits : place.descriptors) in.take(bits.data(), bits.size(), "descriptors");

  const std::uint32_t patches = take_count(in, "patches", 9 * sizeof(float) + 1 + sizeof(Descriptor));
  place.patches.reserve(patches);
  for (std::uint32_t i = 0; i < patches; ++i) place.patches.push_back(take_patch(in));
  return place;
}

}  // namespace

void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path) {
  std::string out;
  put(out, static_cast<std::uint32_t>(keyframe_database.keyframes.size()));
  for (const MapKeyframe& place : keyframe_database.keyframes) put_place(out, place);
  write_binary(path, kMagic, kVersion, out);
}

KeyframeDatabase read_keyframe_database(const std::filesystem::path& path) {
  const std::string bytes = read_binary(path, kMagic, kVersion);
  BinaryReader in(bytes, path);
  KeyframeDatabase keyframe_database;
  const auto count = in.take<std::uint32_t>("number of views");
  for (std::uint32_t i = 0; i < count; ++i) keyframe_database.keyframes.push_back(take_place(in));
  if (in.left() != 0) in.fail(std::to_string(in.left()) + " bytes more than the views take");
  return keyframe_database;
}

}  // namespace roomradar
