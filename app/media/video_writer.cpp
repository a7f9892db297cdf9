// video_writer.cpp: writes video through the video codec module, with checks that OpenCV lacks.
#include "app/media/video_writer.hpp"

#include <unistd.h>

#include <cmath>
#include <limits>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/sources/video/video_codecs.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kFramesBetweenSpaceChecks = 15;
// Space for an encoder's buffers and the file's index.
constexpr std::uintmax_t kMinFreeBytes = 4U << 20U;

std::vector<std::string> codecs_for(const std::string& extension) {
  if (extension == ".mp4") return {"avc1", "mp4v"};
  if (extension == ".avi") return {"MJPG"};
  if (extension == ".mkv") return {"mp4v", "MJPG"};
  return {};
}

/// Returns the temporary file's path; its extension selects the encoder.
std::filesystem::path partial_of(const std::filesystem::path& target) {
  std::error_code fault;
  if (std::filesystem::exists(target, fault) && !std::filesystem::is_regular_file(target, fault))
    return target;  // a pipe or a device
  std::filesystem::path partial = target;
  partial.replace_extension(".partial-" + std::to_string(::getpid()) + target.extension().string());
  return partial;
}

}  // namespace

struct VideoWriter::State {
  std::filesystem::path path;     // final path
  std::filesystem::path partial;  // file being written
  double frames_per_s = 30.0;
  std::vector<std::string> codecs;
  std::unique_ptr<VideoEncoder> encoder;
  std::int64_t frames_written = 0;
  double start_s = 0.0;  ///< stamp of the video's first picture
  double last_stamp_s = -std::numeric_limits<double>::infinity();
  bool is_closed = false;

  void open(const ColourImage& picture) {
    for (const std::string& codec : codecs) {
      encoder = video_codecs().create(partial.string(), codec, frames_per_s, picture.width, picture.height);
      if (encoder != nullptr) return;
    }
    throw Error(path.string() +
                ": the video cannot be created; is the folder writable, and is OpenCV built with FFmpeg?");
  }

  void require_space() const {
    std::error_code fault;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    const std::filesystem::space_info space = std::filesystem::space(folder, fault);
    if (!fault && space.capacity > 0 && space.available < kMinFreeBytes)
      throw Error(path.string() + ": the disk is full; make room or choose another folder");
  }
};

VideoWriter::VideoWriter(std::filesystem::path path, double frames_per_s)
    : state_(std::make_unique<State>()) {
  state_->codecs = codecs_for(path.extension().string());
  if (state_->codecs.empty()) throw Error(path.string() + ": a video's name ends in .mp4, .avi or .mkv");
  if (!(frames_per_s >= 1.0 && frames_per_s <= 240.0))
    throw Error(path.string() + ": " + format_number(frames_per_s) + " frames per second: must be in 1..240");
  std::error_code fault;
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), fault))
    throw Error(path.string() + ": its folder does not exist; make it first");
  if (std::filesystem::is_directory(path, fault))
    throw Error(path.string() + ": is a folder, not a video file");
  if (std::filesystem::is_symlink(path, fault) && std::filesystem::exists(path, fault))
    path = std::filesystem::canonical(path, fault);
  if (partial_of(path) != path)  // else a pipe or a device
    if (const std::string why = why_not_writable(path); !why.empty())
      throw Error(path.string() + ": cannot be written: " + why);
  (void)video_codecs();  // a missing module is reported before the work begins
  state_->partial = partial_of(path);
  state_->path = std::move(path);
  state_->frames_per_s = frames_per_s;
}

VideoWriter::~VideoWriter() {
  try {
    close();
  } catch (const Error&) {  // the temporary file remains
  }
}

std::int64_t VideoWriter::frames_written() const { return state_->frames_written; }

void VideoWriter::write(const ColourImage& picture) {
  State& s = *state_;
  if (s.is_closed) throw Error(s.path.string() + ": the video is finished; nothing can be added");
  if (picture.width < 2 || picture.height < 2)
    throw Error(s.path.string() + ": a video's picture needs 2 x 2 pixels");
  if (s.frames_written == 0) {
    s.require_space();
    s.open(picture);
  }
  if (s.frames_written % kFramesBetweenSpaceChecks == 0) s.require_space();
  s.encoder->write(picture);
  ++s.frames_written;
}

void VideoWriter::write_at(const ColourImage& picture, double stamp_s) {
  constexpr double kJump_s = 1.0;
  State& s = *state_;
  const bool is_next = stamp_s >= s.last_stamp_s && stamp_s <= s.last_stamp_s + kJump_s;
  if (!is_next) s.start_s = stamp_s - static_cast<double>(s.frames_written) / s.frames_per_s;
  s.last_stamp_s = stamp_s;
  const auto place =
      is_next ? static_cast<std::int64_t>((stamp_s - s.start_s) * s.frames_per_s + 0.5) : s.frames_written;
  while (s.frames_written <= place) write(picture);
}

void VideoWriter::close() {
  State& s = *state_;
  if (std::exchange(s.is_closed, true) || s.frames_written == 0) return;
  s.encoder.reset();
  if (s.partial == s.path) return;  // a pipe or a device cannot be read back
  // OpenCV does not report failed writes, so the file is read back: a truncated one has no index, or fewer
  // frames.
  const std::unique_ptr<VideoDecoder> reader = video_codecs().open(s.partial.string());
  const double frames_held = reader != nullptr ? reader->frame_count() : 0.0;
  if (frames_held + 1.5 < static_cast<double>(s.frames_written))
    throw Error(s.path.string() + ": only " + std::to_string(static_cast<long>(std::max(frames_held, 0.0))) +
                " of " + std::to_string(s.frames_written) + " frames could be written, see " +
                s.partial.string() + "; is the disk full?");
  std::error_code fault;
  std::filesystem::rename(s.partial, s.path, fault);
  if (fault)
    throw Error(s.path.string() + ": cannot be written: " + system_reason(fault) + "; the video is in " +
                s.partial.string());
}

void VideoWriter::discard() {
  State& s = *state_;
  if (std::exchange(s.is_closed, true) || s.frames_written == 0) return;
  s.encoder.reset();
  if (s.partial == s.path) return;  // a pipe or a device
  std::error_code ignored;
  std::filesystem::remove(s.partial, ignored);
}

}  // namespace roomradar
