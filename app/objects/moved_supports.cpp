// moved_supports.cpp: kept objects go where the thing on which they stood was carried.
#include "app/objects/moved_supports.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "app/models/model_file.hpp"
#include "mapping/map/map_diff.hpp"
#include "mapping/map/moved_things.hpp"

namespace roomradar {
namespace {

constexpr double kNear_m = 0.04;  // two cells of 2 cm

/// Where an object stands.
struct Footing {
  std::vector<Eigen::Vector3d> lowest_world;  ///< vertices within 2 cm of the lowest
  Eigen::AlignedBox3d box_world;
};

Footing footing_of(const KeptObject& object, const std::filesystem::path& folder) {
  constexpr double kLow_m = 0.02;
  const Mesh mesh = read_model(folder / object.model).mesh;
  std::vector<Eigen::Vector3d> vertices_world;
  Footing footing;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    vertices_world.push_back(object.T_world_object * (mesh.origin + vertex.cast<double>()));
    footing.box_world.extend(vertices_world.back());
  }
  for (const Eigen::Vector3d& p : vertices_world)
    if (p.z() < footing.box_world.min().z() + kLow_m) footing.lowest_world.push_back(p);
  return footing;
}

bool stands_on(const Footing& footing, const Change& thing) {
  if (footing.box_world.isEmpty() || thing.box_world.exteriorDistance(footing.box_world.center()) >
                                         footing.box_world.diagonal().norm() + kNear_m)
    return false;
  const auto near = std::count_if(
      footing.lowest_world.begin(), footing.lowest_world.end(), [&](const Eigen::Vector3d& low) {
        return std::any_of(
            thing.surface_world.begin(), thing.surface_world.end(),
            [&](const Eigen::Vector3d& p) { return (p - low).squaredNorm() < kNear_m * kNear_m; });
      });
  return 3 * near >= static_cast<std::ptrdiff_t>(footing.lowest_world.size());
}

bool stands_on(const Footing& upper, const Footing& lower) {
  const Eigen::AlignedBox3d &top = upper.box_world, &under = lower.box_world;
  const Eigen::Vector3d middle = top.center();
  return std::abs(top.min().z() - under.max().z()) < kNear_m && middle.x() > under.min().x() &&
         middle.x() < under.max().x() && middle.y() > under.min().y() && middle.y() < under.max().y();
}

/// Returns for each object the vanished change on which it stands, itself or by the objects under it.
std::vector<std::optional<std::size_t>> supports_of(const std::vector<Footing>& footings,
                                                    const std::vector<Change>& changes) {
  std::vector<std::optional<std::size_t>> on(footings.size());
  for (std::size_t i = 0; i < footings.size(); ++i)
    for (std::size_t c = 0; c < changes.size() && !on[i]; ++c)
      if (changes[c].kind == ChangeKind::kVanished && stands_on(footings[i], changes[c])) on[i] = c;
  for (std::size_t level = 0; level < footings.size(); ++level)  // of a pile, at most one per object
    for (std::size_t i = 0; i < footings.size(); ++i)
      for (std::size_t k = 0; k < footings.size() && !on[i]; ++k)
        if (on[k] && k != i && stands_on(footings[i], footings[k])) on[i] = on[k];
  return on;
}

/// A thing that stands on the same floor as before has not been lifted: what the comparison says is noise.
Eigen::Isometry3d without_lift(Eigen::Isometry3d T_now_before, double voxel_m) {
  const double noise_m = std::max(0.015, 1.5 * voxel_m);
  if (std::abs(T_now_before.translation().z()) < noise_m) T_now_before.translation().z() = 0.0;
  return T_now_before;
}

}  // namespace

std::vector<SupportChange> follow_moved_supports(const StaticMap& before, const StaticMap& after,
                                                 const std::filesystem::path& folder,
                                                 std::vector<KeptObject>& objects) {
  std::vector<SupportChange> followed;
  if (objects.empty()) return followed;
  const std::vector<Change> changes = diff_maps(before, after, Eigen::Isometry3d::Identity());
  const std::vector<MovedThing> moved =
      find_moved_things(changes, surface_of_both(before, after, Eigen::Isometry3d::Identity()));
  std::vector<Footing> footings;
  for (const KeptObject& object : objects) footings.push_back(footing_of(object, folder));
  const std::vector<std::optional<std::size_t>> on = supports_of(footings, changes);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!on[i]) continue;
    const auto thing = std::find_if(moved.begin(), moved.end(),
                                    [&](const MovedThing& each) { return each.vanished == *on[i]; });
    if (thing == moved.end()) {
      followed.push_back({objects[i].name, false, 0.0, 0.0});
      continue;
    }
    const Eigen::Vector3d from = objects[i].T_world_object.translation();
    objects[i].T_world_object =
        without_lift(thing->T_now_before, after.resolution_m()) * objects[i].T_world_object;
    followed.push_back(
        {objects[i].name, true, (objects[i].T_world_object.translation() - from).norm(), thing->turned_deg});
  }
  return followed;
}

}  // namespace roomradar
