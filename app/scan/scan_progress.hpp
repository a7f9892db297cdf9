// scan_progress.hpp: shows the stages of a scan on stderr and in its window, and ends the scan on Ctrl-C.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/progress.hpp"
#include "app/scan/scan_channel.hpp"
#include "app/scan/scan_view.hpp"
#include "app/scan/unfinished_scan.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Message printed when Ctrl-C ends a scan without a map.
inline constexpr const char* kStopsWithoutMap =
    "\nroomradar: stops after the next frame, without a map; after the last frame the map is still made. "
    "Press Ctrl-C again to end at once\n";

/// Returns true for the stages of PrescanProgress in which frames are tracked.
inline bool is_tracking(const std::string& stage) { return stage == "track" || stage == "track again"; }

/// Window channel of a scan, and the observer that publishes to it during the first pass. Both null: there is
/// no window.
struct ScanWindow {
  ScanChannel* channel = nullptr;
  std::unique_ptr<ScanView> view{};
};

class ScanProgress {
 public:
  /// All arguments must outlive this object.
  ScanProgress(const PrescanOptions& options, const ScanStart& start, const PrescanConfig& config,
               ScanWindow& window)
      : options_(options), start_(start), config_(config), window_(window) {}

  /// Shows progress. Call after each frame of a stage. The first call after Ctrl-C requests a checkpoint of
  /// the frames read so far; the next call throws StoppedByUser. While a live source is tracked, ignores
  /// Ctrl-C, which then ends the source. Throws ScanDiscarded if the user discards the scan in the window.
  void show(const std::string& stage, const std::string& note);

 private:
  const PrescanOptions& options_;
  const ScanStart& start_;
  const PrescanConfig& config_;
  ScanWindow& window_;
  std::unique_ptr<Progress> progress_;
  std::string stage_;
  std::int64_t shown_ = 0;  ///< calls of show_in_window() in this stage
  std::int64_t fused_ = 0;  ///< frames fused in this process
  bool is_stopping_ = false;

  [[nodiscard]] std::optional<std::int64_t> total_of(const std::string& stage) const;
  void show_in_window(const std::string& stage);
  void begin(const std::string& stage);
};

}  // namespace roomradar
