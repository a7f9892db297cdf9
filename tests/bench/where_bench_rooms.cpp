// where_bench_rooms.cpp: scans once, and draws views that show enough of the scanned surface.
#include "where_bench_rooms.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "bench_times.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/map/surface_points.hpp"
#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

bool is_shell(const Room& room, const Vector3d& p_room) {
  constexpr double kThin_m = 0.01;
  return ((p_room - room.interior_min_world).array() < kThin_m).any() ||
         ((room.interior_max_world - p_room).array() < kThin_m).any();
}

/// Fractions of a coarse grid of pixels: `mapped`, surface in range and in the map; `things`, mapped surface
/// that is not floor, wall or ceiling.
struct Parts {
  double mapped = 0.0, things = 0.0;
};
Parts parts_of(const Room& room, const SavedMap& map, const MeshDistanceQuery& mesh,
               const Eigen::Isometry3d& T_room_camera, const FreeViews& which) {
  constexpr int kStep_px = 40;
  constexpr float kSame_m = 0.04F;
  const Intrinsics& camera = kKinectDepthCamera;
  int pixels = 0, mapped = 0, things = 0;
  for (int y = kStep_px / 2; y < camera.height_px; y += kStep_px) {
    for (int x = kStep_px / 2; x < camera.width_px; x += kStep_px) {
      ++pixels;
      const Vector3d ray = back_project(camera, x, y, 1.0);
      const auto hit = cast_ray(room, T_room_camera.translation(), T_room_camera.linear() * ray);
      if (!hit || hit->range_m < 0.5 || hit->range_m > which.max_depth_m) continue;
      const Vector3d p_room = T_room_camera * (hit->range_m * ray);
      const Vector3d p_world = map.info.T_world_recorded * p_room;
      if (mesh.distance_m((p_world - map.mesh.origin).cast<float>(), kSame_m) > kSame_m) continue;
      ++mapped;
      things += !is_shell(room, p_room);
    }
  }
  return {static_cast<double>(mapped) / pixels, static_cast<double>(things) / pixels};
}

}  // namespace

Tracking SearchedRoom::find(Locator& locator, const Frame& frame, const MaskImage& dynamic_mask) {
  const auto expected_depth = [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
    const double start_ms = test::thread_ms();
    const ExpectedView& expected = scene.render_expected(frame.depth_camera, T_world_camera);
    drawing_ms += test::thread_ms() - start_ms;
    return expected.depth_m;
  };
  return locate(locator, frame, map.keyframe_database.load(), dynamic_mask, expected_depth);
}

SimOptions scan_of(const std::string& room, std::uint64_t seed) {
  SimOptions scan;
  scan.room = room;
  scan.seed = seed;
  scan.frames = 250;
  scan.rate_hz = 12.5;
  return scan;
}

std::vector<Eigen::Isometry3d> poses_of(const SimOptions& scan) {
  const Room room = make_room(scan.room, false, scan.seed);
  const double duration_s = static_cast<double>(scan.frames) / scan.rate_hz;
  const CameraPath path = plan_camera_path(room, scan.path, scan.seed, duration_s);
  std::vector<Eigen::Isometry3d> poses;
  for (std::int64_t i = 0; i < scan.frames; ++i)
    poses.push_back(T_world_camera_at(path, static_cast<double>(i) / scan.rate_hz));
  return poses;
}

SavedMap map_of(FrameSource& source, PoseOrigin poses, const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "map.json")) {
    std::fprintf(stderr, "scanning %s\n", source.name().c_str());
    StageTimes times;
    PrescanConfig config;
    config.poses = poses;
    save_map(folder, prescan(source, config, times).map);
  }
  return load_map(folder);
}

std::vector<Eigen::Isometry3d> draw_free_views(const Room& room, const SavedMap& map,
                                               const std::vector<Eigen::Isometry3d>& T_room_scan,
                                               std::size_t count, std::uint64_t seed,
                                               const FreeViews& which) {
  constexpr double kLowest_m = 0.6, kHighest_m = 1.9, kMaxRoll_rad = 10.0 * std::numbers::pi / 180.0;
  constexpr std::size_t kTargets = 5000;
  const std::vector<Vector3d> targets = sample_surface(map.mesh, kTargets);
  const Eigen::Isometry3d T_room_world = map.info.T_world_recorded.inverse();
  const MeshDistanceQuery mesh(map.mesh, 0.05F);
  std::vector<Eigen::Isometry3d> views;
  for (std::uint64_t draw = 0; views.size() < count && draw < 2000 * count; ++draw) {
    CounterRandom random(hash_of(seed, 0x66726565), draw);
    const Vector3d low = room.interior_min_world, high = room.interior_max_world;
    const Vector3d eye(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()),
                       random.uniform(kLowest_m, kHighest_m));
    const Vector3d target =
        T_room_world *
        targets[static_cast<std::size_t>(random.uniform() * static_cast<double>(targets.size()))];
    const double roll_rad = random.uniform(-kMaxRoll_rad, kMaxRoll_rad);
    const double path_length_m = (target - eye).norm();
    const bool steep = std::abs(target.z() - eye.z()) > 0.9 * path_length_m;
    if (path_length_m < 0.8 || path_length_m > which.max_depth_m || steep ||
        signed_distance_m(room, eye) < which.clear_m)
      continue;
    const bool off_path = std::all_of(T_room_scan.begin(), T_room_scan.end(), [&](const auto& T) {
      return (T.translation() - eye).norm() >= which.off_path_m;
    });
    if (!off_path) continue;
    Eigen::Isometry3d T_room_camera = looking_at(eye, target);
    T_room_camera.rotate(Eigen::AngleAxisd(roll_rad, Vector3d::UnitZ()));
    const Parts parts = parts_of(room, map, mesh, T_room_camera, which);
    if (parts.mapped < which.min_mapped || (parts.things < which.things) != which.bare) continue;
    views.push_back(T_room_camera);
  }
  return views;
}

}  // namespace roomradar
