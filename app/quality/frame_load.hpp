// frame_load.hpp: the parts of a frame that take time, and what is known of their work before they do it.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace roomradar {

enum class FramePart {
  kLocate,   ///< where is the camera, what moved
  kMesh,     ///< of what moved
  kPhysics,  ///< the objects move
  kCompose,  ///< the picture
  kDone,     ///< no part: the frame is over
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
  double dynamic_fraction = 0.0;  ///< of the depth image's pixels; before kMesh, of the frame before
  int moving = 0;                 ///< virtual objects in the room that are not at rest
  int resting = 0;
};

}  // namespace roomradar
