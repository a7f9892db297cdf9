// open_source.cpp: recognises the kind of a source by its name, and opens it.
#include "app/cli/open_source.hpp"

#include <charconv>
#include <filesystem>
#include <utility>

#include "app/calibration/calibrated_source.hpp"
#include "app/cli/session_folder.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/kinect_source.hpp"
#include "app/sources/kinect/openni_source.hpp"
#include "app/sources/recordings/cached_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/read_ahead.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kKinect = "kinect:";
constexpr std::string_view kOpenni = "openni:";
constexpr std::string_view kSim = "sim:";
constexpr std::string_view kRegistered = "?depth=registered";

/// Opens kinect:N[?depth=raw|mm|registered].
std::unique_ptr<FrameSource> open_kinect_named(const std::string& source, SourceOptions options) {
  int device = -1;
  const char* begin = source.data() + kKinect.size();
  const char* end = source.data() + source.size();
  const auto parsed = std::from_chars(begin, end, device);
  const std::string_view rest(parsed.ptr, static_cast<std::size_t>(end - parsed.ptr));
  if (rest == "?depth=mm")
    options.kinect_depth = KinectDepth::kMillimetres;
  else if (rest == kRegistered)
    options.kinect_depth = KinectDepth::kRegistered;
  const bool is_known = rest.empty() || rest == "?depth=raw" || options.kinect_depth != KinectDepth::kRaw;
  if (parsed.ec != std::errc() || !is_known || device < 0)
    throw Error(source +
                ": must be kinect:N with the device's number N, from 0, optionally followed by ?depth=raw "
                "(as measured), ?depth=mm (converted to millimetres by libfreenect) or ?depth=registered "
                "(also transformed to the colour camera)");
  return open_kinect(device, options);
}

/// Throws Error if options were given that state what a recording does not, for a source that states it itself.
void require_no_statements(const std::string& source, const char* is, bool has_cameras, const SourceOptions& options) {
  const char* given = options.depth_unit_m                             ? "--depth-unit"
                      : options.pose_convention                        ? "--poses-convention"
                      : options.stamps != StampChoice::kAuto           ? "--stamps"
                      : has_cameras && !options.camera_file.empty()    ? "--camera"
                                                                       : nullptr;
  if (given) throw Error(source + ": is " + is + ", which " + given + " does not apply to; leave it out");
}

std::unique_ptr<FrameSource> open_whole(const std::string& source, const SourceOptions& options) {
  const bool is_simulated = source.starts_with(kSim), is_openni = source.starts_with(kOpenni);
  if (is_simulated || is_openni || source.starts_with(kKinect))
    require_no_statements(source, is_simulated ? "simulated" : "a device", is_simulated || is_openni, options);
  else if (std::filesystem::exists(source) && is_session_folder(source))
    require_no_statements(source, "a recorded session", true, options);
  if (source.starts_with(kKinect)) return open_kinect_named(source, options);
  if (source.starts_with(kOpenni)) return open_openni(source.substr(kOpenni.size()), options);
  if (source.starts_with(kSim)) return std::make_unique<SimulatedSource>(parse_sim_spec(source));
  if (!std::filesystem::exists(source))
    throw Error(source +
                ": no such file or folder. A source is a recording (`roomradar help sources` lists the "
                "kinds), kinect:N or openni:N for a device, or sim:ROOM for the simulated one");
  if (is_session_folder(source)) return open_session_frames(source);
  return open_folder(source, options);
}

/// Returns true if a folder's frames had their lens and depth errors corrected before recording.
bool was_calibrated(const std::string& source) {
  std::filesystem::path folder = source;
  if (source.starts_with(kKinect)) {
    const auto replayed = replayed_folder();
    if (!replayed) return false;
    folder = *replayed;
  }
  if (is_session_folder(folder)) return is_session_calibrated(folder);
  return std::filesystem::exists(folder / "camera.json") &&
         read_camera_file(folder / "camera.json").was_calibrated;
}

}  // namespace

std::filesystem::path calibration_for(const std::string& source, const std::filesystem::path& chosen) {
  if (!chosen.empty()) return chosen;
  const std::filesystem::path in_folder = std::filesystem::path(source) / "calibration.json";
  // Recordings of other programs bring their own calibration, some in a file of that name.
  return std::filesystem::exists(in_folder) && !is_foreign_recording(source) ? in_folder
                                                                             : std::filesystem::path{};
}

bool gives_calibrated_frames(const std::string& source, const std::filesystem::path& chosen) {
  return !calibration_for(source, chosen).empty() || was_calibrated(source);
}

std::unique_ptr<FrameSource> open_source(const std::string& source, const std::optional<FrameRange>& frames,
                                         const std::filesystem::path& calibration,
                                         const SourceOptions& options) {
  const std::filesystem::path used = options.as_recorded ? calibration : calibration_for(source, calibration);
  const bool is_registered = source.starts_with(kKinect) && source.ends_with(kRegistered);
  if (is_registered && (options.as_recorded || !used.empty()))
    throw Error(source +
                ": registered depth is in the colour camera's view, but a calibration is for the depth "
                "camera; use ?depth=raw or ?depth=mm");
  std::unique_ptr<FrameSource> opened = open_whole(source, options);
  if ((options.as_recorded || !used.empty()) && was_calibrated(source))
    throw Error(source + ": lens and depth errors of its frames were corrected before they were recorded; " +
                (used.empty() ? "a calibration needs frames as the device delivers them"
                              : used.string() + " would correct them a second time; leave it out"));
  if (!used.empty()) opened = calibrated(std::move(opened), read_calibration(used));
  if (!frames && !opened->frame_count() && !replayed_folder())
    options.say(opened->name() + ": continues until Ctrl-C is pressed once");
  if (frames) opened = limit_frames(std::move(opened), frames->first, frames->last);
  if (options.cache_simulated && source.starts_with(kSim)) opened = cache_frames(std::move(opened));
  return source.starts_with(kKinect) || source.starts_with(kOpenni) ? std::move(opened)
                                                                    : read_ahead(std::move(opened));
}

void require_recorded_world(const MapInfo& info, const std::string& map, const std::string& source) {
  if (knows_recorded_world(info)) return;
  throw Error(map + ": was scanned without recorded poses, so the poses of " + source +
              " have no meaning in it; use --poses tracked");
}

}  // namespace roomradar
