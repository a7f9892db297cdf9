// scenario_frame.cpp: renders the camera's frames while a scenario's object moves.
#include "app/sim/scenarios/scenario_frame.hpp"

#include <vector>

#include "app/sim/sensor/kinect_depth.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

std::vector<Solid> occluder_at(const Scenario& scenario, int frame) {
  std::vector<Solid> solids = scenario.occluder_solids;
  for (Solid& solid : solids)
    solid.T_world_solid.pretranslate(frame * kScenarioFrame_s * scenario.occluder_velocity_world);
  return solids;
}

void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame) {
  std::vector<Solid> solids = room.solids;
  const std::vector<Solid> occluder = occluder_at(scenario, frame_number);
  solids.insert(solids.end(), occluder.begin(), occluder.end());
  std::vector<float> infrared;
  for (const Material& material : room.materials) infrared.push_back(material.infrared);
  for (const Material& material : scenario.occluder_materials) infrared.push_back(material.infrared);
  ViewCaster view;
  ExactView exact;
  view.prepare(solids, scenario.depth_camera, scenario.T_world_camera);
  render_exact(solids, view, scenario.depth_camera, {}, exact);
  if (noise_scale > 0.0) {
    KinectScratch scratch;
    measure_depth({solids, infrared},
                  {.caster = view,
                   .exact = exact,
                   .camera = scenario.depth_camera,
                   .T_world_camera = scenario.T_world_camera},
                  {.faults = {},
                   .noise_scale = noise_scale,
                   .seed = mixed(scenario.seed + static_cast<std::uint64_t>(scenario.number)),
                   .frame_index = frame_number},
                  scratch, frame.depth_m);
  } else {
    frame.depth_m = exact.depth_m;
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m < static_cast<float>(kKinectNearest_m) || depth_m > static_cast<float>(kKinectFarthest_m))
        depth_m = 0.0F;
  }
  frame.index = frame_number;
  frame.stamp_s = frame_number * kScenarioFrame_s;
  frame.depth_camera = scenario.depth_camera;
  frame.colour = {};
  frame.colour_camera = {};
  frame.T_world_camera = scenario.T_world_camera;
  frame.down_camera = scenario.T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ();
}

}  // namespace roomradar
