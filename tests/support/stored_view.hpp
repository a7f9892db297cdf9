// stored_view.hpp: a frame as keyframes keep it, with every pixel measured.
#pragma once
#include <memory>

#include "mapping/alignment/packed_view.hpp"
#include "mapping/alignment/view_pyramid.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar::test {

inline std::shared_ptr<const PackedView> stored_view(const Frame& frame, const ViewConfig& config = {}) {
  ViewPyramid pyramid;
  make_pyramid(frame, config, pyramid);
  const Intrinsics& camera = pyramid.levels.front().camera;
  const Image<std::uint8_t> measured(camera.width_px, camera.height_px, 1);
  return std::make_shared<const PackedView>(packed(store(pyramid, measured)));
}

}  // namespace roomradar::test
