// input_lines.cpp: one line per decision, and the options as settings.
#include "app/cli/input_lines.hpp"

#include <unistd.h>

#include <cstdio>
#include <vector>

namespace roomradar {

void InputLines::say() {
  const std::vector<InputDecision> decisions = report_.decisions();
  // On a terminal the progress line has no line end.
  const char* begin = said_ > 0 && isatty(STDERR_FILENO) != 0 ? "\n" : "";
  for (; said_ < decisions.size(); ++said_, begin = "")
    std::fprintf(stderr, "%sroomradar: %s: %s\n", begin, source_.c_str(), line_of(decisions[said_]).c_str());
}

void add_to(nlohmann::json& settings, const InputOptions& options) {
  if (options.depth_unit_m) settings["depth_unit"] = *options.depth_unit_m;
  if (!options.camera.empty()) settings["camera"] = options.camera;
  if (options.poses_convention) settings["poses_convention"] = to_string(*options.poses_convention);
  if (options.stamps != StampChoice::kAuto) settings["stamps"] = to_string(options.stamps);
  if (!options.depth_topic.empty()) settings["depth_topic"] = options.depth_topic;
}

}  // namespace roomradar
