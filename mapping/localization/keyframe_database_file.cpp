// keyframe_database_file.cpp: reads and writes the keyframe database as one binary file.
//
// All numbers are little-endian. Header: "RRPLACES", version (u32). Then columns (see compressed_columns.hpp)
// with the items of all views:
// - preview depth (u16, mm): differences from the pixel before
// - points (i32, in steps of 0.2 mm): 3 per feature, then 3 per patch
// - directions of the patches (i16, in steps of 1 / 32,767): 3 of the normal, 3 of `along`
// - bytes: 32 per feature (descriptor), then 33 per patch (size, descriptor)
// The steps round points by at most 0.1 mm and directions by 0.002 degrees, far below the noise of depth.
// Then the number of views (u32). Each view: frame index (i64), pose (12 f64: rotation by rows, translation),
// preview camera (2 u32, 4 f64), number of features (u32), number of patches (u32). The file ends with the
// FNV-1a hash (u64) of all bytes before it.
//
// In version 2 there are no columns. Each view holds its items itself, not rounded: preview depth before the
// number of features, points (3 f32 each) and descriptors after it, and per patch point, normal, `along` (3
// f32 each), size and descriptor after the number of patches.
#include "mapping/localization/keyframe_database_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMagic = "RRPLACES";
constexpr std::uint32_t kInline = 2, kColumns = 3;  // versions of the file; version 1 had no patches
constexpr std::uint32_t kMaxPreview_px = 4096;      // per side
constexpr double kMaxPlace_m = 1e5;                 // a map reaches at most 32,768 voxels of 1 m
constexpr float kPointStep_m = 2e-4F;
constexpr float kDirectionStep = 1.0F / 32767.0F;

/// The items of all views, in the order of views.
struct ViewColumns {
  std::vector<std::uint16_t> depth_mm;
  std::vector<std::int32_t> points;
  std::vector<std::int16_t> directions;
  std::vector<std::uint8_t> bytes;
};

/// Returns the sum over all views of count(view). Reserving it avoids copies: long scans have 100 MB of
/// items.
template <typename Count>
std::size_t sum_of(std::span<const MapKeyframe> views, const Count& count) {
  return std::accumulate(views.begin(), views.end(), std::size_t{0},
                         [&](std::size_t sum, const MapKeyframe& view) { return sum + count(view); });
}

std::vector<std::uint16_t> depth_column(std::span<const MapKeyframe> views) {
  std::vector<std::uint16_t> depth_mm;
  depth_mm.reserve(sum_of(views, [](const MapKeyframe& v) { return v.preview_depth_mm.pixels.size(); }));
  for (const MapKeyframe& view : views) {
    std::uint16_t before = 0;
    for (const std::uint16_t pixel_mm : view.preview_depth_mm.pixels) {
      depth_mm.push_back(static_cast<std::uint16_t>(pixel_mm - before));
      before = pixel_mm;
    }
  }
  return depth_mm;
}

std::vector<std::int32_t> point_column(std::span<const MapKeyframe> views) {
  constexpr float kMost = 1e9F;  // 200 km
  std::vector<std::int32_t> points;
  points.reserve(
      3 * sum_of(views, [](const MapKeyframe& v) { return v.points_camera.size() + v.patches.size(); }));
  const auto put_point = [&](const Eigen::Vector3f& point) {
    for (const float component : point)
      points.push_back(
          static_cast<std::int32_t>(std::lround(std::clamp(component / kPointStep_m, -kMost, kMost))));
  };
  for (const MapKeyframe& view : views) {
    for (const Eigen::Vector3f& point : view.points_camera) put_point(point);
    for (const SurfacePatch& patch : view.patches) put_point(patch.point);
  }
  return points;
}

std::vector<std::int16_t> direction_column(std::span<const MapKeyframe> views) {
  std::vector<std::int16_t> directions;
  directions.reserve(6 * sum_of(views, [](const MapKeyframe& v) { return v.patches.size(); }));
  for (const MapKeyframe& view : views)
    for (const SurfacePatch& patch : view.patches)
      for (const Eigen::Vector3f& direction : {patch.normal, patch.along})
        for (const float component : direction)
          directions.push_back(
              static_cast<std::int16_t>(std::lround(std::clamp(component, -1.0F, 1.0F) / kDirectionStep)));
  return directions;
}

std::vector<std::uint8_t> byte_column(std::span<const MapKeyframe> views) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(sum_of(views, [](const MapKeyframe& v) {
    return v.descriptors.size() * sizeof(Descriptor) + v.patches.size() * (1 + sizeof(Descriptor));
  }));
  for (const MapKeyframe& view : views) {
    for (const Descriptor& bits : view.descriptors) bytes.insert(bytes.end(), bits.begin(), bits.end());
    for (const SurfacePatch& patch : view.patches) {
      bytes.push_back(patch.size);
      bytes.insert(bytes.end(), patch.bits.begin(), patch.bits.end());
    }
  }
  return bytes;
}

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
  put(out, static_cast<std::uint32_t>(place.descriptors.size()));
  put(out, static_cast<std::uint32_t>(place.patches.size()));
}

/// Takes the items of views, in the order of views: from columns, or in version 2 from the views themselves.
class ItemReader {
 public:
  ItemReader(BinaryReader& in, const ViewColumns* columns) : in_(in), columns_(columns) {}

  void take_depth(std::vector<std::uint16_t>& depth_mm) {
    if (!columns_) return in_.take(depth_mm.data(), depth_mm.size(), "preview depth");
    std::uint16_t before = 0;
    for (std::uint16_t& depth : depth_mm)
      before = depth = static_cast<std::uint16_t>(before + next(columns_->depth_mm, depth_, "preview depth"));
  }
  Eigen::Vector3f take_point(const char* what) {
    Eigen::Vector3f point;
    if (!columns_) {
      in_.take(point.data(), 3, what);
      if (!point.allFinite()) in_.fail(std::string(what) + ": a position is not a number");
    } else {
      for (float& component : point)
        component = static_cast<float>(next(columns_->points, point_, what)) * kPointStep_m;
    }
    return point;
  }
  Eigen::Vector3f take_direction() {
    Eigen::Vector3f direction;
    if (!columns_) {
      in_.take(direction.data(), 3, "patches");
    } else {
      for (float& component : direction)
        component = static_cast<float>(next(columns_->directions, direction_, "patches")) * kDirectionStep;
    }
    return direction;
  }
  void take_bytes(std::uint8_t* bytes, std::size_t count, const char* what) {
    if (!columns_) return in_.take(bytes, count, what);
    if (count > columns_->bytes.size() - byte_) fail_cut_short(what);
    std::copy_n(columns_->bytes.data() + byte_, count, bytes);
    byte_ += count;
  }
  /// Throw if not all pixels, features or patches are there.
  void require_depth(std::size_t pixels) const {
    if (!columns_) return in_.require(pixels, sizeof(std::uint16_t), "preview depth");
    if (pixels > columns_->depth_mm.size() - depth_) fail_cut_short("preview depth");
  }
  void require_described(std::size_t count, const char* what) const {
    if (!columns_) return in_.require(count, 3 * sizeof(float) + sizeof(Descriptor), what);
    if (count > (columns_->bytes.size() - byte_) / sizeof(Descriptor)) fail_cut_short(what);
  }
  void require_end() const {
    if (in_.left() != 0) in_.fail(std::to_string(in_.left()) + " bytes more than the views take");
    if (columns_ && (depth_ != columns_->depth_mm.size() || point_ != columns_->points.size() ||
                     direction_ != columns_->directions.size() || byte_ != columns_->bytes.size()))
      in_.fail("items more than the views take");
  }

 private:
  [[noreturn]] void fail_cut_short(const char* what) const {
    in_.fail(std::string("cut short: ") + what + " missing");
  }
  template <typename Item>
  Item next(const std::vector<Item>& items, std::size_t& at, const char* what) const {
    if (at == items.size()) fail_cut_short(what);
    return items[at++];
  }

  BinaryReader& in_;
  const ViewColumns* columns_;                                    ///< null: version 2
  std::size_t depth_ = 0, point_ = 0, direction_ = 0, byte_ = 0;  ///< items taken of each column
};

SurfacePatch take_patch(ItemReader& items, const BinaryReader& in) {
  SurfacePatch patch;
  patch.point = items.take_point("patches");
  patch.normal = items.take_direction();
  patch.along = items.take_direction();
  constexpr float kUnit = 1e-3F;
  if (!(std::abs(patch.normal.norm() - 1.0F) <= kUnit && std::abs(patch.along.norm() - 1.0F) <= kUnit &&
        std::abs(patch.normal.dot(patch.along)) <= kUnit))
    in.fail("a patch's directions are not two at right angles");
  items.take_bytes(&patch.size, 1, "patches");
  if (patch.size >= kPatchSizes) in.fail("a patch of size " + std::to_string(patch.size));
  items.take_bytes(patch.bits.data(), patch.bits.size(), "patches");
  return patch;
}

/// Takes the number of features or patches of a view.
std::uint32_t take_count(BinaryReader& in, const char* what) {
  const auto count = in.take<std::uint32_t>(what);
  if (count > static_cast<std::uint32_t>(kMostDescribed))
    in.fail("a view of " + std::to_string(count) + " " + what);
  return count;
}

/// Takes the preview's camera, and sets the size of its depth image.
void take_camera(BinaryReader& in, const ItemReader& items, MapKeyframe& place) {
  const auto width = in.take<std::uint32_t>("preview size"), height = in.take<std::uint32_t>("preview size");
  if (width > kMaxPreview_px || height > kMaxPreview_px) {
    in.fail("a preview of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  std::array<double, 4> camera{};
  in.take(camera.data(), camera.size(), "preview camera");
  place.preview_camera = {
      static_cast<int>(width), static_cast<int>(height), camera[0], camera[1], camera[2], camera[3]};
  require_valid(place.preview_camera, (in.path() + ": a preview's camera").c_str());
  items.require_depth(std::size_t{width} * height);
  place.preview_depth_mm.resize(static_cast<int>(width), static_cast<int>(height));
}

void take_pose(BinaryReader& in, Eigen::Isometry3d& T_world_camera) {
  std::array<double, 12> pose{};
  in.take(pose.data(), pose.size(), "pose");
  if (!std::all_of(pose.begin(), pose.end(), [](double x) { return std::isfinite(x); })) {
    in.fail("a view's pose is not a number");
  }
  T_world_camera.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.data());
  T_world_camera.translation() = Eigen::Map<const Eigen::Vector3d>(pose.data() + 9);
  if (!(T_world_camera.translation().cwiseAbs().maxCoeff() <= kMaxPlace_m))
    in.fail("a view's pose is 100 km away and more, where no map reaches");
  if (!is_rigid(T_world_camera, 1e-6)) in.fail("a view's pose is not a rotation");
}

MapKeyframe take_place(BinaryReader& in, ItemReader& items) {
  MapKeyframe place;
  place.frame_index = in.take<std::int64_t>("frame index");
  take_pose(in, place.T_world_camera);
  take_camera(in, items, place);
  items.take_depth(place.preview_depth_mm.pixels);

  const std::uint32_t features = take_count(in, "features");
  items.require_described(features, "features");
  place.points_camera.resize(features);
  place.descriptors.resize(features);
  for (Eigen::Vector3f& p : place.points_camera) p = items.take_point("feature points");
  for (Descriptor& bits : place.descriptors) items.take_bytes(bits.data(), bits.size(), "descriptors");

  const std::uint32_t patches = take_count(in, "patches");
  items.require_described(patches, "patches");
  place.patches.reserve(patches);
  for (std::uint32_t i = 0; i < patches; ++i) place.patches.push_back(take_patch(items, in));
  return place;
}

ViewColumns take_columns(ColumnReader& in) {
  ViewColumns columns;
  columns.depth_mm = in.take<std::uint16_t>("preview depths");
  columns.points = in.take<std::int32_t>("points");
  columns.directions = in.take<std::int16_t>("directions");
  columns.bytes = in.take<std::uint8_t>("descriptors");
  return columns;
}

}  // namespace

void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path) {
  const std::vector<MapKeyframe>& views = keyframe_database.keyframes;
  std::string out;
  put_column(out, depth_column(views));
  put_column(out, point_column(views));
  put_column(out, direction_column(views));
  put_column(out, byte_column(views));
  put(out, static_cast<std::uint32_t>(views.size()));
  for (const MapKeyframe& view : views) put_place(out, view);
  write_binary(path, kMagic, kColumns, out);
}

KeyframeDatabase read_keyframe_database(const std::filesystem::path& path) {
  const BinaryBody body = read_binary(path, kMagic, kInline, kColumns);
  ColumnReader in(body.bytes, path);
  std::optional<ViewColumns> columns;
  if (body.version == kColumns) columns = take_columns(in);
  ItemReader items(in.numbers(), columns ? &*columns : nullptr);
  KeyframeDatabase keyframe_database;
  const auto count = in.numbers().take<std::uint32_t>("number of views");
  for (std::uint32_t i = 0; i < count; ++i)
    keyframe_database.keyframes.push_back(take_place(in.numbers(), items));
  items.require_end();
  return keyframe_database;
}

}  // namespace roomradar
