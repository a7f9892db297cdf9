// check_command.cpp: opens a recording, reads frames spread over it, and prints the findings.
#include "app/commands/commands.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sources/decisions/decide.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

/// Counts over frames that are spread over the recording.
struct SampledFrames {
  std::size_t frames = 0, unreadable = 0, with_pose = 0, with_colour = 0, unreadable_colour = 0,
              with_gravity = 0;
  std::string first_fault, first_colour_fault;
};

/// Reads up to 100 frames, for at most 1.5 s.
SampledFrames sample(const DecidedRecording& recording) {
  constexpr std::size_t kMost = 100;
  constexpr double kMost_s = 1.5;
  SampledFrames sampled;
  DepthImage depth_m;
  ColourImage colour;
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t count = std::min(kMost, recording.frames.size());
  // In an order that is spread over the recording wherever the time ends.
  std::size_t step = 61;
  while (count > 1 && count % step == 0) --step;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (k * step % count) * recording.frames.size() / count;
    const DecidedFrame& frame = recording.frames[i];
    ++sampled.frames;
    try {
      read_depth(recording, i, depth_m);
    } catch (const Error& fault) {
      ++sampled.unreadable;
      if (sampled.first_fault.empty()) sampled.first_fault = fault.what();
    }
    if (stated_pose_of(recording, i, 0)) ++sampled.with_pose;
    const auto down = recording.facts.read_down ? recording.facts.read_down(frame.stated, frame.stamp_s)
                                                : recording.facts.frames[frame.stated].down_camera;
    if (down || (recording.facts.is_world_level && pose_of(recording, i))) ++sampled.with_gravity;
    if (frame.colour) ++sampled.with_colour;
    if (frame.colour && k % 8 == 0) try {
        recording.facts.read_colour(*frame.colour, colour);
      } catch (const Error& fault) {
        ++sampled.unreadable_colour;
        if (sampled.first_colour_fault.empty()) sampled.first_colour_fault = fault.what();
      }
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > kMost_s) break;
  }
  return sampled;
}

struct Timing {
  double length_s = 0.0, rate_hz = 0.0, longest_gap_s = 0.0;
  std::size_t gap_after = 0;
  std::size_t gaps = 0;  ///< of more than 0.5 s and more than five periods
};

Timing timing_of(const DecidedRecording& recording) {
  Timing timing;
  std::vector<double> steps_s;
  const DecidedFrame* last = nullptr;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const DecidedFrame& frame = recording.frames[i];
    if (!frame.fault.empty()) continue;
    if (last) {
      steps_s.push_back(frame.stamp_s - last->stamp_s);
      timing.length_s += steps_s.back();
      if (steps_s.back() > timing.longest_gap_s)
        timing.longest_gap_s = steps_s.back(), timing.gap_after = i - 1;
    }
    last = &frame;
  }
  if (steps_s.empty()) return timing;
  std::nth_element(steps_s.begin(), steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2),
                   steps_s.end());
  const double period_s = steps_s[steps_s.size() / 2];
  timing.rate_hz = period_s > 0.0 ? 1.0 / period_s : 0.0;
  timing.gaps = static_cast<std::size_t>(std::count_if(
      steps_s.begin(), steps_s.end(), [&](double step_s) { return step_s > std::max(0.5, 5.0 * period_s); }));
  return timing;
}

const char* name_of(Origin origin) {
  switch (origin) {
    case Origin::kRecording:
      return "stated by the recording";
    case Origin::kFile:
      return "stated by a file";
    case Origin::kOption:
      return "stated by an option";
    case Origin::kFormat:
      return "defined by the format";
    case Origin::kAssumed:
      return "assumed";
  }
  return "unknown";
}

nlohmann::json json_of(const Intrinsics& camera) {
  return {{"width_px", camera.width_px}, {"height_px", camera.height_px}, {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},       {"cx_px", camera.cx_px},         {"cy_px", camera.cy_px}};
}

std::string camera_text(const Intrinsics& camera) {
  return size_text(camera.width_px, camera.height_px) + ", focal length " + format_readable(camera.fx_px, 4) +
         " px";
}

std::string percent(std::size_t part, std::size_t of) {
  return of == 0 ? "0 %"
                 : format_fixed(100.0 * static_cast<double>(part) / static_cast<double>(of), 0) + " %";
}

/// Returns what `prescan` would do with the recording, in a sentence.
std::string prescan_text(const DecidedRecording& recording, const SampledFrames& sampled) {
  const DepthEvidence& evidence = *recording.evidence;
  std::string text = "tracks the camera through " + std::to_string(recording.frames.size()) + " frames";
  if (sampled.with_pose > 0)
    text += evidence.poses_disagree && !recording.poses_are_used
                ? "; the recorded poses cannot be used"
                : "; the recorded poses predict and constrain the motion [--poses auto]";
  if (evidence.is_camera_still) text += "; the camera does not move, so only what it sees is mapped";
  return text;
}

nlohmann::json json_of(const DecidedRecording& recording, const SampledFrames& sampled, const Timing& timing,
                       const std::vector<InputDecision>& decisions) {
  const RecordingFacts& facts = recording.facts;
  const DepthEvidence& evidence = *recording.evidence;
  nlohmann::json json = {
      {"recording", facts.name},
      {"kind", facts.kind},
      {"frames", recording.frames.size()},
      {"length_s", timing.length_s},
      {"rate_hz", timing.rate_hz},
      {"longest_gap_s", timing.longest_gap_s},
      {"gaps", timing.gaps},
      {"depth_unit_m", recording.depth_unit_m},
      {"depth_unit_origin", name_of(facts.unit_origin)},
      {"median_depth_m", evidence.median_depth_m},
      {"measured_part", evidence.measured_part},
      {"depth_camera", json_of(facts.rig.depth_camera)},
      {"cameras_origin", name_of(facts.camera_origin)},
      {"cameras_source", facts.camera_source},
      {"colour_part",
       sampled.frames ? static_cast<double>(sampled.with_colour) / static_cast<double>(sampled.frames) : 0.0},
      {"pose_part",
       sampled.frames ? static_cast<double>(sampled.with_pose) / static_cast<double>(sampled.frames) : 0.0},
      {"poses_convention", to_string(recording.pose_convention)},
      {"poses_agree",
       evidence.posed_pairs >= 3 ? nlohmann::json(!evidence.poses_disagree) : nlohmann::json()},
      {"pose_difference_mm",
       evidence.pose_disagreement ? nlohmann::json(1000.0 * evidence.pose_difference_m) : nlohmann::json()},
      {"pose_disagreement",
       evidence.pose_disagreement ? nlohmann::json(*evidence.pose_disagreement) : nlohmann::json()},
      {"gravity_part", sampled.frames
                           ? static_cast<double>(sampled.with_gravity) / static_cast<double>(sampled.frames)
                           : 0.0},
      {"camera_is_still",
       evidence.still_difference ? nlohmann::json(evidence.is_camera_still) : nlohmann::json()},
      {"still_disagreement",
       evidence.still_difference ? nlohmann::json(*evidence.still_difference) : nlohmann::json()},
      {"noise_ratio", evidence.noise_ratio ? nlohmann::json(*evidence.noise_ratio) : nlohmann::json()},
      {"prescan", prescan_text(recording, sampled)},
      {"input", to_json(decisions)}};
  if (facts.rig.colour_camera) json["colour_camera"] = json_of(*facts.rig.colour_camera);
  return json;
}

void print(const DecidedRecording& recording, const SampledFrames& sampled, const Timing& timing,
           const std::vector<InputDecision>& decisions) {
  const RecordingFacts& facts = recording.facts;
  const DepthEvidence& evidence = *recording.evidence;
  const auto line = [](const char* name, const std::string& text) {
    std::printf("%-10s %s\n", name, text.c_str());
  };
  std::printf("%s: %s\n", facts.name.c_str(), facts.kind.c_str());
  line("frames", std::to_string(recording.frames.size()) + ", " +
                     percent(sampled.with_colour, sampled.frames) + " with colour");
  line("time", format_readable(timing.length_s, 4) + " s, " + format_readable(timing.rate_hz, 3) +
                   " frames per second, longest gap " + format_readable(timing.longest_gap_s, 3) + " s" +
                   (timing.gaps > 0 ? " after frame " + std::to_string(timing.gap_after) : ""));
  line("depth",
       "unit " + format_general(recording.depth_unit_m, 4) + " m (" +
           (facts.unit_source.empty() ? std::string(name_of(facts.unit_origin)) : facts.unit_source) + "); " +
           format_fixed(100.0 * evidence.measured_part, 0) +
           " % of the pixels measured, half of them nearer than " + format_fixed(evidence.median_depth_m, 2) +
           " m, a tenth beyond " + format_fixed(evidence.far_depth_m, 2) + " m");
  line("cameras",
       "depth " + camera_text(facts.rig.depth_camera) +
           (facts.rig.colour_camera ? "; colour " + camera_text(*facts.rig.colour_camera) : "; no colour") +
           " (" + (facts.camera_origin == Origin::kAssumed ? "assumed: " : "") + facts.camera_source + ")");
  if (sampled.with_pose == 0)
    line("poses", "none");
  else
    line("poses",
         percent(sampled.with_pose, sampled.frames) + " of the frames" +
             (evidence.pose_disagreement
                  ? "; depth of nearby frames differs by " +
                        format_readable(1000.0 * evidence.pose_difference_m, 2) + " mm under them, which " +
                        (evidence.poses_disagree ? "cannot be right" : "agrees")
                  : "; too few to compare with depth"));
  line("gravity", sampled.with_gravity == 0 ? "not recorded"
                                            : percent(sampled.with_gravity, sampled.frames) +
                                                  " of the frames, from " + facts.gravity_source);
  if (evidence.still_difference) line("camera", evidence.is_camera_still ? "stands still" : "moves");
  if (evidence.noise_ratio)
    line("noise", format_fixed(*evidence.noise_ratio, 2) + " times that of the sensor's model");
  line("prescan", prescan_text(recording, sampled));
  for (const InputDecision& decision : decisions)
    line(decision.is_advice ? "advice" : "note", line_of(decision));
}

}  // namespace

int run(const CheckOptions& options) {
  SourceOptions source_options = source_options_of(options.input);
  source_options.questions = Questions::kDepth;
  source_options.input = std::make_shared<InputReport>();
  const DecidedRecording recording =
      decide(read_facts(options.recording, source_options.depth_topic), options.recording, source_options);
  const SampledFrames sampled = sample(recording);
  std::vector<InputDecision> decisions = source_options.input->decisions();
  if (sampled.unreadable > 0)
    decisions.push_back(
        {"images",
         percent(sampled.unreadable, sampled.frames) + " of " + std::to_string(sampled.frames) +
             " depth images that were tried cannot be read, the first: " + sampled.first_fault,
         static_cast<std::int64_t>(sampled.unreadable), "", true});
  if (sampled.unreadable_colour > 0)
    decisions.push_back({"images",
                         "some colour images cannot be read, the first: " + sampled.first_colour_fault,
                         static_cast<std::int64_t>(sampled.unreadable_colour), "", true});
  const Timing timing = timing_of(recording);
  if (options.json)
    std::printf("%s\n", json_of(recording, sampled, timing, decisions)
                            .dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                            .c_str());
  else
    print(recording, sampled, timing, decisions);
  const bool has_advice = std::any_of(decisions.begin(), decisions.end(),
                                      [](const InputDecision& each) { return each.is_advice; });
  return has_advice ? 1 : 0;
}

}  // namespace roomradar
