// scan_channel.hpp: thread-safe channel between the scan window's thread and the scan's thread.
#pragma once
#include <Eigen/Geometry>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scan/live/holes_so_far.hpp"
#include "app/scan/live/scan_advice.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A part of the live model, and its pose.
struct ShownPart {
  std::shared_ptr<const Mesh> mesh;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

/// Next-best view, see best_next_view().
struct ShownNextView {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::string way;  ///< directions from the camera to the view, in words
};

struct ScanCounts {
  std::int64_t frames = 0;
  double frames_per_s = 0.0;
  double read_ms = 0.0, track_ms = 0.0;  ///< per frame, smoothed; read_ms includes waiting for the frame
  std::int64_t keyframes = 0;
  std::int64_t loops = 0;
  double seen_m2 = 0.0;
  double well_known = 0.0;                   ///< well-measured fraction of the seen surface
  std::optional<double> table_tops_known{};  ///< the same of table tops; unset: none was seen above a floor
  std::size_t memory_bytes = 0;
  /// Time until memory or disk space is exhausted; unset: unknown.
  std::optional<double> left_s{};
};

/// State of a scan after a frame. +z of the world frame is the current estimate of the up direction.
struct ShownScan {
  std::int64_t frame_index = -1;  ///< -1: no frame so far
  double stamp_s = 0.0;
  ColourImage picture;        ///< colour image; depth as a grey image if there is no colour
  Image<std::uint32_t> tint;  ///< overlay for the picture, of lower resolution: RGBA, red in the lowest byte
  TrackStatus status = TrackStatus::kTracked;
  std::optional<ScanFault> fault;
  double relative_speed = 0.0;  ///< see relative_speed()
  Intrinsics camera;            ///< depth camera
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::vector<ShownPart> parts;
  std::vector<Eigen::Vector3f> path_world;  ///< trajectory: positions of the keyframes, then of the camera
  std::optional<ShownNextView> next_view;   ///< unset: unknown, or no unseen surface is near
  std::vector<NumberedHole> holes;          ///< the largest holes above the floor, near the camera
  ScanCounts counts;
};

/// Result of a scan, for its window.
struct ScanOutcome {
  std::string text;                       ///< empty: the scan is still running
  std::shared_ptr<const Mesh> surface{};  ///< surface of the saved map; null: there is no map
  std::vector<NumberedHole> holes{};      ///< holes inside the scan, in the map's world frame
};

/// Progress of a scan's work after its last frame.
struct ScanStage {
  std::string name;                   ///< stage name, as in PrescanProgress; empty: tracking is still running
  std::int64_t done = 0;              ///< number of frames processed in this stage
  std::optional<std::int64_t> total;  ///< unset: unknown
};

/// The user's requests to a scan.
enum class ScanRequest {
  kGoOn,
  kFinish,   ///< make the map of the frames so far
  kDiscard,  ///< end without a map
  kPlay,     ///< play in the map of the scan, which is over
};

/// Connects one window and one scan. Thread safe.
class ScanChannel {
 public:
  /// @param wake  called after each new state
  explicit ScanChannel(std::function<void()> wake = [] {}) : wake_(std::move(wake)) {}

  // For the window's thread.
  void set_paused(bool is_paused);
  [[nodiscard]] bool is_paused() const;
  void request(ScanRequest request);
  /// Requests that the frames of the scan's last `seconds` be discarded.
  void undo(double seconds);
  /// Swaps the newest state with `shown`. Returns false if no state was published since the last call.
  bool take(ShownScan& shown);
  [[nodiscard]] ScanStage stage() const;
  /// Returns the result once the scan is over. Until then, ScanOutcome::text is empty.
  [[nodiscard]] ScanOutcome outcome() const;

  // For the scan's thread.
  [[nodiscard]] ScanRequest requested() const;
  /// Returns the sum of the durations passed to undo() since the last call, s.
  double take_undo_s();
  /// Waits while the window is paused. Returns early if the user makes a request.
  void wait_while_paused();
  /// Publishes `filled`, and swaps it with an old state whose memory can be reused.
  void publish(ShownScan& filled);
  void set_stage(ScanStage stage);
  void finish(ScanOutcome outcome);

 private:
  std::function<void()> wake_;
  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  ShownScan newest_;
  ScanStage stage_;
  ScanOutcome outcome_;
  ScanRequest request_ = ScanRequest::kGoOn;
  double undo_s_ = 0.0;
  bool is_fresh_ = false, is_paused_ = false;
};

}  // namespace roomradar
