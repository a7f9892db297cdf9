// fusion_bench.cpp: time to fuse a frame, and agreement with OctoMap's insertPointCloud in the same run.
//
// usage: fusion_bench [RECORDING] [--frames N] [--judged N] [--resolutions M,M,...] [--json FILE] RECORDING
// has poses (default: the kitchen beside the project). Our map fuses the first N frames (300) at each
// resolution (0.05,0.02,0.01,0.005), including colour. OctoMap inserts all pixels of `judged` of them (10),
// evenly spaced; a map of ours from just these frames is compared with OctoMap's, voxel by voxel along three
// million random points. OctoMap is omitted at 0.005 m, where it would need minutes. Times are the thread's
// CPU time with one thread, so other programs affect them only through shared caches; reading is not timed.
// wall_median_ms and two_threads_wall_median_ms are wall times with one and two threads, frame by frame in
// turn; in prepared_wall_median_ms the next frame is prepared meanwhile, as in a prescan. The first line
// names processor, compiler and flags; then follows one JSON row per cell. Settings are the defaults of
// FusionConfig: changing them breaks the comparison with earlier results.
#include <octomap/OcTree.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/octree/prepared_frame.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar {
namespace {

struct Settings {
  std::string recording = ROOMRADAR_DATA_DEFAULT "/kitchen";
  std::int64_t frames = 300;
  std::int64_t judged = 10;
  std::vector<double> resolutions_m = {0.05, 0.02, 0.01, 0.005};
  std::string json;
};

constexpr double kFinestJudged_m = 0.0099;

using Clock = std::chrono::steady_clock;

double ms_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - start).count();
}

// Calls visit(frame) for `count` frames with a pose, `step` apart.
template <typename Visit>
void for_frames(const std::string& recording, std::int64_t count, std::int64_t step, const Visit& visit) {
  const std::unique_ptr<FrameSource> source = open_folder(recording);
  Frame frame;
  for (std::int64_t i = 0; i < count * step;) {
    const ReadResult read = source->next(frame);
    if (read.status == ReadStatus::kEnd) return;
    if (read.status == ReadStatus::kSkipped) continue;
    if (!frame.T_world_camera)
      throw Error(recording + ": frame " + std::to_string(frame.index) + " has no pose");
    if (i % step == 0) visit(frame);
    ++i;
  }
}

void insert_rays(octomap::OcTree& tree, const Frame& frame, float max_range_m) {
  octomap::Pointcloud cloud;
  for (int y = 0; y < frame.depth_m.height; ++y)
    for (int x = 0; x < frame.depth_m.width; ++x) {
      const float depth_m = frame.depth_m.at(x, y);
      if (depth_m == 0.0F || depth_m > max_range_m) continue;
      const Eigen::Vector3f p =
          (*frame.T_world_camera * back_project(frame.depth_camera, x, y, depth_m)).cast<float>();
      cloud.push_back(p.x(), p.y(), p.z());
    }
  const Eigen::Vector3f eye = frame.T_world_camera->translation().cast<float>();
  tree.insertPointCloud(cloud, {eye.x(), eye.y(), eye.z()});
}

struct Agreement {
  double agree = 0.0;  // fraction of the voxels known to both that have the same occupancy
  // Fraction of OctoMap's occupied voxels known to both that are occupied in ours.
  double occupied_kept = 0.0;
  double made_free = 0.0;  // fraction of OctoMap's unknown voxels that are free in ours
};

Agreement compare(const StaticMap& ours, const octomap::OcTree& reference) {
  const Eigen::AlignedBox3d box = ours.counts().known_world;
  std::mt19937_64 random(1);
  std::size_t known = 0, agree = 0, occupied = 0, kept = 0, unknown = 0, made_free = 0;
  for (int i = 0; i < 3'000'000; ++i) {
    const auto between = [&](int axis) {
      return std::uniform_real_distribution<double>(box.min()[axis], box.max()[axis])(random);
    };
    const Eigen::Vector3d p(between(0), between(1), between(2));
    const Occupancy answer = ours.occupancy_at(p);
    const octomap::OcTreeNode* node = reference.search(p.x(), p.y(), p.z());
    if (!node) {
      ++unknown;
      made_free += answer == Occupancy::kFree;
    } else if (answer != Occupancy::kUnknown) {
      const bool is_occupied = reference.isNodeOccupied(node);
      ++known;
      agree += (answer == Occupancy::kOccupied) == is_occupied;
      occupied += is_occupied;
      kept += is_occupied && answer == Occupancy::kOccupied;
    }
  }
  const auto part = [](std::size_t of, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(of) / static_cast<double>(all);
  };
  return {part(agree, known), part(kept, occupied), part(made_free, unknown)};
}

nlohmann::json row(const char* method, double resolution_m, const std::vector<double>& times_ms) {
  return {{"method", method},
          {"resolution_m", resolution_m},
          {"frames", times_ms.size()},
          {"median_ms", test::quantile(times_ms, 0.5)},
          {"p95_ms", test::quantile(times_ms, 0.95)}};
}

void bench(const Settings& settings, double resolution_m, nlohmann::json& rows) {
  std::vector<double> ours_ms, wall_ms, two_threads_ms, prepared_ms;
  StaticMap map(resolution_m, {.threads = 1}), by_two(resolution_m, {.threads = 2}),
      ahead(resolution_m, {.threads = 2});
  Frame before;
  PreparedFrame prepared, next;
  for_frames(settings.recording, settings.frames, 1, [&](const Frame& frame) {
    const double start_ms = test::thread_ms();
    const Clock::time_point start = Clock::now();
    static_cast<void>(map.fuse(frame, *frame.T_world_camera));
    const Clock::time_point middle = Clock::now();
    ours_ms.push_back(test::thread_ms() - start_ms);
    static_cast<void>(by_two.fuse(frame, *frame.T_world_camera));
    wall_ms.push_back(ms_between(start, middle));
    const Clock::time_point end = Clock::now();
    two_threads_ms.push_back(ms_between(middle, end));
    auto preparing =
        std::async(std::launch::async, [&] { ahead.prepare(frame, *frame.T_world_camera, next); });
    static_cast<void>(ahead.fuse(before, prepared));
    preparing.get();
    prepared_ms.push_back(ms_between(end, Clock::now()));
    before = frame;
    std::swap(prepared, next);
  });
  const MapCounts counts = map.counts();
  nlohmann::json ours = row("roomradar", resolution_m, ours_ms);
  ours["wall_median_ms"] = test::quantile(wall_ms, 0.5);
  ours["two_threads_wall_median_ms"] = test::quantile(two_threads_ms, 0.5);
  ours["prepared_wall_median_ms"] = test::quantile(prepared_ms, 0.5);
  ours["memory_mb"] = static_cast<double>(counts.memory_bytes) / 1e6;
  ours["nodes"] = counts.nodes;
  ours["occupied_leaves"] = counts.occupied_leaves;
  ours["free_leaves"] = counts.free_leaves;
  ours["sampled_leaves"] = counts.sampled_leaves;
  const auto show = [&](const nlohmann::json& r) {
    std::printf("%s\n", r.dump().c_str());
    rows.push_back(r);
  };
  if (resolution_m < kFinestJudged_m) return show(ours);

  std::vector<double> reference_ms, same_ms;  // times of the same frames
  StaticMap judged(resolution_m, {.threads = 1});
  octomap::OcTree reference(resolution_m);
  const std::int64_t step =
      std::max<std::int64_t>(settings.frames / std::max<std::int64_t>(settings.judged, 1), 1);
  for_frames(settings.recording, settings.judged, step, [&](const Frame& frame) {
    double start = test::thread_ms();
    static_cast<void>(judged.fuse(frame, *frame.T_world_camera));
    same_ms.push_back(test::thread_ms() - start);
    start = test::thread_ms();
    insert_rays(reference, frame, judged.config().max_range_m);
    reference_ms.push_back(test::thread_ms() - start);
  });
  const Agreement agreement = compare(judged, reference);
  ours["agree"] = agreement.agree;
  ours["occupied_kept"] = agreement.occupied_kept;
  ours["unknown_made_free"] = agreement.made_free;
  ours["judged_median_ms"] = test::quantile(same_ms, 0.5);
  ours["times_faster"] = test::quantile(reference_ms, 0.5) / test::quantile(same_ms, 0.5);
  nlohmann::json theirs = row("insertPointCloud", resolution_m, reference_ms);
  theirs["agree"] = 1.0;
  show(ours);
  show(theirs);
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> all;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) all.push_back(std::stod(word));
  return all;
}

int run(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--frames" && has_value) {
      settings.frames = std::max(1L, std::atol(argv[++i]));
    } else if (word == "--judged" && has_value) {
      settings.judged = std::max(1L, std::atol(argv[++i]));
    } else if (word == "--resolutions" && has_value) {
      settings.resolutions_m = numbers(argv[++i]);
    } else if (word == "--json" && has_value) {
      settings.json = argv[++i];
    } else if (word.rfind("--", 0) == 0) {
      throw Error(
          "usage: fusion_bench [RECORDING] [--frames N] [--judged N] [--resolutions M,M,...] [--json FILE]");
    } else {
      settings.recording = word;
    }
  }
  nlohmann::json rows = nlohmann::json::array();
  std::printf("%s, one core; compiler %s; %s\n", test::processor().c_str(), __VERSION__, ROOMRADAR_FLAGS);
  for (const double resolution_m : settings.resolutions_m) bench(settings, resolution_m, rows);
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("fusion_bench", [&] { return roomradar::run(argc, argv); });
}
