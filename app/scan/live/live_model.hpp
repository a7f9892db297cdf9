// live_model.hpp: coarse mesh of the room that grows while a scan goes on.
#pragma once
#include <Eigen/Geometry>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A part of the live model.
struct LiveModelPart {
  std::size_t anchor = 0;                   ///< the part's coordinate frame moves with this anchor
  std::shared_ptr<const Mesh> mesh_anchor;  ///< in the anchor's frame; replaced when it has grown
};

/// Fuses frames on a thread of its own into one small octree per anchor, and extracts their surfaces twice a
/// second. Octrees of anchors that the camera has left are dropped; their meshes stay. Frames that come while
/// the thread is busy are left out. Thread safe.
class LiveModel {
 public:
  /// @param cell_m  edge of the octrees' voxels; the scan's own map has smaller ones
  explicit LiveModel(double cell_m = 0.02);
  ~LiveModel();
  LiveModel(const LiveModel&) = delete;
  LiveModel& operator=(const LiveModel&) = delete;

  /// Passes a frame to the thread. Returns false, and ignores the frame, if the thread is busy.
  /// @param shows_new  the frame shows places that are not known well. Other frames are fused only where the
  ///                   anchor's octree still exists
  bool offer(std::shared_ptr<const Frame> frame, std::size_t anchor, const Eigen::Isometry3d& T_anchor_camera,
             bool shows_new);

  /// Returns the current parts.
  [[nodiscard]] std::vector<LiveModelPart> parts() const;
  /// Waits until the last frame handed over is in the parts.
  void finish();

 private:
  struct Work {
    std::shared_ptr<const Frame> frame;
    std::size_t anchor = 0;
    Eigen::Isometry3d T_anchor_camera = Eigen::Isometry3d::Identity();
    bool shows_new = false;
  };
  struct Part {
    std::size_t anchor = 0;
    StaticMap map;
    bool is_changed = false;  ///< since its mesh was extracted
    std::size_t index = 0;    ///< in parts_
  };

  const double cell_m_;
  std::list<Part> open_;  ///< the part used last first; only the thread uses it

  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::optional<Work> work_;
  bool is_busy_ = false, is_finishing_ = false, is_closed_ = false;
  std::vector<LiveModelPart> parts_;
  std::thread thread_;  ///< declared last because it uses the members above

  void serve();
  void fuse(const Work& work);
  void extract(Part& part);
};

}  // namespace roomradar
