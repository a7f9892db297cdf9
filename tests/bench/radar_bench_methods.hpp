// radar_bench_methods.hpp: everything that is measured, as one question: how far may the object go?
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

/// One way to answer, with the scene new in each call: from a depth image, or a mesh, that it has not seen
/// before.
struct Method {
  std::string name;
  int radar_px = 0;  ///< 0: has no pixels
  bool gives_bounds = true;
  std::function<Contact(const Pose&)> query;
};

/// From the depth image to the answer.
Method radar_on_depth(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                      double distance_m);
/// From triangles that live one frame to the answer: their tree, the question.
Method radar_on_mesh(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                     double distance_m);
/// From triangles in memory to the answer: upload, two passes, reading back.
Method gl_radar_on_mesh(GlContext& context, const FrameScene& frame, const Mesh& sensor, int radar_px,
                        double distance_m);
/// `peer` must stay while the method is used and has this sensor from now on.
Method peer_on_depth(Peer& peer, const FrameScene& frame, const Mesh& sensor, double distance_m);

}  // namespace roomradar::bench
