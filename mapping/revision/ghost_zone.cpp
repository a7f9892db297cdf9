// ghost_zone.cpp: marks the bricks around ghosts and computes the pixels they project to.
#include "mapping/revision/ghost_zone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "mapping/octree/tsdf_bricks.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kNear = 2;      // voxels; covers rounding, and the noise of averaged samples
constexpr int kCellEdge = 4;  // voxels, half a brick
constexpr double kNearest_m =
    0.1;  // a brick with a corner nearer to the camera plane is treated as filling the image

std::size_t offset_of(const VoxelIndex& voxel) {
  return brick_offset(voxel.unaryExpr([](int v) { return v & (kBrickEdge - 1); }));
}

// Index of the voxel's cell within its brick.
std::size_t cell_of(const VoxelIndex& voxel) {
  const auto half = [&](int axis) { return static_cast<std::size_t>(voxel[axis] >> 2 & 1); };
  return half(0) | half(1) << 1U | half(2) << 2U;
}

// Sets the bits of a brick's voxels that are in a box, borders included.
void set_box(const VoxelIndex& low, const VoxelIndex& high, std::bitset<512>& bits) {
  const VoxelIndex from = low.cwiseMax(0), to = high.cwiseMin(kBrickEdge - 1);
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x) bits.set(brick_offset({x, y, z}));
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
    const Eigen::Vector3d corner(first.x() + (i & 1 ? kBrickEdge : 0), first.y() + (i & 2 ? kBrickEdge : 0),
                                 first.z() + (i & 4 ? kBrickEdge : 0));
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

GhostZone::GhostZone(const GhostVotes::Verdicts& verdicts, double resolution_m)
    : resolution_m_(resolution_m) {
  const auto mark = [this](const VoxelIndex& ghost, std::bitset<512> Marks::*bits) {
    const auto found = marks_.find(voxel_key(brick_of(ghost)));
    if (found != marks_.end() && found->second.ghost_cells.test(cell_of(ghost))) {
      (found->second.*bits).set(offset_of(ghost));
      return;
    }
    for (int i = 0; i < kCellsRound; ++i) {
      const VoxelIndex step = neighbour_offset(i);
      const VoxelIndex first = brick_of(ghost) + kBrickEdge * step;
      if (marks_.try_emplace(voxel_key(first)).second) bricks_.push_back(first);
      const VoxelIndex neighbour = ghost + kCellEdge * step;
      marks_[voxel_key(brick_of(neighbour))].cells.set(cell_of(neighbour));
    }
    Marks& own = marks_.at(voxel_key(brick_of(ghost)));
    own.ghost_cells.set(cell_of(ghost));
    (own.*bits).set(offset_of(ghost));
  };
  for (const VoxelIndex& ghost : verdicts.ghosts) mark(ghost, &Marks::ghost);
  for (const VoxelIndex& absent : verdicts.absent) mark(absent, &Marks::absent);
  // The marks of a brick and of the 26 around it; null: not in the zone. Voxels come brick by brick.
  std::array<Marks*, kCellsRound> round{};
  std::optional<VoxelIndex> middle;
  const auto mark_near = [&](const VoxelIndex& voxel, std::bitset<512> Marks::*bits) {
    if (const VoxelIndex first = brick_of(voxel); first != middle) {
      for (int i = 0; i < kCellsRound; ++i) {
        const auto found = marks_.find(voxel_key(first + kBrickEdge * neighbour_offset(i)));
        round[static_cast<std::size_t>(i)] = found == marks_.end() ? nullptr : &found->second;
      }
      middle = first;
    }
    for (int i = 0; i < kCellsRound; ++i) {
      Marks* const marks = round[static_cast<std::size_t>(i)];
      const VoxelIndex in_brick = voxel - *middle - kBrickEdge * neighbour_offset(i);
      if (marks) set_box(in_brick.array() - kNear, in_brick.array() + kNear, marks->*bits);
    }
  };
  for (const VoxelIndex& ghost : verdicts.ghosts) mark_near(ghost, &Marks::near_ghost);
  for (const VoxelIndex& absent : verdicts.absent) mark_near(absent, &Marks::near_ghost);
  for (const VoxelIndex& still : verdicts.still) mark_near(still, &Marks::near_still);
  for (const VoxelIndex& unseen : verdicts.unseen) {
    const auto found = marks_.find(voxel_key(brick_of(unseen)));
    if (found != marks_.end()) found->second.unseen.set(offset_of(unseen));
    mark_near(unseen, &Marks::near_unseen);
  }
}

bool GhostZone::reaches(const VoxelIndex& voxel) const {
  for (int i = 0; i < 8; ++i) {
    const VoxelIndex corner(i & 1 ? kNear : -kNear, i & 2 ? kNear : -kNear, i & 4 ? kNear : -kNear);
    if (marks_.contains(voxel_key(brick_of(voxel + corner)))) return true;
  }
  return false;
}

bool GhostZone::touches(const VoxelIndex& first) const {
  for (int i = 0; i < kCellsRound; ++i)
    if (marks_.contains(voxel_key(first + kBrickEdge * neighbour_offset(i)))) return true;
  return false;
}

const GhostZone::Marks* GhostZone::marks_of(const VoxelIndex& voxel) const {
  const auto found = marks_.find(voxel_key(brick_of(voxel)));
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
      if (const std::uint64_t brick = voxel_key(brick_of(voxel)); brick != last_brick) {
        marks = marks_of(voxel);
        last_brick = brick;
      }
      const std::size_t offset = offset_of(voxel);
      if (!marks || !marks->near_still.test(offset) || marks->near_ghost.test(offset)) depth = 0.0F;
    }
}

}  // namespace roomradar
