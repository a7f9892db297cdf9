// locate_request.hpp: parses the body of a request to locate a camera.
#pragma once
#include <cstddef>
#include <string_view>

#include "mapping/types/frame.hpp"

namespace roomradar {

inline constexpr std::size_t kMaxLocateBody_bytes = 8'000'000;
inline constexpr std::size_t kMaxLocateHeader_bytes = 16'384;
inline constexpr long kMaxLocatePixels = 2'500'000;  ///< per image; 1,920 x 1,080 has 2.1 million

/// Parses a request's body: one line of JSON, then the bytes of both images.
///
///     {"camera": {"depth": {"width_px": 640, ...}, "colour": {...}, "T_colour_depth": [...]},
///      "depth_bytes": 183042, "colour_bytes": 90211, "depth_units_per_m": 1000}\n
///     depth: grey PNG of 16 bit, 0: no measurement; colour: JPEG or PNG
///
/// `camera` has the fields of camera.json; see read_camera_file(). If it lacks `colour` and `T_colour_depth`,
/// the colour image is registered to the depth image and has its size. The default of `depth_units_per_m` is
/// 1000 (mm). The body is untrusted: lengths, image sizes and cameras are checked before pixels are decoded.
/// @throws Error with a message for the client
Frame parse_locate_request(std::string_view body);

}  // namespace roomradar
