// spooled_source.hpp: lets a live source be read again from its first frame, also by a later process.
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
#include <string_view>
#include <thread>
#include <vector>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Reads the source within in a thread of its own, from the first next() on, and writes each frame to a
/// folder; next() reads it from there, the same to the bit, however far behind it is: a live source's frames
/// are not lost to a reader that is slower. About 0.7 MB a 640 x 480 frame and 14 ms of that thread.
class SpooledSource final : public FrameSource {
 public:
  /// Spools to a temporary folder that goes with the object.
  /// @param parent_folder  where the temporary folder is made; the system's own place for such if empty
  /// @throws Error if the folder cannot be made; next() throws Error if it cannot be written (disk full), and
  /// what the source within throws, after the last frame before that
  explicit SpooledSource(std::unique_ptr<FrameSource> source,
                         const std::filesystem::path& parent_folder = {});

  /// Spools to `folder`, which stays. Frames that an earlier process left there come first, and those of the
  /// source follow as if they were one recording: with the next index, and stamps that go on.
  /// @param source      may be null where has_end(folder)
  /// @param most_ahead  the source is not read while so many frames wait to be: of a live one, those in
  ///                    between are lost, as if there were no spool
  /// @throws Error if the folder cannot be made, or holds no spool
  static std::unique_ptr<SpooledSource> kept(std::unique_ptr<FrameSource> source,
                                             const std::filesystem::path& folder,
                                             std::size_t most_ahead = kEveryFrame);
  static constexpr std::size_t kEveryFrame = std::numeric_limits<std::size_t>::max();
  /// Whether a spool is in the folder whose source had come to its end.
  static bool has_end(const std::filesystem::path& folder);
  /// Whether there is a frame to be read again. Throws Error as has_end.
  static bool has_frames(const std::filesystem::path& folder);

  /// What was spooled to `folder`, to its end or to where the process that did it was cut off; the folder is
  /// only read.
  /// @throws Error if the folder holds no spool
  static std::unique_ptr<SpooledSource> again(const std::filesystem::path& folder);

  ~SpooledSource() override;

  ReadResult next(Frame& frame) override;
  bool rewind() override;
  bool seek(std::int64_t index) override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override;

 private:
  /// A frame without its images, or the sentence that stood in its place.
  struct Entry {
    Frame frame;
    std::string fault;
  };
  /// What an earlier process left in a folder.
  struct Left {
    std::string name;
    std::vector<Entry> entries;
    bool at_end = false;
    std::uintmax_t sound_bytes = 0;  ///< of the list; a frame that was being written follows
  };
  template <typename Archive>
  static void transfer_entry(Archive& archive, Entry& entry);
  static Entry entry_of(std::string_view bytes, const std::filesystem::path& list);
  static Left read_list(const std::filesystem::path& folder);

  SpooledSource(std::unique_ptr<FrameSource> source, std::filesystem::path folder, bool kept);
  void take(Left left);
  void append(Entry* entry);
  ReadResult read_again(const Entry& entry, std::size_t position, Frame& frame) const;
  void stop_capture();
  bool wait_for_reader();
  // Of the thread that reads the source within.
  void capture();
  bool capture_one(Frame& frame);

  std::unique_ptr<FrameSource> source_;
  std::filesystem::path folder_;
  bool kept_;
  std::string name_;
  std::ofstream list_;                          ///< only if kept
  std::int64_t index_offset_ = 0;               ///< added to the source's own, if others came before
  std::optional<double> stamp_offset_s_ = 0.0;  ///< none: to be found from the source's next frame
  std::size_t most_ahead_ = kEveryFrame;

  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::size_t position_ = 0;
  std::size_t left_ = 0;       ///< so many are of an earlier process
  std::deque<Entry> entries_;  ///< those that are there stay where they are
  bool at_end_ = false;
  bool stop_ = false;
  std::optional<ReadResult> waiting_;  ///< the source's latest word, if it was that there is nothing yet
  std::exception_ptr failure_;

  std::thread thread_;
};

/// `source` itself if it rewinds on its own (asked before anything was read), else `source` spooled.
std::unique_ptr<FrameSource> make_rewindable(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
