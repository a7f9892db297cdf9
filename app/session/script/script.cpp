// script.cpp: reads and writes the events file of `roomradar run --script FILE`.
#include "app/session/script/script.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "app/session/script/script_line.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMaxBytes = 1U << 26U;  // a recorded day of dragging objects
constexpr double kMaxCoordinate_m = 1e8;      // for an object's origin, which may be far from its mesh
constexpr double kMaxSpeed_mps = 100.0;
constexpr double kMaxAngular_rad_s = 1000.0;
constexpr double kMaxTime_s = 1e6;

constexpr std::array<Word<Action>, 17> kActions = {
    {{"add", Action::kAdd},
     {"place", Action::kPlace},
     {"drop", Action::kDrop},
     {"throw", Action::kThrow},
     {"material", Action::kMaterial},
     {"remove", Action::kRemove},
     {"turn", Action::kTurn},
     {"carry", Action::kCarry},
     {"release", Action::kRelease},
     {"surfaces", Action::kSurfaces},
     {"unknown", Action::kUnknown},
     {"radar", Action::kRadar},
     {"quality", Action::kQuality},
     {"camera", Action::kCamera},
     {"commit", Action::kCommit},
     {"adopt", Action::kCommit},  // of scripts of earlier versions
     {"quit", Action::kQuit}}};
constexpr std::array<Word<SurfacePolicy>, 4> kSurfaces = {{{"holes", SurfacePolicy::kHoles},
                                                           {"skirt", SurfacePolicy::kSkirt},
                                                           {"border", SurfacePolicy::kBorder},
                                                           {"map", SurfacePolicy::kMap}}};
constexpr std::array<Word<bool>, 2> kUnknown = {{{"free", false}, {"solid", true}}};
constexpr std::array<Word<RadarMode>, 3> kRadarModes = {
    {{"exact", RadarMode::kExact}, {"sampled", RadarMode::kSampled}, {"passes", RadarMode::kPasses}}};
constexpr std::array<Word<FramePart>, 4> kFramePartWords = {{{"locate", FramePart::kLocate},
                                                             {"mesh", FramePart::kMesh},
                                                             {"physics", FramePart::kPhysics},
                                                             {"compose", FramePart::kCompose}}};
constexpr std::array<Word<CameraPlay>, 6> kCameraPlays = {{{"hold", CameraPlay::kHold},
                                                           {"go", CameraPlay::kGo},
                                                           {"rewind", CameraPlay::kRewind},
                                                           {"loop", CameraPlay::kLoop},
                                                           {"stay", CameraPlay::kStay},
                                                           {"resume", CameraPlay::kResume}}};

Eigen::Vector3d read_position(LineReader& line) {
  return line.vector("a position X Y Z (m)", kMaxCoordinate_m);
}

/// Reads the optional orientation at the end of a line.
void read_turned(LineReader& line, ScriptEvent& event) {
  if (!line.take_if("turned")) return;
  event.turned_deg = line.vector("the angles YAW PITCH ROLL (degrees)", 360.0);
  const Eigen::Vector3d angles = event.turned_deg * (std::numbers::pi / 180.0);
  event.R_world_object = (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitX()))
                             .toRotationMatrix();
}

void read_quality(LineReader& line, ScriptEvent& event) {
  if (line.take_if("from")) event.from = line.choice("a part of the frame", kFramePartWords);
  while (!line.done()) {
    const std::string_view name = line.word("a setting's name");
    const std::string_view word = line.word("a setting's value");
    try {
      set_field(event.quality, name, word);
    } catch (const Error& fault) {
      line.fail(fault.what());
    }
  }
}

constexpr auto kUpAxes = [] {
  std::array<Word<UpAxis>, kUpAxisNames.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = {kUpAxisNames[i], static_cast<UpAxis>(i)};
  return words;
}();

/// Reads one value of a material. Returns false if the next word names none, or one that is set.
bool read_material(LineReader& line, BodyMaterial& material) {
  for (const MaterialField& field : kMaterialFields) {
    std::optional<double>& value = material.*field.value;
    if (value || !line.take_if(field.name)) continue;
    value = line.number(field.wanted, field.least, field.most);
    if (material.mass_kg && material.density_kg_m3) line.fail("a mass and a density exclude each other");
    return true;
  }
  return false;
}

/// Reads the options after the mesh, in any order.
void read_add(LineReader& line, ScriptEvent& event) {
  while (!line.done()) {
    if (!event.size_m && line.take_if("size")) {
      event.size_m = line.number("a size (m), 0.001..10", 0.001, 10.0);
    } else if (!event.up && line.take_if("up")) {
      event.up = line.choice("the axis of the file that points up", kUpAxes);
    } else if (!read_material(line, event.material)) {
      line.fail(
          in_quotes(line.word("an option")) +
          " is not an option of add (size, up, mass, density, friction, restitution), or is given twice");
    }
  }
}

void read_when(LineReader& line, ScriptEvent& event) {
  const std::string_view when = line.word("'frame' or 'time'");
  if (when == "frame") {
    event.frame = static_cast<std::int64_t>(line.whole_number("a frame number from 0", 0.0, 1e12));
  } else if (when == "time") {
    event.time_s = line.number("a time in seconds, from 0", 0.0, kMaxTime_s);
  } else {
    line.fail("an event begins with 'frame N' or 'time SECONDS', not with " + in_quotes(when));
  }
}

// Not split: one case per action.
void read_action(LineReader& line, ScriptEvent& event) {
  event.action = line.choice("an action", kActions);
  if (has_object(event.action)) event.name = line.word("the object's name");
  switch (event.action) {
    case Action::kAdd:
      event.mesh = line.word("'teapot' or a mesh file");
      read_add(line, event);
      break;
    case Action::kMaterial:
      if (!read_material(line, event.material))
        line.fail("'material " + event.name +
                  "' is followed by mass, density, friction or restitution, and a number");
      while (read_material(line, event.material)) {
      }
      break;
    case Action::kPlace:
      event.position_world = read_position(line);
      read_turned(line, event);
      break;
    case Action::kCarry:
      event.position_world = read_position(line);
      break;
    case Action::kDrop:
      if (line.take_if("near")) {
        event.near_world = read_position(line);
      } else if (!line.take_if("view")) {
        line.expect("at");
        event.position_world = read_position(line);
      }
      if (line.take_if("height")) event.height_m = line.number("a height (m), 0..5", 0.0, 5.0);
      read_turned(line, event);
      break;
    case Action::kThrow:
      event.position_world = read_position(line);
      line.expect("velocity");
      event.velocity_world_mps = line.vector("a velocity X Y Z (m/s)", kMaxSpeed_mps);
      if (line.take_if("spin"))
        event.angular_velocity_world_rad_s = line.vector("a spin X Y Z (rad/s)", kMaxAngular_rad_s);
      read_turned(line, event);
      break;
    case Action::kRelease:
      line.expect("velocity");
      event.velocity_world_mps = line.vector("a velocity X Y Z (m/s)", kMaxSpeed_mps);
      break;
    case Action::kTurn:
      event.turn_world_deg = line.vector("a turn X Y Z (degrees about the world's axes)", kMaxTurn_deg);
      break;
    case Action::kSurfaces:
      event.surfaces = line.choice("the surfaces that can be touched", kSurfaces);
      break;
    case Action::kUnknown:
      event.unknown_is_solid = line.choice("the state of unknown space", kUnknown);
      break;
    case Action::kRadar:
      event.radar.mode = line.choice("the radar's mode", kRadarModes);
      event.radar.resolution_px = static_cast<int>(line.whole_number("pixels, 1..4096", 1.0, 4096.0));
      break;
    case Action::kQuality:
      read_quality(line, event);
      break;
    case Action::kCamera:
      event.camera = line.choice("a camera command", kCameraPlays);
      break;
    case Action::kRemove:
    case Action::kCommit:
    case Action::kQuit:
      break;
  }
}

std::string number_word(double value) { return " " + format_number(value); }

std::string vector_words(const Eigen::Vector3d& v) {
  return number_word(v.x()) + number_word(v.y()) + number_word(v.z());
}

std::string material_words(const BodyMaterial& material) {
  std::string words;
  for (const MaterialField& field : kMaterialFields)
    if (const auto& value = material.*field.value)
      words.append(" ").append(field.name) += number_word(*value);
  return words;
}

std::string turned_words(const ScriptEvent& event) {
  return event.R_world_object ? " turned" + vector_words(event.turned_deg) : std::string();
}

}  // namespace

Script parse_script(std::string_view text, std::string_view where) {
  if (text.find('\0') != std::string_view::npos)
    throw Error(std::string(where) + ": is not text; give a file with one event per line");
  Script script;
  std::map<std::string, int, std::less<>> added_in_line;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    LineReader line(text.substr(0, end), where, ++number);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.done()) continue;

    ScriptEvent event;
    event.line = number;
    read_when(line, event);
    read_action(line, event);
    line.expect_end();

    if (event.action == Action::kAdd) {
      const auto [first, is_new] = added_in_line.emplace(event.name, number);
      if (!is_new)
        line.fail(in_quotes(event.name) + " was already added in line " + std::to_string(first->second));
    } else if (!event.name.empty() && !added_in_line.contains(event.name)) {
      line.fail("no object " + in_quotes(event.name) + " was added in a line above; write 'frame 0 add " +
                event.name + " teapot' first");
    }
    script.events.push_back(std::move(event));
  }
  return script;
}

Script read_script(const std::filesystem::path& path, LastLine last_line) {
  std::string text = read_bytes(path, "a text file with one event per line", kMaxBytes);
  if (last_line == LastLine::kMayBeCut) text.resize(text.rfind('\n') + 1);  // npos + 1 is 0

  Script script = parse_script(text, path.string());
  for (ScriptEvent& event : script.events) {
    const bool is_file = event.action == Action::kAdd && event.mesh != "teapot";
    if (is_file && std::filesystem::path(event.mesh).is_relative())
      event.mesh = (path.parent_path() / event.mesh).string();
  }
  return script;
}

// Not split: one case per action.
std::string to_line(const ScriptEvent& event) {
  std::string line =
      event.frame ? "frame " + std::to_string(*event.frame) : "time" + number_word(*event.time_s);
  line.append(" ").append(word_of(kActions, event.action));
  if (has_object(event.action)) line.append(" ").append(event.name);
  switch (event.action) {
    case Action::kAdd:
      line.append(" ").append(event.mesh);
      if (event.size_m) line += " size" + number_word(*event.size_m);
      if (event.up) line.append(" up ").append(to_string(*event.up));
      line += material_words(event.material);
      break;
    case Action::kMaterial:
      line += material_words(event.material);
      break;
    case Action::kPlace:
      line += vector_words(*event.position_world) + turned_words(event);
      break;
    case Action::kCarry:
      line += vector_words(*event.position_world);
      break;
    case Action::kDrop:
      line += event.position_world ? " at" + vector_words(*event.position_world)
              : event.near_world   ? " near" + vector_words(*event.near_world)
                                   : " view";
      line += " height" + number_word(event.height_m) + turned_words(event);
      break;
    case Action::kThrow:
      line += vector_words(*event.position_world) + " velocity" + vector_words(event.velocity_world_mps);
      if (!event.angular_velocity_world_rad_s.isZero(0.0))
        line += " spin" + vector_words(event.angular_velocity_world_rad_s);
      line += turned_words(event);
      break;
    case Action::kRelease:
      line += " velocity" + vector_words(event.velocity_world_mps);
      break;
    case Action::kTurn:
      line += vector_words(event.turn_world_deg);
      break;
    case Action::kSurfaces:
      line.append(" ").append(word_of(kSurfaces, event.surfaces));
      break;
    case Action::kUnknown:
      line.append(" ").append(word_of(kUnknown, event.unknown_is_solid));
      break;
    case Action::kRadar:
      line.append(" ").append(word_of(kRadarModes, event.radar.mode));
      line += " " + std::to_string(event.radar.resolution_px);
      break;
    case Action::kQuality:
      if (event.from != FramePart::kLocate) line.append(" from ").append(to_string(event.from));
      for (const auto& [name, word] : words_of(event.quality)) line += " " + name + " " + word;
      break;
    case Action::kCamera:
      line.append(" ").append(word_of(kCameraPlays, event.camera));
      break;
    case Action::kRemove:
    case Action::kCommit:
    case Action::kQuit:
      break;
  }
  return line;
}

}  // namespace roomradar
