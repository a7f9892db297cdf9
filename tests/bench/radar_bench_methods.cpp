// radar_bench_methods.cpp: our modes and the peers behind one interface.
#include "radar_bench_methods.hpp"

#include "radar/batch/gl_radar.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar::bench {
namespace {

/// A radar with the trees of its object and scene.
struct ProcessorRadar {
  CyberRadar radar;
  TriangleTree sensor;
  TriangleTree scene;
  ProcessorRadar(const Mesh& mesh, RadarMode mode, int radar_px)
      : radar({.mode = mode, .resolution_px = radar_px}) {
    sensor.build_by_place(mesh);
  }
  Contact query(const Pose& pose, double distance_m, const RadarScene& in) {
    RadarQuery question;
    question.object = {&sensor, pose.T_world_sensor};
    question.direction_world = pose.direction_world;
    question.distance_m = distance_m;
    return radar.query(question, in);
  }
};

const char* name_of(RadarMode mode) { return mode == RadarMode::kExact ? "exact" : "sampled"; }

}  // namespace

Method radar_on_depth(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                      double distance_m) {
  auto radar = std::make_shared<ProcessorRadar>(sensor, mode, radar_px);
  SceneDepth depth;
  depth.depth_m = &frame.depth_m;
  depth.camera = frame.camera;
  depth.stride_px = frame.stride_px;
  depth.max_jump_m = 1e6F;  // keeps all cells
  return {name_of(mode), radar_px, true, [=](const Pose& pose) {
            return radar->query(pose, distance_m, {.trees = {}, .depths = {&depth, 1}});
          }};
}

Method radar_on_mesh(const FrameScene& frame, const Mesh& sensor, RadarMode mode, int radar_px,
                     double distance_m) {
  auto radar = std::make_shared<ProcessorRadar>(sensor, mode, radar_px);
  const Mesh* const mesh = &frame.mesh;
  return {std::string(name_of(mode)) + ", mesh", radar_px, true, [=](const Pose& pose) {
            radar->scene.build_in_order(*mesh);
            const SceneTree tree{{&radar->scene, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic};
            return radar->query(pose, distance_m, {.trees = {&tree, 1}, .depths = {}});
          }};
}

Method gl_radar_on_mesh(GlContext& context, const FrameScene& frame, const Mesh& sensor, int radar_px,
                        double distance_m) {
  struct State {
    GlRadar radar;
    GpuMesh scene, sensor;
    State(GlContext& gl, int px) : radar(gl, {.resolution_px = px}), scene(gl), sensor(gl) {}
  };
  auto state = std::make_shared<State>(context, radar_px);
  state->sensor.upload(sensor, MeshUsage::kStatic);
  const Mesh* const mesh = &frame.mesh;
  return {"GL", radar_px, true, [=](const Pose& pose) {
            state->scene.upload(*mesh, MeshUsage::kStreamed);
            const GpuSceneMesh scene{{&state->scene, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic};
            return state->radar.query({&state->sensor, pose.T_world_sensor}, pose.direction_world, distance_m,
                                      {&scene, 1});
          }};
}

Method peer_on_depth(Peer& peer, const FrameScene& frame, const Mesh& sensor, double distance_m) {
  peer.set_sensor(sensor);
  return {peer.name(), 0, false, [&peer, &frame, distance_m](const Pose& pose) {
            Contact contact;
            contact.status = ContactStatus::kNoTarget;
            if (const std::optional<double> contact_distance_m =
                    peer.contact_distance_m(frame, pose, distance_m)) {
              contact.status = ContactStatus::kContact;
              contact.contact_distance_m = contact.lower_m = contact.upper_m = *contact_distance_m;
            }
            return contact;
          }};
}

}  // namespace roomradar::bench
