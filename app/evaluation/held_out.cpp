// held_out.cpp: builds histograms of the differences of rendered and measured depth.
#include "app/evaluation/held_out.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mapping/prescan.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/depth/depth_pass.hpp"

namespace roomradar {
namespace {

constexpr int kStride_px = 4;
constexpr float kFarthest_m = 4.0F;
constexpr double kOutlier_m = 0.1;
constexpr double kBin_m = 0.00005;
constexpr std::size_t kBins = 20'000;  // up to 1 m; larger differences go into the last bin

using Histogram = std::array<std::int64_t, kBins>;

std::size_t bin_of(double size_m) { return static_cast<std::size_t>(std::min(size_m / kBin_m, kBins - 1.0)); }

/// Returns the value at `rank` (0: smallest) among those counted, to half a bin.
double value_at(const Histogram& counts, std::int64_t rank) {
  std::int64_t sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += counts[bin];
    if (sum > rank) return (static_cast<double>(bin) + 0.5) * kBin_m;
  }
  return 0.0;
}

/// Histograms of signed differences.
struct Differences {
  Histogram behind{};  // mesh farther than measured
  Histogram before{};
  std::int64_t outliers = 0;

  void add(double difference_m) {
    ++(difference_m >= 0.0 ? behind : before)[bin_of(std::abs(difference_m))];
    outliers += std::abs(difference_m) > kOutlier_m ? 1 : 0;
  }
};

std::int64_t total(const Histogram& counts) {
  std::int64_t sum = 0;
  for (const std::int64_t count : counts) sum += count;
  return sum;
}

void compare(const DepthImage& measured_m, const DepthImage& mesh_m, Differences& differences,
             std::int64_t& pixels) {
  for (int y = 0; y < measured_m.height; y += kStride_px) {
    for (int x = 0; x < measured_m.width; x += kStride_px) {
      const float measured = measured_m.at(x, y);
      if (!(measured > 0.0F && measured <= kFarthest_m)) continue;
      ++pixels;
      if (mesh_m.at(x, y) > 0.0F) differences.add(double{mesh_m.at(x, y)} - double{measured});
    }
  }
}

}  // namespace

HeldOutScore score_held_out(FrameSource& source, const Mesh& mesh, const std::vector<TimedPose>& trajectory,
                            std::int64_t hold_out) {
  HeldOutScore score;
  std::map<std::int64_t, Eigen::Isometry3d> T_world_camera;
  for (const TimedPose& pose : trajectory) {
    if (is_held_out(pose.frame_index, hold_out)) T_world_camera[pose.frame_index] = pose.T_world_camera;
  }
  if (T_world_camera.empty()) return score;
  if (!source.rewind()) throw Error(source.name() + ": cannot be read again to score the held-out frames");

  GlContext context;
  GpuMesh room(context);
  room.upload(mesh, MeshUsage::kStatic);
  const MeshInstance instance{&room, Eigen::Isometry3d::Identity()};
  DepthPass depth_pass(context);
  DepthImage mesh_m;
  Differences differences;
  Frame frame;
  for (ReadResult read = source.next(frame); read.status != ReadStatus::kEnd; read = source.next(frame)) {
    if (read.status != ReadStatus::kFrame) continue;
    if (frame.index > T_world_camera.rbegin()->first)
      break;  // reading on would make a live source record
              // more
    const auto pose = T_world_camera.find(frame.index);
    if (pose == T_world_camera.end()) continue;
    depth_pass.render({&instance, 1}, frame.depth_camera, pose->second, mesh_m);
    if (mesh_m.width != frame.depth_m.width || mesh_m.height != frame.depth_m.height) continue;
    ++score.frames;
    compare(frame.depth_m, mesh_m, differences, score.pixels);
  }

  Histogram sizes = differences.behind;
  for (std::size_t bin = 0; bin < kBins; ++bin) sizes[bin] += differences.before[bin];
  const std::int64_t covered = total(sizes);
  if (covered == 0) return score;
  score.cover = static_cast<double>(covered) / static_cast<double>(score.pixels);
  score.outliers = static_cast<double>(differences.outliers) / static_cast<double>(covered);
  score.median_m = value_at(sizes, covered / 2);
  const std::int64_t before = total(differences.before);
  const std::int64_t middle = covered / 2;  // rank from the most negative difference, from 0
  score.bias_m = middle < before ? -value_at(differences.before, before - 1 - middle)
                                 : value_at(differences.behind, middle - before);
  return score;
}

}  // namespace roomradar
