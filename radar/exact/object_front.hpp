// object_front.hpp: M of a moving object, kept between queries, at the resolution that pays.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "radar/exact/object_height_map.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/exact/scene_in_frame.hpp"

namespace roomradar {

/// The object's height map, kept while the object's tree and the direction in its frame are unchanged.
/// Per query: direction_in_object(), turn(), build(), then add_work(). Not thread safe.
class ObjectFront {
 public:
  /// Returns the unit direction in the object's frame. Reuses the last one if only rounding differs, so M
  /// stays valid.
  Eigen::Vector3d direction_in_object(const RadarQuery& query);
  /// Computes bounds(); build() must follow.
  void turn(const TurnedTree& object);
  /// Builds a coarse M for a new direction, and a finer one once the direction has repeated so often that the
  /// finer M would have paid by now. M's pixels then rule out nearly all of the scene, whatever the object's
  /// triangles are. The exact result does not depend on M's resolution.
  void build(const TurnedTree& object, const SceneInFrame& scene, const RadarConfig& config);
  /// Adds the work of a query with this M, in units of ColumnScratch::work.
  void add_work(std::uint64_t work) { work_ += work; }

  [[nodiscard]] const ObjectHeightMap& map() const { return map_; }
  /// See ObjectHeightMap::bounds().
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return map_.bounds(); }

 private:
  ObjectHeightMap map_;
  bool is_kept_ = false;    // the last turn() changed nothing
  std::uint64_t work_ = 0;  // of all queries since map_ was last turned
  Eigen::Vector3d u_mesh_ = Eigen::Vector3d::Zero();
};

}  // namespace roomradar
