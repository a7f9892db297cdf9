// read_ahead.cpp: reads the next wanted frame asynchronously.
#include "mapping/read_ahead.hpp"

#include <utility>

namespace roomradar {

ReadResult ReadAhead::next(Frame& frame) {
  if (next_ == wanted_.size()) return {};
  const auto read_next = [this] { return read(); };
  if (!is_read_.valid()) is_read_ = std::async(std::launch::async, read_next);
  ReadResult result = is_read_.get();
  if (result.status == ReadStatus::kEnd) return result;
  if (result.status == ReadStatus::kFrame) std::swap(frame, ahead_);
  if (!result.waiting) ++next_;
  if (next_ < wanted_.size()) is_read_ = std::async(std::launch::async, read_next);
  return result;
}

ReadResult ReadAhead::read() {
  const std::int64_t wanted = wanted_[next_];
  if (position_ < wanted && source_.seek(wanted)) position_ = wanted;
  for (;;) {
    ReadResult result = source_.next(ahead_);
    if (result.status == ReadStatus::kEnd || result.waiting) return result;
    if (position_++ == wanted) return result;
  }
}

}  // namespace roomradar
