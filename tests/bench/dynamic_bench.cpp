// dynamic_bench.cpp: time and accuracy of finding and meshing the dynamic foreground. Scenes, seeds and
// frames are fixed: changing them breaks the comparison with earlier results. Times are CPU times of one
// thread.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dynamic/foreground/change_tracker.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/bench/dynamic_bench.hpp"
#include "tests/dynamic/foreground/foreground_judge.hpp"

namespace roomradar::test {
namespace {

// Puts a ball that covers a fifth of the image in front of the room.
void put_in_front(Frame& frame) {
  DepthImage& depth_m = frame.depth_m;
  const double radius_px = std::sqrt(0.2 * depth_m.width * depth_m.height / M_PI);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const double r = std::hypot(x - depth_m.width / 2, y - depth_m.height / 2) / radius_px;
      if (r < 1.0) depth_m.at(x, y) = static_cast<float>(0.8 - 0.2 * std::sqrt(1.0 - r * r));
    }
  }
}

void measure_times(Rows& rows) {
  constexpr int kWarmUp = 10, kRepeats = 200;
  SimOptions options;
  options.frames = 1;
  options.path = CameraPathKind::kView;
  SimulatedSource source(options);
  Frame frame;
  if (source.next(frame).status != ReadStatus::kFrame) return;
  ViewCaster caster;
  DepthImage expected_m;
  cast_room(source.room(), frame.depth_camera, source.truth().T_world_camera, caster, expected_m);
  put_in_front(frame);

  ForegroundState foreground;
  LabelImage labels;
  MaskImage dynamic_mask;
  ForegroundCounts counts;
  Times segmentation;
  for (int i = 0; i < kWarmUp + kRepeats; ++i) {
    const double start_ms = thread_ms();
    counts = mark_foreground({frame.depth_m, frame.depth_camera, source.truth().T_world_camera}, expected_m,
                             {}, foreground, labels, dynamic_mask);
    if (i >= kWarmUp) segmentation.samples_ms.push_back(thread_ms() - start_ms);
  }
  const double fraction =
      static_cast<double>(counts.moved) / static_cast<double>(frame.depth_m.pixels.size());
  rows.push_back({{"work", "segmentation"},
                  {"width", frame.depth_m.width},
                  {"height", frame.depth_m.height},
                  {"foreground_fraction", fraction},
                  {"median_ms", segmentation.percentile(0.5)},
                  {"p95_ms", segmentation.percentile(0.95)},
                  {"p99_ms", segmentation.percentile(0.99)}});
}

// Measures change tracking: a plate in front of a wall covers a part of the image, with the sensor's noise
// and a swaying camera, for 20 s. Includes the search for completed changes, which a session runs four times
// per second.
void measure_watching(Rows& rows) {
  constexpr int kFrames = 600, kWarmUp = 60, kImages = 30;
  constexpr float kWall_m = 4.0F;
  const Intrinsics& camera = kKinectDepthCamera;
  for (const auto& [fraction, plate_m] : {std::pair{0.2, 1.2F}, {0.2, 2.5F}, {1.0, 3.0F}}) {
    const DepthImage expected_m(camera.width_px, camera.height_px, kWall_m);
    std::vector<DepthImage> depth_m(kImages, expected_m);
    LabelImage labels(camera.width_px, camera.height_px, PixelLabel::kStatic);
    const double half = 0.5 * std::sqrt(fraction);
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x)
        if (std::abs(x + 0.5 - 0.5 * camera.width_px) <= half * camera.width_px &&
            std::abs(y + 0.5 - 0.5 * camera.height_px) <= half * camera.height_px)
          labels.at(x, y) = PixelLabel::kMoved;
    for (int i = 0; i < kImages; ++i)
      for (std::size_t p = 0; p < labels.pixels.size(); ++p) {
        const float z = labels.pixels[p] == PixelLabel::kMoved ? plate_m : kWall_m;
        const auto key = hash_of(7, static_cast<std::uint64_t>(i), p);
        depth_m[static_cast<std::size_t>(i)].pixels[p] = z + depth_sigma_m(DepthNoise{}, z) * gaussian(key);
      }
    ChangeTracker tracker;
    Times watching, looking;
    std::size_t things = 0;
    for (int i = 0; i < kFrames; ++i) {
      Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
      T_world_camera.translation().x() = 0.003 * std::sin(0.3 * i);
      const double start_ms = thread_ms();
      tracker.update(depth_m[static_cast<std::size_t>(i % kImages)], expected_m, labels, camera,
                     T_world_camera, i / 30.0);
      if (i >= kWarmUp) watching.samples_ms.push_back(thread_ms() - start_ms);
      if (i % 7 != 0) continue;
      const double look_ms = thread_ms();
      things = tracker.lasting_changes(i + 7 < kFrames ? 1e3 : 5.0).size();
      if (i >= kWarmUp) looking.samples_ms.push_back(thread_ms() - look_ms);
    }
    rows.push_back({{"work", "watching for what stays"},
                    {"foreground_fraction", fraction},
                    {"depth_m", plate_m},
                    {"points", tracker.point_count()},
                    {"things", things},
                    {"median_ms", watching.percentile(0.5)},
                    {"p95_ms", watching.percentile(0.95)},
                    {"p99_ms", watching.percentile(0.99)},
                    {"look_max_ms", looking.percentile(1.0)}});
  }
}

int run(int argc, char** argv) {
  const bool mesh_only = argc > 1 && std::strcmp(argv[1], "--mesh") == 0;
  if (mesh_only) --argc, ++argv;
  const char* file = nullptr;
  if (argc == 3 && std::strcmp(argv[1], "--json") == 0) file = argv[2];
  if (argc != 1 && !file) {
    std::cerr << "usage: dynamic_bench [--mesh] [--json FILE]\n";
    return 2;
  }
  Rows rows = Rows::array();
  measure_mesh_times(rows);
  measure_mesh_quality(rows);
  if (!mesh_only) {
    measure_times(rows);
    measure_watching(rows);
    measure_foreground(rows);
  }
  for (const auto& row : rows) std::cout << row.dump() << "\n";
  write_rows(file ? file : "", rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::test

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("dynamic_bench", [&] { return roomradar::test::run(argc, argv); });
}
