// absence.hpp: which surface of the map moved on where no depth is measured behind it: before glass, or
// before more than the sensor reaches.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// What the frames say about one voxel's surface by not measuring it. That alone is no proof: dark and glossy
/// things give no depth from where they are seen at a slant. But from one place and a moment later they look
/// as before, and what moved on does not.
struct AbsenceVotes {
  enum class State : std::uint8_t { kUnknown, kMeasured, kGone };

  std::uint16_t gone = 0;  ///< frames without depth all round it
  /// Frames without depth at it and in most pixels round it, of which none is nearer.
  std::uint16_t unmeasured = 0;
  std::uint16_t last_look = 0;      ///< when it was last measured or gone
  std::uint16_t turn_change = 0;    ///< sum over `turns` of the greatest change of a colour channel
  std::uint16_t steady_change = 0;  ///< the same over `steadies`
  std::uint8_t turns = 0;  ///< times it was measured in one look and gone in the next, from nearly one place
  std::uint8_t steadies = 0;      ///< times it was measured in both
  State state = State::kUnknown;  ///< at last_look
  Rgb colour{};                   ///< at last_look
};

/// Turns frames into votes; one for a map, frames in the order of the recording.
class AbsenceLooks {
 public:
  void begin(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// The frame has depth at the voxel's own distance, in the pixel that sees it.
  void measured(const Frame& frame, const Eigen::Vector3f& p_camera, AbsenceVotes& votes) const;
  /// The frame has no depth in pixel x, y, which should see the voxel.
  /// @param measured_share  pixels with depth, of those within some 3 cm round it
  /// @param beside_nearer   whether any of those is nearer than the voxel: it may be in that thing's shadow
  /// @param has_colour      whether the voxel is one of those whose colour is looked at
  void unmeasured(const Frame& frame, int x, int y, const Eigen::Vector3f& p_camera, float measured_share,
                  bool beside_nearer, bool has_colour, AbsenceVotes& votes) const;

 private:
  void turn(const Frame& frame, const Eigen::Vector3f& p_camera, AbsenceVotes::State state,
            AbsenceVotes& votes) const;

  std::vector<Eigen::Vector3d> centres_world_;  // of the camera, by look
  Eigen::Matrix3f K_R_colour_depth_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f K_t_colour_depth_ = Eigen::Vector3f::Zero();
};

/// A voxel and where its votes stand.
struct VotedVoxel {
  VoxelIndex voxel = VoxelIndex::Zero();
  std::uint32_t position = 0;
};

/// Whether a voxel that was seen so often is gone so often that it may be the core of what moved on.
bool may_be_absent(const AbsenceVotes& votes, int seen);
/// Whether it goes with such a core that it touches.
bool may_go_along(const AbsenceVotes& votes, int seen);

/// Of the voxels that may be absent, those of groups that hang together, have at least so many voxels, and
/// changed their colour when they turned from measured to gone or back. `votes` is by their position.
std::vector<VotedVoxel> find_absent(std::span<const VotedVoxel> candidates,
                                    std::span<const AbsenceVotes> votes, double min_group_voxels);

/// The cores, and all that hang together with them over voxels that go along, so many from one to the next.
std::vector<VotedVoxel> spread(std::vector<VotedVoxel> cores, std::span<const VotedVoxel> going_along,
                               int max_steps = std::numeric_limits<int>::max());

}  // namespace roomradar
