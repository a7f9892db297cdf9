// frame_range.cpp: counts a source's frames and delivers only a range of them.
#include "app/sources/formats/frame_range.hpp"

#include <string>
#include <utility>

#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

std::string range_text(std::int64_t first, std::int64_t last) {
  return "frames " + std::to_string(first) + ":" + std::to_string(last);
}

[[noreturn]] void fail_outside(const FrameSource& source, std::int64_t first, std::int64_t last,
                               std::int64_t count) {
  throw Error(source.name() + ": " + range_text(first, last) +
              " extend past the end of the recording, which has " + std::to_string(count) + " frames" +
              (count > 0 ? ", 0:" + std::to_string(count - 1) + "; give a range within these" : ""));
}

class FrameRangeSource final : public FrameSource {
 public:
  FrameRangeSource(std::unique_ptr<FrameSource> source, std::int64_t first, std::int64_t last)
      : source_(std::move(source)), first_(first), last_(last), is_live_(!source_->frame_count()) {
    if (source_->seek(first_)) position_ = first_;
  }

  ReadResult next(Frame& frame) override {
    // Half a second of a device's frames; returning then lets the caller stop.
    constexpr int kMostPassedOver = 15;
    for (int passed_over = 0; position_ <= last_; ++passed_over) {
      if (passed_over == kMostPassedOver) return {ReadStatus::kWaiting, {}};
      ReadResult result = source_->next(frame);
      // A device that ends early, by Ctrl-C or because it is gone, has given what there is.
      if (result.status == ReadStatus::kEnd && position_ > first_) return result;
      if (result.status == ReadStatus::kEnd) fail_outside(*source_, first_, last_, position_);
      if (result.status == ReadStatus::kWaiting) return result;
      // Frames of a live device count by index, which includes dropped frames. Frames of its recording keep
      // these indices but count by position.
      const std::int64_t at = is_live_ && result.status == ReadStatus::kFrame ? frame.index : position_;
      position_ = at + 1;
      if (at >= first_ && at <= last_) return result;
    }
    return {ReadStatus::kEnd, {}};
  }

  bool rewind() override {
    if (!source_->rewind()) return false;
    position_ = source_->seek(first_) ? first_ : 0;
    return true;
  }

  bool seek(std::int64_t index) override {
    if (index < 0 || index > last_ - first_ || !source_->seek(first_ + index)) return false;
    position_ = first_ + index;
    return true;
  }

  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return last_ - first_ + 1; }
  [[nodiscard]] std::string name() const override {
    return source_->name() + ", " + range_text(first_, last_);
  }

 private:
  std::unique_ptr<FrameSource> source_;
  std::int64_t first_;
  std::int64_t last_;
  bool is_live_;
  std::int64_t position_ = 0;
};

}  // namespace

FrameRange parse_frame_range(std::string_view text, std::string_view of) {
  const std::size_t colon = text.find(':');
  if (colon != std::string_view::npos) {
    const auto first = parse_whole_number(text.substr(0, colon));
    const auto last = parse_whole_number(text.substr(colon + 1));
    if (first && last && *first >= 0 && *first <= *last) return {*first, *last};
  }
  throw Error(std::string(of) + " '" + std::string(text) +
              "': must be A:B with whole numbers 0 <= A <= B, both included, as in 400:499 for 100 " +
              std::string(of));
}

std::unique_ptr<FrameSource> limit_frames(std::unique_ptr<FrameSource> source, std::int64_t first,
                                          std::int64_t last) {
  if (first < 0 || last < first)
    throw Error(range_text(first, last) + ": the first must be >= 0 and the last not before it");
  const auto count = source->frame_count();
  if (count && last >= *count) fail_outside(*source, first, last, *count);
  return std::make_unique<FrameRangeSource>(std::move(source), first, last);
}

}  // namespace roomradar
