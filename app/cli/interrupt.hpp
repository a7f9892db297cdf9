// interrupt.hpp: Ctrl-C asks the work to end well; a second one ends it as ever.
#pragma once
#include <memory>

#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// While one lives, SIGINT is counted instead of ending the process; a second one that comes before the first
/// was taken ends it. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// From now on Ctrl-C prints this, which stays and ends its line, instead of that the work takes no more
  /// frames and ends with those it has.
  static void say(const char* sentence);
  /// Whether Ctrl-C was pressed since it was last taken.
  static bool take();
  /// Whether it was pressed and is not taken yet.
  static bool is_asked();
};

/// A source that comes to its end when Ctrl-C is pressed while it is read.
std::unique_ptr<FrameSource> ended_by_interrupt(std::unique_ptr<FrameSource> source);

}  // namespace roomradar
