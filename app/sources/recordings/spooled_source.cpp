// spooled_source.cpp: keeps images in files, all else in memory and, if the spool is kept, in a list file.
//
// list.bin: "RRSPOOL1", the source's name, then for each frame the size of its entry in bytes (u32) and the
// entry; a size of 0 marks the end of the source.
#include "app/sources/recordings/spooled_source.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/temporary_folder.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "list.bin";
constexpr std::string_view kMagic = "RRSPOOL1";

fs::path depth_file(const fs::path& folder, std::size_t position) {
  return folder / (std::to_string(position) + ".depth.png");
}
fs::path colour_file(const fs::path& folder, std::size_t position) {
  return folder / (std::to_string(position) + ".colour.png");
}

/// Returns false for a list without a complete header: a full disk or a kill cut it off before the first
/// frame.
bool has_list(const fs::path& folder) {
  std::error_code fault;
  const std::uintmax_t bytes = fs::file_size(folder / kList, fault);
  return !fault && bytes > kMagic.size();
}

/// Copies all of the frame except its images.
Frame without_images(const Frame& frame) {
  Frame rest;
  rest.index = frame.index;
  rest.stamp_s = frame.stamp_s;
  rest.colour_after_depth_s = frame.colour_after_depth_s;
  rest.depth_camera = frame.depth_camera;
  rest.colour_camera = frame.colour_camera;
  rest.T_colour_depth = frame.T_colour_depth;
  rest.T_world_camera = frame.T_world_camera;
  rest.down_camera = frame.down_camera;
  return rest;
}

}  // namespace

template <typename Archive>
void SpooledSource::serialize_entry(Archive& archive, Entry& entry) {
  Frame& frame = entry.frame;
  serialize(archive, entry.fault);
  if (!entry.fault.empty()) return;
  serialize(archive, frame.index);
  serialize(archive, frame.stamp_s);
  serialize(archive, frame.colour_after_depth_s);
  serialize(archive, frame.depth_camera);
  bool coloured = frame.colour_camera.width_px > 0;
  serialize(archive, coloured);
  if (coloured) serialize(archive, frame.colour_camera);
  serialize(archive, frame.T_colour_depth);
  serialize(archive, frame.T_world_camera);
  serialize(archive, frame.down_camera);
}

/// Parses an entry; a damaged entry becomes an unreadable frame.
SpooledSource::Entry SpooledSource::entry_of(std::string_view bytes, const fs::path& list) {
  Entry entry;
  try {
    ByteReader reader(bytes, list.string());
    serialize_entry(reader, entry);
    reader.require_end();
  } catch (const Error& damage) {
    return {{}, damage.what()};
  }
  return entry;
}

SpooledSource::Left SpooledSource::read_list(const fs::path& folder) {
  const fs::path path = folder / kList;
  const std::string bytes = read_bytes(path, "the list of a live scan's frames");
  ByteReader list(bytes, path.string());
  std::string magic(kMagic.size(), '\0');
  list.raw(magic.data(), magic.size());
  if (magic != kMagic) list.fail("is no list of spooled frames, or of another version");
  Left left;
  serialize(list, left.name);
  left.sound_bytes = bytes.size() - list.left();
  while (!left.at_end) {
    // A truncated entry was being written when the process was killed; its frame was never used.
    std::uint32_t size = 0;
    if (list.left() < sizeof size) break;
    serialize(list, size);
    if (list.left() < size) break;
    left.at_end = size == 0;
    if (left.at_end && list.left() > 0) {  // zeros left by a power failure instead of entries
      left.at_end = false;
      break;
    }
    if (size > 0) left.entries.push_back(entry_of(list.take(size), path));
    left.sound_bytes = bytes.size() - list.left();
  }
  return left;
}

SpooledSource::SpooledSource(std::unique_ptr<FrameSource> source, fs::path folder, bool kept)
    : source_(std::move(source)),
      folder_(std::move(folder)),
      kept_(kept),
      name_(source_ ? source_->name() : std::string{}) {}

SpooledSource::SpooledSource(std::unique_ptr<FrameSource> source, const fs::path& parent_folder)
    : SpooledSource(std::move(source), make_temporary_folder(parent_folder), /*kept=*/false) {}

std::unique_ptr<SpooledSource> SpooledSource::kept(std::unique_ptr<FrameSource> source,
                                                   const fs::path& folder, std::size_t most_ahead) {
  std::error_code fault;
  fs::create_directories(folder, fault);
  if (fault) throw Error(folder.string() + ": the folder cannot be made: " + fault.message());
  std::unique_ptr<SpooledSource> spooled(new SpooledSource(std::move(source), folder, /*kept=*/true));
  spooled->most_ahead_ = most_ahead;
  const fs::path path = folder / kList;
  if (has_list(folder)) {
    Left left = read_list(folder);
    fs::resize_file(path, left.sound_bytes);
    spooled->take(std::move(left));
    spooled->list_.open(path, std::ios::binary | std::ios::app);
  } else {
    ByteWriter head;
    head.raw(kMagic.data(), kMagic.size());
    serialize(head, spooled->name_);
    spooled->list_.open(path, std::ios::binary);
    spooled->list_ << head.bytes() << std::flush;
    if (!spooled->list_) fs::remove(path, fault);  // holds no frame, and would block the folder
  }
  require_written(spooled->list_, path);
  return spooled;
}

bool SpooledSource::has_end(const fs::path& folder) { return has_list(folder) && read_list(folder).at_end; }

bool SpooledSource::has_frames(const fs::path& folder) {
  return has_list(folder) && !read_list(folder).entries.empty();
}

std::unique_ptr<SpooledSource> SpooledSource::again(const fs::path& folder) {
  if (!fs::exists(folder / kList)) throw Error((folder / kList).string() + ": there are no recorded frames");
  std::unique_ptr<SpooledSource> spooled(new SpooledSource(nullptr, folder, /*kept=*/true));
  spooled->take(read_list(folder));
  spooled->at_end_ = true;
  return spooled;
}

void SpooledSource::take(Left left) {
  name_ = std::move(left.name);
  entries_.assign(std::make_move_iterator(left.entries.begin()), std::make_move_iterator(left.entries.end()));
  at_end_ = left.at_end;
  left_ = entries_.size();
  if (entries_.empty()) return;
  stamp_offset_s_.reset();
  for (const Entry& entry : entries_) index_offset_ = std::max(index_offset_ + 1, entry.frame.index + 1);
}

/// Null marks the end of the source.
void SpooledSource::append(Entry* entry) {
  if (!kept_) return;
  ByteWriter bytes;
  if (entry) serialize_entry(bytes, *entry);
  const auto size = static_cast<std::uint32_t>(bytes.bytes().size());
  list_.write(reinterpret_cast<const char*>(&size), sizeof size);
  list_ << bytes.bytes() << std::flush;
  require_written(list_, folder_ / kList);
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

SpooledSource::~SpooledSource() {
  stop_capture();
  if (kept_) return;
  std::error_code ignored;  // destructors must not throw
  fs::remove_all(folder_, ignored);
}

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
  std::optional<Entry> entry;
  if (result.status == ReadStatus::kFrame) {
    constexpr double kFrame_s = 1.0 / 30.0;
    if (!stamp_offset_s_) {
      double last_s = 0.0;
      for (const Entry& before : entries_) last_s = std::max(last_s, before.frame.stamp_s);
      stamp_offset_s_ = last_s + kFrame_s - frame.stamp_s;
    }
    frame.index += index_offset_;
    frame.stamp_s += *stamp_offset_s_;
    write_exact_depth_file(frame.depth_m, depth_file(folder_, position));
    // A killed process may have left the colour image of a frame that is not in the list.
    std::error_code fault;
    fs::remove(colour_file(folder_, position), fault);
    if (!frame.colour.empty()) write_colour_file(frame.colour, colour_file(folder_, position));
    entry = Entry{without_images(frame), {}};
  } else if (result.status == ReadStatus::kSkipped && !result.waiting) {
    entry = Entry{{}, result.fault};
  }
  if (!result.waiting) append(entry ? &*entry : nullptr);
  const std::lock_guard lock(mutex_);
  waiting_.reset();
  if (entry)
    entries_.push_back(std::move(*entry));
  else if (result.waiting)
    waiting_ = std::move(result);
  else
    at_end_ = true;
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
  const Entry& entry = entries_[position];
  lock.unlock();
  changed_.notify_all();
  try {
    return read_again(entry, position, frame);
  } catch (const Error& fault) {
    // After a power failure the list may be ahead of its images. Images written by this process must exist.
    if (position >= left_) throw;
    return {ReadStatus::kSkipped, fault.what()};
  }
}

ReadResult SpooledSource::read_again(const Entry& entry, std::size_t position, Frame& frame) const {
  if (!entry.fault.empty()) return {ReadStatus::kSkipped, entry.fault};
  DepthImage depth_m = std::move(frame.depth_m);
  ColourImage colour = std::move(frame.colour);
  read_exact_depth_file(depth_file(folder_, position), depth_m);
  const fs::path colour_path = colour_file(folder_, position);
  if (fs::exists(colour_path))
    read_colour_file(colour_path, colour);
  else
    colour.resize(0, 0);
  frame = entry.frame;
  frame.depth_m = std::move(depth_m);
  frame.colour = std::move(colour);
  if (const std::string_view fault = fault_of(frame); !fault.empty())
    throw Error(depth_file(folder_, position).string() + ": is damaged: " + std::string(fault));
  return {ReadStatus::kFrame, {}};
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
