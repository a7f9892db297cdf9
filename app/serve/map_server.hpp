// map_server.hpp: the HTTP server over the maps.
#pragma once
#include <memory>
#include <string>

#include "app/serve/access.hpp"
#include "app/serve/map_requests.hpp"

namespace roomradar {

struct MapServerConfig {
  ListenAddress address;
  std::string token;  ///< empty: none is asked for
  bool verbose = false;
  int connections = 24;     ///< answered at a time; as many again wait, more wait in the system's queue
  int locating = 0;         ///< frames located at a time; 0: one per processor
  int locating_waits = 16;  ///< requests that wait for that; more are told to come back (503)
};

/// Answers requests, each connection in one request: no client holds a thread while it asks nothing. Requests
/// have limits of size (kMaxLocateBody_bytes) and of silence (5 s). Without cpp-httplib, making one throws.
class MapServer {
 public:
  /// Binds the address. Throws Error if it cannot be used.
  MapServer(MapServerConfig config, MapCatalogue catalogue);
  ~MapServer();
  MapServer(const MapServer&) = delete;
  MapServer& operator=(const MapServer&) = delete;

  [[nodiscard]] int port() const;
  /// Answers requests until stop() is called; then finishes those that have begun.
  void run();
  /// May be called from another thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
