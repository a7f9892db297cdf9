// manual_page.cpp: the manual page from the command line's own help.
#include "app/manual_page.hpp"

#include <CLI/CLI.hpp>
#include <string_view>

#include "mapping/types/version.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kSections = R"(.SH SOURCES
A SOURCE is one of
.TP
.BR kinect: N
a Kinect v1, the first being 0
.TP
.BR sim: ROOM [ ?key=value & ... ]
a simulated Kinect in the room
.BR table ", " shelf ", " wall ", " random " or " board ;
keys are seed, frames, rate, path, moving, noise and others
.TP
.I DIR
a recording, recognised by what is in it: 7-Scenes (frame-XXXXXX.depth.png, .color.jpg, .png or, empty, .none, .pose.txt), TUM RGB-D
(depth.txt, rgb.txt), fakenect (INDEX.txt), or numbered images (depth/00000.png, color/00000.jpg). A camera.json in
it gives the cameras, a calibration.json their errors.
.SH FILES
.TP
.I MAP/
a saved map: map.json (facts and checksums), the octree as .ot and .bt, the mesh, the places by which a camera is
found again, trajectory.txt and coverage.png. It is saved whole or not at all.
.TP
.I MAP.unfinished
what a scan that was cut off has done so far, for
.BR "prescan \-\-resume" .
.SH ENVIRONMENT
.TP
.B ROOMRADAR_RENDERER
.B gpu
or
.B software
insists on one; else a GPU is taken where there is one.
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

/// Text as man(7) takes it: nothing in it is a request, a minus is a minus.
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
