// script.cpp: reads and writes the events file of `roomradar run --script FILE`.
#include "app/session/script/script.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/overloaded.hpp"

namespace roomradar {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result.append(text).append("'");
  return result;
}

/// Keyword of a script, and its value.
template <typename Value>
struct Word {
  std::string_view word;
  Value value;
};

/// Returns the keywords as a list such as "add, place or drop".
template <typename Value, std::size_t kCount>
std::string listed(const std::array<Word<Value>, kCount>& words) {
  std::string list;
  for (std::size_t i = 0; i < kCount; ++i)
    list.append(i == 0 ? "" : i + 1 == kCount ? " or " : ", ").append(words[i].word);
  return list;
}

/// Returns the keyword of a value; empty if the value has none.
template <typename Value, std::size_t kCount>
std::string_view word_of(const std::array<Word<Value>, kCount>& words, Value value) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& word) { return word.value == value; });
  return found == words.end() ? std::string_view{} : found->word;
}

/// Reads the words of one line, separated by spaces or tabs, in order. Error messages contain the file's name
/// and the line number.
class LineReader {
 public:
  /// @param where  name of the file, for error messages. `text` and `where` must outlive the reader
  LineReader(std::string_view text, std::string_view where, int line);
  [[nodiscard]] bool done() const { return next_ == words_.size(); }

  /// Throws Error "FILE:LINE: complaint".
  [[noreturn]] void fail(const std::string& complaint) const;
  /// Returns the next word. Throws Error if the line has ended; `wanted` describes the expected word in the
  /// message.
  std::string_view word(const char* wanted);
  /// Consumes the next word and returns true if it equals `expected`; else returns false.
  bool take_if(std::string_view expected);
  void expect(std::string_view expected);
  /// Reads a finite number in lowest..highest.
  double number(const char* wanted, double lowest, double highest);
  double whole_number(const char* wanted, double lowest, double highest);
  /// Returns the value of the next word. Throws Error if the word is not in `words`.
  template <typename Value, std::size_t kCount>
  Value choice(const char* wanted, const std::array<Word<Value>, kCount>& words) {
    const std::string list = listed(words);
    const std::string_view found = word((std::string(wanted) + ": " + list).c_str());
    for (const Word<Value>& candidate : words)
      if (candidate.word == found) return candidate.value;
    fail("unknown word " + in_quotes(found) + "; expected " + wanted + ": " + list);
  }
  /// Reads three numbers, each in -limit..limit.
  Eigen::Vector3d vector(const char* wanted, double limit);
  void expect_end() const;

 private:
  std::string_view where_;
  int line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

LineReader::LineReader(std::string_view text, std::string_view where, int line) : where_(where), line_(line) {
  text = text.substr(0, text.find('#'));
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \t\r", begin), text.size());
    words_.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

void LineReader::fail(const std::string& complaint) const {
  throw Error(std::string(where_) + ":" + std::to_string(line_) + ": " + complaint);
}

std::string_view LineReader::word(const char* wanted) {
  if (done()) fail("the line ends too early; expected " + std::string(wanted));
  return words_[next_++];
}

bool LineReader::take_if(std::string_view expected) {
  if (done() || words_[next_] != expected) return false;
  ++next_;
  return true;
}

void LineReader::expect(std::string_view expected) {
  const std::string_view found = word(in_quotes(expected).c_str());
  if (found != expected) fail("expected " + in_quotes(expected) + ", found " + in_quotes(found));
}

double LineReader::number(const char* wanted, double lowest, double highest) {
  const std::string_view text = word(wanted);
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    fail(in_quotes(text) + " is not a finite number; expected " + wanted);
  if (value < lowest || value > highest) fail(in_quotes(text) + " is out of range for " + wanted);
  return value;
}

double LineReader::whole_number(const char* wanted, double lowest, double highest) {
  const double value = number(wanted, lowest, highest);
  if (value != std::floor(value)) fail("expected a whole number: " + std::string(wanted));
  return value;
}

Eigen::Vector3d LineReader::vector(const char* wanted, double limit) {
  const std::string most = format_general(limit, 6);
  const std::string wanted_each = std::string(wanted) + ", each from -" + most + " to " + most;
  Eigen::Vector3d value;
  for (int axis = 0; axis < 3; ++axis) value[axis] = number(wanted_each.c_str(), -limit, limit);
  return value;
}

void LineReader::expect_end() const {
  if (!done()) fail("unexpected " + in_quotes(words_[next_]) + ": the event is already complete");
}

}  // namespace

std::string object_of(const Action& action) {
  return std::visit(
      [](const auto& kind) -> std::string {
        if constexpr (requires { kind.name; })
          return kind.name;
        else
          return {};
      },
      action);
}

bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s) {
  return event.frame ? *event.frame <= run_frame : event.time_s && *event.time_s <= run_time_s;
}

namespace {

constexpr std::size_t kMaxBytes = 1U << 26U;  // a recorded day of dragging objects
constexpr double kMaxCoordinate_m = 1e8;      // for an object's origin, which may be far from its mesh
constexpr double kMaxSpeed_mps = 100.0;
constexpr double kMaxAngular_rad_s = 1000.0;
constexpr double kMaxTime_s = 1e6;

constexpr std::array<Word<SurfacePolicy>, 4> kSurfaces = {{{"holes", SurfacePolicy::kHoles},
                                                           {"skirt", SurfacePolicy::kSkirt},
                                                           {"border", SurfacePolicy::kBorder},
                                                           {"map", SurfacePolicy::kMap}}};
constexpr std::array<Word<bool>, 2> kUnknown = {{{"free", false}, {"solid", true}}};
constexpr auto kRadarModeWords = [] {
  std::array<Word<RadarMode>, kRadarModes.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = {to_string(kRadarModes[i]), kRadarModes[i]};
  return words;
}();
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

std::string read_name(LineReader& line) { return std::string(line.word("the object's name")); }

Eigen::Vector3d read_position(LineReader& line) {
  return line.vector("a position X Y Z (m)", kMaxCoordinate_m);
}

Eigen::Vector3d read_velocity(LineReader& line) {
  line.expect("velocity");
  return line.vector("a velocity X Y Z (m/s)", kMaxSpeed_mps);
}

/// Reads the optional orientation at the end of a line, in degrees.
std::optional<Eigen::Vector3d> read_turned(LineReader& line) {
  if (!line.take_if("turned")) return std::nullopt;
  return line.vector("the angles YAW PITCH ROLL (degrees)", 360.0);
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
void read_add_options(LineReader& line, AddObject& add) {
  while (!line.done()) {
    if (!add.source.size_m && line.take_if("size")) {
      add.source.size_m = line.number("a size (m), 0.001..10", 0.001, 10.0);
    } else if (!add.source.up && line.take_if("up")) {
      add.source.up = line.choice("the axis of the file that points up", kUpAxes);
    } else if (!read_material(line, add.material)) {
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

Action read_add(LineReader& line) {
  AddObject add{.name = read_name(line)};
  add.source.mesh = line.word("'teapot' or a mesh file");
  read_add_options(line, add);
  return add;
}

Action read_place(LineReader& line) {
  PlaceObject place{.name = read_name(line)};
  place.position_world = read_position(line);
  place.turned_deg = read_turned(line);
  return place;
}

Action read_stand(LineReader& line) {
  StandObject stand{.name = read_name(line)};
  stand.position_world = read_position(line);
  const char* const wanted = "a quaternion x y z w";
  for (double& value : stand.R_world_object.coeffs()) value = line.number(wanted, -1.1, 1.1);
  constexpr double kMostOff = 0.02;  // of rounded numbers
  if (!(std::abs(stand.R_world_object.norm() - 1.0) <= kMostOff))
    line.fail("the quaternion of 'stand " + stand.name + "' must have the length 1, within 2 %");
  // A quaternion that this program wrote is normalised already, and stays the same to the bit.
  if (std::abs(stand.R_world_object.norm() - 1.0) > 1e-12) stand.R_world_object.normalize();
  return stand;
}

Action read_drop(LineReader& line) {
  DropObject drop{.name = read_name(line)};
  if (line.take_if("near")) {
    drop.near_world = read_position(line);
  } else if (!line.take_if("view")) {
    line.expect("at");
    drop.position_world = read_position(line);
  }
  if (line.take_if("height")) drop.height_m = line.number("a height (m), 0..5", 0.0, 5.0);
  drop.turned_deg = read_turned(line);
  return drop;
}

Action read_throw(LineReader& line) {
  ThrowObject thrown{.name = read_name(line)};
  thrown.position_world = read_position(line);
  thrown.velocity_world_mps = read_velocity(line);
  if (line.take_if("spin"))
    thrown.angular_velocity_world_rad_s = line.vector("a spin X Y Z (rad/s)", kMaxAngular_rad_s);
  thrown.turned_deg = read_turned(line);
  return thrown;
}

Action read_change_material(LineReader& line) {
  ChangeMaterial change{.name = read_name(line)};
  if (!read_material(line, change.material))
    line.fail("'material " + change.name +
              "' is followed by mass, density, friction or restitution, and a number");
  while (read_material(line, change.material)) {
  }
  return change;
}

Action read_remove(LineReader& line) { return RemoveObject{.name = read_name(line)}; }

Action read_turn(LineReader& line) {
  TurnObject turn{.name = read_name(line)};
  turn.turn_world_deg = line.vector("a turn X Y Z (degrees about the world's axes)", kMaxTurn_deg);
  return turn;
}

Action read_carry(LineReader& line) {
  CarryObject carry{.name = read_name(line)};
  carry.position_world = read_position(line);
  return carry;
}

Action read_release(LineReader& line) {
  ReleaseObject release{.name = read_name(line)};
  release.velocity_world_mps = read_velocity(line);
  return release;
}

Action read_surfaces(LineReader& line) {
  return SetSurfaces{line.choice("the surfaces that can be touched", kSurfaces)};
}

Action read_unknown(LineReader& line) {
  return SetUnknown{line.choice("the state of unknown space", kUnknown)};
}

Action read_radar(LineReader& line) {
  SetRadar set;
  set.radar.mode = line.choice("the radar's mode", kRadarModeWords);
  set.radar.resolution_px = static_cast<int>(line.whole_number("pixels, 1..4096", 1.0, 4096.0));
  return set;
}

Action read_quality(LineReader& line) {
  SetQuality set;
  if (line.take_if("from")) set.from = line.choice("a part of the frame", kFramePartWords);
  while (!line.done()) {
    const std::string_view name = line.word("a setting's name");
    const std::string_view word = line.word("a setting's value");
    try {
      set_field(set.quality, name, word);
    } catch (const Error& fault) {
      line.fail(fault.what());
    }
  }
  return set;
}

Action read_camera(LineReader& line) { return PlayCamera{line.choice("a camera command", kCameraPlays)}; }

Action read_commit(LineReader& /*line*/) { return CommitChanges{}; }

Action read_quit(LineReader& /*line*/) { return Quit{}; }

/// Each action's keyword, and the function that reads the words after the keyword.
constexpr std::array<Word<Action (*)(LineReader&)>, 18> kActions = {
    {{"add", read_add},
     {"place", read_place},
     {"stand", read_stand},
     {"drop", read_drop},
     {"throw", read_throw},
     {"material", read_change_material},
     {"remove", read_remove},
     {"turn", read_turn},
     {"carry", read_carry},
     {"release", read_release},
     {"surfaces", read_surfaces},
     {"unknown", read_unknown},
     {"radar", read_radar},
     {"quality", read_quality},
     {"camera", read_camera},
     {"commit", read_commit},
     {"adopt", read_commit},  // of scripts of earlier versions
     {"quit", read_quit}}};

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

std::string turned_words(const std::optional<Eigen::Vector3d>& turned_deg) {
  return turned_deg ? " turned" + vector_words(*turned_deg) : std::string();
}

std::string add_words(const AddObject& add) {
  std::string words = "add " + add.name + " " + add.source.mesh;
  if (add.source.size_m) words += " size" + number_word(*add.source.size_m);
  if (add.source.up) words.append(" up ").append(to_string(*add.source.up));
  return words + material_words(add.material);
}

std::string drop_words(const DropObject& drop) {
  const std::string where = drop.position_world ? " at" + vector_words(*drop.position_world)
                            : drop.near_world   ? " near" + vector_words(*drop.near_world)
                                                : " view";
  return "drop " + drop.name + where + " height" + number_word(drop.height_m) + turned_words(drop.turned_deg);
}

std::string throw_words(const ThrowObject& thrown) {
  std::string words = "throw " + thrown.name + vector_words(thrown.position_world) + " velocity" +
                      vector_words(thrown.velocity_world_mps);
  if (!thrown.angular_velocity_world_rad_s.isZero(0.0))
    words += " spin" + vector_words(thrown.angular_velocity_world_rad_s);
  return words + turned_words(thrown.turned_deg);
}

std::string quality_words(const SetQuality& set) {
  std::string words = "quality";
  if (set.from != FramePart::kLocate) words.append(" from ").append(to_string(set.from));
  for (const auto& [name, word] : words_of(set.quality)) words += " " + name + " " + word;
  return words;
}

/// Returns the action's keyword and the words after it.
std::string action_words(const Action& action) {
  return std::visit(
      overloaded{
          [](const AddObject& add) { return add_words(add); },
          [](const PlaceObject& place) {
            return "place " + place.name + vector_words(place.position_world) +
                   turned_words(place.turned_deg);
          },
          [](const StandObject& stand) {
            const Eigen::Quaterniond& q = stand.R_world_object;
            return "stand " + stand.name + vector_words(stand.position_world) + number_word(q.x()) +
                   number_word(q.y()) + number_word(q.z()) + number_word(q.w());
          },
          [](const DropObject& drop) { return drop_words(drop); },
          [](const ThrowObject& thrown) { return throw_words(thrown); },
          [](const ChangeMaterial& change) {
            return "material " + change.name + material_words(change.material);
          },
          [](const RemoveObject& remove) { return "remove " + remove.name; },
          [](const TurnObject& turn) { return "turn " + turn.name + vector_words(turn.turn_world_deg); },
          [](const CarryObject& carry) { return "carry " + carry.name + vector_words(carry.position_world); },
          [](const ReleaseObject& release) {
            return "release " + release.name + " velocity" + vector_words(release.velocity_world_mps);
          },
          [](const SetSurfaces& set) { return "surfaces " + std::string(word_of(kSurfaces, set.surfaces)); },
          [](const SetUnknown& set) { return "unknown " + std::string(word_of(kUnknown, set.is_solid)); },
          [](const SetRadar& set) {
            return "radar " + std::string(to_string(set.radar.mode)) + " " +
                   std::to_string(set.radar.resolution_px);
          },
          [](const SetQuality& set) { return quality_words(set); },
          [](const PlayCamera& camera) {
            return "camera " + std::string(word_of(kCameraPlays, camera.play));
          },
          [](const CommitChanges&) { return std::string("commit"); },
          [](const Quit&) { return std::string("quit"); },
      },
      action);
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
    event.action = line.choice("an action", kActions)(line);
    line.expect_end();

    const std::string name = object_of(event.action);
    if (std::holds_alternative<AddObject>(event.action)) {
      const auto [first, is_new] = added_in_line.emplace(name, number);
      if (!is_new) line.fail(in_quotes(name) + " was already added in line " + std::to_string(first->second));
    } else if (!name.empty() && !added_in_line.contains(name)) {
      line.fail("no object " + in_quotes(name) + " was added in a line above; write 'frame 0 add " + name +
                " teapot' first");
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
    auto* const add = std::get_if<AddObject>(&event.action);
    if (add == nullptr || add->source.mesh == "teapot") continue;
    std::string& mesh = add->source.mesh;
    if (std::filesystem::path(mesh).is_relative()) mesh = (path.parent_path() / mesh).string();
  }
  return script;
}

std::string to_line(const ScriptEvent& event) {
  const std::string when =
      event.frame ? "frame " + std::to_string(*event.frame) : "time" + number_word(*event.time_s);
  return when + " " + action_words(event.action);
}

}  // namespace roomradar
