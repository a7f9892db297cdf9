// simulate_command.cpp: roomradar simulate: records a simulated Kinect, with ground truth.
#include "app/commands/simulate_command.hpp"

#include <cstdio>

#include "app/cli/progress.hpp"
#include "app/sim/simulate.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

int run(const SimulateOptions& options) {
  require_contents_outside_maps(options.folder);
  // Builds a `sim:` source from the options, so simulations are described in one syntax only.
  std::string spec = "sim:" + options.room + "?seed=" + std::to_string(options.seed) +
                     "&frames=" + std::to_string(options.frames) + "&path=" + options.path;
  if (!options.moving.empty()) spec += "&moving=" + options.moving;
  {
    Progress progress("simulating", options.frames);
    simulate(options.folder, parse_sim_spec(spec), options.format,
             [&](std::int64_t /*done*/, std::int64_t /*total*/) { progress.step(); });
  }
  std::printf("%s: %lld frames, the truth in truth/\n", options.folder.c_str(),
              static_cast<long long>(options.frames));
  return 0;
}

}  // namespace roomradar
