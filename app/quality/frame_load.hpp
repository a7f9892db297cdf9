// frame_load.hpp: the parts of a frame, and quantities, known in advance, that predict their times.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace roomradar {

enum class FramePart {
  kLocate,   ///< localisation and foreground
  kMesh,     ///< mesh of the dynamic foreground
  kPhysics,  ///< motion of the objects
  kCompose,  ///< picture
  kDone,     ///< not a part: the frame is finished
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

struct FrameLoad {
  double dynamic_fraction = 0.0;  ///< dynamic part of the depth pixels; before kMesh: previous frame's
  int moving = 0;                 ///< virtual objects in the room that are not asleep
  int resting = 0;
};

}  // namespace roomradar
