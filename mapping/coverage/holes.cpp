// holes.cpp: finds holes of the surface in addition to the frontier's, and describes them.
#include "mapping/coverage/holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mapping/coverage/frontier.hpp"
#include "mapping/mesh/mesh_borders.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

std::string_view to_string(HoleKind kind) {
  switch (kind) {
    case HoleKind::kSurfaceBorder:
      return "surface border";
    case HoleKind::kUnknownSpace:
      return "unknown space";
    case HoleKind::kOuterBorder:
      return "outer border";
  }
  return "?";
}

std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m) {
  constexpr double kLook_m = 1.2;  // from this distance a person sees a hole and its surroundings
  std::vector<Hole> holes = frontier.holes;
  const double known_within_m = 3.0 * frontier.cell_m;
  for (const BorderLoop& loop : border_loops(surface)) {
    if (loop.encloses_surface || loop.size_m < min_border_size_m || loop.outward_world.isZero()) continue;
    const bool is_known =
        std::any_of(frontier.cells.begin(), frontier.cells.end(), [&](const FrontierCell& cell) {
          return cell.hole >= 0 && (cell.centre_world - loop.centre_world).norm() < known_within_m;
        });
    if (is_known) continue;
    Hole hole{.kind = HoleKind::kSurfaceBorder,
              .position_world = loop.centre_world,
              .size_m = loop.size_m,
              .area_m2 = loop.area_m2,
              .look_direction_world = -loop.outward_world,
              .viewpoint_world = std::nullopt};
    const Eigen::Vector3d stand = loop.centre_world + kLook_m * loop.outward_world;
    if (map.occupancy_at(stand) == Occupancy::kFree) hole.viewpoint_world = stand;
    holes.push_back(hole);
  }
  std::stable_sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) {
    const bool is_a_outside = a.kind == HoleKind::kOuterBorder;
    const bool is_b_outside = b.kind == HoleKind::kOuterBorder;
    return is_a_outside != is_b_outside ? is_b_outside : a.area_m2 > b.area_m2;
  });
  return holes;
}

std::string describe(const Hole& hole) {
  char text[512];  // room for five numbers of up to 42 digits, and words
  const Eigen::Vector3d p = rounded(hole.position_world, 2), look = rounded(hole.look_direction_world, 2);
  int length = format_classic(
      text, sizeof(text), "%s at (%.2f, %.2f, %.2f) m, %.2f m wide, %.2f m2; look along (%.2f, %.2f, %.2f)",
      std::string(to_string(hole.kind)).c_str(), p.x(), p.y(), p.z(), hole.size_m, hole.area_m2, look.x(),
      look.y(), look.z());
  std::string words(text, static_cast<std::size_t>(length));
  if (!hole.viewpoint_world) return words;
  const Eigen::Vector3d from = rounded(*hole.viewpoint_world, 2);
  length = format_classic(text, sizeof(text), " from (%.2f, %.2f, %.2f)", from.x(), from.y(), from.z());
  return words.append(text, static_cast<std::size_t>(length));
}

}  // namespace roomradar
