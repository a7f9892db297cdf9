// ghosts.cpp: collects the votes of frames on the map's surface, brick by brick.
#include "mapping/revision/ghosts.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mapping/revision/ghost_zone.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/parallel_for.hpp"
#include "mapping/types/validity.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {

void require_valid(const GhostConfig& c) {
  const ConfigCheck require{"ghosts"};
  require(c.margin_m > 0.0F && std::isfinite(c.margin_m), "margin_m", c.margin_m, "> 0");
  require(c.margin_per_m >= 0.0F && std::isfinite(c.margin_per_m), "margin_per_m", c.margin_per_m, ">= 0");
  require(c.margin_voxels >= 0.0F && std::isfinite(c.margin_voxels), "margin_voxels", c.margin_voxels,
          ">= 0");
  require(c.margin_sigmas >= 0.0F && std::isfinite(c.margin_sigmas), "margin_sigmas", c.margin_sigmas,
          ">= 0");
  require(c.window_radius_m >= 0.0F && c.window_radius_m <= 1.0F, "window_radius_m", c.window_radius_m,
          "in 0..1 m");
  require(c.min_measured_share >= 0.0F && c.min_measured_share <= 1.0F, "min_measured_share",
          c.min_measured_share, "in 0..1");
  require(c.min_through >= 1, "min_through", c.min_through, "1 or more");
  require(c.min_through_share >= 0.0F && c.min_through_share <= 1.0F, "min_through_share",
          c.min_through_share, "in 0..1");
  require(c.min_extent_m >= 0.0F && std::isfinite(c.min_extent_m), "min_extent_m", c.min_extent_m, ">= 0");
  require(c.min_extent_mostly_through_m >= 0.0F && std::isfinite(c.min_extent_mostly_through_m),
          "min_extent_mostly_through_m", c.min_extent_mostly_through_m, ">= 0");
  require(c.far_behind_m >= 0.0F && std::isfinite(c.far_behind_m), "far_behind_m", c.far_behind_m, ">= 0");
  require(c.max_looks >= 1 && c.max_looks <= 60'000, "max_looks", c.max_looks, "in 1..60000");
}

std::int64_t look_stride(std::int64_t frames, const GhostConfig& config) {
  return 1 + (frames - 1) / config.max_looks;
}

namespace {

constexpr int kLevels = std::bit_width(static_cast<unsigned>(2 * kMaxWindowRadius_px + 1));

// Computes minima over squares of twice the side; ignores parts beyond the image's border.
void double_side(const DepthImage& fine, int side, DepthImage& coarse) {
  coarse.width = fine.width;
  coarse.height = fine.height;
  coarse.pixels.resize(fine.pixels.size());
  for (int y = 0; y < fine.height; ++y) {
    const float* upper = fine.row(y);
    const float* lower = fine.row(std::min(y + side, fine.height - 1));
    float* out = coarse.row(y);
    const int inner = std::max(fine.width - side, 0);
    for (int x = 0; x < inner; ++x)
      out[x] = std::min(std::min(upper[x], upper[x + side]), std::min(lower[x], lower[x + side]));
    for (int x = inner; x < fine.width; ++x) out[x] = std::min(upper[x], lower[x]);
  }
}

void count_measured(const DepthImage& depth_m, Image<std::int32_t>& measured) {
  measured.resize(depth_m.width + 1, depth_m.height + 1);
  for (int y = 0; y < depth_m.height; ++y) {
    std::int32_t in_row = 0;
    for (int x = 0; x < depth_m.width; ++x) {
      in_row += depth_m.at(x, y) > 0.0F ? 1 : 0;
      measured.at(x + 1, y + 1) = measured.at(x + 1, y) + in_row;
    }
  }
}

}  // namespace

void build_windows(const DepthImage& depth_m, DepthWindows& windows) {
  windows.nearest_m.resize(kLevels);
  windows.nearest_m[0] = depth_m;
  for (float& nearest_m : windows.nearest_m[0].pixels)
    nearest_m = nearest_m > 0.0F ? nearest_m : std::numeric_limits<float>::infinity();
  for (int k = 1; k < kLevels; ++k)
    double_side(windows.nearest_m[static_cast<std::size_t>(k - 1)], 1 << (k - 1),
                windows.nearest_m[static_cast<std::size_t>(k)]);
  count_measured(depth_m, windows.measured);
}

WindowDepth window_depth(const DepthWindows& windows, int x, int y, int radius_px) {
  assert(windows.nearest_m.front().contains(x, y) && radius_px >= 0 && radius_px <= kMaxWindowRadius_px);
  const int side = 2 * radius_px + 1;
  const int level = std::bit_width(static_cast<unsigned>(side)) - 1;
  const DepthImage& nearest_m = windows.nearest_m[static_cast<std::size_t>(level)];
  const int left = std::max(x - radius_px, 0);
  const int top = std::max(y - radius_px, 0);
  const int end_x = std::min(x + radius_px + 1, nearest_m.width);
  const int end_y = std::min(y + radius_px + 1, nearest_m.height);
  const int second_x = std::max(end_x - (1 << level), 0);
  const int second_y = std::max(end_y - (1 << level), 0);
  const auto& measured = windows.measured;
  const std::int32_t count =
      measured.at(end_x, end_y) - measured.at(left, end_y) - measured.at(end_x, top) + measured.at(left, top);
  return {std::min(std::min(nearest_m.at(left, top), nearest_m.at(second_x, top)),
                   std::min(nearest_m.at(left, second_y), nearest_m.at(second_x, second_y))),
          static_cast<float>(count) / static_cast<float>(side * side)};
}

namespace {

using State = AbsenceVotes::State;

constexpr float kNearestMeasured_m = 0.6F;  // below this distance sensors may give no depth
constexpr float kFarthest_m = 4.5F;         // above this distance, too
constexpr float kUnmeasuredShare = 0.5F;
constexpr float kGoneShare = 0.25F;  // max fraction of pixels around a gone voxel that have depth
constexpr int kBorder = 32;        // the outermost 1/32 of the image is ignored: sensors have no depth there
constexpr double kOnePlace = 0.1;  // max distance of camera centres counted as one place, relative to the
                                   // surface's depth: 6 degrees
constexpr int kMinGone = 3;        // frames
constexpr int kSeenForUnmeasured = 2;  // max frames that measure a voxel per frame that does not
constexpr double kTurnChange = 30.0;   // of 255; larger than between two observations of static surface
constexpr double kMinTurned = 0.1;     // min fraction of a group's voxels with colour

template <typename Count>
void add(Count& count, int n = 1) {
  count = static_cast<Count>(std::min<int>(count + n, std::numeric_limits<Count>::max()));
}

// Spatial index of voxels; returns each voxel once.
class Unreached {
 public:
  explicit Unreached(std::span<const VotedVoxel> voxels) : voxels_(voxels) {
    index_of_.reserve(voxels.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) index_of_.emplace(voxel_key(voxels[i].voxel), i);
  }

  void take(const VoxelIndex& voxel) { index_of_.erase(voxel_key(voxel)); }
  // Takes a voxel and its 26 neighbours, as far as they are in the set. Calls take(index in the set).
  template <typename Take>
  void take_round(const VoxelIndex& voxel, const Take& take) {
    for (int i = 0; i < kCellsRound; ++i) {
      const auto found = index_of_.find(voxel_key(voxel + neighbour_offset(i)));
      if (found == index_of_.end()) continue;
      const std::size_t taken = found->second;
      index_of_.erase(found);
      take(taken);
    }
  }
  // Takes the connected component of a voxel, as far as it is in the set, and returns its indices.
  std::vector<std::size_t> take_component(const VoxelIndex& voxel) {
    std::vector<std::size_t> component;
    const auto take = [&](std::size_t i) { component.push_back(i); };
    take_round(voxel, take);
    for (std::size_t done = 0; done < component.size(); ++done)
      take_round(VoxelIndex(voxels_[component[done]].voxel), take);
    return component;
  }

 private:
  std::span<const VotedVoxel> voxels_;
  std::unordered_map<std::uint64_t, std::size_t> index_of_;
};

// Mean colour change at the group's turns minus the mean change between steady looks; negative if too few
// voxels turned.
double turn_change(std::span<const VotedVoxel> group, std::span<const AbsenceVotes> all_votes) {
  double turns = 0.0, turn_sum = 0.0, steadies = 0.0, steady_sum = 0.0;
  double coloured = 0.0, turned = 0.0;  // numbers of voxels
  for (const VotedVoxel& one : group) {
    const AbsenceVotes& votes = all_votes[one.position];
    coloured += votes.state != State::kUnknown ? 1.0 : 0.0;
    turned += votes.turns > 0 ? 1.0 : 0.0;
    turns += votes.turns;
    turn_sum += votes.turn_change;
    steadies += votes.steadies;
    steady_sum += votes.steady_change;
  }
  if (turned < 1.0 || turned < kMinTurned * coloured) return -1.0;
  return turn_sum / std::max(turns, 1.0) - steady_sum / std::max(steadies, 1.0);
}

}  // namespace

void AbsenceVoter::begin(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  centres_world_.emplace_back(T_world_camera.translation());
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = frame.colour_camera.fx_px;
  K(1, 1) = frame.colour_camera.fy_px;
  K(0, 2) = frame.colour_camera.cx_px;
  K(1, 2) = frame.colour_camera.cy_px;
  K_R_colour_depth_ = (K * frame.T_colour_depth.linear()).cast<float>();
  K_t_colour_depth_ = (K * frame.T_colour_depth.translation()).cast<float>();
}

void AbsenceVoter::turn(const Frame& frame, const Eigen::Vector3f& p_camera, State state,
                        AbsenceVotes& votes) const {
  const Eigen::Vector3f p = K_R_colour_depth_ * p_camera + K_t_colour_depth_;
  if (!(p.z() > 0.0F)) return;
  const float u = p.x() / p.z() + 0.5F;
  const float v = p.y() / p.z() + 0.5F;
  if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(frame.colour.width) &&
        v < static_cast<float>(frame.colour.height)))
    return;
  const Rgb colour = frame.colour.at(static_cast<int>(u), static_cast<int>(v));
  if (votes.state != State::kUnknown && (state == State::kMeasured || votes.state == State::kMeasured)) {
    const double apart_m = (centres_world_[votes.last_look] - centres_world_.back()).norm();
    if (apart_m < kOnePlace * static_cast<double>(p_camera.z())) {
      const int change = std::max({std::abs(colour.r - votes.colour.r), std::abs(colour.g - votes.colour.g),
                                   std::abs(colour.b - votes.colour.b)});
      const bool turned = state != votes.state;
      std::uint8_t& count = turned ? votes.turns : votes.steadies;
      if (count < std::numeric_limits<std::uint8_t>::max()) {
        add(count);
        add(turned ? votes.turn_change : votes.steady_change, change);
      }
    }
  }
  votes.state = state;
  votes.colour = colour;
  votes.last_look = static_cast<std::uint16_t>(centres_world_.size() - 1);
}

void AbsenceVoter::measured(const Frame& frame, const Eigen::Vector3f& p_camera, AbsenceVotes& votes) const {
  turn(frame, p_camera, State::kMeasured, votes);
}

void AbsenceVoter::unmeasured(const Frame& frame, const UnmeasuredPixel& pixel,
                              const Eigen::Vector3f& p_camera, bool has_colour, AbsenceVotes& votes) const {
  const float z = p_camera.z();
  const int border_x = frame.depth_m.width / kBorder;
  const int border_y = frame.depth_m.height / kBorder;
  if (!(z > kNearestMeasured_m && z < kFarthest_m) || pixel.measured_share >= kUnmeasuredShare ||
      pixel.x < border_x || pixel.y < border_y || pixel.x >= frame.depth_m.width - border_x ||
      pixel.y >= frame.depth_m.height - border_y)
    return;
  if (!pixel.beside_nearer) add(votes.unmeasured);
  if (pixel.measured_share >= kGoneShare) return;
  add(votes.gone);
  if (has_colour) turn(frame, p_camera, State::kGone, votes);
}

bool may_be_absent(const AbsenceVotes& votes, int seen) {
  return votes.gone >= kMinGone && votes.gone >= 2 * seen;
}

bool may_go_along(const AbsenceVotes& votes, int seen) {
  if (votes.unmeasured >= kMinGone && kSeenForUnmeasured * votes.unmeasured >= seen) return true;
  return votes.turns > 0 && votes.turn_change >= kTurnChange * votes.turns;
}

std::vector<VotedVoxel> find_absent(std::span<const VotedVoxel> candidates,
                                    std::span<const AbsenceVotes> votes, double min_group_voxels) {
  std::vector<VotedVoxel> absent, group;
  Unreached unreached(candidates);
  for (const VotedVoxel& seed : candidates) {
    group.clear();
    for (const std::size_t i : unreached.take_component(seed.voxel)) group.push_back(candidates[i]);
    if (static_cast<double>(group.size()) >= min_group_voxels && turn_change(group, votes) >= kTurnChange)
      absent.insert(absent.end(), group.begin(), group.end());
  }
  return absent;
}

std::vector<VotedVoxel> spread(std::vector<VotedVoxel> cores, std::span<const VotedVoxel> going_along,
                               int max_steps) {
  Unreached unreached(going_along);
  for (const VotedVoxel& core : cores) unreached.take(core.voxel);
  std::size_t done = 0;
  for (int step = 0; step < max_steps && done < cores.size(); ++step)
    for (const std::size_t end = cores.size(); done < end; ++done)
      unreached.take_round(VoxelIndex(cores[done].voxel),
                           [&](std::size_t i) { cores.push_back(going_along[i]); });
  return cores;
}

std::vector<VotedVoxel> mostly_core(std::span<const VotedVoxel> voxels, std::size_t cores) {
  std::vector<VotedVoxel> kept;
  Unreached unreached(voxels);
  for (std::size_t seed = 0; seed < cores; ++seed) {
    const std::vector<std::size_t> component = unreached.take_component(voxels[seed].voxel);
    const auto own =
        std::count_if(component.begin(), component.end(), [&](std::size_t i) { return i < cores; });
    if (2 * static_cast<std::size_t>(own) < component.size()) continue;
    for (const std::size_t i : component) kept.push_back(voxels[i]);
  }
  return kept;
}

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
        window.measured_share >= config_.min_measured_share) {
      ++votes.through;
      if (window.nearest_m - z > config_.far_behind_m) ++votes.far_through;
    } else if (measured_m - z > margin_m(measured_m))
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

double GhostVotes::voxels_of(double edge_m) const {
  return 2.0 * edge_m * edge_m / (resolution_m_ * resolution_m_);
}

GhostVotes::ThroughGroups GhostVotes::groups_seen_through() const {
  const auto seen_through = those([this](const Votes& votes, const AbsenceVotes&) {
    return votes.through >= config_.min_through && is_share(votes.through, votes.seen);
  });
  const auto mostly_through = those([this](const Votes& votes, const AbsenceVotes&) {
    return votes.far_through >= config_.min_through && votes.far_through > votes.seen;
  });
  const double min_voxels = voxels_of(static_cast<double>(config_.min_extent_m));
  const double min_mostly_through = voxels_of(static_cast<double>(config_.min_extent_mostly_through_m));
  const std::vector<std::size_t> together = voxels_together(seen_through),
                                 mostly_together = voxels_together(mostly_through);
  ThroughGroups groups;
  for (std::size_t i = 0, k = 0; i < seen_through.size(); ++i) {
    const auto size = static_cast<double>(together[i]);
    // Both lists are in one order, and the second is a part of the first.
    const bool is_mostly = k < mostly_through.size() && mostly_through[k].voxel == seen_through[i].voxel;
    const double mostly_size = is_mostly ? static_cast<double>(mostly_together[k++]) : 0.0;
    if (size >= min_voxels || (is_mostly && mostly_size >= min_mostly_through))
      groups.ghosts.push_back(seen_through[i]);
    if (size >= voxels_of(kSureExtent_m)) groups.sure.push_back(seen_through[i]);
  }
  return groups;
}

std::vector<GhostVotes::Fate> GhostVotes::fates() const {
  std::vector<Fate> fates(votes_.size(), Fate::kStill);

  // Voxels with enough evidence, in groups that are large enough.
  const auto may_be_gone = those(
      [](const Votes& votes, const AbsenceVotes& absence) { return may_be_absent(absence, votes.seen); });
  const std::vector<VotedVoxel> absent =
      find_absent(may_be_gone, absence_, voxels_of(static_cast<double>(config_.min_extent_m)));
  auto [ghosts, sure] = groups_seen_through();

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
