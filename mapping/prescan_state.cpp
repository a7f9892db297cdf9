// prescan_state.cpp: fields of a prescan's state, and the files that contain them.
//
// state.bin: a file as in binary_file.hpp with magic "RRPRSCAN" and the fields in the order of the functions
// below. Numbers are little-endian; lists are preceded by their length (u64). Beside it are odometry/ in the
// first pass (odometry_checkpoint.cpp), and octree.bin and places.bin, as in a map, in the second.
#include "mapping/prescan_state.hpp"

#include <algorithm>
#include <string>

#include "mapping/localization/keyframe_database_file.hpp"
#include "mapping/odometry/odometry_checkpoint.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {

namespace fs = std::filesystem;

template <typename Archive>
void serialize(Archive& archive, PrescanCounts& counts) {
  for (std::int64_t* count :
       {&counts.frames_read, &counts.frames_skipped, &counts.frames_tracked, &counts.frames_fused,
        &counts.frames_lost, &counts.keyframes, &counts.loops_found, &counts.restarts, &counts.ghost_voxels,
        &counts.recorded_used, &counts.recorded_contradicted}) {
    serialize(archive, *count);
    if constexpr (Archive::kReads) {
      if (*count < 0) archive.fail("is damaged: a count is negative");
    }
  }
  serialize(archive, counts.timing);
  serialize(archive, counts.recorded_sigma_m);
  serialize(archive, counts.stopped_for_memory);
  serialize(archive, counts.last_fault);
}

template <typename Archive>
void serialize(Archive& archive, TrackedFrame& frame) {
  serialize(archive, frame.frame_index);
  serialize(archive, frame.stamp_s);
  serialize(archive, frame.T_world_camera);
  serialize(archive, frame.status, TrackStatus::kDiverged);
  serialize(archive, frame.part);
  serialize(archive, frame.trusted);
}

template <typename Archive>
void serialize(Archive& archive, ScanPart& part) {
  serialize(archive, part.first);
  serialize(archive, part.last);
  serialize(archive, part.frames);
  serialize(archive, part.is_joined);
}

template <typename Archive>
void serialize(Archive& archive, UpDirection& up) {
  serialize(archive, up.source, UpSource::kPlane);
  serialize(archive, up.up_world);
  serialize(archive, up.support);
}

template <typename Archive>
void serialize(Archive& archive, FusedFrame& frame) {
  serialize(archive, frame.position);
  serialize(archive, frame.frame_index);
  serialize(archive, frame.depth_camera);
  serialize(archive, frame.T_world_camera);
}

template <typename Archive>
void serialize(Archive& archive, GhostRevision& revision) {
  GhostVotes::Verdicts& verdicts = revision.verdicts;
  for (std::vector<VoxelIndex>* voxels :
       {&verdicts.ghosts, &verdicts.absent, &verdicts.still, &verdicts.unseen}) {
    serialize(archive, *voxels);
    if constexpr (Archive::kReads) {
      static constexpr int kReach = 32768;  // range of the octree's 16-bit keys
      const auto is_in_reach = [](const VoxelIndex& v) {
        return (v.array() >= -kReach).all() && (v.array() < kReach).all();
      };
      if (!std::all_of(voxels->begin(), voxels->end(), is_in_reach))
        archive.fail("is damaged: a voxel is past the octree's reach");
    }
  }
  serialize(archive, revision.next);
}

namespace {

constexpr const char* kState = "state.bin";
constexpr const char* kOdometry = "odometry";
constexpr const char* kOctree = "octree.bin";
constexpr const char* kPlaces = "places.bin";
constexpr std::string_view kMagic = "RRPRSCAN";
constexpr std::uint32_t kVersion = 7;

template <typename Archive>
void serialize_state(Archive& archive, TrackingPass& pass) {
  serialize(archive, pass.counts);
  auto parts = static_cast<std::uint64_t>(pass.up.size());
  serialize(archive, parts);
  if constexpr (Archive::kReads) {
    constexpr std::uint64_t kMost = 1'000'000;
    if (parts == 0 || parts > kMost) archive.fail("is damaged: its number of parts");
    pass.up.resize(static_cast<std::size_t>(parts));
  }
  for (UpEstimator& up : pass.up) up.serialize_fields(archive);
  serialize(archive, pass.recorded);
}

template <typename Archive>
void serialize_state(Archive& archive, FusionPass& pass) {
  serialize(archive, pass.counts);
  serialize(archive, pass.found.frames);
  serialize(archive, pass.found.up);
  serialize(archive, pass.found.recorded);
  serialize(archive, pass.found.parts);
  serialize(archive, pass.T_world_found);
  serialize(archive, pass.frames_read);
  serialize(archive, pass.fused);
  serialize(archive, pass.stopped_for_memory);
  serialize(archive, pass.revision);
  serialize(archive, pass.ghost_voxels);
}

template <typename Pass>
void write_fields(Pass& pass, const fs::path& path) {
  ByteWriter archive;
  serialize_state(archive, pass);
  write_binary(path, kMagic, kVersion, archive.bytes());
}

template <typename Pass>
void read_fields(const fs::path& path, Pass& pass) {
  const std::string bytes = read_binary(path, kMagic, kVersion);
  ByteReader archive(bytes, path.string());
  serialize_state(archive, pass);
  archive.require_end();
}

}  // namespace

void write_state(TrackingPass& pass, const fs::path& into, const fs::path& previous) {
  write_fields(pass, into / kState);
  fs::create_directory(into / kOdometry);
  save_odometry(pass.odometry, into / kOdometry, previous.empty() ? fs::path{} : previous / kOdometry);
}

void write_state(FusionPass& pass, const fs::path& into, const fs::path& previous) {
  write_fields(pass, into / kState);
  // The keyframe database does not change in this pass.
  if (previous.empty() || !fs::exists(previous / kOctree) || !carry_over(previous / kPlaces, into / kPlaces))
    write_keyframe_database(pass.found.keyframe_database, into / kPlaces);
  pass.octree.write(into / kOctree);
}

TrackingPass read_tracking_pass(const Checkpoint& checkpoint, const OdometryConfig& config) {
  TrackingPass pass(config);
  read_fields(checkpoint.folder / kState, pass);
  pass.odometry = load_odometry(checkpoint.folder / kOdometry, config);
  return pass;
}

FusionPass read_fusing_pass(const Checkpoint& checkpoint) {
  FusionPass pass;
  read_fields(checkpoint.folder / kState, pass);
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
