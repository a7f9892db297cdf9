// unmapped_space.cpp: warps what was seen block by block, and updates it with each frame.
#include "dynamic/foreground/unmapped_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomradar {
namespace {

constexpr std::uint8_t kMostFrames = 255, kMostAveraged = 16;
constexpr std::uint8_t kStanding_frames = 3;  // after which a surface that was there may be continued
constexpr std::uint8_t kStill_frames = 15;    // after which a surface that came no longer moves
constexpr int kSlowdown = 8;                  // such a frame counts once in so many if its region has moved
constexpr std::uint8_t kForget_frames = 90;   // without a measurement, such as at a shiny surface
constexpr std::uint8_t kEmpty_frames = 5;     // without a measurement: nothing was there
constexpr float kAnotherSurface = 0.03F;      // relative difference of depth, beside the noise
constexpr float kSigmas = 4.0F;

/// Returns true if no block changes its place: at a focal length of 585 px, a tenth of a pixel at 1 m.
bool is_same_view(const Eigen::Isometry3d& T_world_a, const Eigen::Isometry3d& T_world_b) {
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * T_world_b;
  return T_a_b.translation().norm() < 2e-4 && Eigen::AngleAxisd(T_a_b.linear()).angle() < 2e-4;
}

/// Gives blocks that no surface reached, between blocks that surfaces reached, the nearest one beside them.
void close_cracks(const BlockGrid& grid, const std::vector<float>& model_m,
                  std::vector<BlockSurface>& surfaces) {
  constexpr int kFewest = 5;  // of eight neighbours
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if (model_m[i] > 0.0F || surfaces[i].depth_m > 0.0F) continue;
      const BlockSurface* nearest = nullptr;
      int around = 0;
      for (int v = std::max(row - 1, 0); v <= std::min(row + 1, grid.rows - 1); ++v) {
        for (int u = std::max(column - 1, 0); u <= std::min(column + 1, grid.columns - 1); ++u) {
          const BlockSurface& beside = surfaces[grid.at(u, v)];
          if (!(beside.depth_m > 0.0F)) continue;
          ++around;
          if (nearest == nullptr || beside.depth_m < nearest->depth_m) nearest = &beside;
        }
      }
      if (around >= kFewest) surfaces[i] = *nearest;
    }
  }
}

void warp_surfaces(const Intrinsics& camera, const Eigen::Isometry3f& T_camera_world, const BlockGrid& grid,
                   const std::vector<float>& model_m, std::vector<BlockSurface>& reached,
                   std::vector<BlockSurface>& surfaces) {
  std::fill(reached.begin(), reached.end(), BlockSurface{});
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  bool any = false;
  for (const BlockSurface& surface : surfaces) {
    if (!(surface.depth_m > 0.0F)) continue;
    const Eigen::Vector3f p = T_camera_world * surface.p_world_m;
    if (!(p.z() > 0.05F)) continue;
    const float x_px = p.x() / p.z() * fx + cx + 0.5F, y_px = p.y() / p.z() * fy + cy + 0.5F;
    if (!(x_px >= 0.0F && y_px >= 0.0F && x_px < static_cast<float>(camera.width_px) &&
          y_px < static_cast<float>(camera.height_px)))
      continue;
    const std::size_t i = grid.at(static_cast<int>(x_px) / kBlock_px, static_cast<int>(y_px) / kBlock_px);
    BlockSurface& target = reached[i];
    if (model_m[i] > 0.0F) continue;
    if (target.depth_m > 0.0F && target.depth_m <= p.z()) continue;
    target = surface;
    target.depth_m = p.z();
    any = true;
  }
  surfaces.swap(reached);
  if (any) close_cracks(grid, model_m, surfaces);
}

/// Returns true for rows, or columns, that are not in the sensor's margin.
bool is_inside_margin(const std::vector<std::uint8_t>& measures, int i) {
  constexpr int kMargin = 8;  // the margin is at most an eighth of the image on either side
  const int size = static_cast<int>(measures.size());
  return measures[static_cast<std::size_t>(i)] != 0 || (kMargin * i >= size && kMargin * (size - i) > size);
}

/// Warps the counts by the camera's rotation, since nothing has no distance. What leaves the sensor's margin
/// was not measured there, whatever it is.
void warp_empty(const Intrinsics& camera, const Eigen::Matrix3f& R_before_now,
                const std::vector<float>& model_m, UnmappedSpace& space) {
  const BlockGrid grid = space.grid;
  space.empty_before.swap(space.empty);
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      std::uint8_t& empty = space.empty[grid.at(column, row)];
      empty = 0;
      if (model_m[grid.at(column, row)] > 0.0F) continue;
      const auto x = static_cast<float>(column * kBlock_px + kBlock_px / 2);
      const auto y = static_cast<float>(row * kBlock_px + kBlock_px / 2);
      const Eigen::Vector3f ray = R_before_now * Eigen::Vector3f((x - cx) / fx, (y - cy) / fy, 1.0F);
      if (!(ray.z() > 0.05F)) continue;
      const float u = ray.x() / ray.z() * fx + cx + 0.5F, v = ray.y() / ray.z() * fy + cy + 0.5F;
      if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(camera.width_px) &&
            v < static_cast<float>(camera.height_px)))
        continue;
      const int from_column = static_cast<int>(u) / kBlock_px, from_row = static_cast<int>(v) / kBlock_px;
      const bool leaves_margin =
          (is_inside_margin(space.column_measures, column) &&
           !is_inside_margin(space.column_measures, from_column)) ||
          (is_inside_margin(space.row_measures, row) && !is_inside_margin(space.row_measures, from_row));
      if (!leaves_margin) empty = space.empty_before[grid.at(from_column, from_row)];
    }
  }
}

/// Least and greatest measured depth of a block, m, both 0 if nothing is measured; number of measured pixels.
struct BlockDepth {
  float nearest_m = 0.0F, farthest_m = 0.0F;
  int measured = 0;
};

BlockDepth depth_of(const DepthImage& depth_m, int column, int row) {
  BlockDepth depth{std::numeric_limits<float>::max(), 0.0F, 0};
  for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, depth_m.height); ++y) {
    for (int x = column * kBlock_px; x < std::min((column + 1) * kBlock_px, depth_m.width); ++x) {
      const float z_m = depth_m.at(x, y);
      if (!(z_m > 0.0F)) continue;
      depth.nearest_m = std::min(depth.nearest_m, z_m);
      depth.farthest_m = std::max(depth.farthest_m, z_m);
      ++depth.measured;
    }
  }
  return depth.farthest_m > 0.0F ? depth : BlockDepth{};
}

Eigen::Vector3f point_world(const UnmappedSpace& space, int column, int row, float depth_m) {
  const Eigen::Vector3d p_camera = back_project(space.camera, column * kBlock_px + 0.5 * (kBlock_px - 1),
                                                row * kBlock_px + 0.5 * (kBlock_px - 1), depth_m);
  return (space.T_world_camera * p_camera).cast<float>();
}

float tolerance_at(float z_m, const DepthNoise& noise) {
  return kAnotherSurface * z_m + kSigmas * depth_sigma_m(noise, z_m);
}

/// Adds the rows and columns that measure anything in this frame, along every fourth row and column of
/// blocks.
void find_margin(const DepthImage& depth_m, UnmappedSpace& space) {
  constexpr int kStep_px = 4 * kBlock_px;
  for (int y = kBlock_px / 2; y < depth_m.height; y += kBlock_px)
    for (int x = kStep_px / 2; x < depth_m.width && space.row_measures[y / kBlock_px] == 0; x += kStep_px)
      space.row_measures[y / kBlock_px] = depth_m.at(x, y) > 0.0F ? 1 : 0;
  for (int x = kBlock_px / 2; x < depth_m.width; x += kBlock_px)
    for (int y = kStep_px / 2; y < depth_m.height && space.column_measures[x / kBlock_px] == 0; y += kStep_px)
      space.column_measures[x / kBlock_px] = depth_m.at(x, y) > 0.0F ? 1 : 0;
}

/// How the surface in a block goes on within two blocks around it.
struct Continuation {
  bool is_standing = false;  ///< the model, or a surface that has been there for a while
  bool is_moving = false;    ///< a surface that has come and was dynamic in the last frame
};

Continuation continuation_of(const UnmappedSpace& space, const std::vector<float>& model_m, int column,
                             int row, float z_m, float tolerance_m) {
  constexpr int kReach = 2;
  const BlockGrid& grid = space.grid;
  Continuation found;
  for (int v = std::max(row - kReach, 0); v <= std::min(row + kReach, grid.rows - 1); ++v) {
    for (int u = std::max(column - kReach, 0); u <= std::min(column + kReach, grid.columns - 1); ++u) {
      const std::size_t i = grid.at(u, v);
      const BlockSurface& seen = space.nearest[i];
      const float there_m = model_m[i] > 0.0F ? model_m[i] : seen.depth_m;
      if (!(there_m > 0.0F && std::abs(there_m - z_m) <= tolerance_m)) continue;
      found.is_standing |=
          model_m[i] > 0.0F || (seen.has_come == 0 && seen.has_moved == 0 && seen.frames >= kStanding_frames);
      found.is_moving |= !(model_m[i] > 0.0F) && seen.has_come != 0 && seen.has_moved != 0;
    }
  }
  return found;
}

/// True: the blocks that it entered and left are many, and on different sides.
bool is_moving(const SurfaceMotion& motion) {
  constexpr double kFewest = 10.0, kLeastPart = 0.02, kLeastApart = 5.0, kLeastApartOfRadius = 0.5;
  const double blocks = motion.all.count, fewest = std::max(kFewest, kLeastPart * blocks);
  if (motion.entered.count < fewest || motion.left.count < fewest) return false;
  const Eigen::Vector2d apart =
      motion.entered.sum / motion.entered.count - motion.left.sum / motion.left.count;
  const double radius =
      std::sqrt(std::max(motion.all.sum_of_squares / blocks - (motion.all.sum / blocks).squaredNorm(), 0.0));
  return apart.norm() > std::max(kLeastApart, kLeastApartOfRadius * radius);
}

/// True: it is not a part of the model's surface that is seen through a gap of the model.
bool is_apart_from_model(const SurfaceMotion& motion) {
  constexpr double kMostBeside = 0.1;
  return motion.beside_model <= kMostBeside * motion.all.count;
}

/// True: most of it is known to move. The rest was measured only now.
bool goes_on_moving(const SurfaceMotion& motion) { return 2.0 * motion.walking > motion.all.count; }

/// Sets UnmappedSpace::surface_of. Returns the number of surfaces.
std::int32_t connect_surfaces(const std::vector<float>& model_m, UnmappedSpace& space) {
  constexpr float kStep = 0.1F;  // relative difference of depth between neighbours on one surface
  constexpr int kGap = 6;        // blocks without a measurement, or with another surface, between its parts
  const BlockGrid& grid = space.grid;
  const auto is_surface = [&](std::size_t i) {
    return !(model_m[i] > 0.0F) && space.nearest[i].depth_m > 0.0F && space.nearest[i].unseen == 0;
  };
  space.surface_of.assign(grid.size(), -1);
  std::int32_t surfaces = 0;
  for (std::size_t first = 0; first < grid.size(); ++first) {
    if (space.surface_of[first] >= 0 || !is_surface(first)) continue;
    space.surface_of[first] = surfaces;
    space.reached_blocks.assign(1, first);
    while (!space.reached_blocks.empty()) {
      const std::size_t i = space.reached_blocks.back();
      space.reached_blocks.pop_back();
      const int column = static_cast<int>(i % static_cast<std::size_t>(grid.columns)),
                row = static_cast<int>(i / static_cast<std::size_t>(grid.columns));
      const float z_m = space.nearest[i].depth_m;
      const auto goes_on = [&](int u, int v) {
        return u >= 0 && u < grid.columns && v >= 0 && v < grid.rows && is_surface(grid.at(u, v)) &&
               std::abs(space.nearest[grid.at(u, v)].depth_m - z_m) <= kStep * z_m;
      };
      const bool is_inside = goes_on(column - 1, row) && goes_on(column + 1, row) &&
                             goes_on(column, row - 1) && goes_on(column, row + 1);
      const int reach = is_inside ? 1 : kGap;
      for (int v = row - reach; v <= row + reach; ++v)
        for (int u = column - reach; u <= column + reach; ++u) {
          if (!goes_on(u, v) || space.surface_of[grid.at(u, v)] >= 0) continue;
          space.surface_of[grid.at(u, v)] = surfaces;
          space.reached_blocks.push_back(grid.at(u, v));
        }
    }
    ++surfaces;
  }
  return surfaces;
}

constexpr std::uint8_t kRecent_frames = 15, kLeast_frames = 3;

bool has_entered(const BlockSurface& seen) { return seen.grown > 0 && seen.grown <= kRecent_frames; }

bool was_left(const BlockSurface& seen) {
  return seen.depth_m > 0.0F && seen.unseen >= kLeast_frames && seen.unseen <= kRecent_frames &&
         seen.frames >= kLeast_frames;
}

/// Returns false if no surface can move: nearly always, which spares the rest.
bool may_anything_move(const UnmappedSpace& space) {
  std::size_t entered = 0, left = 0, walking = 0;
  for (const BlockSurface& seen : space.nearest) {
    entered += has_entered(seen) ? 1 : 0;
    left += was_left(seen) ? 1 : 0;
    walking += seen.walks != 0 && seen.has_moved != 0 ? 1 : 0;
  }
  return walking > 0 || (entered > 0 && left > 0);
}

/// Adds a block that its surface entered, or that a surface left, to the motion of that surface. A block
/// counts only if it is more than a block away from where the surface stays: the camera's pose is not more
/// exact than that.
void add_change(int column, int row, UnmappedSpace& space) {
  constexpr int kReach = 8;  // from blocks that were left to the surface
  constexpr float kSameDepth = 0.15F;
  const BlockGrid& grid = space.grid;
  const std::size_t i = grid.at(column, row);
  const BlockSurface& seen = space.nearest[i];
  const std::int32_t own = space.surface_of[i];
  const bool is_left = own < 0;
  const int reach = is_left ? kReach : 1;
  std::int32_t surface = own;
  for (int v = std::max(row - reach, 0); v <= std::min(row + reach, grid.rows - 1); ++v)
    for (int u = std::max(column - reach, 0); u <= std::min(column + reach, grid.columns - 1); ++u) {
      const std::size_t j = grid.at(u, v);
      const std::int32_t other = space.surface_of[j];
      if (other < 0 || std::abs(space.nearest[j].depth_m - seen.depth_m) > kSameDepth * seen.depth_m)
        continue;
      const bool is_near = std::abs(u - column) <= 1 && std::abs(v - row) <= 1;
      if (is_near && (is_left || (other == own && !has_entered(space.nearest[j])))) return;
      if (is_left) surface = other;
    }
  if (surface < 0) return;
  SurfaceMotion& motion = space.motions[static_cast<std::size_t>(surface)];
  (is_left ? motion.left : motion.entered).add(column, row);
}

/// Returns true if the model goes on at the depth of a block's surface, beside the block.
bool is_beside_model(const std::vector<float>& model_m, const DepthNoise& noise, const UnmappedSpace& space,
                     int column, int row) {
  const BlockGrid& grid = space.grid;
  const float z_m = space.nearest[grid.at(column, row)].depth_m;
  const float tolerance_m = tolerance_at(z_m, noise);
  for (int v = std::max(row - 1, 0); v <= std::min(row + 1, grid.rows - 1); ++v)
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, grid.columns - 1); ++u) {
      const float beside_m = model_m[grid.at(u, v)];
      if (beside_m > 0.0F && std::abs(beside_m - z_m) <= tolerance_m) return true;
    }
  return false;
}

/// Marks surfaces that move as a whole as come.
void find_moving_surfaces(const std::vector<float>& model_m, const DepthNoise& noise, UnmappedSpace& space) {
  if (!may_anything_move(space)) return;
  const BlockGrid& grid = space.grid;
  space.motions.assign(static_cast<std::size_t>(connect_surfaces(model_m, space)), {});
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      const BlockSurface& seen = space.nearest[i];
      if (model_m[i] > 0.0F || !(seen.depth_m > 0.0F)) continue;
      if (space.surface_of[i] >= 0) {
        SurfaceMotion& motion = space.motions[static_cast<std::size_t>(space.surface_of[i])];
        motion.all.add(column, row);
        motion.walking += seen.walks != 0 && seen.has_moved != 0 ? 1.0 : 0.0;
        motion.beside_model += is_beside_model(model_m, noise, space, column, row) ? 1.0 : 0.0;
        if (has_entered(seen)) add_change(column, row, space);
      } else if (was_left(seen)) {
        add_change(column, row, space);
      }
    }
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (space.surface_of[i] < 0) continue;
    const SurfaceMotion& motion = space.motions[static_cast<std::size_t>(space.surface_of[i])];
    if (!is_apart_from_model(motion) || !(is_moving(motion) || goes_on_moving(motion))) continue;
    BlockSurface& seen = space.nearest[i];
    seen.has_come = seen.walks = 1;
    if (is_moving(motion)) seen.frames = 0;
  }
}

}  // namespace

void warp_unmapped(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   const std::vector<float>& model_m, UnmappedSpace& space) {
  if (!(space.camera == camera)) {
    const BlockGrid grid{blocks_along(camera.width_px), blocks_along(camera.height_px)};
    space.grid = grid;
    space.camera = camera;
    space.T_world_camera = T_world_camera;
    for (auto* surfaces : {&space.farthest, &space.nearest, &space.reached})
      surfaces->assign(grid.size(), {});
    for (auto* counts : {&space.empty, &space.empty_before}) counts->assign(grid.size(), 0);
    space.measured_m.assign(grid.size(), 0.0F);
    space.row_measures.assign(static_cast<std::size_t>(grid.rows), 0);
    space.column_measures.assign(static_cast<std::size_t>(grid.columns), 0);
    return;
  }
  if (is_same_view(space.T_world_camera, T_world_camera)) return;
  warp_empty(camera, (space.T_world_camera.linear().transpose() * T_world_camera.linear()).cast<float>(),
             model_m, space);
  space.T_world_camera = T_world_camera;
  const Eigen::Isometry3f T_camera_world = T_world_camera.inverse().cast<float>();
  warp_surfaces(camera, T_camera_world, space.grid, model_m, space.reached, space.farthest);
  warp_surfaces(camera, T_camera_world, space.grid, model_m, space.reached, space.nearest);
}

bool is_moving(const BlockSurface& nearest) {
  return nearest.depth_m > 0.0F && nearest.has_come != 0 && nearest.unseen == 0 &&
         nearest.frames < kStill_frames;
}

void see_what_came(const DepthImage& depth_m, const std::vector<float>& model_m, const DepthNoise& noise,
                   UnmappedSpace& space) {
  constexpr int kLeastMeasured = kBlock_px * kBlock_px / 2;  // pixels of a block; fewer are specks
  const BlockGrid grid = space.grid;
  ++space.frames;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if (model_m[i] > 0.0F) continue;
      const BlockDepth depth = depth_of(depth_m, column, row);
      space.measured_m[i] = depth.farthest_m;
      BlockSurface& seen = space.nearest[i];
      std::uint8_t& empty = space.empty[i];
      if (seen.grown > 0 && seen.grown < kMostFrames) ++seen.grown;
      if (depth.measured == 0) {
        if (empty < kMostFrames) ++empty;
        if (seen.unseen < kMostFrames) ++seen.unseen;
        if (seen.unseen > kForget_frames) seen = {};
        continue;
      }
      const float z_m = depth.nearest_m;
      const float tolerance_m = tolerance_at(z_m, noise);
      const bool was_there = seen.depth_m > 0.0F;
      if (was_there && std::abs(z_m - seen.depth_m) <= tolerance_m) {
        if (seen.unseen >= kEmpty_frames) {  // it has come again
          seen.grown = 1;
          if (seen.has_come != 0) seen.frames = 0;
        }
        seen.unseen = 0;
        if (seen.frames < kMostFrames) ++seen.frames;
      } else if (depth.measured >= kLeastMeasured || !was_there) {
        // What is nearer than a surface that was there is known from see_background(). Behind a thing that
        // has come is what was there before, if anything was; else, more of the thing.
        const Continuation on = continuation_of(space, model_m, column, row, z_m, tolerance_m);
        const float behind_m = space.farthest[i].depth_m;
        const bool is_behind = behind_m > 0.0F && z_m >= behind_m - tolerance_m;
        const bool is_same_thing = (was_there && seen.has_come != 0) || on.is_moving;
        const bool is_new = !was_there && empty >= kEmpty_frames;
        const bool has_come =
            depth.measured >= kLeastMeasured && !on.is_standing && (is_new || (is_same_thing && !is_behind));
        const std::uint8_t grown = is_new ? 1 : seen.grown;
        seen = {point_world(space, column, row, z_m),
                z_m,
                0,
                0,
                static_cast<std::uint8_t>(has_come),
                seen.has_moved,
                static_cast<std::uint8_t>(has_come && seen.walks != 0),
                grown};
      }
      empty = 0;
    }
  }
  find_moving_surfaces(model_m, noise, space);
  find_margin(depth_m, space);  // afterwards, so that a thing that enters it is not new there
}

void see_background(const DepthImage& depth_m, const MaskImage& dynamic_mask,
                    const std::vector<float>& model_m, const DepthNoise& noise, UnmappedSpace& space) {
  const BlockGrid grid = space.grid;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.at(column, row);
      if (model_m[i] > 0.0F) continue;
      const float farthest_m = space.measured_m[i];
      if (!(farthest_m > 0.0F)) continue;
      const int x = std::min(column * kBlock_px + kBlock_px / 2, depth_m.width - 1);
      const int y = std::min(row * kBlock_px + kBlock_px / 2, depth_m.height - 1);
      BlockSurface& nearest = space.nearest[i];
      nearest.has_moved = dynamic_mask.at(x, y) != 0 ? 1 : 0;
      if (nearest.has_moved != 0) {
        if (nearest.frames > 0 && space.frames % kSlowdown != 0) --nearest.frames;
        continue;
      }
      if (nearest.has_come != 0) continue;
      BlockSurface& seen = space.farthest[i];
      const float apart_m = farthest_m - seen.depth_m;
      const float noise_m = kSigmas * depth_sigma_m(noise, farthest_m);
      const bool is_first = !(seen.depth_m > 0.0F);
      if (!is_first && (apart_m < -noise_m || (apart_m <= noise_m && seen.frames >= kMostAveraged))) continue;
      if (is_first || apart_m > noise_m) {
        seen.depth_m = farthest_m;
        seen.frames = 1;
      } else {
        ++seen.frames;
        seen.depth_m += apart_m / static_cast<float>(seen.frames);
      }
      seen.p_world_m = point_world(space, column, row, seen.depth_m);
    }
  }
}

}  // namespace roomradar
