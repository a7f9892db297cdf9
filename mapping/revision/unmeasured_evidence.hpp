// unmeasured_evidence.hpp: finds surface of departed objects without measured depth behind them, such as in
// front of glass or of walls beyond the sensor's range.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Evidence from frames that do not measure a voxel's surface. Missing depth alone does not prove that the
/// surface is gone, since dark and glossy surfaces give no depth at grazing angles. Colour distinguishes both
/// cases. In a later frame from the same camera position, the pixels of a dark or glossy surface still have
/// their colour. The pixels of a departed object do not.
struct AbsenceVotes {
  enum class State : std::uint8_t { kUnknown, kMeasured, kGone };

  std::uint16_t gone = 0;  ///< frames without depth at the voxel and in over 75 % of the pixels around it
  /// Frames without depth at the voxel and in over 50 % of the pixels around it, and without nearer depth in
  /// the other pixels around it.
  std::uint16_t unmeasured = 0;
  std::uint16_t last_look = 0;      ///< index of the frame that last measured the voxel or found it gone
  std::uint16_t turn_change = 0;    ///< sum over `turns` of the largest change of a colour channel
  std::uint16_t steady_change = 0;  ///< sum over `steadies` of the largest change of a colour channel
  /// Number of switches between measured and gone, in consecutive observations from one camera position.
  std::uint8_t turns = 0;
  std::uint8_t steadies = 0;      ///< pairs of consecutive measured observations from one position
  State state = State::kUnknown;  ///< state in frame last_look
  Rgb colour{};                   ///< colour in frame last_look
};

/// A pixel without depth, to which a voxel projects, and what is measured around it.
struct UnmeasuredPixel {
  int x = 0, y = 0;
  float measured_share = 0.0F;  ///< fraction of the pixels within about 3 cm of the voxel that have depth
  /// True if one of these pixels has a smaller depth than the voxel. The nearer surface may then shadow the
  /// projector's light.
  bool beside_nearer = false;
};

/// Adds a frame's evidence to the votes of voxels. Use one instance per map, and pass frames in the order of
/// the recording.
class AbsenceVoter {
 public:
  /// Begins a frame. Call before measured() and unmeasured().
  void begin(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Adds the vote of a frame that measures the voxel's surface in the pixel to which the voxel projects.
  void measured(const Frame& frame, const Eigen::Vector3f& p_camera, AbsenceVotes& votes) const;
  /// Adds the vote of a frame that has no depth in the pixel to which the voxel projects.
  /// @param has_colour  true if the voxel's colour is tracked
  void unmeasured(const Frame& frame, const UnmeasuredPixel& pixel, const Eigen::Vector3f& p_camera,
                  bool has_colour, AbsenceVotes& votes) const;

 private:
  void turn(const Frame& frame, const Eigen::Vector3f& p_camera, AbsenceVotes::State state,
            AbsenceVotes& votes) const;

  std::vector<Eigen::Vector3d> centres_world_;  // camera centre of each frame
  Eigen::Matrix3f K_R_colour_depth_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f K_t_colour_depth_ = Eigen::Vector3f::Zero();
};

/// A voxel and the index of its votes.
struct VotedVoxel {
  VoxelIndex voxel = VoxelIndex::Zero();
  std::uint32_t position = 0;
};

/// Returns true if a voxel may be a core voxel of a departed object, i.e. has enough evidence by itself. The
/// voxel must be gone in at least 3 frames, and in at least twice as many frames as measured it (`seen`).
bool may_be_absent(const AbsenceVotes& votes, int seen);
/// Returns true if the voxel's evidence suffices to remove it together with a connected core voxel.
bool may_go_along(const AbsenceVotes& votes, int seen);

/// Returns the candidates in connected components of at least min_group_voxels voxels whose colour changed
/// between measured and gone. `votes` is indexed by VotedVoxel::position.
std::vector<VotedVoxel> find_absent(std::span<const VotedVoxel> candidates,
                                    std::span<const AbsenceVotes> votes, double min_group_voxels);

/// Returns the core voxels, and those voxels of `going_along` that are connected to a core voxel within
/// max_steps steps.
std::vector<VotedVoxel> spread(std::vector<VotedVoxel> cores, std::span<const VotedVoxel> going_along,
                               int max_steps = std::numeric_limits<int>::max());

/// Returns the voxels of those connected components in which at least half of the voxels are core voxels.
/// Most voxels of a departed object have enough evidence by themselves. Where few have, an error of the pose
/// or missing depth of the surface explains them: a glossy surface far away, of which every frame measures
/// another part.
/// @param voxels  the core voxels first, as spread() returns them
std::vector<VotedVoxel> mostly_core(std::span<const VotedVoxel> voxels, std::size_t cores);

}  // namespace roomradar
