// scan_picture.cpp: projects the knowledge at depth pixels into the picture.
#include "app/scan/scan_picture.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

constexpr int kStep_px = KnowledgeGrid::kStep_px;
constexpr std::uint32_t kNoTint =
    64U | 196U << 8U | 120U << 16U;  // green with alpha 0, as it is interpolated

std::uint32_t colour_of(Knowledge knowledge) {
  constexpr auto rgba = [](unsigned r, unsigned g, unsigned b, unsigned a) {
    return r | g << 8U | b << 16U | a << 24U;
  };
  if (knowledge == Knowledge::kWell) return rgba(64, 196, 120, 70);
  return knowledge == Knowledge::kThin ? rgba(240, 178, 74, 90) : kNoTint;
}

}  // namespace

void make_picture(const Frame& frame, ColourImage& picture) {
  if (!frame.colour.empty()) {
    picture = frame.colour;
    return;
  }
  picture.resize(frame.depth_m.width, frame.depth_m.height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const float depth_m = frame.depth_m.pixels[i];
    if (!(depth_m > 0.0F)) continue;
    const auto grey = static_cast<std::uint8_t>(std::clamp(255.0F * 0.5F / depth_m, 26.0F, 255.0F));
    picture.pixels[i] = {grey, grey, grey};
  }
}

Image<std::uint32_t> make_tint(const Frame& frame, const Image<Knowledge>& knowledge) {
  const bool has_colour = !frame.colour.empty();
  const Intrinsics& camera = has_colour ? frame.colour_camera : frame.depth_camera;
  Image<std::uint32_t> tint((camera.width_px + kStep_px - 1) / kStep_px,
                            (camera.height_px + kStep_px - 1) / kStep_px, kNoTint);
  for (int row = 0; row < knowledge.height; ++row)
    for (int column = 0; column < knowledge.width; ++column) {
      const std::uint32_t colour = colour_of(knowledge.at(column, row));
      if (colour == kNoTint) continue;
      const int x = kStep_px * column + kStep_px / 2, y = kStep_px * row + kStep_px / 2;
      Eigen::Vector3d p = back_project(frame.depth_camera, x, y, static_cast<double>(frame.depth_m.at(x, y)));
      if (has_colour) p = frame.T_colour_depth * p;
      if (!(p.z() > 0.0)) continue;
      const Eigen::Vector2d at = project(camera, p) / kStep_px;
      if (!(at.array().abs() < 1e6).all()) continue;
      const int to_x = static_cast<int>(std::floor(at.x())), to_y = static_cast<int>(std::floor(at.y()));
      if (tint.contains(to_x, to_y)) tint.at(to_x, to_y) = colour;
    }
  return tint;
}

void mix_half(const ColourImage& last_good, ColourImage& picture) {
  if (last_good.width != picture.width || last_good.height != picture.height) return;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const auto mixed = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>((a + b) / 2); };
    Rgb& pixel = picture.pixels[i];
    const Rgb& good = last_good.pixels[i];
    pixel = {mixed(pixel.r, good.r), mixed(pixel.g, good.g), mixed(pixel.b, good.b)};
  }
}

}  // namespace roomradar
