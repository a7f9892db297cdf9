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
#include "mapping/prescan.hpp"

namespace roomradar {

/// Prepares pictures, tint, advice and the live model on separate threads, so that the scan does not wait.
/// Frames that arrive while the view is busy are not shown.
class ScanView final : public ScanObserver {
 public:
  /// @param channel  must outlive the view
  /// @param max_memory_bytes, folder  see resources_now()
  /// @param first_view  view suggested as the next view until the camera has reached it, in the world frame
  ///                    of the extended map; unset: none
  explicit ScanView(ScanChannel& channel, std::size_t max_memory_bytes = 0,
                    std::filesystem::path folder = ".", std::optional<NextView> first_view = {});
  ~ScanView() override;

  void after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry,
                   const StageTimes& times) override;
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
    bool is_located = false;  ///< the odometry's world frame is that of the map
    std::vector<Eigen::Vector3f> path_world;
    std::vector<Keyframe> keyframes;  ///< only if the next view is to be searched
    ScanCounts counts;
  };
  struct Pose {
    double stamp_s = 0.0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  };

  /// Used on the scan's thread.
  struct Scan {
    Anchors anchors;
    bool has_moved = false;
    std::optional<Pose> last;
    double speed_mps = 0.0, speed_rad_s = 0.0;
    std::int64_t frames = 0;
    std::deque<double> seen_s;             ///< times at which the last frames arrived
    double read_ms = 0.0, track_ms = 0.0;  ///< smoothed
  };
  /// Up direction, estimated again whenever the number of frames has grown by half.
  struct Up {
    UpEstimator estimator;
    std::int64_t frames = 0, due = 1;
    Eigen::Isometry3d T_shown_world = Eigen::Isometry3d::Identity();  ///< rotation; up becomes +z
  };
  /// Values that are computed every 30 frames.
  struct Counted {
    const std::size_t max_memory_bytes;
    const std::filesystem::path folder;
    std::int64_t since = 0;  ///< frames since they were computed
    double well_known = 0.0;
    std::optional<double> table_tops_known{};
    ResourceForecast forecast{};
  };
  /// Result of a search for views and holes, in the levelled world frame that was current when the search
  /// began.
  struct Explored {
    Eigen::Isometry3d T_shown_world = Eigen::Isometry3d::Identity();
    std::optional<ExplorationGrid> grid;
    std::optional<NextView> next_view;
    std::vector<Hole> holes;
  };
  struct Search {
    std::optional<NextView> first_view;  ///< in the odometry's world frame
    Explored last{};
    std::vector<NumberedHole> holes{};
    std::chrono::steady_clock::time_point begun{};
    std::future<Explored> running{};
  };
  /// Passes work from the scan's thread to the view's; guarded by `mutex`.
  struct Handover {
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Work> work;
    bool is_busy = false, is_closed = false;
  };

  Scan scan_;

  // Used on the view's thread.
  ScanChannel& channel_;
  KnowledgeGrid knowledge_;
  ObservedArea seen_;
  ScanAdvice advice_;
  ShownScan shown_;
  ColourImage last_good_;
  Up up_;
  Counted counted_;
  LiveModel model_;
  Search search_;

  std::atomic<bool> wants_keyframes_ = true;
  Handover handover_;
  std::thread thread_;  ///< declared last because it uses the members above

  void measure_speed(const Frame& frame, const Tracking& tracking);
  void serve();
  void show(const Work& work);
  void show_state(const Work& work);
  void explore(const Work& work);
  [[nodiscard]] std::optional<NextView> next_view(const Work& work) const;
  void estimate_up(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
};

}  // namespace roomradar
