// scan.cpp: the prescan of `roomradar prescan`, with progress by callback and Ctrl-C.
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/cli/apply_scan_quality.hpp"
#include "app/cli/open_source.hpp"
#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "app/python/maps.hpp"
#include "app/python/sources.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/coverage/holes.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar::python {
namespace {

/// Result of a prescan, with its map as an object of its own.
struct Scan {
  std::shared_ptr<Map> map;
  std::vector<Hole> holes;
  std::vector<FrameSpan> lost;
  PrescanCounts counts;
};

/// Another source's frames, in the order of one pass. Ends when `is_ended` is set.
class EndedByFlag final : public WrappedSource {
 public:
  EndedByFlag(FrameSource& source, const std::atomic<bool>& is_ended)
      : WrappedSource(source), is_ended_(is_ended) {}

  ReadResult next(Frame& frame) override { return is_ended_ ? ReadResult{} : source_.next(frame); }

 private:
  const std::atomic<bool>& is_ended_;
};

bool is_tracking(const std::string& stage) { return stage == "track" || stage == "track again"; }

/// Calls `progress` after each frame. Throws its exceptions and KeyboardInterrupt. While a live source is
/// tracked, Ctrl-C and a returned False end the source instead.
class ScanProgress {
 public:
  ScanProgress(const py::object& progress, bool is_live, std::atomic<bool>& is_ended)
      : progress_(progress), is_live_(is_live), is_ended_(is_ended) {}

  void operator()(const std::string& stage, const std::string& note) const {
    const bool ends_source = is_live_ && is_tracking(stage) && !is_ended_;
    try {
      if (!report_progress(progress_, stage, note) && ends_source) is_ended_ = true;
    } catch (py::error_already_set& fault) {
      const py::gil_scoped_acquire acquire;
      if (!ends_source || !fault.matches(PyExc_KeyboardInterrupt)) throw;
      is_ended_ = true;
    }
  }

 private:
  const py::object& progress_;
  bool is_live_;
  std::atomic<bool>& is_ended_;
};

/// Returns the map to extend, read again from its folder. Sets the settings that it keeps.
SavedMap map_to_extend(const Map& map, PrescanConfig& config) {
  if (map.folder.empty()) throw Error("extend: the map is not in a folder; save it first, and open it again");
  SavedMap extended = load_map(map.folder);
  keep_settings_of(extended, /*is_deviation_asked_for=*/false, config);
  return extended;
}

Scan scan(FrameSource& source, PrescanConfig config, const Map* extend, const py::object& progress) {
  std::unique_ptr<FrameSource> spooled;
  std::atomic<bool> is_ended = false;
  const bool is_live = !source.rewind();
  if (is_live) spooled = make_rewindable(std::make_unique<EndedByFlag>(source, is_ended));
  FrameSource& frames = is_live ? *spooled : source;
  PrescanInput input;
  if (extend != nullptr) input.map = map_to_extend(*extend, config);
  StageTimes times;
  PrescanResult result =
      prescan(frames, config, times, ScanProgress(progress, is_live, is_ended), std::move(input));
  return {std::make_shared<Map>(std::move(result.map), ""), std::move(result.holes), std::move(result.lost),
          std::move(result.counts)};
}

PoseOrigin origin_of(const std::string& poses) {
  for (const PoseOrigin origin : {PoseOrigin::kAuto, PoseOrigin::kTracked, PoseOrigin::kRecorded})
    if (to_string(origin) == poses) return origin;
  throw py::value_error("poses: is \"" + required_text(poses, "poses") +
                        "\"; must be auto, tracked or recorded");
}

std::optional<GivenUp> up_of(const py::object& up) {
  if (up.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(up)) {
    if (!up.equal(py::str("camera"))) throw py::value_error("up: must be a vector, \"camera\" or None");
    return GivenUp{};
  }
  const Eigen::Vector3d up_world = vector_of(up, "up");
  if (!(up_world.norm() > 1e-6)) throw py::value_error("up: must be a direction, not zero");
  return GivenUp{up_world.normalized()};
}

Scan scan_source(const std::variant<std::filesystem::path, Source*>& source, const std::string& poses,
                 const ScanQuality& quality, const py::object& up, std::int64_t hold_out, bool texture,
                 double max_memory_mb, const std::shared_ptr<Map>& extend, const py::object& progress) {
  require_callback(progress, "progress");
  require_valid(quality);
  if (hold_out < 0) throw py::value_error("hold_out: must be 0 or more");
  if (!(max_memory_mb >= 0.0 && max_memory_mb < 1e9))
    throw py::value_error("max_memory_mb: must be 0 or more");
  PrescanOptions options;
  options.quality = quality;
  options.poses = origin_of(poses);
  options.up = up_of(up);
  options.hold_out = hold_out;
  options.texture = texture;
  options.max_memory_mb = max_memory_mb;
  const PrescanConfig config = prescan_config_of(options);
  if (const auto* name = std::get_if<std::filesystem::path>(&source))
    return without_gil([&] {
      SourceOptions of_scan;
      of_scan.keep_all = true;
      of_scan.cache_simulated = true;
      return scan(*open_source(name->string(), std::nullopt, {}, of_scan), config, extend.get(), progress);
    });
  Source* const given = std::get<Source*>(source);
  if (given == nullptr) throw py::type_error("source: must be a Source or the name of one");
  const UseFlag::Lock lock(given->use(), "the source");
  FrameSource& opened = given->opened();
  given->was_read();
  return without_gil([&] { return scan(opened, config, extend.get(), progress); });
}

py::dict dict_of(const PrescanCounts& counts) {
  py::dict dict;
  dict["frames_read"] = counts.frames_read;
  dict["frames_skipped"] = counts.frames_skipped;
  dict["frames_tracked"] = counts.frames_tracked;
  dict["frames_fused"] = counts.frames_fused;
  dict["frames_lost"] = counts.frames_lost;
  dict["keyframes"] = counts.keyframes;
  dict["loops_found"] = counts.loops_found;
  dict["recorded_used"] = counts.recorded_used;
  dict["recorded_contradicted"] = counts.recorded_contradicted;
  dict["frames_impossible_motion"] = counts.impossible_motion;
  dict["ghost_voxels"] = counts.ghost_voxels;
  dict["stopped_for_memory"] = counts.stopped_for_memory;
  return dict;
}

void bind_results(py::module_& module) {
  py::class_<Hole>(module, "Hole", "A region that a scan has not observed.")
      .def_property_readonly("kind", [](const Hole& hole) { return std::string(to_string(hole.kind)); })
      .def_property_readonly("is_inside_scan", &is_inside_scan)
      .def_property_readonly("position_world", [](const Hole& hole) { return array_of(hole.position_world); })
      .def_readonly("size_m", &Hole::size_m)
      .def_readonly("area_m2", &Hole::area_m2)
      .def_property_readonly("look_direction_world",
                             [](const Hole& hole) { return array_of(hole.look_direction_world); })
      .def_property_readonly(
          "viewpoint_world", [](const Hole& hole) { return array_or_none(hole.viewpoint_world); },
          "Free position from which the hole can be seen, or None.")
      .def("__repr__", [](const Hole& hole) {
        return "<roomradar.Hole " + std::string(to_string(hole.kind)) + " of " +
               format_readable(hole.area_m2, 3) + " m2 at " + text_of_point(hole.position_world) + ">";
      });
  py::class_<Scan>(module, "Scan", "Result of a prescan.")
      .def_readonly("map", &Scan::map)
      .def_readonly("holes", &Scan::holes, "Largest first; those at the end of the whole scan last.")
      .def_property_readonly(
          "lost",
          [](const Scan& scan) {
            py::list spans;
            for (const FrameSpan& span : scan.lost) spans.append(py::make_tuple(span.first, span.last));
            return spans;
          },
          "First and last index of the spans of frames without a trusted pose.")
      .def_property_readonly("counts", [](const Scan& scan) { return dict_of(scan.counts); });
}

}  // namespace

void bind_scan(py::module_& module) {
  bind_results(module);
  const ScanQuality quality;
  module.def(
      "prescan",
      [](const std::variant<std::filesystem::path, Source*>& source, const std::string& poses,
         double resolution_m, double deviation_m, int tracking_px, int fuse_every, const py::object& up,
         std::int64_t hold_out, bool texture, double max_memory_mb, const std::shared_ptr<Map>& extend,
         const py::object& progress) {
        return scan_source(source, poses, {resolution_m, deviation_m, tracking_px, fuse_every}, up, hold_out,
                           texture, max_memory_mb, extend, progress);
      },
      py::arg("source"), py::kw_only(), py::arg("poses") = "auto",
      py::arg("resolution_m") = quality.resolution_m, py::arg("deviation_m") = quality.deviation_m,
      py::arg("tracking_px") = quality.tracking_px, py::arg("fuse_every") = quality.fuse_every,
      py::arg("up") = py::none(), py::arg("hold_out") = 0, py::arg("texture") = true,
      py::arg("max_memory_mb") = 0.0, py::arg("extend") = py::none(), py::arg("progress") = py::none(),
      "Scans a room and returns a Scan, whose map is in memory; save it with Map.save(). The map is that of\n"
      "`roomradar prescan` with the same settings, byte for byte. Reads the source several times.\n\n"
      "source: a Source, or the name of one as for open_source()\n"
      "poses: auto (by odometry, with recorded poses as a prior), tracked (by odometry alone), or recorded "
      "(those of the frames)\n"
      "resolution_m: edge of the smallest voxels\n"
      "deviation_m: max distance of the simplified mesh from the full one\n"
      "up: up direction in the poses' world, \"camera\" (the cameras' mean), or None (estimated)\n"
      "hold_out: N > 0: every Nth frame is tracked, but not fused\n"
      "extend: a map to extend, which keeps its world and resolution\n"
      "progress: called after each frame with the stage (track, fuse, ghosts, surface, texture) and a note. "
      "Its\n"
      "exceptions, and Ctrl-C, end the scan without a map. A live source is ended by Ctrl-C, or by returning "
      "False\n"
      "while it is tracked; the map is then made of the frames so far.");
}

}  // namespace roomradar::python
