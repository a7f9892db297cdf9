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
  int connections = 24;     ///< max concurrent requests; as many are queued here, further ones by the system
  int locating = 0;         ///< max concurrent locate requests; 0: one per processor
  int locating_waits = 16;  ///< max queued locate requests; others get status 503
};

/// Answers requests. A connection is closed after one request, so idle clients occupy no thread. Requests are
/// limited in size (kMaxLocateBody_bytes). Reads and writes time out after 5 s without data. The constructor
/// throws Error in builds without cpp-httplib.
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
