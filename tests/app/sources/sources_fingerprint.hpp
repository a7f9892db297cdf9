// sources_fingerprint.hpp: a frame as one line of text, equal only for bit-identical frames.
#pragma once
#include <array>
#include <cstdio>
#include <string>
#include <string_view>

#include "mapping/types/frame.hpp"

namespace roomradar::test {

/// FNV-1a hash of the pixels' bytes.
template <typename Pixel>
std::uint64_t hash_of(const Image<Pixel>& image) {
  std::uint64_t hash = 14695981039346656037ULL;
  const std::string_view bytes(reinterpret_cast<const char*>(image.pixels.data()),
                               image.pixels.size() * sizeof(Pixel));
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  return hash;
}

inline std::string fingerprint(const Frame& frame) {
  const Eigen::Vector3d down = frame.down_camera.value_or(Eigen::Vector3d::Zero());
  std::array<char, 512> line{};
  std::snprintf(line.data(), line.size(),
                "frame %lld %.9f depth %d %d %016llx colour %d %d %016llx down %.12f %.12f %.12f fx %.6f",
                static_cast<long long>(frame.index), frame.stamp_s, frame.depth_m.width, frame.depth_m.height,
                static_cast<unsigned long long>(hash_of(frame.depth_m)), frame.colour.width,
                frame.colour.height, static_cast<unsigned long long>(hash_of(frame.colour)), down.x(),
                down.y(), down.z(), frame.depth_camera.fx_px);
  return line.data();
}

}  // namespace roomradar::test
