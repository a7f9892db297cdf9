// radar_bench_peers.hpp: other libraries that can say how far an object may go, for comparison only.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radar_bench_poses.hpp"
#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

/// One collision library, on one thread. What it keeps of the object is made once; of the scene, nothing
/// outlives a call.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;
  virtual void set_sensor(const Mesh& sensor) = 0;
  /// From the depth image to the answer: the triangles in the way, their tree, the question.
  /// @return nothing if there is no contact within distance_m
  virtual std::optional<double> contact_distance_m(const FrameScene& frame, const Pose& pose,
                                                   double distance_m) = 0;
};

/// The libraries whose modules lie beside the program and load. Of each other one a line of `missing` says
/// which package brings it. The modules keep their own code from the program, so that it runs where they
/// cannot.
std::vector<std::unique_ptr<Peer>> load_peers(std::vector<std::string>& missing);

}  // namespace roomradar::bench
