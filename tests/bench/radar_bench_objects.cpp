// radar_bench_objects.cpp: many objects that drift through the scene of the depth frame.
#include "radar_bench_objects.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <random>
#include <tuple>
#include <utility>

#include "radar/batch/gl_radar.hpp"
#include "radar/exact/scene_boxes.hpp"
#include "radar/gl/gpu_mesh.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::bench {
namespace {

constexpr double kAhead_m = 0.2;
constexpr int kFrames = 9, kJudgedPerFrame = 4;

struct Crowd {
  std::vector<std::size_t> shape;
  std::vector<Eigen::Isometry3d> T_world_object;
  std::vector<Eigen::Vector3d> velocity_m_s;
};

Crowd crowd(int count, std::size_t shapes) {
  Crowd result;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) {
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const double px = uniform(random), py = uniform(random), pz = uniform(random);
    const double vx = uniform(random), vy = uniform(random), vz = uniform(random);
    result.shape.push_back(static_cast<std::size_t>(i) % shapes);
    result.T_world_object.push_back(Eigen::Translation3d(4.0 * px, 1.5 * py, 4.0 + 4.0 * pz) *
                                    Eigen::Quaterniond(w, x, y, z).normalized());
    result.velocity_m_s.emplace_back(vx, vy, vz);
  }
  return result;
}

using Meshes = std::array<Mesh, 3>;
Meshes shapes() { return {box_mesh({0.15F, 0.15F, 0.15F}), bumpy_torus(68, 46), cup_mesh()}; }

/// True distance to contact of object i, which is free; nullopt if it touches nothing.
std::optional<double> exact_of(const FrameScene& frame, const Meshes& meshes, const Crowd& objects,
                               std::size_t i) {
  const auto travel_to = [&](const Mesh& mesh, const Eigen::Isometry3d& T_world_mesh) {
    return exact_travel(meshes[objects.shape[i]], objects.T_world_object[i], objects.velocity_m_s[i],
                        kAhead_m, mesh, T_world_mesh)
        .value_or(2.0 * kAhead_m);
  };
  double least_m = travel_to(frame.mesh, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < objects.shape.size(); ++k) {
    const double apart_m =
        (objects.T_world_object[k].translation() - objects.T_world_object[i].translation()).norm();
    if (k == i || apart_m > 0.26 + kAhead_m) continue;  // two tori touch up to 0.25 m apart
    least_m = std::min(least_m, travel_to(meshes[objects.shape[k]], objects.T_world_object[k]));
  }
  return least_m <= kAhead_m ? std::optional(least_m) : std::nullopt;
}

/// Times answer(objects, contacts) in every frame.
template <typename Answer>
Row measure_frames(const FrameScene& frame, const Meshes& meshes, int count, const Answer& answer) {
  Crowd objects = crowd(count, meshes.size());
  std::vector<Contact> contacts(static_cast<std::size_t>(count));
  std::vector<double> wall_ms, cpu_ms, error_m;
  Row row{.table = "objects", .method = {}};
  row.scene_triangles = frame.mesh.triangles.size();
  for (int f = 0; f < kFrames; ++f) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      objects.T_world_object[i].pretranslate(objects.velocity_m_s[i] / 30.0);
    }
    const auto start = std::chrono::steady_clock::now();
    const double start_cpu_ms = test::thread_ms();
    answer(objects, contacts);
    cpu_ms.push_back(test::thread_ms() - start_cpu_ms);
    wall_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    for (int j = 0; j < kJudgedPerFrame; ++j) {
      const std::size_t i = static_cast<std::size_t>(f * kJudgedPerFrame + j) * 17 % contacts.size();
      if (contacts[i].status == ContactStatus::kOverlap)
        continue;  // the benchmark does not stop objects at
                   // contacts
      if (const auto error = judge(contacts[i], exact_of(frame, meshes, objects, i), row)) {
        error_m.push_back(*error);
      }
    }
  }
  for (const std::size_t shape : objects.shape) row.sensor_triangles += meshes[shape].triangles.size();
  row.median_ms = test::quantile(wall_ms, 0.5);
  row.p95_ms = test::quantile(wall_ms, 0.95);
  row.cpu_median_ms = test::quantile(cpu_ms, 0.5);
  add_errors(error_m, row);
  return row;
}

}  // namespace

Row measure_objects(const FrameScene& frame, int count, int radar_px, RadarMode mode) {
  const Meshes meshes = shapes();
  std::array<TriangleTree, std::tuple_size_v<Meshes>> trees;
  for (std::size_t i = 0; i < meshes.size(); ++i) trees[i].build_by_place(meshes[i]);
  SceneDepth depth;
  depth.depth_m = &frame.depth_m;
  depth.camera = frame.camera;
  depth.stride_px = frame.stride_px;
  depth.max_jump_m = 1e6F;
  CyberRadar radar({.mode = mode, .resolution_px = radar_px});
  std::vector<SceneTree> scene;
  SceneBoxes boxes;
  Row row = measure_frames(frame, meshes, count, [&](const Crowd& objects, std::vector<Contact>& contacts) {
    scene.clear();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      scene.push_back({{&trees[objects.shape[i]], objects.T_world_object[i]}, SurfaceKind::kObject});
    }
    boxes.build(std::span<const SceneTree>(scene));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const RadarQuery query{.object = scene[i].instance,
                             .direction_world = objects.velocity_m_s[i],
                             .distance_m = kAhead_m,
                             .own_tree = i};
      contacts[i] = radar.query(query, {.trees = scene, .depths = {&depth, 1}, .boxes = &boxes});
    }
  });
  row.method = mode == RadarMode::kExact ? "exact" : "sampled";
  row.radar_px = radar_px;
  return row;
}

Row measure_objects_gl(GlContext& context, const FrameScene& frame, int count, int radar_px) {
  const Meshes meshes = shapes();
  std::vector<std::unique_ptr<GpuMesh>> gpu_meshes;
  for (const Mesh& mesh : meshes) {
    gpu_meshes.push_back(std::make_unique<GpuMesh>(context));
    gpu_meshes.back()->upload(mesh, MeshUsage::kStatic);
  }
  GpuMesh depth(context);
  GlRadar radar(context, {.resolution_px = radar_px});
  std::vector<GpuSceneMesh> scene;
  std::vector<GlQuery> queries;
  Row row = measure_frames(frame, meshes, count, [&](const Crowd& objects, std::vector<Contact>& contacts) {
    depth.upload(frame.mesh, MeshUsage::kStreamed);
    scene.clear();
    queries.clear();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const MeshInstance object{gpu_meshes[objects.shape[i]].get(), objects.T_world_object[i]};
      scene.push_back({object, SurfaceKind::kObject});
      queries.push_back({object, objects.velocity_m_s[i], kAhead_m, i});
    }
    scene.push_back({{&depth, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic});
    radar.query_all(queries, scene, contacts);
  });
  row.method = "GL, one call";
  row.radar_px = radar_px;
  return row;
}

}  // namespace roomradar::bench
