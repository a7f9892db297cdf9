// interrupt.hpp: the first Ctrl-C ends the work in an orderly way; the second kills the process.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// While an instance exists, the first SIGINT only sets a flag; the second ends the process. At most one
/// instance at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Replaces the message that Ctrl-C prints. By default it says that no more frames are read and the work
  /// ends with those so far. The string must stay valid and end with a line break.
  static void say(const char* sentence);
  /// Returns true if Ctrl-C was pressed, once; later calls return false.
  static bool take();
  /// Returns true if Ctrl-C was pressed and take() has not returned it.
  static bool is_asked();
};

/// Wraps a source so it ends when Ctrl-C is pressed.
std::unique_ptr<FrameSource> ended_by_interrupt(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
