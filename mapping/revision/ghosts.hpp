// ghosts.hpp: finds ghosts (surface of objects that moved away during the scan) in the static map.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/revision/brick_projection.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct GhostConfig {
  /// A frame sees through a sample (a voxel with a signed distance) if the frame's depth there exceeds the
  /// sample's depth by more than the largest of the four margins below. margin_m (metres) and margin_sigmas
  /// (standard deviations of depth) cover noise and tracking errors.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// Margin per metre of depth. Covers a pose error of 1.7 degrees on a slanted surface, and sensors that are
  /// noisier than the Kinect at long range.
  float margin_per_m = 0.03F;
  /// Margin in voxels: samples are up to one voxel in front of or behind the measured surface.
  float margin_voxels = 1.5F;
  /// Radius of a window around the sample's pixel, in m at the sample's depth. A frame sees through the
  /// sample only if all measured pixels of the window do. With a single pixel, small pose errors would make
  /// rays past the edge of a static object count as well.
  float window_radius_m = 0.03F;
  /// Min fraction of the window's pixels that must have depth. The centre pixel must always have depth.
  float min_measured_share = 0.5F;
  /// Min frames that see through a sample; one suffices for samples connected to such samples.
  int min_through = 3;
  /// Min fraction of frames that see through a ghost's sample, relative to all frames that measure it or see
  /// through it.
  float min_through_share = 0.1F;
  /// Min size of a ghost, as the edge of a square, m. A connected component of samples that frames see
  /// through is a ghost only if it has at least as many samples as the square. The square has two samples per
  /// voxel of area. Smaller components are tracking errors at the edges of static objects.
  float min_extent_m = 0.15F;
  /// The same for samples through which more frames see something far behind (far_behind_m) than measure
  /// them. Tracking errors at static edges do not reach that share; small things that moved do, such as a
  /// part of the robot that carries the camera.
  float min_extent_mostly_through_m = 0.03F;
  float far_behind_m = 0.3F;
  int max_looks = 170;  ///< max number of frames used, evenly spaced over the recording
};

/// Throws Error (naming the field, its value and the rule) if a setting is out of range.
void require_valid(const GhostConfig& config);

/// Returns n such that every n-th of `frames` frames is used; 1: all.
std::int64_t look_stride(std::int64_t frames, const GhostConfig& config);

inline constexpr int kMaxWindowRadius_px = 31;

/// Sparse table. At each pixel, nearest_m[k] stores the minimum depth of the 2^k x 2^k square whose upper
/// left corner is this pixel. The minimum is infinity if the square has no depth. Four such squares cover any
/// window whose side is at least 2^k and less than 2^(k+1).
struct DepthWindows {
  std::vector<DepthImage> nearest_m;
  Image<std::int32_t> measured;  ///< integral image: number of pixels with depth above and to the left
};

struct WindowDepth {
  float nearest_m = 0.0F;       ///< infinity if no pixel of the window has depth
  float measured_share = 0.0F;  ///< fraction of the window's pixels with depth; pixels outside the image
                                ///< count as pixels without depth
};

/// Builds the sparse table and the integral image, reusing the memory of `windows`.
void build_windows(const DepthImage& depth_m, DepthWindows& windows);

/// Queries the window of (2 radius_px + 1)^2 pixels around pixel (x, y). radius_px must be in
/// 0..kMaxWindowRadius_px. At the image's border, nearest_m may include some pixels just outside the window.
WindowDepth window_depth(const DepthWindows& windows, int x, int y, int radius_px);

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

/// For each surface cell of the map, counts the frames that measure it and the frames that see through it.
/// Example: a hand that rests on a table for half of the recording is measured in as many frames as the
/// table. Only frames that measure the table behind the hand's voxels distinguish the hand from static
/// surface. Frames without depth at the cell are counted in AbsenceVotes. All eight voxels of a coarse cell
/// get the same verdict.
class GhostVotes {
 public:
  /// Copies the map's surface cells. A surface cell has a sample, and is occupied or has a signed distance of
  /// at most one voxel. Throws Error if the config is invalid.
  explicit GhostVotes(const StaticMap& map, const GhostConfig& config = {});

  /// Adds one frame's votes. The frame must have been fused at this pose.
  void look(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Classification of the surface voxels. A departed object is a large enough connected component of voxels
  /// with enough evidence, plus connected voxels with weaker evidence. If the latter are more than half, only
  /// the voxels that enough frames see through are removed. Components of at least 0.5 x 0.5 m are too large
  /// to be tracking errors. Up to 20 cm around them, even weaker evidence suffices.
  struct Verdicts {
    std::vector<VoxelIndex> ghosts;  ///< voxels of departed objects through which frames see
    std::vector<VoxelIndex> absent;  ///< voxels of departed objects without measured depth behind
    /// Other occupied surface that a frame observed, within GhostZone::reaches() of the zone of `ghosts` and
    /// `absent`.
    std::vector<VoxelIndex> still;
    /// Surface of an earlier scan that no frame measured or saw through, within reaches() of the same zone.
    std::vector<VoxelIndex> unseen;
  };
  /// Classifies the voxels. Each list is in Morton order.
  [[nodiscard]] Verdicts verdicts() const;

 private:
  enum class Fate : std::uint8_t { kStill, kGhost, kAbsent };
  [[nodiscard]] std::vector<Fate> fates() const;  // in the order of votes_
  /// Voxels that rays went through, in groups that are large enough to be a ghost, or for sure one.
  struct ThroughGroups {
    std::vector<VotedVoxel> ghosts, sure;
  };
  [[nodiscard]] ThroughGroups groups_seen_through() const;
  /// Returns the voxels on both sides of a square surface of that edge.
  [[nodiscard]] double voxels_of(double edge_m) const;
  struct Votes {
    std::uint16_t offset : 9 = 0;  // of the lowest voxel in the brick
    std::uint16_t coarse : 1 = 0;
    std::uint16_t occupied : 1 = 0;
    std::uint16_t seen = 0;
    std::uint16_t through = 0;
    std::uint16_t far_through = 0;  // of these, frames whose depth is far behind the voxel
    // Number of frames that see through the voxel in its pixel, but not in the whole window.
    std::uint16_t glimpsed = 0;
  };
  // Calls visit(voxel, index in votes_) for each voxel of a brick's surface cells, in Morton order.
  template <typename Visit>
  void for_each_voxel_of(const CellBrick& brick, const Visit& visit) const;
  // As for_each_voxel_of(), of all bricks.
  template <typename Visit>
  void for_each_voxel(const Visit& visit) const;
  // Returns the voxels for which are_such(votes, absence votes) is true.
  template <typename AreSuch>
  [[nodiscard]] std::vector<VotedVoxel> those(const AreSuch& are_such) const;
  // Returns true if `part` > 0 and at least min_through_share of part + others.
  [[nodiscard]] bool is_share(int part, int others) const;

  double resolution_m_;
  GhostConfig config_;
  std::vector<CellBrick> bricks_;
  std::vector<Votes> votes_;
  std::vector<AbsenceVotes> absence_;  // in the order of votes_
  AbsenceVoter absence_looks_;
  DepthWindows windows_;
};

}  // namespace roomradar
