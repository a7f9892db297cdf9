// ros_transforms.hpp: the tree of coordinate frames that a ROS recording publishes (tf).
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/sources/containers/message_log.hpp"
#include "app/sources/containers/ros_messages.hpp"

namespace roomradar {

/// Stores the tree and its static transforms. Transforms that vary with time are not stored: each query reads
/// the messages around its time again.
class RosTransforms {
 public:
  /// Reads all messages of tf_static and the first 500 of tf, fewer in a compressed file. Ignores damaged
  /// messages.
  /// @param log  must outlive this object
  explicit RosTransforms(const MessageLog& log);

  /// Returns the constant transform from frame `b` to frame `a`. Returns nullopt if the tree does not connect
  /// the frames, or if a transform on the path between them varies with time.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_a_b(const std::string& a, const std::string& b) const;

  /// Returns true if `frame` moves relative to the root of its tree.
  [[nodiscard]] bool moves(const std::string& frame) const;

  /// Returns the pose of `frame` in the root frame of its tree. `stamp_s` is a time on the clock of the
  /// message headers. Returns nullopt if `frame` does not move relative to the root. Also returns nullopt
  /// unless each varying transform up to the root has a message within 0.15 s before stamp_s and one within
  /// 0.15 s after.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_root_frame(const std::string& frame, double stamp_s) const;

 private:
  struct Edge {
    std::string parent;
    Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
    bool moves = false;
  };
  void add(const RosTransform& transform);
  /// Returns the frames from `frame` up to, not including, the root.
  [[nodiscard]] std::vector<std::string> chain(const std::string& frame) const;

  const MessageLog& log_;
  std::map<std::string, Edge> edges_;  // by child
  std::vector<MessageEntry> moving_;   // messages of tf, by time of reception
  double header_offset_s_ = 0.0;       // stamp of the headers minus time of reception
};

}  // namespace roomradar
