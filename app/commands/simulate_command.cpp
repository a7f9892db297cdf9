// simulate_command.cpp: roomradar simulate: records a simulated Kinect, with ground truth.
#include <cstdio>

#include "app/cli/progress.hpp"
#include "app/commands/commands.hpp"
#include "app/sim/simulate.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

int run(const SimulateCommand& command) {
  require_contents_outside_maps(command.folder);
  // Builds a `sim:` source from the options, so simulations are described in one syntax only.
  std::string spec = "sim:" + command.room + "?seed=" + std::to_string(command.seed) +
                     "&frames=" + std::to_string(command.frames) + "&path=" + command.path;
  if (!command.moving.empty()) spec += "&moving=" + command.moving;
  {
    Progress progress("simulating", command.frames);
    simulate(command.folder, parse_sim_spec(spec), command.format,
             [&](std::int64_t /*done*/, std::int64_t /*total*/) { progress.step(); });
  }
  std::printf("%s: %lld frames, the truth in truth/\n", command.folder.c_str(),
              static_cast<long long>(command.frames));
  return 0;
}

}  // namespace roomradar
