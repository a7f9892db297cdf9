// radar_bench_peers.hpp: other libraries that can compute the distance to contact, for comparison only.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radar_bench_poses.hpp"
#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

/// One collision library, on one thread. Its data for the object is built once; nothing built for the scene
/// outlives a call.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;
  virtual void set_sensor(const Mesh& sensor) = 0;
  /// Includes all work from the depth image to the result: culling of triangles, their tree, the query.
  /// @return nullopt if there is no contact within distance_m
  virtual std::optional<double> contact_distance_m(const FrameScene& frame, const Pose& pose,
                                                   double distance_m) = 0;
};

/// Loads the libraries whose modules are beside the program. For each of the others, `missing` receives a
/// line that names its package. Modules keep the libraries' code out of the program, which therefore also
/// runs without them.
std::vector<std::unique_ptr<Peer>> load_peers(std::vector<std::string>& missing);

}  // namespace roomradar::bench
