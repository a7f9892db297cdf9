// ros_transforms.cpp: transforms from child to parent frame, interpolated if they move.
#include "app/sources/datasets/ros_transforms.hpp"

#include <algorithm>

#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kFirstMessages = 500;
constexpr std::uint32_t kFirstBlocks = 16;  // of a compressed file; some MB
constexpr std::size_t kMaxChain = 64;
constexpr double kTfWithin_s = 0.15;

std::vector<RosTransform> transforms_in(const MessageLog& log, const MessageEntry& entry) {
  try {
    const std::string bytes = log.read(entry);
    return read_transforms({log.encoding, bytes, log.name + ": a transform"});
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

RosTransforms::RosTransforms(const MessageLog& log) : log_(log) {
  for (std::uint32_t topic = 0; topic < log.topics.size(); ++topic) {
    const auto& [name, type] = log.topics[topic];
    if (type != "tf2_msgs/TFMessage" && type != "tf/tfMessage") continue;
    const std::vector<MessageEntry> entries = messages_of(log, topic);
    const bool is_static = name.ends_with("tf_static");
    const std::size_t count = is_static ? entries.size() : std::min(entries.size(), kFirstMessages);
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_static && !log.reads_starts && entries[i].block > entries[0].block + kFirstBlocks) break;
      for (const RosTransform& transform : transforms_in(log, entries[i])) {
        if (!is_static && i == 0) header_offset_s_ = transform.header.stamp_s - entries[i].stamp_s;
        add(transform);
      }
    }
    if (!is_static) moving_.insert(moving_.end(), entries.begin(), entries.end());
  }
  std::stable_sort(moving_.begin(), moving_.end(),
                   [](const MessageEntry& a, const MessageEntry& b) { return a.stamp_s < b.stamp_s; });
}

void RosTransforms::add(const RosTransform& transform) {
  const auto T = rigid_pose(transform.t_m, transform.q_xyzw);
  if (!T || transform.child.empty() || transform.child == transform.header.frame_id) return;
  const auto [edge, is_new] = edges_.try_emplace(transform.child, Edge{transform.header.frame_id, *T, false});
  if (!is_new && edge->second.parent == transform.header.frame_id &&
      !edge->second.T_parent_child.isApprox(*T, 1e-9))
    edge->second.moves = true;
}

std::vector<std::string> RosTransforms::chain(const std::string& frame) const {
  std::vector<std::string> frames;
  for (auto edge = edges_.find(frame); edge != edges_.end() && frames.size() < kMaxChain;
       edge = edges_.find(edge->second.parent))
    frames.push_back(edge->first);
  return frames;
}

std::optional<Eigen::Isometry3d> RosTransforms::T_a_b(const std::string& a, const std::string& b) const {
  if (a == b) return Eigen::Isometry3d::Identity();
  // Both chains without the part that they share at the root.
  std::vector<std::string> from_a = chain(a), from_b = chain(b);
  const auto root_of = [&](const std::string& frame, const std::vector<std::string>& frames) {
    return frames.empty() ? frame : edges_.at(frames.back()).parent;
  };
  if (root_of(a, from_a) != root_of(b, from_b)) return std::nullopt;
  while (!from_a.empty() && !from_b.empty() && from_a.back() == from_b.back()) {
    from_a.pop_back();
    from_b.pop_back();
  }
  const auto T_top = [&](const std::vector<std::string>& frames) -> std::optional<Eigen::Isometry3d> {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (const std::string& frame : frames) {
      const Edge& edge = edges_.at(frame);
      if (edge.moves) return std::nullopt;
      T = edge.T_parent_child * T;
    }
    return T;
  };
  const auto T_top_a = T_top(from_a), T_top_b = T_top(from_b);
  if (!T_top_a || !T_top_b) return std::nullopt;
  return T_top_a->inverse() * *T_top_b;
}

bool RosTransforms::moves(const std::string& frame) const {
  const std::vector<std::string> frames = chain(frame);
  return std::any_of(frames.begin(), frames.end(),
                     [this](const std::string& each) { return edges_.at(each).moves; });
}

std::optional<Eigen::Isometry3d> RosTransforms::T_root_frame(const std::string& frame, double stamp_s) const {
  if (!moves(frame)) return std::nullopt;
  std::map<std::string, std::vector<StampedPose>> tracks;
  const double received_s = stamp_s - header_offset_s_;
  const auto first = std::lower_bound(moving_.begin(), moving_.end(), received_s - kTfWithin_s,
                                      [](const MessageEntry& entry, double s) { return entry.stamp_s < s; });
  for (auto entry = first; entry != moving_.end() && entry->stamp_s <= received_s + kTfWithin_s; ++entry)
    for (const RosTransform& transform : transforms_in(log_, *entry)) {
      const auto T = rigid_pose(transform.t_m, transform.q_xyzw);
      const auto edge = edges_.find(transform.child);
      if (T && edge != edges_.end() && edge->second.parent == transform.header.frame_id)
        tracks[transform.child].push_back({transform.header.stamp_s, *T});
    }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (const std::string& each : chain(frame)) {
    const Edge& edge = edges_.at(each);
    if (!edge.moves) {
      T = edge.T_parent_child * T;
      continue;
    }
    std::vector<StampedPose>& track = tracks[each];
    sort_by_stamp(track);
    const auto T_parent_child = pose_at(track, stamp_s, 2 * kTfWithin_s);
    if (!T_parent_child) return std::nullopt;
    T = *T_parent_child * T;
  }
  return T;
}

}  // namespace roomradar
