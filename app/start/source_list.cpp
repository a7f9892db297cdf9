// source_list.cpp: lists Kinects on the USB bus, recordings in folders, and simulated rooms.
#include "app/start/source_list.hpp"

#include <string_view>

#include "app/cli/session_folder.hpp"
#include "app/cli/shell_line.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/kinect_usb.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "app/start/subfolders.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

std::string frames_text(std::size_t frames) {
  return std::to_string(frames) + (frames == 1 ? " frame" : " frames");
}

/// Returns the path as it is shown: relative to the current folder if it lies in it.
std::string shown_path(const fs::path& path) {
  std::error_code fault;
  const fs::path relative = fs::proximate(path, fault);
  if (fault || relative.empty() || *relative.begin() == "..") return path.string();
  return relative == "." ? fs::absolute(path, fault).filename().string() : relative.string();
}

/// Describes a recording: a folder or a file.
SourceEntry describe_recording(const fs::path& folder) {
  SourceEntry entry{SourceKind::kRecording, shown_path(folder), {}, folder.string(), folder.string(), {}};
  if (is_session_folder(folder)) {
    entry.detail = "recorded session";
    return entry;
  }
  try {
    const RecordingFacts facts = read_facts(folder);
    entry.detail = facts.kind + ", " + frames_text(facts.frames.size());
    entry.check_command = shell_line({"roomradar", "check", folder.string()});
  } catch (const std::exception& error) {
    entry.detail = "cannot be read";
    entry.fault = error.what();
  }
  return entry;
}

SourceEntry describe_simulated(const std::string& spec) {
  SourceEntry entry{SourceKind::kSimulated, spec, {}, spec, spec, {}};
  try {
    SimOptions options = parse_sim_spec(spec);
    if (spec == "sim:" + options.room) entry.name = "Simulated room: " + options.room;
    entry.detail =
        "simulated Kinect, " +
        (options.frames == 0 ? "a whole walk" : frames_text(static_cast<std::size_t>(options.frames)));
    options.path = CameraPathKind::kView;
    entry.play_source = sim_spec(options);
  } catch (const Error& error) {
    entry.detail = "not known";
    entry.fault = error.what();
  }
  return entry;
}

SourceEntry describe_kinect(std::size_t number, const KinectOnUsb& kinect) {
  const std::string source = "kinect:" + std::to_string(number);
  SourceEntry entry{
      SourceKind::kKinect, kinect.model + " (" + source + ")", "plugged in", source, source, {}};
  if (!kinect.may_open) {
    entry.detail = "may not be opened";
    entry.fault = source + ": this user may not open it; Doctor (D) says how to repair that";
  }
  return entry;
}

/// @param but  subfolder that is not searched, since its content is listed
void add_recordings_in(const fs::path& folder, const fs::path& but, std::vector<SourceEntry>& entries) {
  std::vector<fs::path> candidates = subfolders(folder);
  std::erase(candidates, but);
  for (fs::path& file : files_in_folder(folder))
    if (!recording_kind(file).empty()) candidates.push_back(std::move(file));
  for (const fs::path& each : candidates) {
    SourceEntry entry = describe_recording(each);
    if (entry.fault.empty()) entries.push_back(std::move(entry));
  }
}

}  // namespace

std::vector<SourceEntry> list_kinects() {
  std::vector<SourceEntry> entries;
  if (const auto replayed = replayed_folder())
    return {
        {SourceKind::kKinect, "Kinect, replayed (kinect:0)", replayed->string(), "kinect:0", "kinect:0", {}}};
  for (const KinectOnUsb& kinect : kinects_on_usb())
    if (kinect.has_camera) entries.push_back(describe_kinect(entries.size(), kinect));
  return entries;
}

std::vector<SourceEntry> list_recordings(const fs::path& folder) {
  std::vector<SourceEntry> entries;
  SourceEntry here = describe_recording(folder);
  if (here.fault.empty()) return {here};  // its subfolders hold its images
  add_recordings_in(folder, folder / "recordings", entries);
  add_recordings_in(folder / "recordings", {}, entries);
  return entries;
}

std::vector<SourceEntry> list_simulated_rooms() {
  std::vector<SourceEntry> entries;
  for (const std::string& room : room_names()) entries.push_back(describe_simulated("sim:" + room));
  for (const std::string_view room : {kRandomRoom, kFlatRoom, kBuildingRoom})
    entries.push_back(describe_simulated("sim:" + std::string(room)));
  return entries;
}

SourceEntry describe_source(const std::string& source) {
  if (source.starts_with("sim:")) return describe_simulated(source);
  if (source.starts_with("openni:"))
    return {SourceKind::kKinect, source, "device of OpenNI2", source, source, {}};
  if (source.starts_with("kinect:")) {
    for (SourceEntry& entry : list_kinects()) {
      if (source.substr(0, source.find('?')) != entry.source) continue;
      entry.source = entry.play_source = source;
      return entry;
    }
    return {SourceKind::kKinect,
            source,
            "not plugged in",
            source,
            source,
            source + ": is not plugged in; Doctor (D) says what of the set-up works"};
  }
  return describe_recording(source);
}

}  // namespace roomradar
