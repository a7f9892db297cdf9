// interrupt.hpp: handles Ctrl-C: the first ends the work cleanly, the second kills the process.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// While an instance exists, the first SIGINT only sets a flag, and the second ends the process. At most one
/// instance may exist at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Replaces the message that Ctrl-C prints. The default message says that no more frames are read and that
  /// the work ends with the frames read so far. The string must stay valid and end with a line break.
  static void say(const char* sentence);
  /// Returns true once if Ctrl-C was pressed; later calls return false.
  static bool take();
  /// Returns true if Ctrl-C was pressed and take() has not been called since.
  static bool is_asked();
};

/// Wraps a source so it ends when Ctrl-C is pressed.
std::unique_ptr<FrameSource> ended_by_interrupt(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
