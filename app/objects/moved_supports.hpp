// moved_supports.hpp: kept objects go where the thing on which they stood was carried.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "app/objects/kept_objects.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

/// A kept object whose support was carried elsewhere, or is gone.
struct SupportChange {
  std::string name;
  bool was_moved = false;  ///< false: the support is gone, and the object falls in the next run
  double moved_m = 0.0, turned_deg = 0.0;
};

/// Compares two states of one room, and moves the objects that stood on something that was carried elsewhere
/// (find_moved_things()), also those on top of them. An object stands on a thing if a third of the lowest
/// part of its model has the thing's surface within 4 cm. Objects whose support vanished stay where they are,
/// and wake in the next run.
/// @param folder        folder of the objects' models
/// @param[in,out] objects  in the world frame of both states
std::vector<SupportChange> follow_moved_supports(const StaticMap& before, const StaticMap& after,
                                                 const std::filesystem::path& folder,
                                                 std::vector<KeptObject>& objects);

}  // namespace roomradar
