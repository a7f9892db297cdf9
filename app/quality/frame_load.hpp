// frame_load.hpp: processing stages of a frame (parts), and the quantities that predict their times.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace roomradar {

/// Processing stages of a frame, called parts, in order. The quality can change before each part.
enum class FramePart {
  kLocate,   ///< localisation and detection of dynamic pixels
  kMesh,     ///< mesh of the dynamic foreground
  kPhysics,  ///< motion of the objects
  kCompose,  ///< picture
  kDone,     ///< after the last part
};
inline constexpr std::size_t kFrameParts = 4;
constexpr std::size_t index_of(FramePart part) { return static_cast<std::size_t>(part); }

constexpr std::string_view to_string(FramePart part) {
  switch (part) {
    case FramePart::kLocate:
      break;
    case FramePart::kMesh:
      return "mesh";
    case FramePart::kPhysics:
      return "physics";
    case FramePart::kCompose:
      return "compose";
    case FramePart::kDone:
      return "done";
  }
  return "locate";
}

/// Quantities that predict the times of a frame's parts. They are known before the parts begin.
struct FrameLoad {
  /// Dynamic fraction of the depth pixels. Before kMesh: that of the previous frame.
  double dynamic_fraction = 0.0;
  int moving = 0;  ///< virtual objects in the room that are not asleep
  /// Virtual objects in the room that are asleep.
  int resting = 0;
};

}  // namespace roomradar
