// object_front.hpp: keeps M, the height map of a moving object's leading surface, between queries.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "radar/exact/object_height_map.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/exact/scene_in_frame.hpp"

namespace roomradar {

/// Keeps the object's height map M while the object's tree and the direction in the object's frame are
/// unchanged, and chooses its resolution. Each query calls direction_in_object(), turn(), build() and
/// add_work(), in this order. Not thread safe.
class ObjectFront {
 public:
  /// Returns the unit direction of motion in the object's frame. If the direction differs from the previous
  /// call's by less than 1e-13, returns the previous one, so M can be reused.
  Eigen::Vector3d direction_in_object(const RadarQuery& query);
  /// Sets the object's orientation and computes bounds(); build() must follow.
  void turn(const TurnedTree& object);
  /// Builds a coarse M for a new direction. For a repeated direction, builds a finer M once the queries with
  /// this direction have cost more than half as much as building it. M's resolution affects the speed of an
  /// exact query, not its result.
  void build(const TurnedTree& object, const SceneInFrame& scene, const RadarConfig& config);
  /// Adds the cost of a query, in units of ColumnScratch::work.
  void add_work(std::uint64_t work) { work_ += work; }

  [[nodiscard]] const ObjectHeightMap& map() const { return map_; }
  /// Returns the bounds of the whole object in the frame of the motion, margin included, m.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return map_.bounds(); }

 private:
  ObjectHeightMap map_;
  // True if the last turn() changed nothing.
  bool is_kept_ = false;
  // Accumulated cost of all queries since the last change of object or direction, in units of
  // ColumnScratch::work.
  std::uint64_t work_ = 0;
  /// Previous query's direction of motion, in the object's frame.
  Eigen::Vector3d u_mesh_ = Eigen::Vector3d::Zero();
};

}  // namespace roomradar
