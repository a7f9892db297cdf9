// run_results.cpp: results of a run as JSON and as text.
#include "app/run/run_results.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numbers>

#include "app/cli/report.hpp"
#include "app/objects/unknown_support.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {

std::string sentence_of(const Departure& departure, const Session& session) {
  const Eigen::Vector3d& p = departure.position_world;
  std::array<char, 80> place{};
  format_classic(place.data(), place.size(), " fell out of the map at %.2f %.2f %.2f m", p.x(), p.y(), p.z());
  const bool is_solid = session.unknown_is_solid();
  const char* const cure =
      session.config().scene.surfaces != SurfacePolicy::kMap
          ? "; with --surfaces map and --unknown solid, the defaults, nothing falls through"
      : !is_solid ? "; --unknown solid, the default, stops objects at space that was not scanned"
                  : "; it was put into space that was not scanned: place it in the scanned room";
  return departure.name + place.data() +
         (departure.is_back ? " and is back where it last rested" : " and is taken out of the room") + cure;
}

Eigen::Vector3d camera_position_world(const Session& session) {
  if (!session.shown_view()) return Eigen::Vector3d::Zero();
  return session.shown_view()->T_world_view.translation();
}

namespace {

/// Returns the memory of the unknown surface and its grid, and the temporary memory of its extraction, MB.
double unknown_mb(const UnknownSurface& unknown) {
  const Mesh& mesh = unknown.mesh_world;
  const std::size_t bytes = mesh.vertices.size() * sizeof(mesh.vertices[0]) +
                            mesh.triangles.size() * sizeof(mesh.triangles[0]) +
                            unknown.unknown.memory_bytes() + unknown.memory_bytes;
  return static_cast<double>(bytes) / 1e6;
}

/// Returns the viewpoint from which to scan the support of an object that rests on the border of unknown
/// space; null for other objects, or if the support is hidden from all sides.
nlohmann::json scan_from(const VirtualObject& object, const Session& session) {
  if (!rests_on_unknown(object)) return nullptr;
  const auto from =
      viewpoint_of_support(object, session.scene_without(&object), camera_position_world(session));
  return from ? to_json(*from) : nlohmann::json(nullptr);
}

/// Returns the counts and times of a building's tiles.
nlohmann::json tile_results(const BuildingTracker& building) {
  const TileCounts& counts = building.tiles().counts();
  std::map<std::string, StageSummary> times = counts.times.summaries();
  const auto p95_and_max = [&times](const char* stage) -> nlohmann::json {
    return {{"p95", times[stage].p95_ms}, {"max", times[stage].max_ms}};
  };
  return {{"tiles_loaded", counts.loaded},
          {"tiles_dropped", counts.dropped},
          {"tile_wait_ms", p95_and_max("late")},
          {"tile_frame_ms", p95_and_max("frame")},
          {"tile_blocked_ms", p95_and_max("blocked")},
          {"tile_frames_over_33_ms", counts.frames_over_33_ms},
          {"places_recognised", building.recognised()},
          {"places_ambiguous", building.ambiguous()}};
}

/// Returns the objects with their state at the run's end.
nlohmann::json objects_of(const Session& session) {
  nlohmann::json objects = nlohmann::json::array();
  for (const auto& object : session.objects()) {
    const Eigen::Matrix3d R_world_object = object->body.T_world_object.linear();
    const double turned_deg =
        Eigen::AngleAxisd(object->placement.R_world.transpose() * R_world_object).angle() *
        (180.0 / std::numbers::pi);
    const Coefficients surface = on_room(object->body.material, session.config().physics);
    objects.push_back({{"name", object->body.name},
                       {"mass_kg", object->body.mass.mass_kg},
                       {"friction", surface.friction},
                       {"restitution", surface.restitution},
                       {"in_room", object->in_room},
                       {"at_rest", object->body.asleep},
                       {"stuck", object->placement.stuck},
                       {"rests_on", to_string(object->body.rests_on)},
                       {"scan_from_m", scan_from(*object, session)},
                       {"began_in_unknown", object->placement.began_in_unknown},
                       {"left_the_map", object->departures},
                       {"position_m", to_json(object->body.T_world_object.translation())},
                       {"middle_m", to_json(middle_world(*object))},
                       {"orientation_xyzw", to_json(Eigen::Quaterniond(R_world_object))},
                       {"turned_deg", turned_deg}});
  }
  return objects;
}

}  // namespace

nlohmann::json results_of(const RunTotals& totals, const Session& session) {
  nlohmann::json committed_changes = nlohmann::json::array();
  for (const CommittedChange& change : session.committed_changes())
    committed_changes.push_back({{"change", to_string(change.kind)},
                                 {"time_s", change.stamp_s - totals.first_stamp_s},
                                 {"frame", change.frame},
                                 {"position_m", to_json(change.box_world.center())},
                                 {"size_m", to_json(change.box_world.sizes())}});
  nlohmann::json lost = nlohmann::json::array();
  for (const LostSpan& span : totals.lost.spans)
    lost.push_back({{"from_frame", span.from},
                    {"until_frame", span.until < 0 ? totals.lost.last_frame + 1 : span.until}});
  nlohmann::json contacts_by_kind = nlohmann::json::object();
  for (std::size_t kind = 1; kind < kSurfaceKinds; ++kind)
    contacts_by_kind[std::string(to_string(static_cast<SurfaceKind>(kind)))] = totals.contacts_by_kind[kind];
  nlohmann::json results = {
      {"frames_located", totals.located},
      {"frames_uncertain", totals.uncertain},
      {"frames_degenerate", totals.degenerate},
      {"lost", lost},
      {"frames_dropped", totals.dropped.count},
      {"moved_fraction_mean", totals.per_frame(totals.dynamic_fraction)},
      {"moved_fraction_max", totals.max_moved_fraction},
      {"dynamic_triangles_mean", totals.per_frame(totals.dynamic_triangles)},
      {"inferred_triangles_mean", totals.per_frame(totals.inferred_triangles)},
      {"static_triangles_drawn_mean", totals.per_frame(totals.static_triangles)},
      {"contacts", totals.contacts},
      {"left_the_map", totals.departures},
      {"places_refused", totals.places_refused},
      {"contacts_by_kind", contacts_by_kind},
      {"unknown_triangles", session.unknown() ? session.unknown()->mesh_world.triangles.size() : 0},
      {"unknown_mb", session.unknown() ? unknown_mb(*session.unknown()) : 0.0},
      {"deepest_penetration_m", totals.deepest_penetration_m},
      {"needed", to_json(totals.use)},
      {"objects", objects_of(session)},
      {"committed", committed_changes},
  };
  if (session.building() != nullptr) results.update(tile_results(*session.building()));
  if (!totals.last_fault.empty()) results["last_fault"] = totals.last_fault;
  return results;
}

}  // namespace roomradar
