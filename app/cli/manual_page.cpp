// manual_page.cpp: generates the manual page from the command line's help.
#include "app/cli/manual_page.hpp"

#include <CLI/CLI.hpp>
#include <string_view>

#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kSections = R"(.SH SOURCES
A SOURCE is one of
.TP
.BR kinect: N
a Kinect v1, numbered from 0; it continues until Ctrl-C is pressed once
.TP
.BR sim: ROOM [ ?key=value & ... ]
a simulated Kinect in the room
.BR table ", " shelf ", " wall ", " random " or " board ;
keys are seed, frames, rate, path (scan, view, swing), moving (hand, ball, person, with commas between them), pace
(steady, slow, waits, leaves), noise (0 is none, 1 a Kinect's), crate (0, 1, comes, goes), width (pixels of the image),
colour (registered, separate, none) and faults (1: the cameras deviate from their stated parameters)
.TP
.I DIR
a recording, recognised by its files: 7-Scenes (frame-XXXXXX.depth.png, .color.jpg, .png or, empty, .none, .pose.txt), TUM RGB-D
(depth.txt, rgb.txt), fakenect (INDEX.txt), or numbered images (depth/00000.png, color/00000.jpg). A camera.json in
it gives the cameras, a calibration.json their errors: \fBroomradar record\fR and \fBcalibrate\fR write these.
.SH SCRIPT
The events file of
.B run \-\-script
has one event per line, in the order of execution, each due before a frame of the run or at a time (s). Positions are in
the map's world (m, z up), velocities in m/s, # begins a comment.
.nf
frame 0    add pot teapot size 0.2           # or a mesh file
frame 10   drop pot view height 0.3          # over a level surface that the camera sees
frame 11   drop pot near 0.4 -0.1 0.7        # over the one nearest to this point, at most 25 cm away
time 2.5   drop pot at 0.4 \-0.1 0.75 height 0.3
time 4     place pot 0.4 \-0.1 0.9            # drop, place, throw may end: turned YAW PITCH ROLL (degrees)
time 5     throw pot 0.4 \-0.1 1.2 velocity 1 0 0.5
time 5.5   throw pot 0.4 \-0.1 1.2 velocity 1 0 0.5 spin 0 6 0      # rad/s about x y z
time 5.5   turn pot 0 0 45                   # about the world's axes, degrees
time 5.6   carry pot 0.4 \-0.1 1.0
time 5.9   release pot velocity 0 0 0
time 6     remove pot
time 7     adopt                             # objects in view that stand still become part of the room
frame 200  surfaces skirt                    # holes, skirt, border or map
frame 210  unknown solid                     # or free
frame 220  radar sampled 64                  # exact or sampled; pixels
frame 225  quality depth_stride 2 shadows off  # others get their defaults; options keep theirs
frame 230  camera hold                       # go, rewind, loop, stay or resume
frame 300  quit
.fi
.SH FILES
.TP
.I MAP/
a saved map: map.json (facts and checksums), the octree as .ot and .bt, the mesh, the keyframe database for
localisation, trajectory.txt and coverage.png. It is saved completely or not at all.
.TP
.I MAP.unfinished
checkpoint of an interrupted scan, for
.BR "prescan \-\-resume" .
.SH ENVIRONMENT
.TP
.B ROOMRADAR_RENDERER
.B gpu
or
.B software
selects one; otherwise a GPU is used if there is one.
.SH EXIT STATUS
0: done. 1: the work failed; standard error says what, where and what to do. 2: wrong usage.
.SH EXAMPLES
.nf
roomradar doctor
roomradar prescan kinect:0 \-\-map maps/kitchen \-\-report prescan.json
roomradar run kinect:0 \-\-map maps/kitchen \-\-video ar.mp4
roomradar map export maps/kitchen kitchen.glb
roomradar simulate table \-\-room table \-\-frames 600
.fi
.SH SEE ALSO
.BR fakenect (1),
.BR octovis (1)
)";

/// Escapes text for man(7): no line becomes a request, and a minus stays a minus.
std::string escaped(std::string_view text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    begins_line = c == '\n';
  }
  return result;
}

std::string usage_of(const CLI::App& command, const std::string& name) {
  std::string usage = ".B " + escaped(name) + "\n";
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      const std::string& word = option->get_name(true);
      usage += ".I " + escaped(option->get_required() ? word : "[" + word + "]") + "\n";
    } else if (option->get_required()) {
      usage += ".BI " + escaped(option->get_name()) + " \" " + escaped(option->get_type_name()) + "\"\n";
    }
  }
  return usage + "[\n.I options\n]\n";
}

std::string options_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty() || option->get_name(false, true) == "-h,--help") continue;
    const std::string type = option->get_type_name();
    text += ".TP\n";
    if (option->get_positional())
      text += ".I " + escaped(option->get_name(true)) + "\n";
    else if (type.empty())
      text += ".B " + escaped(option->get_name()) + "\n";
    else
      text += ".BI " + escaped(option->get_name()) + " \" " + escaped(type) + "\"\n";
    text += escaped(option->get_description()) + "\n";
  }
  return text;
}

std::string command_section(const CLI::App& command, const std::string& name) {
  std::string text = ".SS " + escaped(name) + "\n" + escaped(command.get_description()) + "\n";
  const auto parts = command.get_subcommands([](const CLI::App*) { return true; });
  if (!parts.empty()) {
    for (const CLI::App* part : parts) text += command_section(*part, name + " " + part->get_name());
    return text;
  }
  return text + ".PP\n" + usage_of(command, name) + options_of(command);
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string page = ".TH ROOMRADAR 1 \"\" \"roomradar " + std::string(kVersion) + "\" \"User Commands\"\n";
  page +=
      ".SH NAME\nroomradar \\- prescan a room with a Kinect, then run augmented reality in the saved map\n"
      ".SH SYNOPSIS\n.B roomradar\n.I command\n[\n.I arguments\n]\n.SH DESCRIPTION\n" +
      escaped(app.get_description()) +
      "\nResults go to standard output, progress and messages to standard error.\n.SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    page += command_section(*command, command->get_name());
  return page + std::string(kSections);
}

}  // namespace roomradar
