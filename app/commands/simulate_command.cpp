// simulate_command.cpp: roomradar simulate: records a simulated Kinect, with ground truth.
#include "app/commands/commands.hpp"

#include <cstdio>
#include <optional>
#include <string>

#include "app/cli/progress.hpp"
#include "app/sim/simulate.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

namespace {

/// Builds a `sim:` source from the options, so simulations are described in one syntax only.
std::string spec_of(const SimulateOptions& options) {
  std::string spec = "sim:" + options.room;
  const auto say = [&spec](const std::string& key, const std::string& value) {
    spec.append(spec.find('?') == std::string::npos ? "?" : "&").append(key).append("=").append(value);
  };
  if (options.seed) say("seed", std::to_string(*options.seed));
  if (options.frames) say("frames", std::to_string(*options.frames));
  if (!options.path.empty()) say("path", options.path);
  if (!options.moving.empty()) say("moving", options.moving);
  return spec;
}

int record_walks(const SimulateOptions& options) {
  std::optional<Progress> progress;
  std::int64_t frames = 0;
  simulate_walks(options.folder, parse_sim_spec(spec_of(options)), options.walks->first, options.walks->last,
                 options.format, [&](const std::string& name, std::int64_t done, std::int64_t total) {
                   if (done == 1) progress.reset();
                   if (done == 1) progress.emplace("simulating " + name, total);
                   progress->step();
                   ++frames;
                 });
  progress.reset();
  const std::int64_t walks = options.walks->last - options.walks->first + 1;
  std::printf("%s: %lld recordings, %lld frames, listed in recordings.txt\n", options.folder.c_str(),
              static_cast<long long>(walks), static_cast<long long>(frames));
  return 0;
}

}  // namespace

int run(const SimulateOptions& options) {
  require_contents_outside_maps(options.folder);
  if (options.walks) return record_walks(options);
  std::optional<Progress> progress;
  std::int64_t frames = 0;
  simulate(options.folder, parse_sim_spec(spec_of(options)), options.format,
           [&](std::int64_t /*done*/, std::int64_t total) {
             if (!progress) progress.emplace("simulating", total);
             progress->step();
             ++frames;
           });
  progress.reset();
  std::printf("%s: %lld frames, the truth in truth/\n", options.folder.c_str(),
              static_cast<long long>(frames));
  return 0;
}

}  // namespace roomradar
