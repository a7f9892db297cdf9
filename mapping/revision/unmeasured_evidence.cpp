// unmeasured_evidence.cpp: votes from colour and missing depth, and connected components of voxels that these
// votes find absent.
#include "mapping/revision/unmeasured_evidence.hpp"

#include <algorithm>
#include <cstdlib>
#include <unordered_map>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
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

}  // namespace roomradar
