// radar_bench_methods.hpp: all measured methods behind one interface: distance to contact.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar_bench_peers.hpp"
#include "radar_bench_poses.hpp"
#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

/// A method to compute the distance to contact. Each call receives a depth image or a mesh that the method
/// has not seen before.
struct Method {
  std::string name;
  int radar_px = 0;  ///< 0: the method has no pixels
  bool gives_bounds = true;
  std::function<Contact(const Pose&)> query;
};

/// Includes all work from the depth image to the result.
Method radar_on_depth(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                      double distance_m);
/// Includes all work from triangles that exist for one frame to the result: building their tree, the query.
Method radar_on_mesh(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                     double distance_m);
/// Includes all work from triangles in memory to the result: upload, two passes, readback.
Method gl_radar_on_mesh(GlContext& context, const FrameScene& frame, const Mesh& sensor, int radar_px,
                        double distance_m);
/// Sets the sensor of `peer`, which must outlive the method.
Method peer_on_depth(Peer& peer, const FrameScene& frame, const Mesh& sensor, double distance_m);

}  // namespace roomradar::bench
