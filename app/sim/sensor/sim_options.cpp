// sim_options.cpp: parses and checks simulation options.
#include "app/sim/sensor/sim_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/sim/building/building_walk.hpp"
#include "app/sim/room/room.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

std::string_view to_string(CameraPathKind kind) {
  switch (kind) {
    case CameraPathKind::kScan:
      return "scan";
    case CameraPathKind::kView:
      return "view";
    case CameraPathKind::kSwing:
      return "swing";
  }
  return "?";
}

std::string_view to_string(MoverKind kind) {
  switch (kind) {
    case MoverKind::kHand:
      return "hand";
    case MoverKind::kBall:
      return "ball";
    case MoverKind::kPerson:
      return "person";
  }
  return "?";
}

std::string_view to_string(Pace pace) {
  switch (pace) {
    case Pace::kSteady:
      return "steady";
    case Pace::kSlow:
      return "slow";
    case Pace::kWaits:
      return "waits";
    case Pace::kLeaves:
      return "leaves";
  }
  return "?";
}

std::string_view to_string(CrateKind kind) {
  switch (kind) {
    case CrateKind::kNone:
      return "0";
    case CrateKind::kStays:
      return "1";
    case CrateKind::kComes:
      return "comes";
    case CrateKind::kGoes:
      return "goes";
  }
  return "?";
}

namespace {

constexpr MoverKind kAllMovers[] = {MoverKind::kHand, MoverKind::kBall, MoverKind::kPerson};
constexpr Pace kAllPaces[] = {Pace::kSteady, Pace::kSlow, Pace::kWaits, Pace::kLeaves};
constexpr CrateKind kAllCrates[] = {CrateKind::kNone, CrateKind::kStays, CrateKind::kComes, CrateKind::kGoes};
constexpr CameraPathKind kAllPaths[] = {CameraPathKind::kScan, CameraPathKind::kView, CameraPathKind::kSwing};

constexpr const char* kShutterRule = "a time in ms, 0 to 50";
constexpr const char* kDelayRule = "a time in ms, -100 to 100";
constexpr const char* kWalkRule = "ring, or a whole number, 0 to 9999";
constexpr const char* kMovedRule = "a share of the furniture, 0 to 1";
constexpr const char* kTurnRule = "degrees per second, 0 to 360";

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    parts.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

void append_with_comma(std::string& list, std::string_view one, std::string_view comma) {
  if (!list.empty()) list += comma;
  list += one;
}

[[noreturn]] void refuse(std::string_view key, std::string_view value, const std::string& wanted) {
  throw Error("sim: " + std::string(key) + " = '" + std::string(value) + "': must be " + wanted);
}

template <typename Number>
Number number(std::string_view key, std::string_view value, const std::string& wanted) {
  Number result{};
  const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), result);
  if (fault != std::errc{} || end != value.data() + value.size()) refuse(key, value, wanted);
  return result;
}

/// Returns the one of `all` that is called `value`.
template <typename Kind, std::size_t count>
Kind one_of(const Kind (&all)[count], std::string_view key, std::string_view value,
            const std::string& wanted) {
  const auto* const found =
      std::find_if(std::begin(all), std::end(all), [&](Kind kind) { return to_string(kind) == value; });
  if (found == std::end(all)) refuse(key, value, wanted);
  return *found;
}

void set_building_option(SimOptions& options, std::string_view key, std::string_view value) {
  if (options.room != kBuildingRoom)
    throw Error("sim: '" + std::string(key) +
                "' is an option of sim:building only, not of sim:" + options.room);
  if (key == "walk") {
    options.walk = value == "ring" ? kRingWalk : number<int>(key, value, kWalkRule);
    if (value != "ring" && options.walk < 0) refuse(key, value, kWalkRule);
  } else if (key == "rooms") {
    options.building.rooms = number<int>(key, value, "a whole number, 2 to 1000");
  } else if (key == "floors") {
    options.building.floors = number<int>(key, value, "a whole number, 1 to 10");
  } else {
    options.building.alike = number<int>(key, value, "an even number, 0 or more");
  }
}

void set_option(SimOptions& options, std::string_view key, std::string_view value) {
  if (key == "seed") {
    options.seed = number<std::uint64_t>(key, value, "a whole number, 0 or more");
  } else if (key == "frames") {
    options.frames = number<std::int64_t>(key, value, "a whole number, 1 or more");
    if (options.frames == 0 && options.room != kBuildingRoom) refuse(key, value, "a whole number, 1 or more");
  } else if (key == "rate") {
    options.rate_hz = number<double>(key, value, "frames per second, such as 30");
  } else if (key == "noise") {
    options.noise_scale = number<double>(key, value, "0 (off), 1 (a Kinect's) or another factor up to 10");
  } else if (key == "path") {
    options.path = one_of(kAllPaths, key, value, "scan, view or swing");
  } else if (key == "moving") {
    for (const std::string_view one : split(value, ','))
      options.movers.push_back(
          one_of(kAllMovers, key, one, "some of hand, ball, person, with commas between"));
  } else if (key == "crate") {
    options.crate = one_of(kAllCrates, key, value, "0, 1, comes or goes");
  } else if (key == "moved") {
    options.moved = number<double>(key, value, kMovedRule);
  } else if (key == "faults") {
    if (value != "0" && value != "1") refuse(key, value, "0 or 1");
    options.faults = value == "1";
  } else if (key == "pace") {
    options.pace = one_of(kAllPaces, key, value, "steady, slow, waits or leaves");
  } else if (key == "width") {
    const int width_px = number<int>(key, value, "the image's width, 64 to 1920, a multiple of 4");
    if (width_px < 64 || width_px > 1920 || width_px % 4 != 0)
      refuse(key, value, "the image's width, 64 to 1920, a multiple of 4");
    options.depth_camera = kinect_of_width(width_px);
  } else if (key == "colour") {
    if (value != "registered" && value != "separate" && value != "none")
      refuse(key, value, "registered, separate or none");
    options.registered_colour = value != "separate";
    options.with_colour = value != "none";
  } else if (key == "shutter") {
    options.timing.shutter_s = 1e-3 * number<double>(key, value, kShutterRule);
  } else if (key == "delay") {
    options.timing.delay_s = 1e-3 * number<double>(key, value, kDelayRule);
  } else if (key == "exposure") {
    options.timing.exposure_s = 1e-3 * number<double>(key, value, kShutterRule);
  } else if (key == "rooms" || key == "floors" || key == "alike" || key == "walk") {
    set_building_option(options, key, value);
  } else if (key == "turn") {
    options.turn_dps = number<double>(key, value, kTurnRule);
  } else {
    throw Error("sim: no option is called '" + std::string(key) +
                "'; known are: seed, frames, rate, path, moving, pace, noise, crate, moved, faults, width, "
                "colour, shutter, delay, exposure, turn; of sim:building also rooms, floors, alike, walk");
  }
}

}  // namespace

Intrinsics kinect_of_width(int width_px) {
  Intrinsics camera = scaled(kKinectDepthCamera, width_px / 640.0);
  camera.width_px = width_px;
  camera.height_px = width_px * 3 / 4;
  return camera;
}

SimOptions parse_sim_spec(std::string_view spec) {
  constexpr std::string_view kScheme = "sim:";
  if (!spec.starts_with(kScheme))
    throw Error("'" + std::string(spec) +
                "' does not start with sim:; write sim:ROOM or sim:ROOM?seed=1&frames=300");
  spec.remove_prefix(kScheme.size());
  const std::size_t question = std::min(spec.find('?'), spec.size());
  SimOptions options;
  options.room = std::string(spec.substr(0, question));
  if (options.room == kBuildingRoom) options.frames = 0;
  if (question < spec.size())
    for (const std::string_view pair : split(spec.substr(question + 1), '&')) {
      const std::size_t equals = pair.find('=');
      if (equals == std::string_view::npos)
        throw Error("sim: '" + std::string(pair) +
                    "' is not a key=value pair; write for example sim:table?seed=1&frames=300");
      set_option(options, pair.substr(0, equals), pair.substr(equals + 1));
    }
  require_valid(options);
  return options;
}

std::string sim_spec(const SimOptions& options) {
  const SimOptions defaults;
  std::string spec = "sim:" + options.room;
  char separator = '?';
  const auto say = [&](const std::string& key, const std::string& value) {
    spec.append(1, separator).append(key).append("=").append(value);
    separator = '&';
  };
  if (options.seed != defaults.seed) say("seed", std::to_string(options.seed));
  if (options.frames != (options.room == kBuildingRoom ? 0 : defaults.frames))
    say("frames", std::to_string(options.frames));
  if (options.building.rooms != defaults.building.rooms) say("rooms", std::to_string(options.building.rooms));
  if (options.building.floors != defaults.building.floors)
    say("floors", std::to_string(options.building.floors));
  if (options.building.alike) say("alike", std::to_string(*options.building.alike));
  if (options.walk != defaults.walk)
    say("walk", options.walk == kRingWalk ? "ring" : std::to_string(options.walk));
  if (options.rate_hz != defaults.rate_hz) say("rate", format_number(options.rate_hz));
  if (options.path != defaults.path) say("path", std::string(to_string(options.path)));
  std::string moving;
  for (const MoverKind kind : options.movers) append_with_comma(moving, to_string(kind), ",");
  if (!moving.empty()) say("moving", moving);
  if (options.crate != defaults.crate) say("crate", std::string(to_string(options.crate)));
  if (options.moved != defaults.moved) say("moved", format_number(options.moved));
  if (options.pace != defaults.pace) say("pace", std::string(to_string(options.pace)));
  if (options.noise_scale != defaults.noise_scale) say("noise", format_number(options.noise_scale));
  if (options.depth_camera.width_px != defaults.depth_camera.width_px)
    say("width", std::to_string(options.depth_camera.width_px));
  if (options.faults) say("faults", "1");
  if (!options.with_colour)
    say("colour", "none");
  else if (!options.registered_colour)
    say("colour", "separate");
  if (options.timing.shutter_s != 0.0) say("shutter", format_number(1e3 * options.timing.shutter_s));
  if (options.timing.delay_s != 0.0) say("delay", format_number(1e3 * options.timing.delay_s));
  if (options.timing.exposure_s != 0.0) say("exposure", format_number(1e3 * options.timing.exposure_s));
  if (options.turn_dps != 0.0) say("turn", format_number(options.turn_dps));
  return spec;
}

void require_valid(const SimOptions& options) {
  require_room(options.room);
  require_valid(options.building);
  if (options.walk != kRingWalk && (options.walk < 0 || options.walk > kLastWalk))
    refuse("walk", std::to_string(options.walk), kWalkRule);
  const bool whole_walk = options.room == kBuildingRoom && options.frames == 0;
  if (!whole_walk && (options.frames < 1 || options.frames > 100'000'000))
    refuse("frames", std::to_string(options.frames), "a whole number, 1 to 100000000");
  if (!(options.rate_hz >= 0.1 && options.rate_hz <= 1000.0))
    refuse("rate", format_number(options.rate_hz), "frames per second, 0.1 to 1000");
  if (!(options.noise_scale >= 0.0 && options.noise_scale <= 10.0))
    refuse("noise", format_number(options.noise_scale), "0 (off), 1 (a Kinect's) or another factor up to 10");
  if (!(options.moved >= 0.0 && options.moved <= 1.0))
    refuse("moved", format_number(options.moved), kMovedRule);
  if (options.moved > 0.0 && options.room != kRandomRoom)
    throw Error("sim: 'moved' is an option of sim:random only, not of sim:" + options.room);
  const SimTiming& timing = options.timing;
  if (!(timing.shutter_s >= 0.0 && timing.shutter_s <= 0.05))
    refuse("shutter", format_number(1e3 * timing.shutter_s), kShutterRule);
  if (!(std::abs(timing.delay_s) <= 0.1)) refuse("delay", format_number(1e3 * timing.delay_s), kDelayRule);
  if (!(timing.exposure_s >= 0.0 && timing.exposure_s <= 0.05))
    refuse("exposure", format_number(1e3 * timing.exposure_s), kShutterRule);
  if (!(options.turn_dps >= 0.0 && options.turn_dps <= 360.0))
    refuse("turn", format_number(options.turn_dps), kTurnRule);
  if (options.faults && options.registered_colour && options.with_colour)
    refuse("faults", "1",
           "combined with colour=separate or colour=none: faults=1 takes away the calibration by which the "
           "colour "
           "image is registered to the depth image");
  for (std::size_t i = 0; i < options.movers.size(); ++i)
    if (std::find(options.movers.begin(), options.movers.begin() + static_cast<std::ptrdiff_t>(i),
                  options.movers[i]) != options.movers.begin() + static_cast<std::ptrdiff_t>(i))
      refuse("moving", to_string(options.movers[i]), "named once");
  require_valid(options.depth_camera, "sim: depth camera");
}

}  // namespace roomradar
