// keyframe_database.cpp: makes keyframes for relocalisation in a known room; reads and writes them as one
// binary file.
//
// The file: all numbers are little-endian. Header: "RRPLACES", version (u32). Then columns (see
// compressed_columns.hpp) with the items of all views:
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
#include "mapping/localization/keyframe_database.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <vector>

#include "mapping/alignment/surface_point.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

void describe_features(const Frame& frame, int most, MapKeyframe& place) {
  cv::Mat3b colour(frame.colour.height, frame.colour.width);
  std::memcpy(colour.data, frame.colour.pixels.data(), frame.colour.pixels.size() * sizeof(Rgb));
  cv::Mat1b grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  constexpr int kFastThreshold = 12;  // of 255; low, because rooms have dim, plain walls
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(most, 1.2F, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, kFastThreshold);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat1b descriptors;
  orb->detectAndCompute(grey, cv::noArray(), keypoints, descriptors);

  std::vector<std::size_t> strongest(keypoints.size());
  for (std::size_t i = 0; i < strongest.size(); ++i) strongest[i] = i;
  std::stable_sort(strongest.begin(), strongest.end(), [&](std::size_t a, std::size_t b) {
    return keypoints[a].response > keypoints[b].response;
  });
  const Eigen::Isometry3d T_depth_colour = frame.T_colour_depth.inverse();
  for (const std::size_t i : strongest) {
    const auto p = surface_point_at(frame, T_depth_colour, static_cast<double>(keypoints[i].pt.x),
                                    static_cast<double>(keypoints[i].pt.y));
    if (!p) continue;
    Descriptor& bits = place.descriptors.emplace_back();
    std::memcpy(bits.data(), descriptors.ptr(static_cast<int>(i)), bits.size());
    place.points_camera.push_back(*p);
  }
}

constexpr std::string_view kMagic = "RRPLACES";
constexpr std::uint32_t kInline = 2, kColumns = 3;  // versions of the file; version 1 had no patches
constexpr std::uint32_t kMaxPreview_px = 4096;      // per side
constexpr double kMaxPlace_m = 1e5;                 // a map reaches at most 32,768 voxels of 1 m
constexpr float kPointStep_m = 2e-4F;
constexpr float kDirectionStep = 1.0F / 32767.0F;

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

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

void put_place(ByteWriter& out, const MapKeyframe& place) {
  const Intrinsics& camera = place.preview_camera;
  out(place.frame_index, RowMajor3d(place.T_world_camera.linear()),
      Eigen::Vector3d(place.T_world_camera.translation()), camera.width_px, camera.height_px, camera.fx_px,
      camera.fy_px, camera.cx_px, camera.cy_px, static_cast<std::uint32_t>(place.descriptors.size()),
      static_cast<std::uint32_t>(place.patches.size()));
}

/// Items of the columns that no view read so far has claimed.
struct UnclaimedItems {
  std::size_t depth, points, directions, bytes;
};

void claim(std::size_t count, std::size_t& unclaimed, const char* what, const ByteReader& in) {
  if (count > unclaimed) in.fail(std::string("cut short: ") + what + " missing");
  unclaimed -= count;
}

/// Takes the number of features or patches of a view.
std::uint32_t take_count(ByteReader& in, const char* what) {
  const auto count = in.number<std::uint32_t>();
  if (count > static_cast<std::uint32_t>(kMostDescribed))
    in.fail("a view of " + std::to_string(count) + " " + what);
  return count;
}

/// Takes the preview's camera. Returns the number of its pixels.
std::size_t take_camera(ByteReader& in, Intrinsics& preview) {
  const auto width = in.number<std::uint32_t>(), height = in.number<std::uint32_t>();
  if (width > kMaxPreview_px || height > kMaxPreview_px) {
    in.fail("a preview of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  preview.width_px = static_cast<int>(width);
  preview.height_px = static_cast<int>(height);
  in(preview.fx_px, preview.fy_px, preview.cx_px, preview.cy_px);
  require_valid(preview, (in.where() + ": a preview's camera").c_str());
  return std::size_t{width} * height;
}

void take_pose(ByteReader& in, Eigen::Isometry3d& T_world_camera) {
  RowMajor3d R;
  Eigen::Vector3d t;
  serialize_finite(in, "a view's pose", R, t);
  T_world_camera.linear() = R;
  T_world_camera.translation() = t;
  if (!(T_world_camera.translation().cwiseAbs().maxCoeff() <= kMaxPlace_m))
    in.fail("a view's pose is 100 km away and more, where no map reaches");
  if (!is_rigid(T_world_camera, 1e-6)) in.fail("a view's pose is not a rotation");
}

void require_sound(const SurfacePatch& patch, const ByteReader& in) {
  constexpr float kUnit = 1e-3F;
  if (!(std::abs(patch.normal.norm() - 1.0F) <= kUnit && std::abs(patch.along.norm() - 1.0F) <= kUnit &&
        std::abs(patch.normal.dot(patch.along)) <= kUnit))
    in.fail("a patch's directions are not two at right angles");
  if (patch.size >= kPatchSizes) in.fail("a patch of size " + std::to_string(patch.size));
}

Eigen::Vector3f take_point(ByteReader& in, const char* what) {
  Eigen::Vector3f point;
  in(point);
  if (!point.allFinite()) in.fail(std::string(what) + ": a position is not a number");
  return point;
}

/// Takes a view of version 2, with its items.
MapKeyframe take_whole_place(ByteReader& in) {
  constexpr std::size_t kDescribed_bytes = 3 * sizeof(float) + sizeof(Descriptor);
  MapKeyframe place;
  place.frame_index = in.number<std::int64_t>();
  take_pose(in, place.T_world_camera);
  in.require(take_camera(in, place.preview_camera), sizeof(std::uint16_t));
  place.preview_depth_mm.resize(place.preview_camera.width_px, place.preview_camera.height_px);
  std::vector<std::uint16_t>& depth_mm = place.preview_depth_mm.pixels;
  in.raw(depth_mm.data(), depth_mm.size() * sizeof(std::uint16_t));

  const std::uint32_t features = take_count(in, "features");
  in.require(features, kDescribed_bytes);
  place.points_camera.resize(features);
  place.descriptors.resize(features);
  for (Eigen::Vector3f& p : place.points_camera) p = take_point(in, "feature points");
  for (Descriptor& bits : place.descriptors) bits = in.number<Descriptor>();

  const std::uint32_t patches = take_count(in, "patches");
  in.require(patches, kDescribed_bytes);
  place.patches.resize(patches);
  for (SurfacePatch& patch : place.patches) {
    patch.point = take_point(in, "patches");
    in(patch.normal, patch.along, patch.size);
    patch.bits = in.number<Descriptor>();
    require_sound(patch, in);
  }
  return place;
}

/// Takes a view whose items are in columns, and gives it room for them.
MapKeyframe take_place(ByteReader& in, UnclaimedItems& unclaimed) {
  MapKeyframe place;
  place.frame_index = in.number<std::int64_t>();
  take_pose(in, place.T_world_camera);
  claim(take_camera(in, place.preview_camera), unclaimed.depth, "preview depth", in);
  place.preview_depth_mm.resize(place.preview_camera.width_px, place.preview_camera.height_px);

  const std::size_t features = take_count(in, "features");
  claim(3 * features, unclaimed.points, "feature points", in);
  claim(features * sizeof(Descriptor), unclaimed.bytes, "descriptors", in);
  place.points_camera.resize(features);
  place.descriptors.resize(features);

  const std::size_t patches = take_count(in, "patches");
  claim(3 * patches, unclaimed.points, "patches", in);
  claim(6 * patches, unclaimed.directions, "patches", in);
  claim(patches * (1 + sizeof(Descriptor)), unclaimed.bytes, "patches", in);
  place.patches.resize(patches);
  return place;
}

// Each set_...() sets one column's items of all views, which have room for exactly as many.

void set_depth(ColumnReader::Items<std::uint16_t> column, std::vector<MapKeyframe>& views) {
  for (MapKeyframe& view : views) {
    std::uint16_t before = 0;
    for (std::uint16_t& depth_mm : view.preview_depth_mm.pixels)
      before = depth_mm = static_cast<std::uint16_t>(before + column.next());
  }
}

void set_points(ColumnReader::Items<std::int32_t> column, std::vector<MapKeyframe>& views) {
  const auto set = [&](Eigen::Vector3f& point) {
    for (float& component : point) component = static_cast<float>(column.next()) * kPointStep_m;
  };
  for (MapKeyframe& view : views) {
    for (Eigen::Vector3f& point : view.points_camera) set(point);
    for (SurfacePatch& patch : view.patches) set(patch.point);
  }
}

void set_directions(ColumnReader::Items<std::int16_t> column, std::vector<MapKeyframe>& views) {
  for (MapKeyframe& view : views)
    for (SurfacePatch& patch : view.patches)
      for (Eigen::Vector3f* const direction : {&patch.normal, &patch.along})
        for (float& component : *direction) component = static_cast<float>(column.next()) * kDirectionStep;
}

void set_bytes(ColumnReader::Items<std::uint8_t> column, std::vector<MapKeyframe>& views) {
  const auto set = [&](Descriptor& bits) {
    for (std::uint8_t& byte : bits) byte = column.next();
  };
  for (MapKeyframe& view : views) {
    for (Descriptor& bits : view.descriptors) set(bits);
    for (SurfacePatch& patch : view.patches) {
      patch.size = column.next();
      set(patch.bits);
    }
  }
}

/// Takes the views of version 3. Unpacks one column at a time: together they are as large as the views.
std::vector<MapKeyframe> take_places(ColumnReader& in) {
  const auto depth_mm = in.take_packed<std::uint16_t>("preview depths");
  const auto points = in.take_packed<std::int32_t>("points");
  const auto directions = in.take_packed<std::int16_t>("directions");
  const auto bytes = in.take_packed<std::uint8_t>("descriptors");
  UnclaimedItems unclaimed{depth_mm.count, points.count, directions.count, bytes.count};
  std::vector<MapKeyframe> views;
  const auto count = in.numbers().number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) views.push_back(take_place(in.numbers(), unclaimed));
  if (unclaimed.depth + unclaimed.points + unclaimed.directions + unclaimed.bytes != 0)
    in.numbers().fail("items more than the views take");
  set_depth(in.unpack(depth_mm), views);
  set_points(in.unpack(points), views);
  set_directions(in.unpack(directions), views);
  set_bytes(in.unpack(bytes), views);
  for (const MapKeyframe& view : views)
    for (const SurfacePatch& patch : view.patches) require_sound(patch, in.numbers());
  return views;
}

}  // namespace

MapKeyframe make_map_keyframe(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                              const KeyframeDatabaseConfig& config) {
  MapKeyframe place;
  place.frame_index = frame.index;
  place.T_world_camera = T_world_camera;
  ViewPyramid small;
  make_pyramid(frame.depth_m, frame.depth_camera, {.finest_width_px = config.preview_width_px, .levels = 1},
               small);
  const ViewPyramid::Level& level = small.levels.front();
  place.preview_camera = level.camera;
  place.preview_depth_mm.resize(level.camera.width_px, level.camera.height_px);
  std::transform(level.inverse_depth_per_m.pixels.begin(), level.inverse_depth_per_m.pixels.end(),
                 place.preview_depth_mm.pixels.begin(), [](float q) {
                   return q > 0.0F ? static_cast<std::uint16_t>(std::lround(std::min(1000.0F / q, 65535.0F)))
                                   : std::uint16_t{0};
                 });
  // ORB needs a neighbourhood of 31 pixels, and OpenCV's pyramid some more.
  constexpr int kSmallest_px = 64;
  place.patches = describe_patches(frame, std::min(config.patches, kMostDescribed));
  if (config.features > 0 && std::min(frame.colour.width, frame.colour.height) >= kSmallest_px) {
    describe_features(frame, std::min(config.features, kMostDescribed), place);
  }
  // A long scan keeps hundreds of keyframes.
  place.points_camera.shrink_to_fit();
  place.descriptors.shrink_to_fit();
  place.patches.shrink_to_fit();
  return place;
}

void update_index(KeyframeDatabase& keyframe_database) {
  for (std::size_t i = keyframe_database.index.size(); i < keyframe_database.keyframes.size(); ++i)
    keyframe_database.index.add(keyframe_database.keyframes[i].descriptors);
}

void transform(KeyframeDatabase& keyframe_database, const Eigen::Isometry3d& T_new_old) {
  for (MapKeyframe& place : keyframe_database.keyframes)
    place.T_world_camera = T_new_old * place.T_world_camera;
  for (LookAlike& look_alike : keyframe_database.look_alikes) {
    look_alike.p_world = T_new_old * look_alike.p_world;
    look_alike.T_other_this = T_new_old * look_alike.T_other_this * T_new_old.inverse();
  }
}

void write_keyframe_database(const KeyframeDatabase& keyframe_database, const std::filesystem::path& path) {
  const std::vector<MapKeyframe>& views = keyframe_database.keyframes;
  ByteWriter out;
  put_column(out.bytes, depth_column(views));
  put_column(out.bytes, point_column(views));
  put_column(out.bytes, direction_column(views));
  put_column(out.bytes, byte_column(views));
  out(static_cast<std::uint32_t>(views.size()));
  for (const MapKeyframe& view : views) put_place(out, view);
  write_binary(path, kMagic, kColumns, out.bytes);
}

KeyframeDatabase read_keyframe_database(const std::filesystem::path& path, FileChecksum checksum) {
  const BinaryBody body = read_binary(path, kMagic, kInline, kColumns, checksum);
  ColumnReader in(body.bytes, path.string());
  KeyframeDatabase keyframe_database;
  if (body.version == kColumns) {
    keyframe_database.keyframes = take_places(in);
  } else {
    const auto count = in.numbers().number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i)
      keyframe_database.keyframes.push_back(take_whole_place(in.numbers()));
  }
  if (in.numbers().left() != 0)
    in.numbers().fail(std::to_string(in.numbers().left()) + " bytes more than the views take");
  return keyframe_database;
}

}  // namespace roomradar
