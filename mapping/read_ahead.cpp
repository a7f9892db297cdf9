// read_ahead.cpp: reads the next frame asynchronously.
#include "mapping/read_ahead.hpp"

#include <utility>

namespace roomradar {

ReadResult ReadAhead::next(Frame& frame) {
  if (left_ <= 0) return {};
  const auto read = [this] { return source_.next(ahead_); };
  if (!is_read_.valid()) is_read_ = std::async(std::launch::async, read);
  ReadResult result = is_read_.get();
  if (result.status == ReadStatus::kEnd) return result;
  if (result.status == ReadStatus::kFrame) std::swap(frame, ahead_);
  if (!result.waiting) --left_;
  if (left_ > 0) is_read_ = std::async(std::launch::async, read);
  return result;
}

}  // namespace roomradar
