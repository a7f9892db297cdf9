// prescan_state.cpp: fields of a prescan's state, and the files that contain them.
//
// state.bin: a file as in binary_file.hpp with magic "RRPRSCAN" and the fields in the order of the functions
// below. Numbers are little-endian; lists are preceded by their length (u64). Beside it are odometry/ in the
// first pass (odometry_checkpoint.cpp), and octree.bin and places.bin, as in a map, in the second.
#include "mapping/prescan_state.hpp"

#include <algorithm>
#include <string>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/odometry_checkpoint.hpp"
#include "mapping/storage/binary_file.hpp"

namespace roomradar {

namespace fs = std::filesystem;

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, PrescanCounts> counts) {
  for (auto* const count :
       {&counts.frames_read, &counts.frames_skipped, &counts.frames_tracked, &counts.frames_fused,
        &counts.frames_lost, &counts.keyframes, &counts.loops_found, &counts.restarts, &counts.ghost_voxels,
        &counts.recorded_used, &counts.recorded_contradicted, &counts.impossible_motion}) {
    archive(*count);
    if constexpr (Archive::kReads) {
      if (*count < 0) archive.fail("is damaged: a count is negative");
    }
  }
  archive(counts.timing, counts.recorded_sigma_m, counts.stopped_for_memory, counts.last_fault);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, TrackedFrame> frame) {
  archive(frame.frame_index, frame.stamp_s, frame.T_world_camera);
  serialize(archive, frame.status, TrackStatus::kDiverged);
  archive(frame.part, frame.trusted);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, ScanPart> part) {
  archive(part.first, part.last, part.frames, part.is_joined);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, UpDirection> up) {
  serialize(archive, up.source, UpSource::kPlane);
  archive(up.up_world, up.support);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, FusedFrame> frame) {
  archive(frame.position, frame.frame_index, frame.depth_camera, frame.T_world_camera);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, GhostRevision> revision) {
  auto& verdicts = revision.verdicts;
  for (auto* const voxels : {&verdicts.ghosts, &verdicts.absent, &verdicts.still, &verdicts.unseen}) {
    archive(*voxels);
    if constexpr (Archive::kReads) {
      static constexpr int kReach = 32768;  // range of the octree's 16-bit keys
      const auto is_in_reach = [](const VoxelIndex& v) {
        return (v.array() >= -kReach).all() && (v.array() < kReach).all();
      };
      if (!std::all_of(voxels->begin(), voxels->end(), is_in_reach))
        archive.fail("is damaged: a voxel is past the octree's reach");
    }
  }
  archive(revision.next);
}

namespace {

constexpr const char* kState = "state.bin";
constexpr const char* kOdometry = "odometry";
constexpr const char* kOctree = "octree.bin";
constexpr const char* kPlaces = "places.bin";
constexpr std::string_view kMagic = "RRPRSCAN";
constexpr std::uint32_t kVersion = 8;

}  // namespace

/// All but the odometry.
template <typename Archive>
void serialize(Archive& archive, Ref<Archive, TrackingPass> pass) {
  archive(pass.counts, pass.up);
  if constexpr (Archive::kReads)
    if (pass.up.empty()) archive.fail("is damaged: its number of parts");
  archive(pass.recorded);
}

/// All but the keyframe database and the octree.
template <typename Archive>
void serialize(Archive& archive, Ref<Archive, FusionPass> pass) {
  archive(pass.counts, pass.found.frames, pass.found.up, pass.found.recorded, pass.found.parts,
          pass.T_world_found, pass.frames_read, pass.fused, pass.stopped_for_memory, pass.revision,
          pass.ghost_voxels);
}

void write_state(const TrackingPass& pass, const fs::path& into, const fs::path& previous) {
  save_binary(into / kState, kMagic, kVersion, pass);
  fs::create_directory(into / kOdometry);
  save_odometry(pass.odometry, into / kOdometry, previous.empty() ? fs::path{} : previous / kOdometry);
}

void write_state(const FusionPass& pass, const fs::path& into, const fs::path& previous) {
  save_binary(into / kState, kMagic, kVersion, pass);
  // The keyframe database does not change in this pass.
  if (previous.empty() || !fs::exists(previous / kOctree) || !carry_over(previous / kPlaces, into / kPlaces))
    write_keyframe_database(pass.found.keyframe_database, into / kPlaces);
  pass.octree.write(into / kOctree);
}

TrackingPass read_tracking_pass(const Checkpoint& checkpoint, const OdometryConfig& config) {
  TrackingPass pass(config);
  load_binary(checkpoint.folder / kState, kMagic, kVersion, pass);
  pass.odometry = load_odometry(checkpoint.folder / kOdometry, config);
  return pass;
}

FusionPass read_fusing_pass(const Checkpoint& checkpoint) {
  FusionPass pass;
  load_binary(checkpoint.folder / kState, kMagic, kVersion, pass);
  pass.found.keyframe_database = read_keyframe_database(checkpoint.folder / kPlaces);
  pass.octree = StaticMap::read(checkpoint.folder / kOctree);
  return pass;
}

std::vector<TimedPose> trusted_poses(const FusionPass& pass) {
  std::vector<TimedPose> poses;
  for (const TrackedFrame& tracked : pass.found.frames) {
    if (tracked.trusted)
      poses.push_back({tracked.frame_index, tracked.stamp_s, pass.T_world_found * tracked.T_world_camera});
  }
  return poses;
}

}  // namespace roomradar
