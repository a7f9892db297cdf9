// octree.hpp: the octree of occupancy and signed distance for Python, for fusion and queries.
#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <shared_mutex>
#include <utility>

#include "mapping/octree/static_map.hpp"

namespace roomradar::python {

/// An octree for fusion, or the immutable octree of a saved map. Thread safe: reading calls may run
/// concurrently, modifying calls are exclusive.
class Octree {
 public:
  explicit Octree(StaticMap map) : Octree(std::make_shared<StaticMap>(std::move(map))) {}
  explicit Octree(std::shared_ptr<const StaticMap> saved) : map_(std::move(saved)) {}

  /// Calls work(const StaticMap&) without the interpreter's lock. Excludes concurrent change().
  template <typename Work>
  auto read(const Work& work) const {
    const pybind11::gil_scoped_release release;
    const std::shared_lock lock(mutex_);
    return work(*map_);
  }
  /// Calls work(StaticMap&) without the interpreter's lock. Excludes all concurrent calls. Throws Error for
  /// the octree of a saved map.
  template <typename Work>
  auto change(const Work& work) {
    StaticMap& map = changeable();
    const pybind11::gil_scoped_release release;
    const std::unique_lock lock(mutex_);
    return work(map);
  }

 private:
  std::shared_ptr<const StaticMap> map_;
  StaticMap* changing_ = nullptr;  ///< equals map_; null for the octree of a saved map
  mutable std::shared_mutex mutex_;

  explicit Octree(std::shared_ptr<StaticMap> own) : map_(own), changing_(own.get()) {}

  [[nodiscard]] StaticMap& changeable() const;
};

/// Returns the occupancy at points (N, 3) as uint8 (N,): the values of Occupancy.
pybind11::object occupancy_of(const Octree& octree, const pybind11::object& points_world);

}  // namespace roomradar::python
