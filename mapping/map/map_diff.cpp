// map_diff.cpp: surface of one map in the other's free space, grouped into connected components.
#include "mapping/map/map_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

/// A surface voxel of one map in free space of the other.
struct Suspect {
  bool clear = false;  ///< the other map is also free on all sides
  int steps = -1;      ///< from the nearest clear voxel; -1: farther than the clearance
  int thing = -1;
};

/// Returns unit vectors to the six faces and eight corners of a cube.
std::array<Eigen::Vector3d, 14> directions() {
  std::array<Eigen::Vector3d, 14> all;
  std::size_t n = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) all[n++] = sign * Eigen::Vector3d::Unit(axis);
  for (int i = 0; i < 8; ++i)
    all[n++] = Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).normalized();
  return all;
}

class ObjectFinder {
 public:
  ObjectFinder(const StaticMap& has, const StaticMap& lacks, const Eigen::Isometry3d& T_lacks_has,
               const DiffConfig& config)
      : has_(has),
        lacks_(lacks),
        T_lacks_has_(T_lacks_has),
        config_(config),
        clearance_m_(std::max(config.clearance_m, config.clearance_voxels *
                                                      std::max(has.resolution_m(), lacks.resolution_m()))) {}

  /// Returns each object's surface voxels, in the grid of the map that has the object.
  std::vector<std::vector<VoxelIndex>> find() {
    collect();
    leave_out_noise();
    reach_out();
    return gather();
  }

 private:
  [[nodiscard]] Eigen::Vector3d centre(const VoxelIndex& voxel) const {
    return (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5)) * has_.resolution_m();
  }

  /// Returns true if no frame, or too few for the mesh, measured the surface of a voxel in a leaf. Leaves
  /// larger than coarse cells have no signed distance.
  [[nodiscard]] bool is_hardly_measured(const VoxelIndex& voxel, const MapLeaf& leaf) const {
    const auto sample = has_.sample_at(centre(voxel));
    return sample ? sample->weight < SurfaceConfig{}.min_weight : leaf.edge_voxels <= 2;
  }

  void collect() {
    static const std::array<Eigen::Vector3d, 14> kAround = directions();
    has_.visit_leaves([&](const MapLeaf& leaf) {
      if (leaf.log_odds <= 0.0F) return;
      const int last = leaf.edge_voxels - 1;
      // A coarse cell is occupied as a whole, wherever the surface is in it.
      const double clearance_m = leaf.edge_voxels == 1 ? clearance_m_ : 2.0 * clearance_m_;
      const auto is_rim = [&](int i) { return i == 0 || i == last; };
      for (int z = 0; z <= last; ++z)
        for (int y = 0; y <= last; ++y)
          for (int x = 0; x <= last;
               x += is_rim(y) || is_rim(z) ? 1 : last) {  // a leaf's interior is not surface
            const VoxelIndex voxel = leaf.lowest_voxel + VoxelIndex(x, y, z);
            const Eigen::Vector3d p = T_lacks_has_ * centre(voxel);
            if (lacks_.occupancy_at(p) != Occupancy::kFree) continue;
            Suspect suspect;
            suspect.clear =
                !is_hardly_measured(voxel, leaf) &&
                std::all_of(kAround.begin(), kAround.end(), [&](const Eigen::Vector3d& direction) {
                  return lacks_.occupancy_at(p + clearance_m * direction) == Occupancy::kFree &&
                         lacks_.occupancy_at(p + 0.5 * clearance_m * direction) == Occupancy::kFree;
                });
            suspects_.emplace(voxel_key(voxel), suspect);
            order_.push_back(voxel);
          }
    });
  }

  /// Calls visit(neighbour, its suspect) for all suspects within `radius` voxels.
  template <typename Visit>
  void neighbours(const VoxelIndex& voxel, int radius, const Visit& visit) {
    for (int z = -radius; z <= radius; ++z)
      for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) {
          const VoxelIndex other = voxel + VoxelIndex(x, y, z);
          if (const auto found = suspects_.find(voxel_key(other)); found != suspects_.end())
            visit(other, found->second);
        }
  }

  /// Marks clear voxels as not clear where little of the surface around them is clear: a surface that was
  /// measured from far away is centimetres rough, and single voxels stand out from it.
  void leave_out_noise() {
    constexpr std::size_t kOneInClear = 3;
    const int around = static_cast<int>(std::lround(clearance_m_ / has_.resolution_m()));
    std::vector<VoxelIndex> noise;
    for (const VoxelIndex& voxel : order_) {
      if (!suspects_.at(voxel_key(voxel)).clear) continue;
      std::size_t all = 0, clear = 0;
      neighbours(voxel, around, [&](const VoxelIndex&, const Suspect& suspect) {
        ++all;
        if (suspect.clear) ++clear;
      });
      if (kOneInClear * clear < all) noise.push_back(voxel);
    }
    for (const VoxelIndex& voxel : noise) suspects_.at(voxel_key(voxel)).clear = false;
  }

  /// Extends clear surface to the surface around it that is closer to other surfaces.
  void reach_out() {
    const int most = static_cast<int>(std::ceil(clearance_m_ / has_.resolution_m())) + 1;
    std::vector<VoxelIndex> rim;
    for (const VoxelIndex& voxel : order_) {
      Suspect& suspect = suspects_.at(voxel_key(voxel));
      if (!suspect.clear) continue;
      suspect.steps = 0;
      rim.push_back(voxel);
    }
    for (int steps = 1; steps <= most; ++steps) {
      std::vector<VoxelIndex> next;
      for (const VoxelIndex& voxel : rim)
        neighbours(voxel, 1, [&](const VoxelIndex& other, Suspect& suspect) {
          if (suspect.steps >= 0) return;
          suspect.steps = steps;
          next.push_back(other);
        });
      rim = std::move(next);
    }
  }

  /// Returns the connected components with enough clear surface, except those that the end of the other map's
  /// scan or pose errors explain.
  std::vector<std::vector<VoxelIndex>> gather() {
    constexpr int kBridged_voxels = 2;
    std::vector<std::vector<VoxelIndex>> things;
    int number = 0;
    for (const VoxelIndex& first : order_) {
      Suspect& start = suspects_.at(voxel_key(first));
      if (start.steps < 0 || start.thing >= 0) continue;
      start.thing = number;
      std::vector<VoxelIndex> thing{first};
      for (std::size_t i = 0; i < thing.size(); ++i) {
        const VoxelIndex voxel = thing[i];
        neighbours(voxel, kBridged_voxels, [&](const VoxelIndex& other, Suspect& suspect) {
          if (suspect.steps < 0 || suspect.thing >= 0) return;
          suspect.thing = number;
          thing.push_back(other);
        });
      }
      ++number;
      if (is_large(thing) && !ends_the_scan(thing) && !is_there_aside(thing))
        things.push_back(std::move(thing));
    }
    return things;
  }

  [[nodiscard]] bool is_large(const std::vector<VoxelIndex>& thing) const {
    std::size_t clear = 0;
    Eigen::AlignedBox3d box;
    for (const VoxelIndex& voxel : thing) {
      if (!suspects_.at(voxel_key(voxel)).clear) continue;
      ++clear;
      box.extend(centre(voxel));
    }
    const double voxel_m = has_.resolution_m();
    constexpr std::size_t kOneInClear = 6;  // less: remains of noise, in surface that is noisy as a whole
    return kOneInClear * clear >= thing.size() &&
           static_cast<double>(clear) * voxel_m * voxel_m >= config_.min_area_m2 &&
           box.sizes().maxCoeff() + voxel_m >= config_.min_size_m;
  }

  /// Returns true if the other map's scan ends at this surface: free space is followed by unknown space
  /// behind more than a quarter of it. Such free voxels come from rays that grazed the surface, or that were
  /// measured too far. If an object appeared or disappeared, the map without it has free space or another
  /// surface behind the object's surface.
  [[nodiscard]] bool ends_the_scan(const std::vector<VoxelIndex>& thing) const {
    static const std::array<Eigen::Vector3d, 14> kAround = directions();
    const double step_m = lacks_.resolution_m(), behind_m = 2.0 * clearance_m_;
    std::size_t looked = 0, unknown = 0;
    for (const VoxelIndex& voxel : thing) {
      const Eigen::Vector3d p = centre(voxel);
      Eigen::Vector3d outwards = Eigen::Vector3d::Zero();  // towards free space of the map with the surface
      for (const Eigen::Vector3d& direction : kAround)
        if (has_.occupancy_at(p + 2.0 * has_.resolution_m() * direction) == Occupancy::kFree)
          outwards += direction;
      if (outwards.norm() < 0.5) continue;
      ++looked;
      for (double deep_m = step_m; deep_m < behind_m + 0.5 * step_m; deep_m += step_m) {
        const Eigen::Vector3d behind = T_lacks_has_ * (p - deep_m * outwards.normalized());
        const Occupancy occupancy = lacks_.occupancy_at(behind);
        if (occupancy == Occupancy::kFree) continue;
        if (occupancy == Occupancy::kUnknown && !lacks_.sample_at(behind)) ++unknown;
        break;
      }
    }
    return 4 * unknown > looked;
  }

  /// Returns true if the other map also has the object, slightly shifted.
  [[nodiscard]] bool is_there_aside(const std::vector<VoxelIndex>& thing) const {
    constexpr std::size_t kLooked = 150;
    const double step_m = std::max(0.02, lacks_.resolution_m());
    const int steps = static_cast<int>(config_.max_pose_error_m / step_m);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < thing.size(); i += 1 + thing.size() / kLooked)
      points.push_back(T_lacks_has_ * centre(thing[i]));
    const auto enough = static_cast<std::size_t>(config_.min_same_shape * static_cast<double>(points.size()));
    for (int z = -steps; z <= steps; ++z)
      for (int y = -steps; y <= steps; ++y)
        for (int x = -steps; x <= steps; ++x) {
          const Eigen::Vector3d shift = step_m * Eigen::Vector3d(x, y, z);
          if (shift.norm() > config_.max_pose_error_m) continue;
          std::size_t met = 0;
          for (const Eigen::Vector3d& p : points)
            if (is_surface(p + shift, step_m)) ++met;
          if (met >= std::max<std::size_t>(enough, 1)) return true;
        }
    return false;
  }
  [[nodiscard]] bool is_surface(const Eigen::Vector3d& p, double near_m) const {
    const auto sample = lacks_.sample_at(p);
    return sample ? static_cast<double>(std::abs(sample->distance_m)) < near_m
                  : lacks_.occupancy_at(p) == Occupancy::kOccupied;
  }

  const StaticMap& has_;
  const StaticMap& lacks_;
  Eigen::Isometry3d T_lacks_has_;
  DiffConfig config_;
  double clearance_m_;
  std::unordered_map<std::uint64_t, Suspect> suspects_;
  std::vector<VoxelIndex> order_;  ///< in the octree's order, so the result does not depend on hashing
};

/// @param T_world_has  to the world of the result
Change describe_thing(ChangeKind kind, const std::vector<VoxelIndex>& thing, const StaticMap& has,
                      const StaticMap& lacks, const Eigen::Isometry3d& T_world_has,
                      const Eigen::Isometry3d& T_lacks_has) {
  Change change;
  change.kind = kind;
  const double voxel_m = has.resolution_m();
  Eigen::AlignedBox3d box_has;
  for (const VoxelIndex& voxel : thing) {
    const Eigen::Vector3d p_has = (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5)) * voxel_m;
    const Eigen::Vector3d p = T_world_has * p_has;
    box_has.extend(p_has);
    change.surface_world.push_back(p);
    change.box_world.extend(p);
    change.position_world += p / static_cast<double>(thing.size());
  }
  change.area_m2 = static_cast<double>(thing.size()) * voxel_m * voxel_m;
  for (Eigen::AlignedBox3d* box : {&change.box_world, &box_has}) {
    box->min().array() -= 0.5 * voxel_m;
    box->max().array() += 0.5 * voxel_m;
  }

  // In the grid of the map that has the object, so that the volume does not depend on the result's world.
  constexpr double kMostCells = 4e6;  // takes some seconds
  Eigen::Array3d cells = (box_has.sizes().array() / voxel_m).round().max(1.0);
  while (cells.prod() > kMostCells) cells = (0.8 * cells).floor().max(1.0);
  const Eigen::Vector3d step = (box_has.sizes().array() / cells).matrix();
  for (int z = 0; z < static_cast<int>(cells.z()); ++z)
    for (int y = 0; y < static_cast<int>(cells.y()); ++y)
      for (int x = 0; x < static_cast<int>(cells.x()); ++x) {
        const Eigen::Vector3d p_has =
            box_has.min() + (Eigen::Vector3d(x, y, z).array() + 0.5).matrix().cwiseProduct(step);
        if (lacks.occupancy_at(T_lacks_has * p_has) == Occupancy::kFree &&
            has.occupancy_at(p_has) != Occupancy::kFree)
          change.volume_m3 += step.prod();
      }
  return change;
}

}  // namespace

std::string_view to_string(ChangeKind kind) {
  return kind == ChangeKind::kAppeared ? "appeared" : "vanished";
}

void require_valid(const DiffConfig& config) {
  const ConfigCheck require{"diff"};
  for (const auto& [name, value] :
       {std::pair("clearance_m", config.clearance_m), std::pair("clearance_voxels", config.clearance_voxels),
        std::pair("min_area_m2", config.min_area_m2), std::pair("min_size_m", config.min_size_m),
        std::pair("max_pose_error_m", config.max_pose_error_m),
        std::pair("min_same_shape", config.min_same_shape)})
    require(value >= 0.0 && std::isfinite(value), name, value, "finite and >= 0");
}

std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const DiffConfig& config) {
  return diff_maps(a, b, T_a_b, T_a_b.inverse(), config);
}

std::vector<Change> diff_maps(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_a_b,
                              const Eigen::Isometry3d& T_b_a, const DiffConfig& config) {
  require_valid(config);
  const Eigen::Isometry3d T_a_a = Eigen::Isometry3d::Identity();
  std::vector<Change> changes;
  for (const auto& thing : ObjectFinder(b, a, T_a_b, config).find())
    changes.push_back(describe_thing(ChangeKind::kAppeared, thing, b, a, T_a_b, T_a_b));
  for (const auto& thing : ObjectFinder(a, b, T_b_a, config).find())
    changes.push_back(describe_thing(ChangeKind::kVanished, thing, a, b, T_a_a, T_b_a));
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& left, const Change& right) { return left.area_m2 > right.area_m2; });
  return changes;
}

}  // namespace roomradar
