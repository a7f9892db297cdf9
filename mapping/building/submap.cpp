// submap.cpp: reads and writes submaps; moves a trajectory with its keyframes.
#include "mapping/building/submap.hpp"

#include <algorithm>
#include <iterator>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kSubmapMagic = "RRSUBMAP";
constexpr std::uint32_t kSubmapVersion = 1;
constexpr const char* kSubmapFile = "submap.bin";
constexpr const char* kKeyframesFile = "keyframes.bin";

constexpr std::size_t kPose_bytes = sizeof(std::int64_t) + 17 * sizeof(double);

}  // namespace

/// All but the keyframes' features and depth.
template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, Submap> submap) {
  archive(submap.source, submap.frames_read, submap.timing);
  for (auto* const poses : {&submap.trajectory, &submap.recorded}) {
    serialize_size(archive, *poses, kPose_bytes);
    for (auto& pose : *poses) archive(pose);
  }
  serialize_size(archive, submap.keyframes.keyframes, kPose_bytes);
  double stamp_s = 0.0;  // not used; in the file, a keyframe is a TimedPose
  for (auto& keyframe : submap.keyframes.keyframes)
    archive(keyframe.frame_index, stamp_s, keyframe.T_world_camera);
}

Eigen::Isometry3d pose_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double part) {
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() =
      Eigen::Quaterniond(a.linear()).slerp(part, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  mean.translation() = (1.0 - part) * a.translation() + part * b.translation();
  return mean;
}

void save_submap(const Submap& submap, const std::filesystem::path& folder) {
  save_binary(folder / kSubmapFile, kSubmapMagic, kSubmapVersion, submap);
  write_keyframe_database(submap.keyframes, folder / kKeyframesFile);
}

Submap load_submap_poses(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kSubmapFile;
  Submap submap;
  load_binary(path, kSubmapMagic, kSubmapVersion, submap);
  const auto& keyframes = submap.keyframes.keyframes;
  const auto is_before = [](const auto& a, const auto& b) { return a.frame_index < b.frame_index; };
  if (!std::is_sorted(keyframes.begin(), keyframes.end(), is_before) ||
      !std::is_sorted(submap.trajectory.begin(), submap.trajectory.end(), is_before))
    throw Error(path.string() + ": is damaged: frames are not in order");
  return submap;
}

Submap load_submap(const std::filesystem::path& folder) {
  Submap submap = load_submap_poses(folder);
  KeyframeDatabase read = read_keyframe_database(folder / kKeyframesFile);
  const auto is_same = [](const MapKeyframe& a, const MapKeyframe& b) {
    return a.frame_index == b.frame_index && a.T_world_camera.isApprox(b.T_world_camera, 1e-9);
  };
  if (!std::equal(read.keyframes.begin(), read.keyframes.end(), submap.keyframes.keyframes.begin(),
                  submap.keyframes.keyframes.end(), is_same))
    throw Error((folder / kKeyframesFile).string() + ": does not belong to the submap beside it");
  submap.keyframes = std::move(read);
  return submap;
}

std::vector<Submap> split_at_losses(const Submap& submap, std::int64_t max_gap, std::size_t min_frames) {
  std::vector<Submap> parts;
  for (const TimedPose& frame : submap.trajectory) {
    if (parts.empty() || frame.frame_index - parts.back().trajectory.back().frame_index > max_gap + 1)
      parts.push_back({submap.source, submap.frames_read, submap.timing, {}, {}, {}});
    parts.back().trajectory.push_back(frame);
  }
  for (Submap& part : parts) {
    const auto is_within = [&](const auto& item) {
      return item.frame_index >= part.trajectory.front().frame_index &&
             item.frame_index <= part.trajectory.back().frame_index;
    };
    std::copy_if(submap.recorded.begin(), submap.recorded.end(), std::back_inserter(part.recorded),
                 is_within);
    std::copy_if(submap.keyframes.keyframes.begin(), submap.keyframes.keyframes.end(),
                 std::back_inserter(part.keyframes.keyframes), is_within);
  }
  std::erase_if(parts, [&](const Submap& part) {
    return part.trajectory.size() < min_frames || part.keyframes.keyframes.empty();
  });
  return parts;
}

std::vector<TimedPose> corrected_trajectory(const Submap& submap,
                                            std::span<const Eigen::Isometry3d> T_world_keyframe) {
  const auto& keyframes = submap.keyframes.keyframes;
  std::vector<TimedPose> corrected;
  if (keyframes.empty() || T_world_keyframe.size() != keyframes.size()) return corrected;
  std::size_t next = 0;  // first keyframe after the frame
  for (const TimedPose& frame : submap.trajectory) {
    while (next < keyframes.size() && keyframes[next].frame_index <= frame.frame_index) ++next;
    const auto moved_with = [&](std::size_t k) -> Eigen::Isometry3d {
      return T_world_keyframe[k] * keyframes[k].T_world_camera.inverse() * frame.T_world_camera;
    };
    Eigen::Isometry3d T_world_camera;
    if (next == 0 || next == keyframes.size()) {
      T_world_camera = moved_with(next == 0 ? 0 : next - 1);
    } else {
      const auto before = static_cast<double>(frame.frame_index - keyframes[next - 1].frame_index);
      const auto span = static_cast<double>(keyframes[next].frame_index - keyframes[next - 1].frame_index);
      T_world_camera = pose_between(moved_with(next - 1), moved_with(next), before / span);
    }
    corrected.push_back({frame.frame_index, frame.stamp_s, T_world_camera});
  }
  return corrected;
}

}  // namespace roomradar
