// frame_result.hpp: result of Session::step() for one frame, with the room triangles and depth pixels that it
// used.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "app/objects/departure.hpp"
#include "app/objects/object_notice.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "dynamic/surface/dynamic_cells.hpp"
#include "mapping/localization/locator.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

class FrameScene;
struct RoomDrawn;
struct SessionRoom;

/// Counts of one localised frame.
struct FrameUse {
  std::size_t room_triangles = 0;  ///< number of triangles of the static mesh
  /// Views of the static mesh rendered for localisation and expected depth. 0: an earlier rendering was
  /// reused because the camera was stationary.
  std::size_t views_drawn = 0;
  std::size_t room_drawn = 0;  ///< mean number of static triangles drawn per view; the others were culled
  /// Number of static triangles for which CyberRadar computed a bound from the triangle's plane, summed over
  /// all queries; see CyberRadar::static_triangles_tested().
  std::size_t room_asked = 0;
  std::size_t valid_px = 0;  ///< pixels with live depth
  /// Pixels meshed. SurfacePolicy::kMap: the dynamic pixels. Other policies: all valid pixels.
  std::size_t meshed_px = 0;
  /// True if dynamic pixels were detected. Only SurfacePolicy::kMap detects them.
  bool knows_moved = true;
  std::size_t mesh_triangles = 0;
  CellCounts cells;  ///< cells of 4 x 4 pixels of the dynamic mesh; all 0 unless SurfacePolicy::kMap
};

/// Returns the counts of the frame that `scene` processed last.
/// @param has_map           true with SurfacePolicy::kMap
/// @param drawn_before      scene.room_drawn() before the frame
/// @param triangles_tested  increase of CyberRadar::static_triangles_tested() in this frame
FrameUse use_of(const SessionRoom& room, const FrameScene& scene, bool has_map,
                const ForegroundCounts& foreground, const RoomDrawn& drawn_before,
                std::uint64_t triangles_tested);

enum class FrameStatus {
  kDone,
  /// The camera's pose is a guess that nothing has verified for a while (TrackStatus::kUncertain).
  /// Objects stand still; the picture shows them from the guessed pose.
  kUncertain,
  kNotLocated,  ///< no camera pose; objects do not move, and the picture does not show them
  kBadFrame,    ///< fault_of() rejects the frame's images; session and picture are unchanged
};

struct FrameResult {
  FrameStatus status = FrameStatus::kNotLocated;
  std::string_view fault;  ///< reason for kBadFrame, from fault_of()
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< kDone and kUncertain
  PoseSigma sigma;  ///< of T_world_camera; 0 for recorded poses
  TrackStatus tracking = TrackStatus::kDiverged;
  ForegroundCounts foreground;
  std::size_t dynamic_triangles = 0;
  /// Triangles of the static mesh that were drawn to render the expected depth.
  std::size_t static_triangles_drawn = 0;
  std::size_t inferred_triangles = 0;  ///< triangles of the inferred backs of dynamic surfaces
  int contacts = 0;
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< contacts per kind of surface touched
  /// Max penetration depth along gravity, >= 0. Set only if config.measure_penetration.
  double deepest_penetration_m = 0.0;
  std::vector<Departure> departures;  ///< objects that fell out of the map
  std::vector<ObjectNotice> notices;  ///< notices since the previous frame
  FrameUse use;                       ///< kDone only
  bool picture_is_new = false;        ///< false: Session::picture() shows an earlier frame
};

}  // namespace roomradar
