// frame_sinks.cpp: one class per output, in the order in which a frame is written.
#include "app/run/frame_sinks.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "app/media/picture_file.hpp"
#include "app/media/video_writer.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/run/frame_stream.hpp"
#include "app/run/growing_file.hpp"
#include "app/run/run_use.hpp"
#include "app/session/session_fingerprint.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {
namespace {

constexpr double kVideoFramesPerS = 30.0;

class FingerprintSink : public FrameSink {
 public:
  FingerprintSink(SessionRecorder* recorder, std::optional<ReplayCheck> check)
      : recorder_(recorder), check_(std::move(check)) {}

  void write(const RunFrame& frame) override {
    const FrameFingerprint fingerprint = fingerprint_of(frame.run_frame, frame.session);
    if (recorder_ != nullptr) recorder_->write(fingerprint);
    if (check_) check_->compare(fingerprint);
  }

  /// Prints to stderr how a replay compares with the recorded results.
  void report(nlohmann::json& results) const override {
    if (!check_) return;
    std::fprintf(stderr, "replay: %lld of %lld frames the same as recorded",
                 static_cast<long long>(check_->same()), static_cast<long long>(check_->recorded()));
    if (check_->different() > 0)
      std::fprintf(stderr, ", the first that is not: %lld",
                   static_cast<long long>(check_->first_different()));
    std::fprintf(stderr, "\n");
    results["replay"] = {
        {"same", check_->same()}, {"different", check_->different()}, {"recorded", check_->recorded()}};
  }

 private:
  SessionRecorder* recorder_;
  std::optional<ReplayCheck> check_;
};

class VideoSink : public FrameSink {
 public:
  explicit VideoSink(const RunOptions& options) : video_(options.video, kVideoFramesPerS) {}

  void write(const RunFrame& frame) override { video_.write_at(frame.session.picture(), frame.time_s); }

  void finish(RunEnd end) override {
    if (end == RunEnd::kNothingDropped)
      video_.discard();
    else
      video_.close();
  }

 private:
  VideoWriter video_;
};

class FrameUseSink : public FrameSink {
 public:
  explicit FrameUseSink(const RunOptions& options) : file_(options.frames_csv) {}

  void write(const RunFrame& frame) override {
    if (frame.result.status == FrameStatus::kDone)
      file_.write(frame.frame.index, frame.result.use, frame.session.objects());
  }

  void finish(RunEnd /*end*/) override { file_.close(); }

 private:
  FrameUseFile file_;
};

class TrajectorySink : public FrameSink {
 public:
  explicit TrajectorySink(const RunOptions& options) : file_(options.trajectory, kTrajectoryHeader) {}

  void write(const RunFrame& frame) override {
    if (frame.result.status == FrameStatus::kDone)
      file_.append(trajectory_line({frame.frame.index, frame.frame.stamp_s, frame.result.T_world_camera}));
  }

  void finish(RunEnd /*end*/) override { file_.close(); }

 private:
  GrowingFile file_;
};

class StreamSink : public FrameSink {
 public:
  explicit StreamSink(const RunOptions& options) : stream_(options.stream, options.source, options.map) {}

  void write(const RunFrame& frame) override {
    frame.times.timed("stream", [&] {
      stream_.write(frame.run_frame, frame.time_s, frame.frame, frame.result, frame.session, frame.times);
    });
  }

  /// Prints how many lines the stream's reader did not get.
  void finish(RunEnd /*end*/) override {
    const LineStream& lines = stream_.lines();
    stream_.close();
    if (lines.is_reader_gone())
      std::fprintf(stderr, "--stream: its reader closed it before the run's end; %lld lines were dropped\n",
                   static_cast<long long>(lines.dropped()));
    else if (lines.dropped() > 0)
      std::fprintf(stderr, "--stream: its reader was too slow; %lld lines were dropped\n",
                   static_cast<long long>(lines.dropped()));
  }

  void report(nlohmann::json& results) const override {
    results["stream_lines_dropped"] = stream_.lines().dropped();
  }

 private:
  FrameStream stream_;
};

/// Writes the composed picture, and the depth camera's mask of dynamic pixels.
class PictureSink : public FrameSink {
 public:
  explicit PictureSink(const RunOptions& options)
      : folder_(options.pictures), stride_(options.pictures_stride) {
    make_folder(options.pictures);
  }

  void write(const RunFrame& frame) override {
    if (frame.run_frame % stride_ != 0) return;
    const std::string name = (folder_ / picture_name(frame)).string();
    if (!frame.session.picture().empty()) write_png(frame.session.picture(), name + ".png");
    if (frame.result.status == FrameStatus::kDone)
      write_png(frame.session.scene().foreground().dynamic_mask, name + ".moved.png");
  }

 private:
  std::filesystem::path folder_;
  std::int64_t stride_;
  std::int64_t last_picture_ = -1;  ///< highest index of the source's frames that has a picture

  /// Returns the source's frame number; if that frame is repeated (held or looped), the run's number follows.
  std::string picture_name(const RunFrame& frame) {
    const std::int64_t index = frame.frame.index;
    const bool is_again = index <= last_picture_;
    last_picture_ = std::max(last_picture_, index);
    return format_frame_number(index) + (is_again ? "-" + format_frame_number(frame.run_frame) : "");
  }
};

template <typename Sink>
std::unique_ptr<FrameSink> opened_if(bool is_requested, const RunOptions& options) {
  return is_requested ? std::make_unique<Sink>(options) : nullptr;
}

class KeptObjectsSink : public FrameSink {
 public:
  KeptObjectsSink(const std::filesystem::path& folder, const Session& session)
      : keeper_(folder), session_(session) {}

  void write(const RunFrame& frame) override {
    try {
      keeper_.keep(frame.session.objects());
    } catch (const Error& fault) {  // tried again later; finish() throws if it still fails
      if (!std::exchange(has_complained_, true)) std::fprintf(stderr, "roomradar: %s\n", fault.what());
    }
  }

  void finish(RunEnd /*end*/) override { keeper_.finish(session_.objects()); }

 private:
  ObjectKeeper keeper_;
  const Session& session_;
  bool has_complained_ = false;
};

}  // namespace

std::unique_ptr<FrameSink> fingerprint_sink(SessionRecorder* recorder, std::optional<ReplayCheck> check) {
  if (recorder == nullptr && !check) return nullptr;
  return std::make_unique<FingerprintSink>(recorder, std::move(check));
}
std::unique_ptr<FrameSink> video_sink(const RunOptions& options) {
  return opened_if<VideoSink>(!options.video.empty(), options);
}
std::unique_ptr<FrameSink> frame_use_sink(const RunOptions& options) {
  return opened_if<FrameUseSink>(!options.frames_csv.empty(), options);
}
std::unique_ptr<FrameSink> trajectory_sink(const RunOptions& options) {
  return opened_if<TrajectorySink>(!options.trajectory.empty(), options);
}
std::unique_ptr<FrameSink> stream_sink(const RunOptions& options) {
  return opened_if<StreamSink>(!options.stream.empty(), options);
}
std::unique_ptr<FrameSink> picture_sink(const RunOptions& options) {
  return opened_if<PictureSink>(!options.pictures.empty(), options);
}

std::unique_ptr<FrameSink> kept_objects_sink(const std::filesystem::path& folder, const Session& session) {
  if (folder.empty()) return nullptr;
  std::error_code fault;
  const std::filesystem::path existing =
      std::filesystem::exists(folder, fault) ? folder : folder.parent_path();
  if (!existing.empty() && access(existing.c_str(), W_OK) != 0) {
    std::fprintf(stderr, "roomradar: %s: cannot be written, so objects are not kept in the room\n",
                 existing.c_str());
    return nullptr;
  }
  return std::make_unique<KeptObjectsSink>(folder, session);
}

}  // namespace roomradar
