// frame_result.hpp: result of Session::step() for one frame.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "app/objects/departure.hpp"
#include "app/objects/object_notice.hpp"
#include "app/session/frame_use.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "mapping/localization/locator.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

enum class FrameStatus {
  kDone,
  /// The camera's pose is a guess that nothing has verified for more than 0.15 s (TrackStatus::kUncertain).
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
