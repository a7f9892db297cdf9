// spooled_source.cpp: images in a temporary folder, everything else in memory.
#include "app/sources/spooled_source.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "app/sources/image_file.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

fs::path make_temporary_folder(fs::path parent) {
  std::error_code fault;
  if (parent.empty()) parent = fs::temp_directory_path(fault);
  if (fault) throw Error("there is no folder for temporary files; set TMPDIR to one: " + fault.message());
  std::string pattern = (parent / "roomradar-spool-XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw Error(parent.string() + ": no temporary folder can be made there: " + std::strerror(errno));
  return pattern;
}

fs::path depth_file(const fs::path& folder, std::size_t position) {
  return folder / (std::to_string(position) + ".depth.png");
}
fs::path colour_file(const fs::path& folder, std::size_t position) {
  return folder / (std::to_string(position) + ".colour.png");
}

/// All of the frame but its images.
Frame without_images(const Frame& frame) {
  Frame rest;
  rest.index = frame.index;
  rest.stamp_s = frame.stamp_s;
  rest.depth_camera = frame.depth_camera;
  rest.colour_camera = frame.colour_camera;
  rest.T_colour_depth = frame.T_colour_depth;
  rest.T_world_camera = frame.T_world_camera;
  rest.down_camera = frame.down_camera;
  return rest;
}

}  // namespace

SpooledSource::SpooledSource(std::unique_ptr<FrameSource> source, const fs::path& parent_folder)
    : source_(std::move(source)), folder_(make_temporary_folder(parent_folder)) {}

SpooledSource::~SpooledSource() {
  std::error_code ignored;  // nobody is left to be told
  fs::remove_all(folder_, ignored);
}

ReadResult SpooledSource::next(Frame& frame) {
  if (position_ < entries_.size()) return read_again(position_++, frame);
  return read_on(frame);
}

ReadResult SpooledSource::read_on(Frame& frame) {
  if (at_end_) return {ReadStatus::kEnd, {}};
  ReadResult result = source_->next(frame);
  if (result.status == ReadStatus::kEnd) {
    at_end_ = true;
    return result;
  }
  if (result.status == ReadStatus::kSkipped) {
    entries_.push_back({Frame{}, result.fault});
  } else {
    write_exact_depth_file(frame.depth_m, depth_file(folder_, entries_.size()));
    if (!frame.colour.empty()) write_colour_file(frame.colour, colour_file(folder_, entries_.size()));
    entries_.push_back({without_images(frame), {}});
  }
  ++position_;
  return result;
}

ReadResult SpooledSource::read_again(std::size_t position, Frame& frame) const {
  const Entry& entry = entries_[position];
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
  return {ReadStatus::kFrame, {}};
}

bool SpooledSource::rewind() {
  position_ = 0;
  return true;
}

bool SpooledSource::seek(std::int64_t index) {
  if (index < 0 || static_cast<std::size_t>(index) >= entries_.size()) return false;
  position_ = static_cast<std::size_t>(index);
  return true;
}

std::optional<std::int64_t> SpooledSource::frame_count() const {
  if (at_end_) return static_cast<std::int64_t>(entries_.size());
  return source_->frame_count();
}

std::string SpooledSource::name() const { return source_->name(); }

std::unique_ptr<FrameSource> make_rewindable(std::unique_ptr<FrameSource> source) {
  if (source->rewind()) return source;
  return std::make_unique<SpooledSource>(std::move(source));
}

}  // namespace roomradar
