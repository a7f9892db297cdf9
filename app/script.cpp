// script.cpp: the events file of `roomradar run --script FILE`.
#include "app/script.hpp"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <system_error>

#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMaxBytes = 1U << 20U;
constexpr double kMaxCoordinate_m = 1000.0;  // farther away than any room
constexpr double kMaxSpeed_mps = 100.0;
constexpr double kMaxSpin_rad_s = 1000.0;
constexpr double kMaxTime_s = 1e6;

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result.append(text).append("'");
  return result;
}

/// The words of one line, taken one after the other; every complaint names the file and the line.
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
    if (found != expected) fail(in_quotes(found) + " stands where " + in_quotes(expected) + " is wanted");
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

/// The rest of the line, if it says how the object stands.
void read_turned(LineReader& line, ScriptEvent& event) {
  if (!line.take_if("turned")) return;
  const Eigen::Vector3d angles =
      line.vector("the angles YAW PITCH ROLL (degrees), -360..360", 360.0) * (std::numbers::pi / 180.0);
  event.R_world_object = (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitX()))
                             .toRotationMatrix();
}

void read_when(LineReader& line, ScriptEvent& event) {
  const std::string_view when = line.word("'frame' or 'time'");
  if (when == "frame") {
    const double frame = line.number("a frame number, a whole number from 0", 0.0, 1e12);
    if (frame != std::floor(frame)) line.fail("a frame number is a whole number");
    event.frame = static_cast<std::int64_t>(frame);
  } else if (when == "time") {
    event.time_s = line.number("a time in seconds, from 0", 0.0, kMaxTime_s);
  } else {
    line.fail("an event begins with 'frame N' or 'time SECONDS', not with " + in_quotes(when));
  }
}

void read_action(LineReader& line, ScriptEvent& event) {
  const std::string_view action = line.word("an action: add, place, drop, throw, remove, adopt or quit");
  if (action == "adopt") {
    event.action = Action::kAdopt;
    return;
  }
  if (action == "quit") {
    event.action = Action::kQuit;
    return;
  }
  const bool known =
      action == "add" || action == "place" || action == "drop" || action == "throw" || action == "remove";
  if (!known)
    line.fail("unknown action " + in_quotes(action) +
              "; there are add, place, drop, throw, remove, adopt and quit");
  event.name = line.word("the object's name");
  if (action == "add") {
    event.action = Action::kAdd;
    event.mesh = line.word("'teapot' or a mesh file");
    if (line.take_if("size")) event.size_m = line.number("a size (m), 0.001..10", 0.001, 10.0);
  } else if (action == "place") {
    event.action = Action::kPlace;
    event.position_world = read_position(line);
    read_turned(line, event);
  } else if (action == "drop") {
    event.action = Action::kDrop;
    if (!line.take_if("view")) {
      line.expect("at");
      event.position_world = read_position(line);
    }
    if (line.take_if("height")) event.height_m = line.number("a height (m), 0..5", 0.0, 5.0);
    read_turned(line, event);
  } else if (action == "throw") {
    event.action = Action::kThrow;
    event.position_world = read_position(line);
    line.expect("velocity");
    event.velocity_world_mps = line.vector("a velocity X Y Z (m/s)", kMaxSpeed_mps);
    if (line.take_if("spin")) event.spin_world_rad_s = line.vector("a spin X Y Z (rad/s)", kMaxSpin_rad_s);
    read_turned(line, event);
  } else {
    event.action = Action::kRemove;
  }
}

}  // namespace

Script parse_script(std::string_view text, std::string_view where) {
  if (text.find('\0') != std::string_view::npos)
    throw Error(std::string(where) + ": is not text; give a file with one event a line");
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

Script read_script(const std::filesystem::path& path) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(path, fault))
    throw Error(path.string() + ": no such file; --script wants a text file with one event a line");
  const std::uintmax_t bytes = std::filesystem::file_size(path, fault);
  if (fault || bytes > kMaxBytes)
    throw Error(path.string() + ": is longer than 1 MiB; that is no events file");
  std::ifstream file(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(bytes), '\0');
  if (!file || !file.read(text.data(), static_cast<std::streamsize>(bytes)))
    throw Error(path.string() + ": cannot be read");

  Script script = parse_script(text, path.string());
  for (ScriptEvent& event : script.events) {
    const bool is_file = event.action == Action::kAdd && event.mesh != "teapot";
    if (is_file && std::filesystem::path(event.mesh).is_relative())
      event.mesh = (path.parent_path() / event.mesh).string();
  }
  return script;
}

bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s) {
  return event.frame ? *event.frame <= run_frame : event.time_s && *event.time_s <= run_time_s;
}

}  // namespace roomradar
