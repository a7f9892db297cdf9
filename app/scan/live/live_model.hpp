// live_model.hpp: coarse mesh of the room, extended during a running scan.
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
  std::size_t anchor = 0;                   ///< index of the anchor with which the part moves
  std::shared_ptr<const Mesh> mesh_anchor;  ///< mesh in the anchor's frame; replaced after each update
};

/// Fuses frames on a separate thread into one small octree per anchor (anchors.hpp), and extracts the
/// octrees' surfaces twice per second. Octrees of anchors that the camera has left are deleted; their meshes
/// remain. Frames that arrive while the thread is busy are ignored. Thread safe.
class LiveModel {
 public:
  /// @param cell_m  voxel size of the octrees; the default is coarser than the default of the scan's map
  explicit LiveModel(double cell_m = 0.02);
  ~LiveModel();
  LiveModel(const LiveModel&) = delete;
  LiveModel& operator=(const LiveModel&) = delete;

  /// Passes a frame to the thread. Returns false, and ignores the frame, if the thread is busy.
  /// @param shows_new  true: the frame shows surface that is not well known (Knowledge::kWell). Other frames
  ///                   are fused only if the anchor's octree still exists
  bool offer(std::shared_ptr<const Frame> frame, std::size_t anchor, const Eigen::Isometry3d& T_anchor_camera,
             bool shows_new);

  /// Returns the current parts.
  [[nodiscard]] std::vector<LiveModelPart> parts() const;
  /// Waits until parts() includes the last frame that offer() accepted.
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
  std::list<Part> open_;  ///< most recently used part first; accessed by the thread only

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
