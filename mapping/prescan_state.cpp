// prescan_state.cpp: fields of a prescan's state, and the files that contain them.
//
// state.bin: a file as in binary_file.hpp with magic "RRPRSCAN" and the fields in the order of the functions
// below. Numbers are little-endian; lists are preceded by their length (u64). Beside it are odometry/ in the
// first pass (odometry_checkpoint.cpp), and octree.ot and places.bin, as in a map, in the second.
#include "mapping/prescan_state.hpp"

#include <algorithm>
#include <string>

#include "mapping/odometry/odometry_checkpoint.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

namespace fs = std::filesystem;

template <typename Archive>
void transfer(Archive& archive, PrescanCounts& counts) {
  for (std::int64_t* count :
       {&counts.frames_read, &counts.frames_skipped, &counts.frames_tracked, &counts.frames_fused,
        &counts.frames_lost, &counts.keyframes, &counts.loops_found, &counts.ghost_voxels}) {
    transfer(archive, *count);
    if constexpr (Archive::kReads) {
      if (*count < 0) archive.fail("is damaged: a count is negative");
    }
  }
  transfer(archive, counts.stopped_for_memory);
  transfer(archive, counts.last_fault);
}

template <typename Archive>
void transfer(Archive& archive, TimedPose& pose) {
  transfer(archive, pose.frame_index);
  transfer(archive, pose.stamp_s);
  transfer(archive, pose.T_world_camera);
}

template <typename Archive>
void transfer(Archive& archive, TrackedFrame& frame) {
  transfer(archive, frame.frame_index);
  transfer(archive, frame.stamp_s);
  transfer(archive, frame.T_world_camera);
  transfer(archive, frame.status, TrackStatus::kDiverged);
  transfer(archive, frame.trusted);
}

template <typename Archive>
void transfer(Archive& archive, UpDirection& up) {
  transfer(archive, up.source, UpSource::kPlane);
  transfer(archive, up.up_world);
  transfer(archive, up.support);
}

template <typename Archive>
void transfer(Archive& archive, FusedFrame& frame) {
  transfer(archive, frame.position);
  transfer(archive, frame.frame_index);
  transfer(archive, frame.depth_camera);
  transfer(archive, frame.T_world_camera);
}

template <typename Archive>
void transfer(Archive& archive, GhostRevision& revision) {
  GhostVotes::Verdicts& verdicts = revision.verdicts;
  for (std::vector<VoxelIndex>* voxels :
       {&verdicts.ghosts, &verdicts.absent, &verdicts.still, &verdicts.unseen}) {
    transfer(archive, *voxels);
    if constexpr (Archive::kReads) {
      static constexpr int kReach = 32768;  // range of the octree's 16-bit keys
      const auto is_in_reach = [](const VoxelIndex& v) {
        return (v.array() >= -kReach).all() && (v.array() < kReach).all();
      };
      if (!std::all_of(voxels->begin(), voxels->end(), is_in_reach))
        archive.fail("is damaged: a voxel is past the octree's reach");
    }
  }
  transfer(archive, revision.next);
}

namespace {

constexpr const char* kState = "state.bin";
constexpr const char* kOdometry = "odometry";
constexpr const char* kOctree = "octree.ot";
constexpr const char* kPlaces = "places.bin";
constexpr std::string_view kMagic = "RRPRSCAN";
constexpr std::uint32_t kVersion = 4;

template <typename Archive>
void transfer_state(Archive& archive, TrackingPass& pass) {
  transfer(archive, pass.counts);
  pass.up.transfer_fields(archive);
  transfer(archive, pass.recorded);
}

template <typename Archive>
void transfer_state(Archive& archive, FusingPass& pass) {
  transfer(archive, pass.counts);
  transfer(archive, pass.found.frames);
  transfer(archive, pass.found.up);
  transfer(archive, pass.found.recorded);
  transfer(archive, pass.T_world_found);
  transfer(archive, pass.frames_read);
  transfer(archive, pass.fused);
  transfer(archive, pass.stopped_for_memory);
  transfer(archive, pass.revision);
  transfer(archive, pass.ghost_voxels);
}

template <typename Pass>
void write_fields(Pass& pass, const fs::path& path) {
  ByteWriter archive;
  transfer_state(archive, pass);
  write_binary(path, kMagic, kVersion, archive.bytes());
}

template <typename Pass>
void read_fields(const fs::path& path, Pass& pass) {
  const std::string bytes = read_binary(path, kMagic, kVersion);
  ByteReader archive(bytes, path.string());
  transfer_state(archive, pass);
  archive.require_end();
}

}  // namespace

void write_state(TrackingPass& pass, const fs::path& into, const fs::path& previous) {
  write_fields(pass, into / kState);
  fs::create_directory(into / kOdometry);
  save_odometry(pass.odometry, into / kOdometry, previous.empty() ? fs::path{} : previous / kOdometry);
}

void write_state(FusingPass& pass, const fs::path& into, const fs::path& previous) {
  write_fields(pass, into / kState);
  // The keyframe database does not change in this pass.
  if (previous.empty() || !fs::exists(previous / kOctree) || !carry_over(previous / kPlaces, into / kPlaces))
    write_places(pass.found.places, into / kPlaces);
  pass.octree.write_ot(into / kOctree);
}

TrackingPass read_tracking_pass(const Checkpoint& checkpoint, const OdometryConfig& config) {
  TrackingPass pass(config);
  read_fields(checkpoint.folder / kState, pass);
  pass.odometry = load_odometry(checkpoint.folder / kOdometry, config);
  return pass;
}

FusingPass read_fusing_pass(const Checkpoint& checkpoint) {
  FusingPass pass;
  read_fields(checkpoint.folder / kState, pass);
  pass.found.places = read_places(checkpoint.folder / kPlaces);
  pass.octree = StaticMap::read_ot(checkpoint.folder / kOctree);
  return pass;
}

}  // namespace roomradar
