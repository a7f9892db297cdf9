// run_results.hpp: results of a run, for its report and for messages to the user.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/run/dropped_frames.hpp"
#include "app/run/lost_spans.hpp"
#include "app/run/run_use.hpp"
#include "app/session/session.hpp"

namespace roomradar {

/// Sums and maxima over the frames of a run.
struct RunTotals {
  /// Numbers of frames: read, skipped (unusable), located, uncertain (TrackStatus::kUncertain) and
  /// degenerate. `contacts` counts contacts of objects. `degenerate` counts localised frames whose depth does
  /// not constrain all six degrees of freedom. `departures` counts objects that fell out of the map.
  /// `places_refused` counts events that were refused because there was no free pose (PlaceRefused).
  std::int64_t read = 0, skipped = 0, located = 0, uncertain = 0, degenerate = 0, contacts = 0,
               departures = 0, places_refused = 0;
  std::array<std::int64_t, kSurfaceKinds> contacts_by_kind{};
  /// Sums over localised frames. dynamic_fraction is relative to the pixels with depth. static_triangles
  /// counts drawn triangles.
  double dynamic_fraction = 0.0, dynamic_triangles = 0.0, inferred_triangles = 0.0, static_triangles = 0.0;
  double max_moved_fraction = 0.0;
  double deepest_penetration_m = 0.0;
  double first_stamp_s = 0.0;
  std::string last_fault;
  LostSpans lost;
  DroppedFrames dropped;
  RunUse use;

  /// Adds the results of a frame.
  void add(const FrameResult& frame, const Session& session) {
    if (frame.status == FrameStatus::kUncertain) ++uncertain;
    if (frame.status != FrameStatus::kDone) return;
    ++located;
    use.add(frame.use, session.objects());
    if (frame.tracking == TrackStatus::kDegenerate) ++degenerate;
    contacts += frame.contacts;
    departures += static_cast<std::int64_t>(frame.departures.size());
    for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
      contacts_by_kind[kind] += frame.contacts_by_kind[kind];
    const double fraction = frame.foreground.valid > 0 ? static_cast<double>(frame.foreground.moved) /
                                                             static_cast<double>(frame.foreground.valid)
                                                       : 0.0;
    dynamic_fraction += fraction;
    max_moved_fraction = std::max(max_moved_fraction, fraction);
    dynamic_triangles += static_cast<double>(frame.dynamic_triangles);
    inferred_triangles += static_cast<double>(frame.inferred_triangles);
    static_triangles += static_cast<double>(frame.static_triangles_drawn);
    deepest_penetration_m = std::max(deepest_penetration_m, frame.deepest_penetration_m);
  }
  /// Returns a sum divided by the number of localised frames.
  [[nodiscard]] double per_frame(double sum) const {
    return located > 0 ? sum / static_cast<double>(located) : 0.0;
  }
};

/// Returns the message about an object that fell out of the map, with a remedy.
std::string sentence_of(const Departure& departure, const Session& session);

/// Returns the camera position of the last picture in the world frame; the origin if there is no picture.
Eigen::Vector3d camera_position_world(const Session& session);

/// Returns the entries that a run's report has in addition to those of all reports.
nlohmann::json results_of(const RunTotals& totals, const Session& session);

}  // namespace roomradar
