// script.hpp: reads the events file of `roomradar run --script FILE`, a list of timed actions.
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/session/script/script_event.hpp"

namespace roomradar {

/// Events in the order of the file, which is the order of execution. An event is executed when it is due and
/// all events before it have been executed. All numbers are finite. Each name is added once, before its first
/// use.
struct Script {
  std::vector<ScriptEvent> events;
};

/// Returns true if an event of the script has this kind of action.
template <typename Kind>
bool has(const Script& script) {
  return std::any_of(script.events.begin(), script.events.end(),
                     [](const ScriptEvent& event) { return std::holds_alternative<Kind>(event.action); });
}

/// Treatment of a last line without a line end. kWhole reads the line as an event. kMayBeCut ignores the
/// line, since its writing may have been interrupted.
enum class LastLine { kWhole, kMayBeCut };

/// Reads an events file. One event per line, words separated by spaces or tabs, # begins a comment:
///
///     frame 0    add pot teapot size 0.2
///     frame 0    add chair chair.obj size 0.9 up z        longest side (m); axis of the file that points up
///     frame 0    add ball ball.obj density 600 friction 0.3 restitution 0.8     kg/m3, 1..30000; friction on
///                                                 the room 0..10; 0..1. Or mass 0.5 instead of density, kg
///     frame 10   drop pot view height 0.3         above the free level surface nearest to the image centre
///     frame 11   drop pot near 0.4 -0.1 0.7       above the one nearest to this point, at most 25 cm away
///     time 2.5   drop pot at 0.4 -0.1 0.75 height 0.3
///     time 4     place pot 0.4 -0.1 0.9
///     time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 0.5
///     time 5.5   throw pot 0.4 -0.1 1.2 velocity 1 0 0.5 spin 0 6 0     at most 20 m/s, 60 rad/s about x y z
///     time 5.5   turn pot 0 0 45                  about the world's axes (degrees)
///     time 5.6   carry pot 0.4 -0.1 1.0           moved to this position and held there
///     time 5.9   release pot velocity 0 0 0
///     time 5.9   material pot mass 2 friction 0.1       others are unchanged; also density, restitution
///     time 6     remove pot
///     time 7     commit                          stationary objects in view are added to the map
///     frame 200  surfaces skirt                   holes, skirt, border or map
///     frame 210  unknown solid                    or free
///     frame 220  radar sampled 64                 mode exact, sampled or passes; resolution in pixels
///     frame 225  quality depth_stride 2 shadows off       others as on the command line, or default
///     frame 226  quality from physics move_every_n_frames 4      from the physics stage on; or mesh, compose
///     frame 230  camera hold                      repeats this frame; or go, rewind, loop, stay, resume
///     frame 300  quit
///
/// place, throw and drop put an object that would overlap another object on top of it, if no surface of the
/// room is in the way. These three actions may end with `turned YAW PITCH ROLL`: degrees about z, then about
/// the rotated y axis, then about the rotated x axis. Without `turned`, an object keeps its last orientation,
/// initially upright.
///
/// Throws Error "FILE:LINE: ..." with the text found and the text expected. Errors in words are unknown,
/// missing and surplus words, and names that are not added or added twice. Errors in numbers are malformed,
/// non-finite and out-of-range numbers, and negative frames and times. Throws Error for a file that is
/// unreadable, binary or longer than 64 MiB.
Script read_script(const std::filesystem::path& path, LastLine last_line = LastLine::kWhole);

/// Parses the text of an events file. Error messages contain `where` in place of the file's name. Relative
/// mesh paths are returned unchanged.
Script parse_script(std::string_view text, std::string_view where);

/// Returns the event as a line of an events file, without a line end. parse_script() restores all fields
/// exactly, except ScriptEvent::line and ObjectSource::origin.
std::string to_line(const ScriptEvent& event);

}  // namespace roomradar
