// sources.hpp: a frame source for Python, as an iterator of frames.
#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <string>

#include "app/python/long_calls.hpp"
#include "app/sources/formats/input_report.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar::python {

/// A frame source, and the number of skipped frames. Throws Error if several threads use it concurrently.
class Source {
 public:
  /// @param input  decisions about the recording; null: there are none
  explicit Source(std::unique_ptr<FrameSource> source, std::shared_ptr<const InputReport> input = nullptr);
  virtual ~Source() = default;

  /// Returns the next readable frame; null at the end. Call with the interpreter's lock, which is released
  /// while reading. Waits for a live device until Ctrl-C is pressed.
  std::shared_ptr<Frame> next();
  /// Rewinds to the first frame if frames were read. Returns false if the source cannot rewind (a live
  /// device).
  bool restart();
  bool seek(std::int64_t index);
  /// Closes files and devices. Later calls throw Error.
  void close();

  /// Returns the open source. Throws Error after close().
  [[nodiscard]] FrameSource& opened() const;
  [[nodiscard]] UseFlag& use() { return use_; }
  /// Call after the source was read by other code.
  void was_read() { was_read_ = true; }
  [[nodiscard]] std::int64_t skipped() const { return skipped_; }
  [[nodiscard]] const std::string& last_fault() const { return last_fault_; }
  [[nodiscard]] const InputReport& input() const { return *input_; }

 private:
  std::unique_ptr<FrameSource> source_;
  std::shared_ptr<const InputReport> input_;
  UseFlag use_;
  bool was_read_ = false;
  std::int64_t skipped_ = 0;
  std::string last_fault_;
};

}  // namespace roomradar::python
