// ghost_removal.cpp: two more passes over the recording: finds ghosts, then fuses their surroundings again.
#include "mapping/revision/ghost_removal.hpp"

#include "mapping/revision/ghost_zone.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

// Reads selected frames in recording order; seeks past the frames between if the source can.
class ChosenFrames {
 public:
  ChosenFrames(FrameSource& source, StageTimes& times) : source_(source), times_(times) {
    if (!source.rewind()) throw Error(source.name() + ": cannot be read once more");
  }

  // Returns false if the source does not deliver the same frame as before.
  bool read(const FusedFrame& chosen, Frame& frame) {
    return times_.timed("read", [&] {
      if (position_ != chosen.position && source_.seek(chosen.position)) position_ = chosen.position;
      while (position_ <= chosen.position) {
        const ReadResult result = source_.next(frame);
        if (result.status == ReadStatus::kEnd) return false;
        if (position_++ == chosen.position)
          return result.status == ReadStatus::kFrame && frame.index == chosen.frame_index;
      }
      return false;
    });
  }

 private:
  FrameSource& source_;
  StageTimes& times_;
  std::int64_t position_ = 0;
};

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
  ChosenFrames chosen(source, times);
  for (std::size_t i = 0; i < fused.size(); i += stride) {
    if (!chosen.read(fused[i], frame)) continue;
    times.timed("ghosts", [&] { votes.look(frame, fused[i].T_world_camera); });
    if (progress) progress("looked");
  }

  // Erase them, and all samples that they may have corrupted.
  GhostRevision revision;
  times.timed("ghosts", [&] {
    revision.verdicts = votes.verdicts();
    if (revision.voxels() == 0) return;
    const GhostZone zone(revision.verdicts, map.resolution_m());
    for (std::vector<VoxelIndex>* voxels : {&revision.verdicts.still, &revision.verdicts.unseen})
      std::erase_if(*voxels, [&](const VoxelIndex& voxel) { return !zone.reaches(voxel); });
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
  ChosenFrames chosen(source, times);
  for (const std::size_t i : frames_to_fuse_again(zone, fused)) {
    if (i < revision.next) continue;  // before the scan was resumed
    revision.next = i + 1;
    const FusedFrame& one = fused[i];
    if (!chosen.read(one, frame)) continue;
    times.timed("ghosts", [&] {
      zone.mask(frame.depth_camera, one.T_world_camera, frame.depth_m);
      map.fuse(frame, one.T_world_camera);
    });
    if (progress) progress("fused again");
  }
}

}  // namespace roomradar
