// subsampled_picture.cpp: conversion to luma and chroma, and bilinear interpolation of both.
#include "mapping/texture/subsampled_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roomradar {
namespace {

using Chroma = SubsampledPicture::Chroma;

std::uint8_t luma_of(const Rgb& p) {
  return static_cast<std::uint8_t>(0.299F * p.r + 0.587F * p.g + 0.114F * p.b + 0.5F);
}

/// Chroma of a mean colour.
Chroma chroma_of(const Eigen::Array3f& rgb) {
  const float luma = 0.299F * rgb.x() + 0.587F * rgb.y() + 0.114F * rgb.z();
  const auto rounded = [](float value) {
    return static_cast<std::int8_t>(std::clamp(std::lround(value), -128L, 127L));
  };
  return {rounded((rgb.z() - luma) / 1.772F), rounded((rgb.x() - luma) / 1.402F)};
}

Eigen::Array3f rgb_of(float luma, float cb, float cr) {
  return Eigen::Array3f(luma + 1.402F * cr, luma - 0.344136F * cb - 0.714136F * cr, luma + 1.772F * cb)
      .max(0.0F)
      .min(255.0F);
}

/// Indices and weights of the four pixels around an image coordinate.
struct Neighbours {
  std::array<std::size_t, 4> at;
  std::array<float, 4> weights;
};

Neighbours neighbours(int width, int height, float x, float y) {
  const float in_x = std::clamp(x, 0.0F, static_cast<float>(width - 1));
  const float in_y = std::clamp(y, 0.0F, static_cast<float>(height - 1));
  const int left = std::min(static_cast<int>(in_x), std::max(width - 2, 0));
  const int top = std::min(static_cast<int>(in_y), std::max(height - 2, 0));
  const float u = in_x - static_cast<float>(left), v = in_y - static_cast<float>(top);
  const std::size_t right = width > 1 ? 1 : 0;
  const std::size_t first =
      static_cast<std::size_t>(top) * static_cast<std::size_t>(width) + static_cast<std::size_t>(left);
  const std::size_t below = first + (height > 1 ? static_cast<std::size_t>(width) : 0);
  return {{first, first + right, below, below + right},
          {(1.0F - v) * (1.0F - u), (1.0F - v) * u, v * (1.0F - u), v * u}};
}

}  // namespace

SubsampledPicture subsampled(const ColourImage& picture) {
  SubsampledPicture out;
  out.luma.resize(picture.width, picture.height);
  std::transform(picture.pixels.begin(), picture.pixels.end(), out.luma.pixels.begin(), luma_of);
  out.chroma.resize((picture.width + 1) / 2, (picture.height + 1) / 2);
  for (int y = 0; y < out.chroma.height; ++y)
    for (int x = 0; x < out.chroma.width; ++x) {
      Eigen::Array3f sum = Eigen::Array3f::Zero();
      for (const int v : {2 * y, std::min(2 * y + 1, picture.height - 1)})
        for (const int u : {2 * x, std::min(2 * x + 1, picture.width - 1)}) {
          const Rgb& pixel = picture.at(u, v);
          sum += Eigen::Array3f(pixel.r, pixel.g, pixel.b);
        }
      out.chroma.at(x, y) = chroma_of(0.25F * sum);
    }
  return out;
}

Eigen::Array3f colour_at(const SubsampledPicture& picture, const Eigen::Vector2f& pixel) {
  const Neighbours fine = neighbours(picture.luma.width, picture.luma.height, pixel.x(), pixel.y());
  const Neighbours coarse = neighbours(picture.chroma.width, picture.chroma.height, 0.5F * pixel.x() - 0.25F,
                                       0.5F * pixel.y() - 0.25F);
  float luma = 0.0F, cb = 0.0F, cr = 0.0F;
  for (std::size_t i = 0; i < 4; ++i) {
    luma += fine.weights[i] * static_cast<float>(picture.luma.pixels[fine.at[i]]);
    const Chroma& chroma = picture.chroma.pixels[coarse.at[i]];
    cb += coarse.weights[i] * static_cast<float>(chroma[0]);
    cr += coarse.weights[i] * static_cast<float>(chroma[1]);
  }
  return rgb_of(luma, cb, cr);
}

Eigen::Array3f mean_colour(const SubsampledPicture& picture, int left, int top, int factor) {
  int luma = 0, cb = 0, cr = 0;
  for (int y = top; y < top + factor; ++y)
    for (int x = left; x < left + factor; ++x) luma += picture.luma.at(x, y);
  for (int y = top / 2; y < (top + factor) / 2; ++y)
    for (int x = left / 2; x < (left + factor) / 2; ++x) {
      cb += picture.chroma.at(x, y)[0];
      cr += picture.chroma.at(x, y)[1];
    }
  const float area = static_cast<float>(factor * factor);
  return rgb_of(static_cast<float>(luma) / area, 4.0F * static_cast<float>(cb) / area,
                4.0F * static_cast<float>(cr) / area);
}

}  // namespace roomradar
