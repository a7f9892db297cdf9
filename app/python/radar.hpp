// radar.hpp: Python bindings of Cyber Radar: distance to contact of moving objects, for single queries and
// batches.
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <vector>

#include "mapping/types/frame.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar::python {

/// The surfaces of queries. Shares ownership of trees and frames. Rejects changes while another call reads
/// the scene.
class Scene {
 public:
  std::size_t add_tree(std::shared_ptr<TriangleTree> tree, const Eigen::Isometry3d& T_world_mesh,
                       SurfaceKind kind);
  void add_depth(std::shared_ptr<Frame> frame, SceneDepth depth);
  void set_pose(std::size_t index, const Eigen::Isometry3d& T_world_mesh);
  [[nodiscard]] std::size_t size() const { return trees_.size(); }
  [[nodiscard]] RadarScene radar_scene() const { return {trees_, depths_, nullptr}; }

  /// Guard that marks the scene as being read, for calls without the interpreter's lock.
  class Reading {
   public:
    explicit Reading(Scene& scene) : readers_(scene.readers_) { ++readers_; }
    ~Reading() { --readers_; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    std::atomic<int>& readers_;
  };

 private:
  std::vector<SceneTree> trees_;
  std::vector<SceneDepth> depths_;
  std::vector<std::shared_ptr<TriangleTree>> kept_trees_;
  std::vector<std::shared_ptr<Frame>> kept_frames_;
  std::atomic<int> readers_ = 0;

  void require_unread() const;
};

/// Call after bind_meshes() and bind_frames().
void bind_radar(pybind11::module_& module);

}  // namespace roomradar::python
