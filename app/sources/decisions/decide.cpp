// decide.cpp: times, pairs, cameras, unit and poses of a recording, in this order.
#include "app/sources/decisions/decide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "app/sources/decisions/camera_choice.hpp"
#include "app/sources/decisions/depth_evidence.hpp"
#include "app/sources/decisions/stamp_repair.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

/// Orders the frames by their times. Frames without one keep their place in the recording, and are faulty.
std::vector<DecidedFrame> frames_by_time(const RecordingFacts& facts, const std::vector<double>& stamps_s) {
  std::vector<std::pair<double, std::size_t>> order;
  double last_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < facts.frames.size(); ++i) {
    if (std::isfinite(stamps_s[i])) last_s = stamps_s[i];
    order.emplace_back(last_s, i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<DecidedFrame> frames;
  frames.reserve(order.size());
  for (const auto& [stamp_s, i] : order) {
    const StatedFrame& stated = facts.frames[i];
    frames.push_back({i, std::isfinite(stamp_s) ? stamp_s : 0.0, stated.colour, stated.colour_after_depth_s,
                      stated.fault});
    if (stated.fault.empty() && !std::isfinite(stamps_s[i])) frames.back().fault = "its time is not known";
  }
  return frames;
}

/// Pairs frames with the colour images nearest in time.
void pair_colours(const RecordingFacts& facts, const std::vector<double>& colour_s,
                  std::vector<DecidedFrame>& frames) {
  constexpr std::size_t kColoursWithoutDepth = 300;  // ten seconds
  std::vector<std::size_t> colours(colour_s.size());
  std::iota(colours.begin(), colours.end(), 0U);
  std::erase_if(colours, [&](std::size_t i) { return !std::isfinite(colour_s[i]); });
  std::stable_sort(colours.begin(), colours.end(),
                   [&](std::size_t a, std::size_t b) { return colour_s[a] < colour_s[b]; });
  StampPairing pairing({.tolerance_s = facts.pair_within_s, .colours_kept = kColoursWithoutDepth});
  const auto take_pairs = [&] {
    while (const auto pair = pairing.take()) {
      if (!pair->colour) continue;
      DecidedFrame& frame = frames[static_cast<std::size_t>(pair->depth)];
      frame.colour = static_cast<std::size_t>(*pair->colour);
      frame.colour_after_depth_s = pair->colour_after_depth_s;
    }
  };
  std::size_t next = 0;
  const auto add_colours_until = [&](double stamp_s) {
    for (; next < colours.size() && colour_s[colours[next]] <= stamp_s; ++next) {
      pairing.add_colour(static_cast<std::int64_t>(colours[next]), colour_s[colours[next]]);
      take_pairs();
    }
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].fault.empty()) continue;
    add_colours_until(frames[i].stamp_s);
    pairing.add_depth(static_cast<std::int64_t>(i), frames[i].stamp_s);
    take_pairs();
  }
  add_colours_until(std::numeric_limits<double>::infinity());
  pairing.finish();
  take_pairs();
}

/// Moves the times of colour images by a constant if their clock is not that of depth: if the two lists do
/// not overlap in time.
void align_colour_clock(const RepairedStamps& depth, RepairedStamps& colour, InputReport& report) {
  const auto range = [](const std::vector<double>& stamps_s) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double stamp_s : stamps_s)
      if (std::isfinite(stamp_s)) least = std::min(least, stamp_s), most = std::max(most, stamp_s);
    return std::pair(least, most);
  };
  const auto [depth_first, depth_last] = range(depth.stamps_s);
  const auto [colour_first, colour_last] = range(colour.stamps_s);
  if (!(colour_first <= colour_last && depth_first <= depth_last)) return;
  if (colour_last >= depth_first && colour_first <= depth_last) return;
  const double shift_s = depth.header_offset_s - colour.header_offset_s;
  if (shift_s == 0.0) {
    report.add({"time",
                "no colour image was taken while depth was recorded, by their stamps; colour is not used",
                static_cast<std::int64_t>(colour.stamps_s.size()), "--stamps", true});
    return;
  }
  for (double& stamp_s : colour.stamps_s) stamp_s += shift_s;
  report.add({"time",
              "the clocks of colour and depth differ by " + format_readable(std::abs(shift_s), 4) +
                  " s; both follow their times of reception",
              static_cast<std::int64_t>(colour.stamps_s.size()), "--stamps"});
}

/// Reads the depth images until one can be read, from places spread over the recording first. Throws Error if
/// none can be read.
void require_a_readable_image(const DecidedRecording& recording) {
  constexpr std::size_t kSpread = 8;
  const std::size_t count = recording.frames.size();
  std::string first_fault;
  DepthImage depth_m;
  const auto is_readable = [&](std::size_t i) {
    try {
      read_depth(recording, i, depth_m);
      return true;
    } catch (const Error& fault) {
      if (first_fault.empty()) first_fault = fault.what();
      return false;
    }
  };
  for (std::size_t k = 0; k < std::min(kSpread, count); ++k)
    if (is_readable(k * count / std::min(kSpread, count))) return;
  for (std::size_t i = 0; i < count; ++i)
    if (is_readable(i)) return;
  throw Error(recording.facts.name + ": none of its " + std::to_string(count) +
              " depth images can be read, the first because " + first_fault);
}

void decide_times(DecidedRecording& recording, const SourceOptions& options) {
  RecordingFacts& facts = recording.facts;
  InputReport& report = *recording.report;
  std::vector<StatedTime> times;
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < facts.frames.size(); ++i) {
    if (!facts.frames[i].fault.empty()) continue;
    times.push_back(facts.frames[i].time);
    usable.push_back(i);
  }
  const RepairedStamps depth =
      repair_stamps(times, {options.stamps, facts.stamps_have_no_unit, "depth images"}, report);
  if (facts.has_no_clock && options.stamps == StampChoice::kAuto && facts.frames.size() > 1)
    report.add({"time", "the recording has no clock; 30 images per second are assumed", 0, "--stamps"});
  std::vector<double> stamps_s(facts.frames.size(), kNoStamp);
  for (std::size_t k = 0; k < usable.size(); ++k) stamps_s[usable[k]] = depth.stamps_s[k];
  recording.frames = frames_by_time(facts, stamps_s);
  if (!facts.colours.empty()) {
    RepairedStamps colour = repair_stamps(
        facts.colours, {options.stamps, facts.stamps_have_no_unit, "colour images", &depth}, report);
    align_colour_clock(depth, colour, report);
    pair_colours(facts, colour.stamps_s, recording.frames);
    const auto paired = std::count_if(recording.frames.begin(), recording.frames.end(),
                                      [](const DecidedFrame& frame) { return frame.colour.has_value(); });
    const auto frames = static_cast<std::ptrdiff_t>(recording.frames.size());
    if (paired * 2 < frames && static_cast<std::ptrdiff_t>(facts.colours.size()) * 2 > frames)
      report.add({"time",
                  "only " + std::to_string(paired) + " of " + std::to_string(frames) +
                      " depth images have a colour image within " +
                      format_readable(1000.0 * facts.pair_within_s, 2) + " ms",
                  frames - paired, "--stamps", true});
  }
  if (facts.pose_track)
    if (const double unit_s = repair_track(*facts.pose_track, depth); unit_s != 1.0 && unit_s != depth.unit_s)
      report.add({"time",
                  std::string("the stamps of the poses are in ") +
                      (unit_s == 1e-3   ? "milliseconds"
                       : unit_s == 1e-6 ? "microseconds"
                                        : "nanoseconds") +
                      ", since only then they are near those of the images",
                  static_cast<std::int64_t>(facts.pose_track->size())});
  if (facts.acceleration_track) repair_track(*facts.acceleration_track, depth);
}

void report_lost_poses(const RecordingFacts& facts, InputReport& report) {
  std::size_t lost = facts.lost_track_poses;
  std::string first;
  for (std::size_t i = 0; i < facts.frames.size(); ++i) {
    if (facts.frames[i].pose_fault.empty()) continue;
    if (first.empty())
      first = "the first at image " + std::to_string(i) + ", which " + facts.frames[i].pose_fault;
    ++lost;
  }
  const bool is_any_left =
      (facts.pose_track && !facts.pose_track->empty()) ||
      std::any_of(facts.frames.begin(), facts.frames.end(),
                  [](const StatedFrame& frame) { return frame.T_world_camera.has_value(); });
  if (lost > 0)
    report.add({"poses",
                std::to_string(lost) +
                    (lost == 1 ? " recorded pose is lost or no rigid transform; its frame is"
                               : " recorded poses are lost or no rigid transform; their frames are") +
                    " used without a pose" + (first.empty() ? "" : " (" + first + ")"),
                static_cast<std::int64_t>(lost), "", !is_any_left});
}

/// Advises on poses that are read frame by frame, if none of those that were tried can be used.
void advise_on_unusable_poses(const DecidedRecording& recording) {
  constexpr std::size_t kTried = 20;
  if (!recording.facts.read_pose || recording.facts.pose_track) return;
  std::string first_fault;
  const std::size_t frames = recording.frames.size(), tried = std::min(kTried, frames);
  for (std::size_t k = 0; k < tried; ++k) {
    const DecidedFrame& frame = recording.frames[k * frames / tried];
    const StatedPose pose = recording.facts.read_pose(frame.stated, frame.stamp_s);
    if (pose.T_world_camera) return;
    if (first_fault.empty()) first_fault = pose.fault;
  }
  if (!first_fault.empty())
    recording.report->add(
        {"poses", "no recorded pose that was tried can be used, the first: " + first_fault, 0, "", true});
}

/// Reports tracks whose entries are not near the images in time, so that most frames get nothing from them.
void report_tracks(const DecidedRecording& recording) {
  const RecordingFacts& facts = recording.facts;
  const auto range_text = [](double first_s, double last_s) {
    return format_fixed(first_s, 1) + " to " + format_fixed(last_s, 1) + " s";
  };
  const auto report_track = [&](const auto& track, const char* topic, const std::string& what,
                                const auto& has_entry) {
    std::size_t timed = 0, with = 0;
    double first_s = 0.0, last_s = 0.0;
    for (const DecidedFrame& frame : recording.frames) {
      if (!frame.fault.empty()) continue;
      if (timed++ == 0) first_s = frame.stamp_s;
      last_s = frame.stamp_s;
      if (has_entry(frame)) ++with;
    }
    if (track.empty() || timed < 10 || 10 * with >= 9 * timed) return;
    const bool is_elsewhere = with == 0 && (track.back().stamp_s < first_s || track.front().stamp_s > last_s);
    recording.report->add(
        {topic,
         "only " + std::to_string(with) + " of " + std::to_string(timed) + " frames have " + what +
             " near in time" +
             (is_elsewhere
                  ? ": those recorded are from " + range_text(track.front().stamp_s, track.back().stamp_s) +
                        ", the images from " + range_text(first_s, last_s) + "; is it another clock?"
                  : "; those recorded are " +
                        format_readable((track.back().stamp_s - track.front().stamp_s) /
                                            static_cast<double>(std::max<std::size_t>(track.size(), 2) - 1),
                                        2) +
                        " s apart on average"),
         static_cast<std::int64_t>(timed - with), "", is_elsewhere && topic == std::string("poses")});
  };
  if (facts.pose_track && facts.read_pose)
    report_track(*facts.pose_track, "poses", "a recorded pose", [&](const DecidedFrame& frame) {
      return facts.read_pose(frame.stated, frame.stamp_s).T_world_camera.has_value();
    });
  if (facts.acceleration_track && facts.read_down)
    report_track(
        *facts.acceleration_track, "gravity", "a measured direction of gravity",
        [&](const DecidedFrame& frame) { return facts.read_down(frame.stated, frame.stamp_s).has_value(); });
}

/// Reports a gap in the images that is longer than any pause: the clock may have been set.
void report_gap(const DecidedRecording& recording) {
  constexpr double kLongest_s = 120.0;
  double longest_s = 0.0;
  std::size_t after = 0;
  for (std::size_t i = 1; i < recording.frames.size(); ++i) {
    const double step_s = recording.frames[i].stamp_s - recording.frames[i - 1].stamp_s;
    if (step_s > longest_s) longest_s = step_s, after = i - 1;
  }
  if (longest_s > kLongest_s)
    recording.report->add({"time",
                           "there is no image for " + format_readable(longest_s, 3) + " s after frame " +
                               std::to_string(after) + "; was the clock set?",
                           1, "--stamps"});
}

/// Advises on recordings whose frames are so far apart that tracking may lose the camera.
void advise_on_rate(const DecidedRecording& recording) {
  constexpr double kLeastRate_hz = 4.0;
  if (!recording.evidence || recording.evidence->is_camera_still) return;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < recording.frames.size(); ++i)
    steps_s.push_back(recording.frames[i].stamp_s - recording.frames[i - 1].stamp_s);
  if (steps_s.size() < 4) return;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  if (!(*middle * kLeastRate_hz > 1.0)) return;
  for (const auto& [word, length_s] : {std::pair("ms", 1e-3), {"us", 1e-6}, {"ns", 1e-9}}) {
    const double rate_hz = 1.0 / (*middle * length_s);
    if (*middle < 5.0 || rate_hz < 1.0 || rate_hz > 240.0) continue;
    recording.report->add({"time",
                           "frames are " + format_readable(*middle, 2) + " s apart; are their stamps in " +
                               word + ", which would be " + format_readable(rate_hz, 3) + " per second?",
                           0, std::string("--stamps ") + word, true});
    return;
  }
  const bool has_poses = recording.evidence->pose_disagreement && recording.poses_are_used;
  recording.report->add({"time",
                         "frames are " + format_readable(*middle, 2) +
                             " s apart, so tracking may lose the camera" +
                             (has_poses ? "; the recorded poses agree with the depth and help" : ""),
                         0, has_poses ? "--poses auto" : "", true});
}

}  // namespace

DecidedRecording decide(RecordingFacts facts, const std::filesystem::path& folder,
                        const SourceOptions& options) {
  DecidedRecording recording;
  recording.report = options.input ? options.input : std::make_shared<InputReport>();
  InputReport& report = *recording.report;
  if (facts.frames.empty()) throw Error(facts.name + ": the recording contains no frames");
  for (const InputDecision& note : facts.notes) report.add(note);
  recording.facts = std::move(facts);

  const std::filesystem::path files =
      recording.facts.entered.empty() ? folder : std::filesystem::path(recording.facts.entered);
  decide_times(recording, options);
  choose_cameras(recording.facts, files, options, report);
  const StatedInput stated = read_stated_input(files, options);
  recording.depth_unit_m = recording.facts.depth_unit_m;
  if (const auto unit_m = options.depth_unit_m ? options.depth_unit_m : stated.depth_unit_m) {
    recording.depth_unit_m = *unit_m;
    recording.facts.unit_origin = options.depth_unit_m ? Origin::kOption : Origin::kFile;
    recording.facts.unit_source = options.depth_unit_m ? "--depth-unit" : "camera.json";
  }
  report_lost_poses(recording.facts, report);
  const auto convention = options.pose_convention ? options.pose_convention : stated.pose_convention;
  if (convention) recording.pose_convention = *convention;
  require_a_readable_image(recording);
  if (options.questions == Questions::kDepth) question_depth(recording, convention.has_value());

  if (options.questions == Questions::kDepth) advise_on_unusable_poses(recording);
  report_tracks(recording);
  report_gap(recording);
  advise_on_rate(recording);

  if (!options.input)
    for (const InputDecision& decision : report.decisions())
      options.say(recording.facts.name + ": " + line_of(decision));
  return recording;
}

std::optional<Eigen::Isometry3d> stated_pose_of(const DecidedRecording& recording, std::size_t frame,
                                                int later_by) {
  const RecordingFacts& facts = recording.facts;
  const auto at = static_cast<std::ptrdiff_t>(frame) + later_by;
  if (at < 0 || at >= static_cast<std::ptrdiff_t>(recording.frames.size())) return std::nullopt;
  const DecidedFrame& decided = recording.frames[static_cast<std::size_t>(at)];
  if (!facts.read_pose) return facts.frames[decided.stated].T_world_camera;
  const StatedPose read = facts.read_pose(decided.stated, decided.stamp_s);
  if (!read.fault.empty())
    recording.report->count(
        "poses", "% recorded poses are lost or no rigid transform; their frames are used without a pose", at,
        read.fault);
  if (read.was_transposed)
    recording.report->count("poses", "% recorded poses are stored column by column; they are transposed", at,
                            "");
  return read.T_world_camera;
}

Eigen::Isometry3d in_world(const RecordingFacts& facts, const Eigen::Isometry3d& stated,
                           const PoseConvention& convention) {
  const Eigen::Isometry3d T = converted(stated, convention);
  const bool has_axes = !facts.T_world_statedworld.matrix().isIdentity(0.0) ||
                        !facts.T_statedcamera_camera.matrix().isIdentity(0.0);
  return has_axes ? facts.T_world_statedworld * T * facts.T_statedcamera_camera : T;
}

std::optional<Eigen::Isometry3d> pose_of(const DecidedRecording& recording, std::size_t frame) {
  if (!recording.poses_are_used) return std::nullopt;
  const auto stated = stated_pose_of(recording, frame, recording.pose_convention.later_by);
  if (!stated) return std::nullopt;
  return in_world(recording.facts, *stated, recording.pose_convention);
}

void read_depth(const DecidedRecording& recording, std::size_t frame, DepthImage& depth_m) {
  const DecidedFrame& decided = recording.frames[frame];
  if (!decided.fault.empty()) throw Error(decided.fault);
  recording.facts.read_depth(decided.stated, recording.depth_unit_m, depth_m);
  const Intrinsics& camera = recording.facts.rig.depth_camera;
  if (depth_m.width != camera.width_px || depth_m.height != camera.height_px)
    throw Error("its depth image is " + size_text(depth_m.width, depth_m.height) +
                ", but the recording's camera is " + size_text(camera.width_px, camera.height_px));
  if (!recording.facts.remove_unsure) return;
  try {
    recording.facts.remove_unsure(decided.stated, depth_m);
  } catch (const Error& fault) {
    recording.report->count("images", "% confidence images cannot be read; all depth of their frames is used",
                            static_cast<std::int64_t>(frame), fault.what());
  }
}

}  // namespace roomradar
