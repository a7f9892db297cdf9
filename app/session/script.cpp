// script.cpp: reads and writes the events file of `roomradar run --script FILE`.
#include "app/session/script.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

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

template <typename Value>
struct Word {
  std::string_view word;
  Value value;
};
constexpr std::array<Word<Action>, 15> kActions = {{{"add", Action::kAdd},
                                                    {"place", Action::kPlace},
                                                    {"drop", Action::kDrop},
                                                    {"throw", Action::kThrow},
                                                    {"remove", Action::kRemove},
                                                    {"turn", Action::kTurn},
                                                    {"carry", Action::kCarry},
                                                    {"release", Action::kRelease},
                                                    {"surfaces", Action::kSurfaces},
                                                    {"unknown", Action::kUnknown},
                                                    {"radar", Action::kRadar},
                                                    {"quality", Action::kQuality},
                                                    {"camera", Action::kCamera},
                                                    {"adopt", Action::kCommit},
                                                    {"quit", Action::kQuit}}};
constexpr std::array<Word<SurfacePolicy>, 4> kSurfaces = {{{"holes", SurfacePolicy::kHoles},
                                                           {"skirt", SurfacePolicy::kSkirt},
                                                           {"border", SurfacePolicy::kBorder},
                                                           {"map", SurfacePolicy::kMap}}};
constexpr std::array<Word<bool>, 2> kUnknown = {{{"free", false}, {"solid", true}}};
constexpr std::array<Word<RadarMode>, 2> kRadarModes = {
    {{"exact", RadarMode::kExact}, {"sampled", RadarMode::kSampled}}};
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

/// Returns "add, place or drop" and the like.
template <typename Value, std::size_t kCount>
std::string listed(const std::array<Word<Value>, kCount>& words) {
  std::string list;
  for (std::size_t i = 0; i < kCount; ++i)
    list.append(i == 0 ? "" : i + 1 == kCount ? " or " : ", ").append(words[i].word);
  return list;
}

template <typename Value, std::size_t kCount>
std::string_view word_of(const std::array<Word<Value>, kCount>& words, Value value) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& word) { return word.value == value; });
  return found == words.end() ? std::string_view{} : found->word;
}

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result.append(text).append("'");
  return result;
}

/// Reads the words of one line in order; every error names the file and the line.
class LineReader {
 public:
  LineReader(std::string_view text, std::string_view where, int line) : where_(where), line_(line) {
    text = text.substr(0, text.find('#'));
    while (!text.empty()) {
      const std::size_t begin = text.find_first_not_of(" \t\r");
      if (begin == std::string_view::npos) break;
      const std::size_t end = std::min(text.find_first_of(" \t\r", begin), text.size());
      words_.push_back(text.substr(begin, end - begin));
      text.remove_prefix(end);
    }
  }
  [[nodiscard]] bool done() const { return next_ == words_.size(); }

  [[noreturn]] void fail(const std::string& complaint) const {
    throw Error(std::string(where_) + ":" + std::to_string(line_) + ": " + complaint);
  }
  std::string_view word(const char* wanted) {
    if (done()) fail("the line ends where " + std::string(wanted) + " is wanted");
    return words_[next_++];
  }
  bool take_if(std::string_view expected) {
    if (done() || words_[next_] != expected) return false;
    ++next_;
    return true;
  }
  void expect(std::string_view expected) {
    const std::string_view found = word(in_quotes(expected).c_str());
    if (found != expected) fail(in_quotes(found) + " found where " + in_quotes(expected) + " is wanted");
  }
  double number(const char* wanted, double lowest, double highest) {
    const std::string_view text = word(wanted);
    double value = 0.0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(in_quotes(text) + " is not a finite number; wanted is " + wanted);
    if (value < lowest || value > highest) fail(in_quotes(text) + " is out of range for " + wanted);
    return value;
  }
  double whole_number(const char* wanted, double lowest, double highest) {
    const double value = number(wanted, lowest, highest);
    if (value != std::floor(value)) fail("a whole number is wanted: " + std::string(wanted));
    return value;
  }
  template <typename Value, std::size_t kCount>
  Value choice(const char* wanted, const std::array<Word<Value>, kCount>& words) {
    const std::string list = listed(words);
    const std::string_view found = word((std::string(wanted) + ": " + list).c_str());
    for (const Word<Value>& candidate : words)
      if (candidate.word == found) return candidate.value;
    fail("unknown word " + in_quotes(found) + "; wanted is " + wanted + ": " + list);
  }
  Eigen::Vector3d vector(const char* wanted, double limit) {
    Eigen::Vector3d value;
    for (int axis = 0; axis < 3; ++axis) value[axis] = number(wanted, -limit, limit);
    return value;
  }
  void expect_end() const {
    if (!done()) fail(in_quotes(words_[next_]) + " is too much; the event is complete before it");
  }

 private:
  std::string_view where_;
  int line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

Eigen::Vector3d read_position(LineReader& line) {
  return line.vector("a position X Y Z (m)", kMaxCoordinate_m);
}

/// Reads the optional orientation at the end of a line.
void read_turned(LineReader& line, ScriptEvent& event) {
  if (!line.take_if("turned")) return;
  event.turned_deg = line.vector("the angles YAW PITCH ROLL (degrees), -360..360", 360.0);
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

/// Returns true if the action is followed by an object's name.
bool has_object(Action action) {
  switch (action) {
    case Action::kSurfaces:
    case Action::kUnknown:
    case Action::kRadar:
    case Action::kQuality:
    case Action::kCamera:
    case Action::kCommit:
    case Action::kQuit:
      return false;
    default:
      return true;
  }
}

void read_action(LineReader& line, ScriptEvent& event) {
  event.action = line.choice("an action", kActions);
  if (has_object(event.action)) event.name = line.word("the object's name");
  switch (event.action) {
    case Action::kAdd:
      event.mesh = line.word("'teapot' or a mesh file");
      if (line.take_if("size")) event.size_m = line.number("a size (m), 0.001..10", 0.001, 10.0);
      break;
    case Action::kPlace:
      event.position_world = read_position(line);
      read_turned(line, event);
      break;
    case Action::kCarry:
      event.position_world = read_position(line);
      break;
    case Action::kDrop:
      if (!line.take_if("view")) {
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
      event.surfaces = line.choice("what can be touched", kSurfaces);
      break;
    case Action::kUnknown:
      event.unknown_is_solid = line.choice("what unknown space is", kUnknown);
      break;
    case Action::kRadar:
      event.radar.mode = line.choice("the radar's mode", kRadarModes);
      event.radar.resolution_px = static_cast<int>(line.whole_number("pixels, 1..4096", 1.0, 4096.0));
      break;
    case Action::kQuality:
      read_quality(line, event);
      break;
    case Action::kCamera:
      event.camera = line.choice("what the camera does", kCameraPlays);
      break;
    case Action::kRemove:
    case Action::kCommit:
    case Action::kQuit:
      break;
  }
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
        line.fail(in_quotes(event.name) + " was added in line " + std::to_string(first->second) + " already");
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

std::string to_line(const ScriptEvent& event) {
  const auto number = [](double value) { return " " + format_number(value); };
  const auto vector = [&](const Eigen::Vector3d& v) { return number(v.x()) + number(v.y()) + number(v.z()); };

  const auto turned = [&] {
    return event.R_world_object ? " turned" + vector(event.turned_deg) : std::string();
  };

  std::string line = event.frame ? "frame " + std::to_string(*event.frame) : "time" + number(*event.time_s);
  line.append(" ").append(word_of(kActions, event.action));
  if (has_object(event.action)) line.append(" ").append(event.name);
  switch (event.action) {
    case Action::kAdd:
      line.append(" ").append(event.mesh);
      if (event.size_m) line += " size" + number(*event.size_m);
      break;
    case Action::kPlace:
      line += vector(*event.position_world) + turned();
      break;
    case Action::kCarry:
      line += vector(*event.position_world);
      break;
    case Action::kDrop:
      line += event.position_world ? " at" + vector(*event.position_world) : " view";
      line += " height" + number(event.height_m) + turned();
      break;
    case Action::kThrow:
      line += vector(*event.position_world) + " velocity" + vector(event.velocity_world_mps);
      if (!event.angular_velocity_world_rad_s.isZero(0.0))
        line += " spin" + vector(event.angular_velocity_world_rad_s);
      line += turned();
      break;
    case Action::kRelease:
      line += " velocity" + vector(event.velocity_world_mps);
      break;
    case Action::kTurn:
      line += vector(event.turn_world_deg);
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

bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s) {
  return event.frame ? *event.frame <= run_frame : event.time_s && *event.time_s <= run_time_s;
}

}  // namespace roomradar
