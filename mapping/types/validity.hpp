// validity.hpp: whether a camera can be one, and whether a frame's images fit its cameras; as values, without
// exceptions, for the path of a frame.
#pragma once
#include <string_view>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Whether points can be projected with it: focal lengths finite and > 0, principal point finite. Of what
/// size the image is does not matter.
[[nodiscard]] bool can_project(const Intrinsics& camera);

/// Whether it keeps the rules of require_valid().
[[nodiscard]] bool is_valid(const Intrinsics& camera);

/// What is wrong with a frame whose depth image does not fit its camera, as a sentence; empty where nothing
/// is.
[[nodiscard]] std::string_view depth_fault_of(const Frame& frame);
/// The same of both images. Where there is no colour image its camera is not looked at.
[[nodiscard]] std::string_view fault_of(const Frame& frame);

}  // namespace roomradar
