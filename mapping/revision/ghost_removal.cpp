// ghost_removal.cpp: two more passes over the recording: finds ghosts, then fuses their surroundings again.
#include "mapping/revision/ghost_removal.hpp"

#include <utility>

#include "mapping/revision/ghost_zone.hpp"

namespace roomradar {
namespace {

/// Returns the frames, in order, that have the zone in view and are to be fused again. Of frames with almost
/// the same view, one in eight is chosen: otherwise a slow scan would be read once more as a whole.
std::vector<std::size_t> frames_to_fuse_again(const GhostZone& zone, std::span<const FusedFrame> fused) {
  constexpr double kOtherView_m = 0.04, kOtherView_rad = 0.04;  // of the recorded kitchen, every fourth frame
  constexpr std::size_t kSameView = 8;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < fused.size(); ++i) {
    if (!zone.in_view(fused[i].depth_camera, fused[i].T_world_camera)) continue;
    if (!chosen.empty() && i < chosen.back() + kSameView) {
      const Eigen::Isometry3d moved = fused[chosen.back()].T_world_camera.inverse() * fused[i].T_world_camera;
      if (moved.translation().norm() < kOtherView_m &&
          Eigen::AngleAxisd(moved.linear()).angle() < kOtherView_rad)
        continue;
    }
    chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

GhostRevision remove_ghosts(FrameSource& source, std::span<const FusedFrame> fused, const GhostConfig& config,
                            StaticMap& map, StageTimes& times, const GhostProgress& progress) {
  // Find the voxels that frames see through.
  GhostVotes votes(map, config);
  Frame frame;
  const auto stride = static_cast<std::size_t>(look_stride(static_cast<std::int64_t>(fused.size()), config));
  std::vector<std::size_t> every_nth;
  for (std::size_t i = 0; i < fused.size(); i += stride) every_nth.push_back(i);
  ChosenFrames chosen(source, fused, std::move(every_nth), times);
  for (std::size_t i = 0; chosen.next(frame, i);) {
    times.timed("ghosts", [&] { votes.look(frame, fused[i].T_world_camera); });
    if (progress) progress("searched");
  }

  // Erase them, and all samples that they may have corrupted.
  GhostRevision revision;
  times.timed("ghosts", [&] {
    revision.verdicts = votes.verdicts();
    if (revision.voxels() == 0) return;
    const GhostZone zone(revision.verdicts, map.resolution_m());
    map.revise_samples([&](const SurfaceSample& sample) { return zone.fate_of(sample); });
  });
  return revision;
}

void refuse_surroundings(FrameSource& source, std::span<const FusedFrame> fused, GhostRevision& revision,
                         StaticMap& map, StageTimes& times, const GhostProgress& progress) {
  if (revision.voxels() == 0) return;
  const GhostZone zone =
      times.timed("ghosts", [&] { return GhostZone(revision.verdicts, map.resolution_m()); });
  Frame frame;
  std::vector<std::size_t> again = frames_to_fuse_again(zone, fused);
  std::erase_if(again, [&](std::size_t i) { return i < revision.next; });  // before the scan was resumed
  ChosenFrames chosen(source, fused, std::move(again), times);
  for (std::size_t i = 0; chosen.next(frame, i);) {
    revision.next = i + 1;
    const FusedFrame& one = fused[i];
    times.timed("ghosts", [&] {
      zone.mask(frame.depth_camera, one.T_world_camera, frame.depth_m);
      map.fuse(frame, one.T_world_camera);
    });
    if (progress) progress("fused again");
  }
}

}  // namespace roomradar
