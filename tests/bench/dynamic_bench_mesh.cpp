// dynamic_bench_mesh.cpp: the mesh of the dynamic foreground compared with the mesh of every pixel and that
// of the whole frame. Scenes, seeds and frames are fixed: changing them breaks the comparison with earlier
// results.
#include "tests/bench/dynamic_bench.hpp"

#include <cmath>
#include <random>
#include <string>

#include "dynamic/surface/depth_mesh.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "mapping/types/depth_noise.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/dynamic/foreground/foreground_judge.hpp"
#include "tests/dynamic/mesh_raster.hpp"

namespace roomradar::test {
namespace {

using Row = nlohmann::json;

constexpr DepthMeshConfig kEveryPixel{.stride_px = 1};

/// A ball that covers a fifth of the image, with the sensor's noise.
void put_in_front(DepthImage& depth_m) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  const double radius_px = std::sqrt(0.2 * depth_m.width * depth_m.height / M_PI);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const double r = std::hypot(x - depth_m.width / 2, y - depth_m.height / 2) / radius_px;
      if (r >= 1.0) continue;
      const auto z = static_cast<float>(0.8 - 0.2 * std::sqrt(1.0 - r * r));
      depth_m.at(x, y) = z + depth_sigma_m(DepthNoise{}, z) * normal(random);
    }
  }
}

template <typename Work>
Times timed(int repeats, const Work& work) {
  constexpr int kWarmUp = 10;
  Times times;
  for (int i = 0; i < kWarmUp + repeats; ++i) {
    const double start_ms = thread_ms();
    work();
    if (i >= kWarmUp) times.samples_ms.push_back(thread_ms() - start_ms);
  }
  return times;
}

Row time_row(const std::string& work, std::size_t triangles, Times times) {
  return {{"work", work},
          {"triangles", triangles},
          {"median_ms", times.percentile(0.5)},
          {"p95_ms", times.percentile(0.95)},
          {"p99_ms", times.percentile(0.99)}};
}

double at_share(std::vector<float>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double rms(const std::vector<float>& values) {
  double squares = 0.0;
  for (const float v : values) squares += static_cast<double>(v) * v;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

/// Totals over the frames of one kind of scene.
struct Quality {
  std::size_t frames = 0, full = 0, seen = 0, inferred = 0;
  double largest_share = 0.0;  // largest fraction of the triangles, in one frame
  std::vector<float> from_full_sigmas, from_truth_sigmas, full_from_truth_sigmas;
  std::size_t full_px = 0, only_full_px = 0, only_seen_px = 0, lost_px = 0;
};

/// Tangent of the angle between surface and image plane, from the exact depth.
float tangent_at(const DepthImage& exact_m, int x, int y, float focal_px) {
  const auto step = [&](int dx, int dy) {
    const float here = exact_m.at(x, y);
    const float before = std::abs(exact_m.at(x - dx, y - dy) - here);
    return std::min(before, std::abs(exact_m.at(x + dx, y + dy) - here));  // not across a depth discontinuity
  };
  return std::hypot(step(1, 0), step(0, 1)) * focal_px / exact_m.at(x, y);
}

void compare(const Mesh& seen, const Mesh& full, const Intrinsics& camera,
             const Eigen::Isometry3d& T_world_camera, const SimTruth& truth, Quality& quality) {
  const DepthImage seen_m = rasterise(seen, camera, T_world_camera);
  const DepthImage full_m = rasterise(full, camera, T_world_camera);
  for (int y = 1; y + 1 < camera.height_px; ++y) {
    for (int x = 1; x + 1 < camera.width_px; ++x) {
      const float a = seen_m.at(x, y), b = full_m.at(x, y);
      quality.full_px += b > 0.0F ? 1U : 0U;
      if (a > 0.0F && !(b > 0.0F)) ++quality.only_seen_px;
      if (b > 0.0F && !(a > 0.0F)) {
        ++quality.only_full_px;
        bool is_near = false;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) is_near = is_near || seen_m.at(x + dx, y + dy) > 0.0F;
        quality.lost_px += is_near ? 0U : 1U;
      }
      const float exact = truth.depth_m.at(x, y);
      if (!(a > 0.0F) || !(b > 0.0F) || truth.moved.at(x, y) == 0 || !(exact > 0.0F)) continue;
      const float sigma_m = depth_sigma_m(
          DepthNoise{}, exact, std::atan(tangent_at(truth.depth_m, x, y, static_cast<float>(camera.fx_px))));
      quality.from_full_sigmas.push_back(std::abs(a - b) / sigma_m);
      quality.from_truth_sigmas.push_back(std::abs(a - exact) / sigma_m);
      quality.full_from_truth_sigmas.push_back(std::abs(b - exact) / sigma_m);
    }
  }
}

}  // namespace

void measure_mesh_times(nlohmann::json& rows) {
  constexpr int kRepeats = 300;
  SimOptions options;
  options.frames = 1;
  options.path = CameraPathKind::kView;
  SimulatedSource source(options);
  Frame frame;
  if (source.next(frame).status != ReadStatus::kFrame) return;
  const Eigen::Isometry3d T_world_camera = source.truth().T_world_camera;
  ViewCaster caster;
  DepthImage expected_m;
  cast_room(source.room(), frame.depth_camera, T_world_camera, caster, expected_m);
  put_in_front(frame.depth_m);

  ForegroundState foreground;
  LabelImage labels;
  MaskImage dynamic_mask;
  DynamicSurfaceScratch scratch;
  DynamicSurface surface;
  const auto find = [&] {
    (void)mark_foreground({frame.depth_m, frame.depth_camera, T_world_camera}, expected_m, {}, foreground,
                          labels, dynamic_mask);
  };
  const auto mesh = [&](const DynamicSurfaceConfig& config) {
    mesh_dynamic({{frame.depth_m, frame.depth_camera, T_world_camera}, dynamic_mask, expected_m}, {}, config,
                 scratch, surface);
  };
  TriangleTree seen_tree, back_tree;
  const Times both = timed(kRepeats, [&] {
    find();
    mesh({});
  });
  rows.push_back(time_row("segmentation and mesh of what moved", surface.seen_world.triangles.size(), both));
  const Times with_back = timed(kRepeats, [&] { mesh({}); });
  rows.push_back(time_row("mesh of what moved, and its back",
                          surface.seen_world.triangles.size() + surface.inferred_world.triangles.size(),
                          with_back));
  const Times trees = timed(kRepeats, [&] {
    seen_tree.build_in_order(surface.seen_world);
    back_tree.build_in_order(surface.inferred_world);
  });
  rows.push_back(time_row("their trees", seen_tree.triangle_count() + back_tree.triangle_count(), trees));
  const DynamicSurfaceConfig without_back{.has_back = false};
  const Times seen_only = timed(kRepeats, [&] { mesh(without_back); });
  rows.push_back(time_row("mesh of what moved, no back", surface.seen_world.triangles.size(), seen_only));

  DepthMeshScratch full_scratch;
  Mesh full;
  const DepthImage moved_m = test::masked_depth(frame.depth_m, dynamic_mask);
  const Times full_times = timed(kRepeats / 4, [&] {
    mesh_whole({moved_m, frame.depth_camera, T_world_camera}, SurfacePolicy::kHoles, kEveryPixel,
               full_scratch, full);
  });
  rows.push_back(time_row("mesh of every moved pixel", full.triangles.size(), full_times));
  rows.push_back(time_row("its tree", full.triangles.size(),
                          timed(kRepeats / 4, [&] { seen_tree.build_in_order(full); })));
  const Times whole_times = timed(kRepeats / 10, [&] {
    mesh_whole({frame.depth_m, frame.depth_camera, T_world_camera}, SurfacePolicy::kHoles, kEveryPixel,
               full_scratch, full);
  });
  rows.push_back(time_row("mesh of the whole frame", full.triangles.size(), whole_times));
  rows.push_back(time_row("its tree, in order", full.triangles.size(),
                          timed(kRepeats / 10, [&] { seen_tree.build_in_order(full); })));
  rows.push_back(time_row("its tree, by place", full.triangles.size(),
                          timed(kRepeats / 60, [&] { seen_tree.build_by_place(full); })));
}

void measure_mesh_quality(nlohmann::json& rows) {
  for (const double noise : {0.0, 1.0}) {
    for (const MoverKind mover : {MoverKind::kHand, MoverKind::kBall, MoverKind::kPerson}) {
      Quality quality;
      for (const std::string& room : room_names()) {
        SimOptions options;
        options.room = room;
        options.noise_scale = noise;
        options.movers = {mover};
        options.path = mover == MoverKind::kBall ? CameraPathKind::kScan : CameraPathKind::kView;
        options.frames = mover == MoverKind::kBall ? 1200 : 150;  // the floor may be out of view
        const std::int64_t step = mover == MoverKind::kBall ? 300 : 50;
        SimulatedSource source(options);
        ViewCaster caster;
        Frame frame;
        DepthImage expected_m;
        ForegroundState foreground;
        LabelImage labels;
        DynamicSurfaceScratch scratch;
        DynamicSurface surface;
        DepthMeshScratch full_scratch;
        Mesh full;
        for (std::int64_t i = 0; i < options.frames; i += step) {
          source.seek(i);
          if (source.next(frame).status != ReadStatus::kFrame) break;
          const SimTruth& truth = source.truth();
          if (std::count(truth.moved.pixels.begin(), truth.moved.pixels.end(), 255) < 500) continue;
          cast_room(source.room(), frame.depth_camera, truth.T_world_camera, caster, expected_m);
          MaskImage mask = truth.moved;
          if (noise > 0.0) {
            (void)mark_foreground({frame.depth_m, frame.depth_camera, truth.T_world_camera}, expected_m, {},
                                  foreground, labels, mask);
          }
          mesh_dynamic({{frame.depth_m, frame.depth_camera, truth.T_world_camera}, mask, expected_m}, {}, {},
                       scratch, surface);
          const DepthImage moved_m = test::masked_depth(frame.depth_m, mask);
          mesh_whole({moved_m, frame.depth_camera, truth.T_world_camera}, SurfacePolicy::kHoles, kEveryPixel,
                     full_scratch, full);
          if (full.triangles.empty()) continue;
          ++quality.frames;
          quality.full += full.triangles.size();
          quality.seen += surface.seen_world.triangles.size();
          quality.inferred += surface.inferred_world.triangles.size();
          quality.largest_share =
              std::max(quality.largest_share, static_cast<double>(surface.seen_world.triangles.size()) /
                                                  static_cast<double>(full.triangles.size()));
          compare(surface.seen_world, full, frame.depth_camera, truth.T_world_camera, truth, quality);
        }
      }
      const auto share = [](std::size_t part, std::size_t whole) {
        return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
      };
      rows.push_back({{"work", "mesh of what moved against every pixel's"},
                      {"mover", std::string(to_string(mover))},
                      {"noise", noise},
                      {"frames", quality.frames},
                      {"triangles_full", quality.full},
                      {"triangles", quality.seen},
                      {"triangles_back", quality.inferred},
                      {"triangle_share", share(quality.seen, quality.full)},
                      {"triangle_share_most", quality.largest_share},
                      {"rms_sigmas", rms(quality.from_full_sigmas)},
                      {"median_sigmas", at_share(quality.from_full_sigmas, 0.5)},
                      {"p95_sigmas", at_share(quality.from_full_sigmas, 0.95)},
                      {"p99_sigmas", at_share(quality.from_full_sigmas, 0.99)},
                      {"from_truth_rms_sigmas", rms(quality.from_truth_sigmas)},
                      {"full_from_truth_rms_sigmas", rms(quality.full_from_truth_sigmas)},
                      {"from_truth_p95_sigmas", at_share(quality.from_truth_sigmas, 0.95)},
                      {"full_from_truth_p95_sigmas", at_share(quality.full_from_truth_sigmas, 0.95)},
                      {"only_full_fraction", share(quality.only_full_px, quality.full_px)},
                      {"only_this_fraction", share(quality.only_seen_px, quality.full_px)},
                      {"farther_than_a_pixel_fraction", share(quality.lost_px, quality.full_px)}});
    }
  }
}

}  // namespace roomradar::test
