// map_merge.cpp: resamples one octree's leaves and samples in the other's grid.
#include "mapping/map/map_merge.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "mapping/coverage/coverage.hpp"
#include "mapping/map/changed_map.hpp"
#include "mapping/map/surface_points.hpp"
#include "mapping/map/tsdf_interpolation.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

/// Visits the voxels of a grid whose centres are in a box of another frame: each voxel once, in cubes as
/// large as fit.
class Cover {
 public:
  Cover(const Eigen::Isometry3d& T_grid_box, double voxel_m)
      : T_grid_box_(T_grid_box),
        T_box_grid_(T_grid_box.inverse()),
        reach_(T_box_grid_.linear().cwiseAbs() * Eigen::Vector3d::Ones()),
        voxel_m_(voxel_m) {}

  template <typename Visit>
  void operator()(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    // Bounds of the box in the grid, in voxels.
    const Eigen::Vector3d centre = T_grid_box_ * box.center() / voxel_m_;
    const Eigen::Vector3d half = T_grid_box_.linear().cwiseAbs() * box.sizes() / (2.0 * voxel_m_);
    const auto across = static_cast<unsigned>(std::max(std::floor(box.sizes().minCoeff() / voxel_m_), 1.0));
    const int edge = static_cast<int>(std::bit_floor(across));
    const VoxelIndex low = ((centre - half) / edge).array().floor().cast<int>() * edge;
    const VoxelIndex high = (centre + half).array().ceil().cast<int>();
    for (int z = low.z(); z < high.z(); z += edge)
      for (int y = low.y(); y < high.y(); y += edge)
        for (int x = low.x(); x < high.x(); x += edge) descend({x, y, z}, edge, box, visit);
  }

 private:
  template <typename Visit>
  void descend(const VoxelIndex& low, int edge, const Eigen::AlignedBox3d& box, const Visit& visit) const {
    const Eigen::Vector3d centre_box =
        T_box_grid_ * ((low.cast<double>() + Eigen::Vector3d::Constant(0.5 * edge)) * voxel_m_);
    if (edge == 1) {
      const bool inside =
          (centre_box.array() >= box.min().array()).all() && (centre_box.array() < box.max().array()).all();
      if (inside) visit(low, edge);
      return;
    }
    const Eigen::Vector3d half = reach_ * (0.5 * edge * voxel_m_);
    const double slack_m = 1e-6 * voxel_m_;
    const Eigen::Array3d under = centre_box.array() - half.array(), over = centre_box.array() + half.array();
    if ((under >= box.max().array()).any() || (over <= box.min().array()).any()) return;
    if ((under >= box.min().array() - slack_m).all() && (over <= box.max().array() + slack_m).all())
      return visit(low, edge);
    for (int i = 0; i < 8; ++i) {
      const VoxelIndex child = low + VoxelIndex(i & 1, (i >> 1) & 1, (i >> 2) & 1) * (edge / 2);
      descend(child, edge / 2, box, visit);
    }
  }

  Eigen::Isometry3d T_grid_box_, T_box_grid_;
  Eigen::Vector3d reach_;  ///< half extents in the box's frame of a cube with half edge 1
  double voxel_m_;
};

bool same_grid(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T) {
  return T.matrix().isIdentity(1e-12) && a.resolution_m() == b.resolution_m();
}

// Extrapolates the distance at a point in a sample's own voxel, linearly along each axis from the adjacent
// samples. This keeps the outermost samples of the thin layer. Returns nullopt if an axis has no adjacent
// sample.
std::optional<double> distance_beside(const StaticMap& map, const SurfaceSample& sample,
                                      const Eigen::Vector3d& p_world) {
  const double voxel_m = map.resolution_m();
  const Eigen::Vector3d centre = (sample.voxel.cast<double>() + Eigen::Vector3d::Constant(0.5)) * voxel_m;
  double distance_m = static_cast<double>(sample.distance_m);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = voxel_m * Eigen::Vector3d::Unit(axis);
    const auto before = map.sample_at(centre - step), after = map.sample_at(centre + step);
    if (!before && !after) return std::nullopt;
    const float rise_m = (after ? *after : sample).distance_m - (before ? *before : sample).distance_m;
    const double run_m = before && after ? 2.0 * voxel_m : voxel_m;
    distance_m += static_cast<double>(rise_m) / run_m * (p_world - centre)[axis];
  }
  return distance_m;
}

}  // namespace

void add_map(const StaticMap& from, const Eigen::Isometry3d& T_into_from, StaticMap& into) {
  if (same_grid(from, into, T_into_from)) return into.add_evidence(from);
  const double voxel_m = from.resolution_m();
  const Cover cover(T_into_from, into.resolution_m());
  const auto box_of = [&](const VoxelIndex& low, int edge) {
    const Eigen::Vector3d corner = low.cast<double>() * voxel_m;
    return Eigen::AlignedBox3d(corner, corner + Eigen::Vector3d::Constant(edge * voxel_m));
  };
  from.visit_leaves([&](const MapLeaf& leaf) {
    cover(box_of(leaf.lowest_voxel, leaf.edge_voxels), [&](const VoxelIndex& low, int edge) {
      into.add_evidence(MapLeaf{low, edge, leaf.log_odds});
    });
  });
  const Eigen::Isometry3d T_from_into = T_into_from.inverse();
  from.visit_samples([&](const SurfaceSample& sample) {
    const auto resample_at = [&](const VoxelIndex& voxel) {
      const Eigen::Vector3d p_into =
          (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5)) * into.resolution_m();
      const Eigen::Vector3d p_from = T_from_into * p_into;
      const auto between = distance_at(from, p_from);
      const auto distance_m =
          between ? std::optional(between->distance_m) : distance_beside(from, sample, p_from);
      if (!distance_m) return;  // at the edge of the sampled layer
      SurfaceSample resampled = sample;
      resampled.voxel = voxel;
      resampled.distance_m = static_cast<float>(*distance_m);
      into.add_evidence(resampled);
    };
    cover(box_of(sample.voxel, 1), [&](const VoxelIndex& low, int edge) {
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x) resample_at(low + VoxelIndex(x, y, z));
    });
  });
}

void append_session(SavedMap& map, const SavedMap& session) {
  constexpr double kFrame_s = 1.0 / 30.0;
  double shift_s = 0.0;
  if (!map.trajectory.empty() && !session.trajectory.empty())
    shift_s = std::max(0.0, map.trajectory.back().stamp_s + kFrame_s - session.trajectory.front().stamp_s);
  for (TimedPose pose : session.trajectory) {
    pose.stamp_s += shift_s;
    map.trajectory.push_back(pose);
  }
  map.keyframe_database.load().keyframes.insert(map.keyframe_database.load().keyframes.end(),
                                                session.keyframe_database.load().keyframes.begin(),
                                                session.keyframe_database.load().keyframes.end());
  map.info.source += "; " + session.info.source;
  map.info.sessions.insert(map.info.sessions.end(), session.info.sessions.begin(),
                           session.info.sessions.end());
  if (const auto stopped = session.info.settings.find(kStoppedSetting);
      stopped != session.info.settings.end())
    map.info.settings.insert(*stopped);
  map.info.frames_read += session.info.frames_read;
  map.info.frames_fused += session.info.frames_fused;
}

namespace {

Registration register_into(const SavedMap& a, const SavedMap& b, const RegistrationConfig& config) {
  Registration there = register_to(a.octree.load(), a.keyframe_database.load(), b.keyframe_database.load(),
                                   sample_surface(b.mesh, config.points), config);
  if (!there) return there;
  const Registration back = verify_registration(b.octree.load(), sample_surface(a.mesh, config.points),
                                                there.T_a_b.inverse(), config);
  // A small part of a in b proves nothing: b may be one corner of a.
  if (back.status == RegistrationStatus::kNoOverlap) return there;
  there.agreement = std::min(there.agreement, back.agreement);
  there.status = back.status;
  return there;
}

}  // namespace

Registration register_maps(const SavedMap& a, const SavedMap& b, const RegistrationConfig& config) {
  // Both orders of the maps are registered in the same direction, so that their results mirror each other.
  if (octree_checksum(b.info) < octree_checksum(a.info)) {
    Registration mirrored = register_maps(b, a, config);
    std::swap(mirrored.T_a_b, mirrored.T_b_a);
    return mirrored;
  }
  Registration found = register_into(a, b, config);
  if (found.status == RegistrationStatus::kNoOverlap) {
    // Conversely, a may be one corner of b.
    Registration turned = register_into(b, a, config);
    turned.T_a_b = turned.T_a_b.inverse();
    if (turned) found = turned;
  }
  found.T_b_a = found.T_a_b.inverse();
  return found;
}

namespace {

/// Throws Error if the resolutions differ so much that one of the maps should be scanned again.
void require_alike(const SavedMap& a, const SavedMap& b) {
  constexpr double kMostTimes = 4.0;  // 64 voxels for one
  const double finer_m = std::min(a.octree.load().resolution_m(), b.octree.load().resolution_m());
  const double coarser_m = std::max(a.octree.load().resolution_m(), b.octree.load().resolution_m());
  if (coarser_m <= kMostTimes * finer_m * (1.0 + 1e-9)) return;
  throw Error("the cells of one map are " + format_number(finer_m) + " m and of the other " +
              format_number(coarser_m) + " m; to be joined they may differ by " + format_number(kMostTimes) +
              " times: scan one of them again");
}

/// Throws Error if a map, in the merged map's world frame, is out of reach at this resolution.
void require_in_reach(const SavedMap& map, const Eigen::Isometry3d& T_merged_map, double resolution_m) {
  const Eigen::AlignedBox3d known = map.octree.load().counts().known_world;
  if (known.isEmpty()) return;
  const double reach_m = StaticMap(resolution_m).reach_m();
  double farthest_m = 0.0;
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    farthest_m = std::max(farthest_m, (T_merged_map * known.corner(corner)).cwiseAbs().maxCoeff());
  }
  if (farthest_m <= reach_m) return;
  std::array<char, 200> text{};
  format_classic(
      text.data(), text.size(),
      ": reaches %.1f m from the merged map's origin, and at cells of %g m, the finer of the two, a "
      "map reaches %.1f m; scan that one with coarser cells",
      farthest_m, resolution_m, reach_m);
  throw Error("the map of " + map.info.source + text.data());
}

}  // namespace

SavedMap merge_maps(SavedMap a, const SavedMap& b, const Eigen::Isometry3d& T_a_b) {
  const double finer_m = std::min(a.octree.load().resolution_m(), b.octree.load().resolution_m());
  require_in_reach(a, Eigen::Isometry3d::Identity(), finer_m);
  require_in_reach(b, T_a_b, finer_m);
  require_alike(a, b);
  if (b.octree.load().resolution_m() < a.octree.load().resolution_m()) {
    StaticMap finer(b.octree.load().resolution_m(), a.octree.load().config());
    add_map(a.octree.load(), Eigen::Isometry3d::Identity(), finer);
    a.octree = std::move(finer);
    if (const auto setting = b.info.settings.find("resolution_m"); setting != b.info.settings.end())
      a.info.settings["resolution_m"] = setting->second;
  }
  add_map(b.octree.load(), T_a_b, a.octree.load());
  EarlierTextures earlier;
  add_texture_of(a, Eigen::Isometry3d::Identity(), earlier);
  add_texture_of(b, T_a_b, earlier);
  a.mesh = extract_surface(a.octree.load(), surface_config_of(a.info));
  renew_texture(earlier, a);
  SavedMap session;
  session.info = b.info;
  session.keyframe_database = b.keyframe_database.load();
  transform(session.keyframe_database.load(), T_a_b);
  session.trajectory = b.trajectory;
  for (TimedPose& pose : session.trajectory) pose.T_world_camera = T_a_b * pose.T_world_camera;
  append_session(a, session);
  a.coverage_png = survey_coverage(a.octree.load(), a.mesh, a.trajectory).picture_png;
  return a;
}

}  // namespace roomradar
