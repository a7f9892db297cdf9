// interrupt.hpp: handles Ctrl-C. The first one ends the work cleanly, the second one kills the process.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// While an instance exists, the first SIGINT only sets a flag, and a second SIGINT ends the process. At most
/// one instance may exist at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Replaces the message that Ctrl-C prints. The default message says that no more frames are read and that
  /// the work is completed with the frames read so far. `sentence` must remain valid and end with a newline.
  static void say(const char* sentence);
  /// Sets what the second Ctrl-C prints before it ends the process; "": nothing. `sentence` must remain
  /// valid.
  static void say_when_ended(const char* sentence);
  /// Returns true once if Ctrl-C was pressed. Later calls return false.
  static bool take();
  /// Returns true if Ctrl-C was pressed and take() has not been called since.
  static bool is_asked();
  /// Returns true if Ctrl-C was pressed since the last instance was made, whether or not take() was called.
  static bool was_pressed();
};

/// Returns a source that delivers the frames of `source` and ends when Ctrl-C is pressed.
std::unique_ptr<FrameSource> ended_by_interrupt(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
