// spooled_source.hpp: caches the frames of a live source on disk for repeated reading.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/sources/formats/scratch_folder.hpp"
#include "app/sources/recordings/spool_list.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// A frame cache on disk (spool). From the first next() on, a background thread reads an inner source and
/// writes each frame to a folder. next() reads the frames from the folder, identical in all bits, or takes
/// the newest from memory. Hence a slow reader loses no frame of a live source. A 640 x 480 frame takes about
/// 0.6 MB, and 8 ms of the background thread.
class SpooledSource final : public FrameSource {
 public:
  /// Caches frames in a temporary folder that the destructor removes.
  /// @param parent_folder  folder in which the temporary folder is created; empty: the system's temporary
  ///                       folder
  /// @throws Error if the folder cannot be created. If a frame cannot be written later or the inner source
  ///         throws, next() throws that error after the last complete frame.
  explicit SpooledSource(std::unique_ptr<FrameSource> source,
                         const std::filesystem::path& parent_folder = {});

  /// Caches frames in `folder`, which is not removed. Frames that an earlier process cached in the folder are
  /// delivered first. Indices and stamps of the source's frames then continue from the last cached frame.
  /// @param source      may be null if has_end(folder)
  /// @param most_ahead  max number of unread frames. While this number is reached, the source is not read, so
  ///                    a live source loses frames
  /// @throws Error if the folder cannot be created, or its list.bin is not a spool's list
  static std::unique_ptr<SpooledSource> kept(std::unique_ptr<FrameSource> source,
                                             const std::filesystem::path& folder,
                                             std::size_t most_ahead = kEveryFrame);
  static constexpr std::size_t kEveryFrame = std::numeric_limits<std::size_t>::max();
  /// Returns true if the folder contains a spool whose source had ended.
  static bool has_end(const std::filesystem::path& folder);
  /// Returns true if the folder contains a cached frame. Throws Error if its list.bin is not a spool's list.
  static bool has_frames(const std::filesystem::path& folder);

  /// Reads the frames cached in `folder`, up to the source's end or the last frame before the writing process
  /// was killed. Never writes to the folder.
  /// @throws Error if the folder contains no spool
  static std::unique_ptr<SpooledSource> again(const std::filesystem::path& folder);

  ~SpooledSource() override;

  ReadResult next(Frame& frame) override;
  bool rewind() override;
  bool seek(std::int64_t index) override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override;

 private:
  /// Location of the cached frames.
  struct Spool {
    std::filesystem::path folder;
    std::optional<ScratchFolder> scratch{};  ///< `folder`; unset if the folder is kept
    /// Open only if the folder is kept.
    std::ofstream list{};
  };
  SpooledSource(std::unique_ptr<FrameSource> source, Spool spool);
  void take(SpoolList left);
  void stop_capture();
  bool wait_for_reader();
  // capture() and capture_one() run in the background thread.
  void capture();
  bool capture_one(Frame& frame);

  /// State for continuing the recording of an earlier process in the same folder.
  struct Continuation {
    /// Offset added to the source's own index.
    std::int64_t index_offset = 0;
    /// Offset added to the source's own stamps; unset: determined at the source's next frame.
    std::optional<double> stamp_offset_s = 0.0;
    /// Number of entries from an earlier process.
    std::size_t left = 0;
  };

  std::unique_ptr<FrameSource> source_;
  Spool spool_;
  std::string name_;
  Continuation continued_;
  std::size_t most_ahead_ = kEveryFrame;

  /// Guards the members below.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t position_ = 0;
  /// List of the frames. Existing entries never move.
  std::deque<SpoolEntry> entries_;
  /// The frame written last, unless the reader has taken it: it need not be read from the folder.
  Frame newest_;
  std::optional<std::size_t> newest_position_;
  bool at_end_ = false;
  bool stop_ = false;
  /// Last result of the source if that result was not a frame.
  std::optional<ReadResult> waiting_;
  std::exception_ptr failure_;

  std::thread thread_;
};

/// Returns `source` if it can rewind, else a SpooledSource around it. Call before the first next().
std::unique_ptr<FrameSource> make_rewindable(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
