// map_server.hpp: HTTP server for maps.
#pragma once
#include <memory>
#include <string>

#include "app/serve/access.hpp"
#include "app/serve/map_requests.hpp"

namespace roomradar {

struct MapServerConfig {
  ListenAddress address;
  std::string token;  ///< empty: requests need no token
  bool verbose = false;
  int connections = 24;     ///< max answered at a time; as many again wait, others in the system's queue
  int locating = 0;         ///< max frames located at a time; 0: one per processor
  int locating_waits = 16;  ///< max requests that wait to be located; others get status 503
};

/// Answers requests. A connection is closed after one request, so idle clients hold no thread. Requests have
/// a max size (kMaxLocateBody_bytes) and a max silence (5 s). The constructor throws Error in builds without
/// cpp-httplib.
class MapServer {
 public:
  /// Binds the address. Throws Error if it cannot be used.
  MapServer(MapServerConfig config, MapCatalogue catalogue);
  ~MapServer();
  MapServer(const MapServer&) = delete;
  MapServer& operator=(const MapServer&) = delete;

  [[nodiscard]] int port() const;
  /// Answers requests until stop() is called, then completes the requests that have begun. Throws Error if
  /// the system closes the socket.
  void run();
  /// May be called from another thread.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
