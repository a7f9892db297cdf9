// texture_pass.cpp: chooses frames by pose and image speed, reads them again, and bakes the texture.
#include "mapping/texture_pass.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/revision/chosen_frames.hpp"
#include "mapping/texture/exposure_gains.hpp"
#include "mapping/texture/texture_bake.hpp"
#include "mapping/texture/view_alignment.hpp"
#include "mapping/texture/view_selection.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

constexpr double kMostBytes = 80e6;     // of all views
constexpr double kBytesPerPixel = 2.1;  // of a view: colour, depth of half the size
constexpr double kColourPixels = 640.0 * 480.0;
constexpr double kBakeBytes = 150e6;  // of an atlas and its JPEG

/// Returns each fused frame's pose, and the speed of its image from the poses before and after it.
std::vector<ViewCandidate> candidates_of(const std::vector<FusedFrame>& fused,
                                         const std::vector<TimedPose>& trajectory) {
  std::map<std::int64_t, std::size_t> at;  // index in the trajectory, by frame index
  for (std::size_t i = 0; i < trajectory.size(); ++i) at[trajectory[i].frame_index] = i;
  std::vector<ViewCandidate> candidates;
  for (const FusedFrame& frame : fused) {
    ViewCandidate candidate{frame.T_world_camera};
    if (const auto found = at.find(frame.frame_index); found != at.end()) {
      const TimedPose& before = trajectory[found->second - std::min<std::size_t>(found->second, 1)];
      const TimedPose& after = trajectory[std::min(found->second + 1, trajectory.size() - 1)];
      candidate.image_speed_pxps = image_speed_pxps(
          velocity_of(before.T_world_camera.inverse() * after.T_world_camera, after.stamp_s - before.stamp_s),
          frame.depth_camera);
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

/// Returns how many views the memory allows, by the size of the first chosen frame's picture.
std::size_t most_views(PrescanWork& work, const FusionPass& pass, std::size_t first) {
  Frame frame;
  std::size_t index = 0;
  ChosenFrames(*work.source, pass.fused, {first}, work.times).next(frame, index);
  const double pixels = std::max(kColourPixels, static_cast<double>(frame.colour.pixels.size()));
  return static_cast<std::size_t>(std::max(1.0, kMostBytes / (kBytesPerPixel * pixels)));
}

bool exceeds_cap(const PrescanConfig& config) {
  return config.max_memory_bytes > 0 && static_cast<double>(resident_bytes()) + kMostBytes + kBakeBytes >
                                            static_cast<double>(config.max_memory_bytes);
}

}  // namespace

std::shared_ptr<const SurfaceTexture> run_texture_pass(PrescanWork& work,
                                                       const std::vector<TimedPose>& trajectory,
                                                       const FusionPass& pass, const EarlierTextures& earlier,
                                                       const Mesh& mesh) {
  if (exceeds_cap(work.config) || pass.fused.empty()) return nullptr;
  const std::vector<ViewCandidate> candidates = candidates_of(pass.fused, trajectory);
  std::vector<std::size_t> chosen = choose_views(candidates, most_views(work, pass, 0));
  work.show("texture", {});
  std::vector<TextureView> views;
  ChosenFrames frames(*work.source, pass.fused, std::move(chosen), work.times);
  Frame frame;
  double bytes = 0.0;
  for (std::size_t i = 0; frames.next(frame, i);) {
    if (frame.colour.empty()) continue;
    bytes += kBytesPerPixel * static_cast<double>(frame.colour.pixels.size());
    if (bytes > kMostBytes && !views.empty()) break;  // later pictures are larger than the first
    work.times.timed("texture", [&] {
      views.push_back(
          make_texture_view(frame, candidates[i].T_world_camera, mesh, candidates[i].image_speed_pxps));
    });
  }
  SurfaceTexture texture = work.times.timed("texture", [&] {
    even_exposure(mesh, views);
    align_views(mesh, views);
    return bake_texture(mesh, views, earlier);
  });
  views = {};
  release_unused_memory();  // the views' small parts
  if (texture.corners.empty()) return nullptr;
  return std::make_shared<const SurfaceTexture>(std::move(texture));
}

}  // namespace roomradar
