// input_options.cpp: names, help texts and checks of the options about a recording's input.
#include "app/cli/options/input_options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli/options/option_checks.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

const std::map<std::string, StampChoice>& stamp_words() {
  static const std::map<std::string, StampChoice> words = {
      {"auto", StampChoice::kAuto},       {"reception", StampChoice::kReception},
      {"index", StampChoice::kIndex},     {"s", StampChoice::kSeconds},
      {"ms", StampChoice::kMilliseconds}, {"us", StampChoice::kMicroseconds},
      {"ns", StampChoice::kNanoseconds}};
  return words;
}

}  // namespace

void add_input_options(CLI::App& command, InputOptions& options) {
  command
      .add_option_function<double>(
          "--depth-unit", [&options](double unit_m) { options.depth_unit_m = unit_m; },
          "length in metres of one unit of the recorded depth: 0.001 for millimetres, 0.0002 for TUM's\n"
          "(default: as the recording or its format states)")
      ->check(within(1e-7, 1000.0, "metres"))
      ->type_name("M");
  command
      .add_option(
          "--camera", options.camera,
          "cameras of the recording: a camera.json, or a text file with the 3 x 3 matrix of the depth\n"
          "camera (default: as the recording states)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--poses-convention",
          [&options](const std::string& text) {
            options.poses_convention = parse_pose_convention(text);
            if (!options.poses_convention)
              throw CLI::ValidationError(
                  "--poses-convention " + text +
                  ": must be stated, or a list of inverse, opengl, wxyz, mm, cm, as in "
                  "inverse,opengl");
          },
          "convention of the recorded poses: stated (that of the format), or a list of inverse (world to\n"
          "camera), opengl (camera with y up, z backwards), wxyz (order of quaternions), mm, cm\n"
          "(default: the one under which the depth of nearby frames agrees)")
      ->type_name("LIST");
  add_choice<StampChoice>(
      command, "--stamps", options.stamps, stamp_words(),
      "times of the recorded images: their stamps, repaired where they cannot be right (auto);\n"
      "times of reception; image numbers at 30 per second (index); or stamps in this unit");
  command
      .add_option("--depth-topic", options.depth_topic,
                  "topic of a ROS recording with the depth images (default: one that is registered to\n"
                  "colour and has a camera_info, if there is one)")
      ->type_name("NAME");
}

SourceOptions source_options_of(const InputOptions& options) {
  SourceOptions source;
  source.depth_unit_m = options.depth_unit_m;
  source.camera_file = options.camera;
  source.pose_convention = options.poses_convention;
  source.stamps = options.stamps;
  source.depth_topic = options.depth_topic;
  return source;
}

std::string words_of(const InputOptions& options) {
  std::string words;
  if (options.depth_unit_m) words += " --depth-unit " + format_number(*options.depth_unit_m);
  if (!options.camera.empty()) words += " --camera " + options.camera;
  if (options.poses_convention) words += " --poses-convention " + to_string(*options.poses_convention);
  if (options.stamps != StampChoice::kAuto) words += " --stamps " + to_string(options.stamps);
  if (!options.depth_topic.empty()) words += " --depth-topic " + options.depth_topic;
  return words;
}

std::string to_string(StampChoice choice) {
  for (const auto& [word, meaning] : stamp_words())
    if (meaning == choice) return word;
  return "auto";
}

}  // namespace roomradar
