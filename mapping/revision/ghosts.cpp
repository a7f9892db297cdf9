// ghosts.cpp: collects the votes of frames on the map's surface, brick by brick.
#include "mapping/revision/ghosts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>

#include "mapping/revision/ghost_zone.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/parallel_for.hpp"
#include "mapping/types/validity.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

// Surface nearer than this gives no depth, and hides the surfaces behind it.
constexpr float kTooNear_m = 0.8F;
constexpr int kHiddenCell_px = 8;  // about the size of a 1 cm voxel at that distance

// A ghost that covers a square of this edge is too large for a tracking error. Within kReach_m around it,
// weaker evidence is enough. Without both limits, rows of voxels at static edges would be removed, too.
constexpr double kSureExtent_m = 0.5;
constexpr double kReach_m = 0.1;
constexpr int kHardlySeen = 3;  // a voxel connected to such a group is kept only if more frames saw it

// One voxel in this many has its colour tracked, and each coarse cell: groups are judged, not single cells.
constexpr std::size_t kEveryColour = 4;

/// Cells of the image that surface too near to give depth may hide.
class HiddenCells {
 public:
  HiddenCells(int width_px, int height_px)
      : across_(width_px / kHiddenCell_px + 1),
        down_(height_px / kHiddenCell_px + 1),
        is_hidden_(index(0, down_), false) {}

  /// Hides the pixel's cell and those around it.
  void hide_around(int x, int y) {
    const int column = x / kHiddenCell_px, row = y / kHiddenCell_px;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, down_ - 1); ++r)
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, across_ - 1); ++c)
        is_hidden_[index(c, r)] = true;
  }
  [[nodiscard]] bool is_hidden(int x, int y) const {
    return is_hidden_[index(x / kHiddenCell_px, y / kHiddenCell_px)];
  }

 private:
  int across_, down_;
  std::vector<bool> is_hidden_;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(column);
  }
};

/// Returns the cells hidden by occupied cells of the map that are too near to give depth.
/// @param cell_at      as for BrickProjection::for_each_nearer()
/// @param is_occupied  callable: is cell i of the bricks occupied?
template <typename CellAt, typename IsOccupied>
HiddenCells hidden_by_near_surface(const DepthImage& depth_m, const BrickProjection& projection,
                                   std::span<const CellBrick> bricks, const CellAt& cell_at,
                                   const IsOccupied& is_occupied) {
  HiddenCells hidden(depth_m.width, depth_m.height);
  projection.for_each_nearer(kTooNear_m, bricks, cell_at,
                             [&](std::size_t i, const Eigen::Vector3f&, int x, int y) {
                               if (is_occupied(i)) hidden.hide_around(x, y);
                             });
  return hidden;
}

Eigen::Vector3i in_brick(std::uint16_t offset) {
  static_assert(kCellBrickEdge == 8);
  return {offset & 7, offset >> 3 & 7, offset >> 6};
}

// Returns for each voxel the number of voxels connected to it, itself included. Voxels are connected if they
// are in the same cell of 4^3 voxels or in touching cells.
std::vector<std::size_t> voxels_together(const std::vector<VotedVoxel>& voxels) {
  const auto cell_of = [](const VoxelIndex& voxel) -> VoxelIndex {
    return voxel.unaryExpr([](int v) { return v >> 2; });
  };
  struct Cell {
    VoxelIndex index;
    std::size_t voxels = 0;
    std::size_t together = 0;  // voxels of all cells connected to it
  };
  std::vector<Cell> cells;
  std::unordered_map<std::uint64_t, std::size_t> position;
  for (const VotedVoxel& one : voxels) {
    const VoxelIndex& voxel = one.voxel;
    const auto [found, is_new] = position.try_emplace(voxel_key(cell_of(voxel)), cells.size());
    if (is_new) cells.push_back({cell_of(voxel)});
    ++cells[found->second].voxels;
  }
  std::vector<std::size_t> group;
  std::vector<std::uint8_t> reached(cells.size(), 0);
  for (std::size_t seed = 0; seed < cells.size(); ++seed) {
    if (reached[seed] != 0) continue;
    group.assign(1, seed);
    reached[seed] = 1;
    std::size_t count = 0;
    for (std::size_t done = 0; done < group.size(); ++done) {
      const Cell& cell = cells[group[done]];
      count += cell.voxels;
      for (int i = 0; i < kCellsRound; ++i) {
        const auto found = position.find(voxel_key(cell.index + neighbour_offset(i)));
        if (found == position.end() || reached[found->second] != 0) continue;
        reached[found->second] = 1;
        group.push_back(found->second);
      }
    }
    for (const std::size_t member : group) cells[member].together = count;
  }
  std::vector<std::size_t> together;
  together.reserve(voxels.size());
  for (const VotedVoxel& one : voxels)
    together.push_back(cells[position.at(voxel_key(cell_of(one.voxel)))].together);
  return together;
}

}  // namespace

GhostVotes::GhostVotes(const StaticMap& map, const GhostConfig& config)
    : resolution_m_(map.resolution_m()), config_(config) {
  require_valid(config);
  const auto voxel_m = static_cast<float>(resolution_m_);
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  map.visit_cells({-reach_m, reach_m}, [&](const SurfaceSample& sample, int edge_voxels) {
    if (sample.occupancy != Occupancy::kOccupied && std::abs(sample.distance_m) > voxel_m) return;
    const VoxelIndex first = cell_brick_of(sample.voxel);
    if (bricks_.empty() || bricks_.back().first != first)
      bricks_.push_back({first, votes_.size(), votes_.size()});
    Votes& votes = votes_.emplace_back();
    votes.offset = cell_brick_offset(sample.voxel - first) & 511U;
    votes.coarse = edge_voxels > 1 ? 1U : 0U;
    votes.occupied = sample.occupancy == Occupancy::kOccupied ? 1U : 0U;
    bricks_.back().end = votes_.size();
  });
  absence_.resize(votes_.size());
}

void GhostVotes::look(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  const DepthImage& depth_m = frame.depth_m;
  if (!depth_fault_of(frame).empty()) return;
  build_windows(depth_m, windows_);
  absence_looks_.begin(frame, T_world_camera);

  const float least_margin_m =
      std::max(config_.margin_m, config_.margin_voxels * static_cast<float>(resolution_m_));
  const BrickProjection projection(frame, T_world_camera, resolution_m_);
  const auto cell_at = [this](std::size_t i) -> CellInBrick {
    return {votes_[i].offset, votes_[i].coarse != 0};
  };
  const HiddenCells hidden = hidden_by_near_surface(
      depth_m, projection, bricks_, cell_at, [this](std::size_t i) { return votes_[i].occupied != 0; });

  const auto vote = [&, this](std::size_t i, const Eigen::Vector3f& p_camera, int x, int y) {
    Votes& votes = votes_[i];
    const float z = p_camera.z();
    const float measured_m = depth_m.at(x, y);
    const auto window_at = [&, this] {
      const int radius_px = std::min(
          static_cast<int>(std::ceil(config_.window_radius_m * projection.fx() / z)), kMaxWindowRadius_px);
      return window_depth(windows_, x, y, radius_px);
    };
    const bool has_colour = votes.coarse != 0 || i % kEveryColour == 0;
    const auto margin_m = [&, this](float depth) {
      return std::max({least_margin_m, config_.margin_sigmas * depth_sigma_m(frame.depth_noise, depth),
                       config_.margin_per_m * depth});
    };
    if (!(measured_m > 0.0F)) {
      if (hidden.is_hidden(x, y)) return;
      const WindowDepth window = window_at();
      const bool beside_nearer = window.nearest_m < z - margin_m(z);
      absence_looks_.unmeasured(
          frame, {.x = x, .y = y, .measured_share = window.measured_share, .beside_nearer = beside_nearer},
          p_camera, has_colour, absence_[i]);
      return;
    }
    if (std::abs(measured_m - z) <= margin_m(measured_m)) {
      ++votes.seen;
      if (has_colour) absence_looks_.measured(frame, p_camera, absence_[i]);
      return;
    }
    if (measured_m < z) return;
    const WindowDepth window = window_at();
    if (window.nearest_m - z > margin_m(window.nearest_m) &&
        window.measured_share >= config_.min_measured_share)
      ++votes.through;
    else if (measured_m - z > margin_m(measured_m))
      ++votes.glimpsed;
  };
  // The votes of different bricks are independent, so the bricks are shared among threads.
  constexpr std::size_t kPiece = 64;  // bricks
  const std::span<const CellBrick> bricks(bricks_);
  parallel_for((bricks.size() + kPiece - 1) / kPiece, hardware_threads(), [&](std::size_t i, unsigned) {
    const std::size_t count = std::min(kPiece, bricks.size() - i * kPiece);
    projection.for_each_nearer(std::numeric_limits<float>::infinity(), bricks.subspan(i * kPiece, count),
                               cell_at, vote);
  });
}

bool GhostVotes::is_share(int part, int others) const {
  return part > 0 &&
         static_cast<float>(part) >= static_cast<float>(part + others) * config_.min_through_share;
}

template <typename Visit>
void GhostVotes::for_each_voxel_of(const CellBrick& brick, const Visit& visit) const {
  for (std::size_t i = brick.begin; i < brick.end; ++i) {
    const VoxelIndex lowest = brick.first + in_brick(votes_[i].offset);
    const int voxels = votes_[i].coarse != 0 ? 8 : 1;
    for (int v = 0; v < voxels; ++v)
      visit(VoxelIndex(lowest + Eigen::Vector3i(v & 1, v >> 1 & 1, v >> 2)), static_cast<std::uint32_t>(i));
  }
}

template <typename Visit>
void GhostVotes::for_each_voxel(const Visit& visit) const {
  for (const CellBrick& brick : bricks_) for_each_voxel_of(brick, visit);
}

template <typename AreSuch>
std::vector<VotedVoxel> GhostVotes::those(const AreSuch& are_such) const {
  std::vector<VotedVoxel> found;
  for_each_voxel([&](const VoxelIndex& voxel, std::uint32_t i) {
    if (are_such(votes_[i], absence_[i])) found.push_back({voxel, i});
  });
  return found;
}

std::vector<GhostVotes::Fate> GhostVotes::fates() const {
  std::vector<Fate> fates(votes_.size(), Fate::kStill);
  const auto voxels_of = [this](double edge_m) {
    return 2.0 * edge_m * edge_m / (resolution_m_ * resolution_m_);
  };
  const double min_voxels = voxels_of(static_cast<double>(config_.min_extent_m));

  // Voxels with enough evidence, in groups that are large enough.
  const auto may_be_gone = those(
      [](const Votes& votes, const AbsenceVotes& absence) { return may_be_absent(absence, votes.seen); });
  const auto seen_through = those([this](const Votes& votes, const AbsenceVotes&) {
    return votes.through >= config_.min_through && is_share(votes.through, votes.seen);
  });
  const std::vector<VotedVoxel> absent = find_absent(may_be_gone, absence_, min_voxels);
  std::vector<VotedVoxel> ghosts, sure;
  const std::vector<std::size_t> together = voxels_together(seen_through);
  for (std::size_t i = 0; i < seen_through.size(); ++i) {
    const auto size = static_cast<double>(together[i]);
    if (size >= min_voxels) ghosts.push_back(seen_through[i]);
    if (size >= voxels_of(kSureExtent_m)) sure.push_back(seen_through[i]);
  }

  // Voxels connected to those groups need less evidence.
  std::vector<VotedVoxel> moved_on;
  const auto add = [&](const std::vector<VotedVoxel>& more) {
    moved_on.insert(moved_on.end(), more.begin(), more.end());
  };
  const auto is_once_through = [this](const Votes& votes, const AbsenceVotes&) {
    return is_share(votes.through, votes.seen);
  };
  const auto goes_along = [](const Votes& votes, const AbsenceVotes& absence) {
    return may_go_along(absence, votes.seen);
  };
  if (!absent.empty()) add(mostly_core(spread(absent, those(goes_along)), absent.size()));
  if (!ghosts.empty()) {
    add(ghosts);
    add(mostly_core(spread(ghosts, those(is_once_through)), ghosts.size()));
  }
  if (!sure.empty()) {
    const int reach = static_cast<int>(std::lround(kReach_m / resolution_m_));
    const auto is_glimpsed = [this](const Votes& votes, const AbsenceVotes&) {
      return is_share(votes.through + votes.glimpsed, votes.seen);
    };
    const auto is_hardly_seen = [](const Votes& votes, const AbsenceVotes&) {
      return votes.seen <= kHardlySeen;
    };
    const std::size_t cores = sure.size();
    sure = mostly_core(spread(std::move(sure), those(is_once_through)), cores);
    sure = spread(std::move(sure), those(is_glimpsed), reach);
    add(spread(std::move(sure), those(is_hardly_seen), reach));
  }
  for (const VotedVoxel& one : moved_on) {
    const Votes& votes = votes_[one.position];
    fates[one.position] = votes.through + votes.glimpsed > 0 ? Fate::kGhost : Fate::kAbsent;
  }
  return fates;
}

GhostVotes::Verdicts GhostVotes::verdicts() const {
  const std::vector<Fate> fates = this->fates();
  Verdicts verdicts;
  for_each_voxel([&](const VoxelIndex& voxel, std::uint32_t i) {
    if (fates[i] == Fate::kGhost) verdicts.ghosts.push_back(voxel);
    if (fates[i] == Fate::kAbsent) verdicts.absent.push_back(voxel);
  });

  // What stays is all of the room. Only what is near the removed voxels is needed.
  const GhostZone zone(verdicts, resolution_m_);
  const auto is_seen = [](const Votes& votes) {
    return votes.seen != 0 || votes.through != 0 || votes.glimpsed != 0;
  };
  for (const CellBrick& brick : bricks_) {
    if (!zone.touches(brick.first)) continue;
    for_each_voxel_of(brick, [&](const VoxelIndex& voxel, std::uint32_t i) {
      if (fates[i] != Fate::kStill || !zone.reaches(voxel)) return;
      if (!is_seen(votes_[i]))
        verdicts.unseen.push_back(voxel);
      else if (votes_[i].occupied != 0)
        verdicts.still.push_back(voxel);
    });
  }
  return verdicts;
}

}  // namespace roomradar
