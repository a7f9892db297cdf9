// frame_result.hpp: result of a session's work on one frame.
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
  kNotLocated,  ///< no camera pose: objects do not move, the picture shows no objects
  kBadFrame,    ///< images do not match their cameras: nothing changes, not even the picture
};

struct FrameResult {
  FrameStatus status = FrameStatus::kNotLocated;
  std::string_view fault;  ///< reason for kBadFrame, as from fault_of()
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< kDone only
  TrackStatus tracking = TrackStatus::kDiverged;
  ForegroundCounts foreground;
  std::size_t dynamic_triangles = 0;
  std::size_t static_triangles_drawn = 0;  ///< drawn for the expected depth
  std::size_t inferred_triangles = 0;      ///< of the inferred backs of dynamic surfaces
  int contacts = 0;
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< contacts per kind of surface touched
  double deepest_penetration_m = 0.0;                 ///< m, >= 0; only if config.measure_penetration
  std::vector<Departure> departures;                  ///< objects that fell out of the map
  std::vector<ObjectNotice> notices;                  ///< notices since the previous frame
  FrameUse use;                                       ///< kDone only
  bool picture_is_new = false;                        ///< false: picture() is that of an earlier frame
};

}  // namespace roomradar
