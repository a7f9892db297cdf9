// spooled_source.cpp: captures frames in a thread, and reads them again.
#include "app/sources/recordings/spooled_source.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/sources/formats/scratch_folder.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace fs = std::filesystem;

SpooledSource::SpooledSource(std::unique_ptr<FrameSource> source, Spool spool)
    : source_(std::move(source)),
      spool_(std::move(spool)),
      name_(source_ ? source_->name() : std::string{}) {}

SpooledSource::SpooledSource(std::unique_ptr<FrameSource> source, const fs::path& parent_folder)
    : SpooledSource(std::move(source), Spool{}) {
  spool_.scratch.emplace(parent_folder);
  spool_.folder = spool_.scratch->path();
}

std::unique_ptr<SpooledSource> SpooledSource::kept(std::unique_ptr<FrameSource> source,
                                                   const fs::path& folder, std::size_t most_ahead) {
  make_folder(folder);
  std::unique_ptr<SpooledSource> spooled(new SpooledSource(std::move(source), Spool{folder}));
  spooled->most_ahead_ = most_ahead;
  if (has_spool_list(folder)) {
    SpoolList left = read_spool_list(folder);
    fs::resize_file(spool_list_file(folder), left.sound_bytes);
    spooled->take(std::move(left));
    spooled->spool_.list.open(spool_list_file(folder), std::ios::binary | std::ios::app);
    require_written(spooled->spool_.list, spool_list_file(folder));
  } else {
    begin_spool_list(folder, spooled->name_, spooled->spool_.list);
  }
  return spooled;
}

bool SpooledSource::has_end(const fs::path& folder) {
  return has_spool_list(folder) && read_spool_list(folder).at_end;
}

bool SpooledSource::has_frames(const fs::path& folder) {
  return has_spool_list(folder) && !read_spool_list(folder).entries.empty();
}

std::unique_ptr<SpooledSource> SpooledSource::again(const fs::path& folder) {
  if (!fs::exists(spool_list_file(folder)))
    throw Error(spool_list_file(folder).string() + ": there are no recorded frames");
  std::unique_ptr<SpooledSource> spooled(new SpooledSource(nullptr, Spool{folder}));
  spooled->take(read_spool_list(folder));
  spooled->at_end_ = true;
  return spooled;
}

void SpooledSource::take(SpoolList left) {
  name_ = std::move(left.name);
  entries_.assign(std::make_move_iterator(left.entries.begin()), std::make_move_iterator(left.entries.end()));
  at_end_ = left.at_end;
  continued_.left = entries_.size();
  if (entries_.empty()) return;
  continued_.stamp_offset_s.reset();
  for (const SpoolEntry& entry : entries_)
    continued_.index_offset = std::max(continued_.index_offset + 1, entry.frame.index + 1);
}

void SpooledSource::stop_capture() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
  thread_ = {};
  stop_ = false;
}

SpooledSource::~SpooledSource() { stop_capture(); }

void SpooledSource::capture() {
  Frame frame;
  try {
    while (wait_for_reader() && capture_one(frame)) {
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
  std::unique_ptr<FrameSource> done;  // destroyed after unlocking; a device then stops sending
  {
    const std::lock_guard lock(mutex_);
    if (at_end_) done = std::move(source_);
  }
  changed_.notify_all();
}

/// Returns false when capture must stop.
bool SpooledSource::wait_for_reader() {
  std::unique_lock lock(mutex_);
  // A reader that went back needs no new frames for now.
  changed_.wait(
      lock, [&] { return stop_ || entries_.size() - std::min(position_, entries_.size()) < most_ahead_; });
  return !stop_;
}

/// Returns false at the end, or when capture must stop.
bool SpooledSource::capture_one(Frame& frame) {
  const std::size_t position = entries_.size();  // only this thread changes it
  const auto most = source_->frame_count();
  ReadResult result;  // stays kEnd if earlier processes already spooled frame_count() frames
  if (!most || static_cast<std::int64_t>(position) < *most) result = source_->next(frame);
  std::optional<SpoolEntry> entry;
  if (result.status == ReadStatus::kFrame) {
    constexpr double kFrame_s = 1.0 / 30.0;
    if (!continued_.stamp_offset_s) {
      double last_s = 0.0;
      for (const SpoolEntry& before : entries_) last_s = std::max(last_s, before.frame.stamp_s);
      continued_.stamp_offset_s = last_s + kFrame_s - frame.stamp_s;
    }
    frame.index += continued_.index_offset;
    frame.stamp_s += *continued_.stamp_offset_s;
    entry = write_spooled(frame, spool_.folder, position);
  } else if (result.status == ReadStatus::kSkipped) {
    entry = SpoolEntry{{}, result.fault};
  }
  if (!spool_.scratch && result.status != ReadStatus::kWaiting)
    append_to_spool_list(entry ? &*entry : nullptr, spool_.folder, spool_.list);
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  if (entry) {
    entries_.push_back(std::move(*entry));
    if (result.status == ReadStatus::kFrame) {
      newest_position_ = position;
      std::swap(newest_, frame);
    }
  } else if (result.status == ReadStatus::kWaiting) {
    waiting_ = std::move(result);
  } else {
    at_end_ = true;
  }
  changed_.notify_all();
  return !at_end_ && !stop_;
}

ReadResult SpooledSource::next(Frame& frame) {
  std::unique_lock lock(mutex_);
  if (position_ == entries_.size()) {
    if (!thread_.joinable() && !at_end_ && !failure_) thread_ = std::thread([this] { capture(); });
    changed_.wait(lock, [&] { return position_ < entries_.size() || at_end_ || failure_ || waiting_; });
    if (position_ == entries_.size()) {
      if (at_end_) return {ReadStatus::kEnd, {}};
      if (failure_) std::rethrow_exception(failure_);
      return *std::exchange(waiting_, std::nullopt);
    }
  }
  const std::size_t position = position_++;
  const SpoolEntry& entry = entries_[position];
  const bool is_newest = newest_position_ == position;
  if (is_newest) {
    newest_position_.reset();
    std::swap(frame, newest_);
  }
  lock.unlock();
  changed_.notify_all();
  if (is_newest) return {ReadStatus::kFrame, {}};
  try {
    return read_spooled(entry, spool_.folder, position, frame);
  } catch (const Error& fault) {
    // After a power failure the list may be ahead of its images. Images written by this process must exist.
    if (position >= continued_.left) throw;
    return {ReadStatus::kSkipped, fault.what()};
  }
}

bool SpooledSource::rewind() {
  // No frames are captured after a rewind until the reader reaches the end of the spool.
  stop_capture();
  position_ = 0;
  return true;
}

bool SpooledSource::seek(std::int64_t index) {
  const std::lock_guard lock(mutex_);
  if (index < 0 || static_cast<std::size_t>(index) >= entries_.size()) return false;
  position_ = static_cast<std::size_t>(index);
  return true;
}

std::optional<std::int64_t> SpooledSource::frame_count() const {
  const std::lock_guard lock(mutex_);
  if (at_end_) return static_cast<std::int64_t>(entries_.size());
  return source_->frame_count();
}

std::string SpooledSource::name() const { return name_; }

std::unique_ptr<FrameSource> make_rewindable(std::unique_ptr<FrameSource> source) {
  if (source->rewind()) return source;
  return std::make_unique<SpooledSource>(std::move(source));
}

}  // namespace roomradar
