// serve_command.cpp: refuses unsafe starts, then serves until Ctrl-C.
#include "app/serve/serve_command.hpp"

#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <set>
#include <thread>
#include <utility>

#include "app/cli/interrupt.hpp"
#include "app/serve/map_server.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

MapCatalogue catalogue_of(const ServeOptions& options) {
  MapCatalogue catalogue;
  std::set<std::string> names;
  for (const std::string& folder : options.maps) {
    catalogue.maps.push_back(std::make_unique<ServedMap>(folder));
    if (!names.insert(catalogue.maps.back()->name()).second)
      throw Error(folder + ": another map has the name " + catalogue.maps.back()->name() +
                  "; maps are served by their folders' names");
    (void)catalogue.maps.back()
        ->current()
        ->keyframes();  // a fault is told now, and the first frame does not wait
  }
  if (!options.anchor.empty()) {
    if (options.maps.size() > 1)
      throw Error("--anchor applies to a single map; serve each map with its own server");
    catalogue.anchor = parse_geo_anchor(options.anchor);
  }
  return catalogue;
}

MapServerConfig config_of(const ServeOptions& options) {
  MapServerConfig config;
  config.address = parse_listen_address(options.listen);
  config.verbose = options.verbose;
  if (!options.token_file.empty()) config.token = read_token(options.token_file);
  if (is_loopback(config.address)) return config;
  if (!options.allow_remote)
    throw Error(
        "--listen " + options.listen +
        ": other machines could read the maps; add --allow-remote and --token-file if this is intended");
  if (config.token.empty())
    throw Error("--listen " + options.listen +
                ": needs --token-file, since other machines reach this address");
  return config;
}

}  // namespace

int run(const ServeOptions& options) {
  // Threads are there for requests. Many arenas would keep memory of past ones.
  cv::setNumThreads(1);
  ::mallopt(M_ARENA_MAX, 2);
  MapServerConfig config = config_of(options);
  const std::string host = config.address.host.find(':') == std::string::npos
                               ? config.address.host
                               : "[" + config.address.host + "]";
  MapServer server(std::move(config), catalogue_of(options));
  const Interrupt interrupt;
  Interrupt::say("roomradar: requests that have begun are answered, then the server ends\n");
  std::exception_ptr fault;
  std::atomic<bool> has_ended = false;
  std::thread serving([&] {
    try {
      server.run();
    } catch (...) {
      fault = std::current_exception();
    }
    has_ended = true;
  });
  std::printf("listening on http://%s:%d\n", host.c_str(), server.port());
  std::fflush(stdout);
  while (!has_ended && !Interrupt::was_pressed()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const bool was_asked = Interrupt::was_pressed();
  server.stop();
  serving.join();
  if (fault && !was_asked) std::rethrow_exception(fault);
  return 0;
}

}  // namespace roomradar
