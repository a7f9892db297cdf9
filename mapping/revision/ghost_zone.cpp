// ghost_zone.cpp: marks bricks around removed voxels, and masks the pixels that measure remaining surface
// there.
#include "mapping/revision/ghost_zone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mapping/revision/brick_projection.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kNear = 2;      // voxels; covers rounding, and the noise of averaged samples
constexpr int kCellEdge = 4;  // voxels, half a brick
constexpr double kNearest_m =
    0.1;  // a brick with a corner nearer to the camera plane is treated as filling the image

std::size_t offset_of(const VoxelIndex& voxel) {
  return cell_brick_offset(voxel.unaryExpr([](int v) { return v & (kCellBrickEdge - 1); }));
}

// Index of the voxel's cell within its brick.
std::size_t cell_of(const VoxelIndex& voxel) {
  const auto half = [&](int axis) { return static_cast<std::size_t>(voxel[axis] >> 2 & 1); };
  return half(0) | half(1) << 1U | half(2) << 2U;
}

struct Rectangle {
  int left = 0, top = 0, right = -1, bottom = -1;  // borders included
};

// Image rectangle that contains a brick's projection; nullopt if it is out of view.
std::optional<Rectangle> covered_by(const VoxelIndex& first, double resolution_m, const Intrinsics& camera,
                                    const Eigen::Isometry3d& T_camera_world) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  int behind = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(first.x() + (i & 1 ? kCellBrickEdge : 0),
                                 first.y() + (i & 2 ? kCellBrickEdge : 0),
                                 first.z() + (i & 4 ? kCellBrickEdge : 0));
    const Eigen::Vector3d p_camera = T_camera_world * (corner * resolution_m);
    if (p_camera.z() < kNearest_m) {
      ++behind;
      continue;
    }
    const Eigen::Array2d pixel = project(camera, p_camera).array();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  if (behind == 8) return std::nullopt;
  if (behind > 0) return Rectangle{0, 0, camera.width_px - 1, camera.height_px - 1};
  const auto last = [](double pixel, int size) {
    return static_cast<int>(std::clamp(pixel, -1.0, size - 1.0));
  };
  const auto begin = [](double pixel, int size) {
    return static_cast<int>(std::clamp(pixel, 0.0, static_cast<double>(size)));
  };
  const Rectangle r{begin(std::floor(low.x()), camera.width_px), begin(std::floor(low.y()), camera.height_px),
                    last(std::ceil(high.x()), camera.width_px), last(std::ceil(high.y()), camera.height_px)};
  if (r.left > r.right || r.top > r.bottom) return std::nullopt;
  return r;
}

}  // namespace

GhostZone::BitsOfBricks GhostZone::bits_of(std::initializer_list<std::span<const VoxelIndex>> sets) {
  BitsOfBricks bits;
  for (const auto& voxels : sets) {
    VoxelBits* own = nullptr;  // voxels come brick by brick
    VoxelIndex first = VoxelIndex::Zero();
    for (const VoxelIndex& voxel : voxels) {
      if (!own || cell_brick_of(voxel) != first) {
        first = cell_brick_of(voxel);
        own = &bits[voxel_key(first)];
      }
      own->set(offset_of(voxel));
    }
  }
  return bits;
}

GhostZone::VoxelBits GhostZone::near_in_brick(const VoxelIndex& first, const BitsOfBricks& set) {
  std::array<const VoxelBits*, kCellsRound> round{};  // the brick and those around it
  bool any = false;
  for (int i = 0; i < kCellsRound; ++i) {
    const auto found = set.find(voxel_key(first + kCellBrickEdge * neighbour_offset(i)));
    if (found == set.end()) continue;
    round[static_cast<std::size_t>(i)] = &found->second;
    any = true;
  }
  VoxelBits near;
  if (!any) return near;
  const auto byte_at = [&](int brick_x, int y, int z) -> unsigned {  // of a row, bit x
    const VoxelBits* const bits = round[static_cast<std::size_t>(
        brick_x + 3 * ((y + kCellBrickEdge) / kCellBrickEdge + 3 * ((z + kCellBrickEdge) / kCellBrickEdge)))];
    return bits ? static_cast<unsigned>(bits->planes[z & 7] >> 8 * (y & 7) & 0xFFU) : 0U;
  };
  for (int z = -kNear; z < kCellBrickEdge + kNear; ++z) {
    std::uint64_t plane = 0;
    for (int y = -kNear; y < kCellBrickEdge + kNear; ++y) {
      // The row from x = -kNear on, and what is within kNear of it.
      const unsigned row = byte_at(0, y, z) >> (8 - kNear) | byte_at(1, y, z) << kNear |
                           (byte_at(2, y, z) & ((1U << kNear) - 1U)) << (8 + kNear);
      unsigned wide = row;
      for (int step = 1; step <= kNear; ++step) wide |= row << step | row >> step;
      const std::uint64_t byte = wide >> kNear & 0xFFU;
      for (int at = std::max(y - kNear, 0); at <= std::min(y + kNear, kCellBrickEdge - 1); ++at)
        plane |= byte << 8 * at;
    }
    for (int at = std::max(z - kNear, 0); at <= std::min(z + kNear, kCellBrickEdge - 1); ++at)
      near.planes[static_cast<std::size_t>(at)] |= plane;
  }
  return near;
}

GhostZone::GhostZone(const GhostVotes::Verdicts& verdicts, double resolution_m)
    : resolution_m_(resolution_m) {
  const auto mark = [this](const VoxelIndex& ghost, VoxelBits Marks::*bits) {
    const auto found = marks_.find(voxel_key(cell_brick_of(ghost)));
    if (found != marks_.end() && found->second.ghost_cells.test(cell_of(ghost))) {
      (found->second.*bits).set(offset_of(ghost));
      return;
    }
    for (int i = 0; i < kCellsRound; ++i) {
      const VoxelIndex first = cell_brick_of(ghost) + kCellBrickEdge * neighbour_offset(i);
      if (marks_.try_emplace(voxel_key(first)).second) bricks_.push_back(first);
    }
    for (int i = 0; i < kCellsRound; ++i) {
      const VoxelIndex neighbour = ghost + kCellEdge * neighbour_offset(i);
      marks_.at(voxel_key(cell_brick_of(neighbour))).cells.set(cell_of(neighbour));
    }
    Marks& own = marks_.at(voxel_key(cell_brick_of(ghost)));
    own.ghost_cells.set(cell_of(ghost));
    (own.*bits).set(offset_of(ghost));
  };
  for (const VoxelIndex& ghost : verdicts.ghosts) mark(ghost, &Marks::ghost);
  for (const VoxelIndex& absent : verdicts.absent) mark(absent, &Marks::absent);
  const BitsOfBricks removed = bits_of({verdicts.ghosts, verdicts.absent});
  const BitsOfBricks still = bits_of({verdicts.still});
  const BitsOfBricks unseen = bits_of({verdicts.unseen});
  for (const VoxelIndex& first : bricks_) {
    Marks& marks = marks_.at(voxel_key(first));
    marks.near_ghost = near_in_brick(first, removed);
    marks.near_still = near_in_brick(first, still);
    marks.near_unseen = near_in_brick(first, unseen);
    if (const auto found = unseen.find(voxel_key(first)); found != unseen.end()) marks.unseen = found->second;
  }
}

bool GhostZone::reaches(const VoxelIndex& voxel) const {
  for (int i = 0; i < 8; ++i) {
    const VoxelIndex corner(i & 1 ? kNear : -kNear, i & 2 ? kNear : -kNear, i & 4 ? kNear : -kNear);
    if (marks_.contains(voxel_key(cell_brick_of(voxel + corner)))) return true;
  }
  return false;
}

bool GhostZone::touches(const VoxelIndex& first) const {
  for (int i = 0; i < kCellsRound; ++i)
    if (marks_.contains(voxel_key(first + kCellBrickEdge * neighbour_offset(i)))) return true;
  return false;
}

const GhostZone::Marks* GhostZone::marks_of(const VoxelIndex& voxel) const {
  const auto found = marks_.find(voxel_key(cell_brick_of(voxel)));
  return found == marks_.end() ? nullptr : &found->second;
}

SampleAction GhostZone::fate_of(const SurfaceSample& sample) const {
  const Marks* marks = marks_of(sample.voxel);
  if (!marks) return SampleAction::kKeep;
  const std::size_t offset = offset_of(sample.voxel);
  if (marks->ghost.test(offset)) return SampleAction::kFree;
  if (marks->absent.test(offset)) return SampleAction::kUnknown;
  const bool near_ghost = marks->near_ghost.test(offset);
  const bool near_still = marks->near_still.test(offset);
  const bool near_unseen = marks->near_unseen.test(offset);
  if (!(sample.weight > 0.0F) && near_ghost && !near_still && !near_unseen) return SampleAction::kUnknown;
  if (!near_ghost && (marks->unseen.test(offset) || (near_unseen && !near_still))) return SampleAction::kKeep;
  return marks->cells.test(cell_of(sample.voxel)) ? SampleAction::kEraseSample : SampleAction::kKeep;
}

bool GhostZone::in_view(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) const {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  return std::any_of(bricks_.begin(), bricks_.end(), [&](const VoxelIndex& first) {
    return covered_by(first, resolution_m_, camera, T_camera_world).has_value();
  });
}

void GhostZone::mask(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                     DepthImage& depth_m) const {
  std::optional<std::uint64_t> last_brick;  // neighbouring pixels mostly see the same one
  const Marks* marks = nullptr;
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x) {
      float& depth = depth_m.at(x, y);
      if (!(depth > 0.0F)) continue;
      const Eigen::Vector3d p_world = T_world_camera * back_project(camera, x, y, static_cast<double>(depth));
      const VoxelIndex voxel = (p_world / resolution_m_).array().floor().cast<int>();
      if (const std::uint64_t brick = voxel_key(cell_brick_of(voxel)); brick != last_brick) {
        marks = marks_of(voxel);
        last_brick = brick;
      }
      const std::size_t offset = offset_of(voxel);
      if (!marks || !marks->near_still.test(offset) || marks->near_ghost.test(offset)) depth = 0.0F;
    }
}

}  // namespace roomradar
