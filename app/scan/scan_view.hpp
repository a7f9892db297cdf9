// scan_view.hpp: follows a scan and publishes the content of the scan window.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/scan/live/anchors.hpp"
#include "app/scan/live/holes_so_far.hpp"
#include "app/scan/live/knowledge_grid.hpp"
#include "app/scan/live/live_model.hpp"
#include "app/scan/live/next_view.hpp"
#include "app/scan/live/scan_advice.hpp"
#include "app/scan/live/scan_resources.hpp"
#include "app/scan/scan_channel.hpp"
#include "mapping/coverage/observed_area.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/scan_observer.hpp"

namespace roomradar {

/// Prepares pictures, tint, advice and the live model on threads of its own, so that the scan does not wait.
/// A frame that comes while the view is busy is not shown.
class ScanView final : public ScanObserver {
 public:
  /// @param channel  must outlive the view
  /// @param max_memory_bytes, folder  see resources_now()
  /// @param first_view  view, in the world of the map that is extended, that is shown as the next one until
  ///                    the camera has been there; unset: none
  explicit ScanView(ScanChannel& channel, std::size_t max_memory_bytes = 0,
                    std::filesystem::path folder = ".", std::optional<NextView> first_view = {});
  ~ScanView() override;

  void after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry) override;
  double take_undo_s() override { return channel_.take_undo_s(); }
  void forgot_frames(std::int64_t from_index) override;

 private:
  /// One frame, and the odometry's state after it.
  struct Work {
    std::shared_ptr<Frame> frame;
    Tracking tracking;
    ScanFacts facts;
    std::size_t anchor = 0;
    AnchorPoses T_world_anchor;
    bool has_moved = false;   ///< anchors moved since the last work
    bool is_located = false;  ///< the odometry's world is that of the map
    std::vector<Eigen::Vector3f> path_world;
    std::vector<Keyframe> keyframes;  ///< only if the next view is to be searched
    ScanCounts counts;
  };
  struct Pose {
    double stamp_s = 0.0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  };

  // For the scan's thread.
  Anchors anchors_;
  bool has_moved_ = false;
  std::optional<Pose> last_;
  double speed_mps_ = 0.0, speed_rad_s_ = 0.0;
  std::int64_t frames_ = 0;
  std::deque<double> seen_s_;  ///< times at which the last frames arrived

  // For the view's thread.
  ScanChannel& channel_;
  KnowledgeGrid knowledge_;
  ObservedArea seen_;
  ScanAdvice advice_;
  ShownScan shown_;
  ColourImage last_good_;
  UpEstimator up_;
  std::int64_t up_frames_ = 0, up_due_ = 1;
  Eigen::Isometry3d T_shown_world_ = Eigen::Isometry3d::Identity();  ///< rotates up to +z
  double well_known_ = 0.0;
  std::optional<double> table_tops_known_;
  std::int64_t since_counted_ = 0;  ///< frames since well_known_ was counted
  const std::size_t max_memory_bytes_;
  const std::filesystem::path folder_;
  ResourceForecast forecast_;
  LiveModel model_;
  /// Result of a search for views and holes, in the shown world of its time.
  struct Explored {
    Eigen::Isometry3d T_shown_world = Eigen::Isometry3d::Identity();
    std::optional<ExplorationGrid> grid;
    std::optional<NextView> next_view;
    std::vector<Hole> holes;
  };
  Explored explored_;
  std::vector<NumberedHole> holes_;
  std::optional<NextView> first_view_;  ///< in the odometry's world
  std::chrono::steady_clock::time_point searched_{};
  std::future<Explored> search_;

  std::atomic<bool> wants_keyframes_ = true;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::optional<Work> work_;
  bool is_busy_ = false, is_closed_ = false;
  std::thread thread_;  ///< declared last because it uses the members above

  void measure_speed(const Frame& frame, const Tracking& tracking);
  void serve();
  void show(const Work& work);
  void explore(const Work& work);
  [[nodiscard]] std::optional<NextView> next_view(const Work& work) const;
  void estimate_up(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
};

}  // namespace roomradar
