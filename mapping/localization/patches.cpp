// patches.cpp: corners with depth, rectified and described by brightness comparisons.
#include "mapping/localization/patches.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <utility>

#include "mapping/alignment/surface_point.hpp"
#include "mapping/alignment/view.hpp"

namespace roomradar {
namespace {

constexpr int kSide = 32;  // samples along a patch's edge
constexpr int kBox = 2;    // brightness is the mean of (2 kBox + 1)^2 samples

using Samples = std::array<float, kSide * kSide>;

/// Axes of a patch, in the depth camera.
struct Axes {
  Eigen::Vector3f along, across;
};

struct ColourView {
  std::vector<cv::Mat1b> mips;  ///< each half the size of the one before
  Intrinsics camera;            ///< camera of the first
  Eigen::Isometry3f T_colour_depth;
};

/// Samples the patch's brightness; returns false if the patch extends beyond the image.
bool sample(const ColourView& view, const Eigen::Vector3f& point, const Axes& axes, float width_m,
            Samples& samples) {
  const float spacing_m = width_m / kSide;
  const Eigen::Vector3f centre = view.T_colour_depth * point;
  const Eigen::Vector3f du = view.T_colour_depth.linear() * axes.along * spacing_m;
  const Eigen::Vector3f dv = view.T_colour_depth.linear() * axes.across * spacing_m;
  if (centre.z() < 0.2F) return false;
  const float spacing_px = static_cast<float>(view.camera.fx_px) * spacing_m / centre.z();
  const int mip = std::clamp(static_cast<int>(std::lround(std::log2(std::max(spacing_px, 1.0F)))), 0,
                             static_cast<int>(view.mips.size()) - 1);
  const cv::Mat1b& image = view.mips[static_cast<std::size_t>(mip)];
  const float scale = 1.0F / static_cast<float>(1 << mip);
  const auto fx = static_cast<float>(view.camera.fx_px) * scale,
             fy = static_cast<float>(view.camera.fy_px) * scale;
  const float cx = (static_cast<float>(view.camera.cx_px) + 0.5F) * scale - 0.5F,
              cy = (static_cast<float>(view.camera.cy_px) + 0.5F) * scale - 0.5F;
  const auto last_u = static_cast<float>(image.cols - 1), last_v = static_cast<float>(image.rows - 1);
  for (int j = 0; j < kSide; ++j) {
    const Eigen::Vector3f row =
        centre + (static_cast<float>(j) - 0.5F * (kSide - 1)) * dv - 0.5F * (kSide - 1) * du;
    for (int i = 0; i < kSide; ++i) {
      const Eigen::Vector3f p = row + static_cast<float>(i) * du;
      const float inverse_z = 1.0F / p.z();
      const float u = fx * p.x() * inverse_z + cx, v = fy * p.y() * inverse_z + cy;
      if (!(u >= 0.0F && v >= 0.0F && u < last_u && v < last_v)) return false;
      const int x = static_cast<int>(u), y = static_cast<int>(v);
      const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
      const std::uint8_t* upper = image.ptr(y) + x;
      const std::uint8_t* lower = image.ptr(y + 1) + x;
      samples[static_cast<std::size_t>(j * kSide + i)] =
          (1.0F - b) * ((1.0F - a) * upper[0] + a * upper[1]) + b * ((1.0F - a) * lower[0] + a * lower[1]);
    }
  }
  return true;
}

/// Rotates the axes so the first points to the patch's brighter side; returns false for an almost uniform
/// patch. Source: Rosin, Measuring corner properties, 1999 (intensity centroid).
bool turn_to_brightness(const Samples& samples, Axes& axes) {
  constexpr float kMinDeviation = 4.0F;  // grey levels
  constexpr float kRadius = 0.5F * kSide;
  float n = 0.0F, sum = 0.0F, squares = 0.0F, su = 0.0F, sv = 0.0F;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const float u = static_cast<float>(i) - 0.5F * (kSide - 1),
                  v = static_cast<float>(j) - 0.5F * (kSide - 1);
      if (u * u + v * v > kRadius * kRadius) continue;
      const float grey = samples[static_cast<std::size_t>(j * kSide + i)];
      n += 1.0F, sum += grey, squares += grey * grey, su += u * grey, sv += v * grey;
    }
  }
  const float variance = squares / n - (sum / n) * (sum / n);
  const float length = std::hypot(su, sv);
  if (variance < kMinDeviation * kMinDeviation || !(length > 0.0F)) return false;
  const float c = su / length, s = sv / length;
  axes = {c * axes.along + s * axes.across, c * axes.across - s * axes.along};
  return true;
}

struct Comparison {
  std::array<int, 4> at;  ///< u and v of the first sample, u and v of the second
};

const std::array<Comparison, 256>& comparisons() {
  static const std::array<Comparison, 256> drawn = [] {
    std::array<Comparison, 256> pairs{};
    std::mt19937 random(7);
    const auto coordinate = [&random] {  // bell-shaped distribution within the patch
      int sum = 0;
      for (int k = 0; k < 3; ++k) sum += static_cast<int>(random() % (kSide - 2 * kBox));
      return kBox + sum / 3;
    };
    for (Comparison& pair : pairs)
      for (int& at : pair.at) at = coordinate();
    return pairs;
  }();
  return drawn;
}

Descriptor compare(const Samples& samples) {
  std::array<float, (kSide + 1) * (kSide + 1)> integral{};
  for (int j = 0; j < kSide; ++j) {
    float row = 0.0F;
    for (int i = 0; i < kSide; ++i) {
      row += samples[static_cast<std::size_t>(j * kSide + i)];
      integral[static_cast<std::size_t>((j + 1) * (kSide + 1) + i + 1)] =
          integral[static_cast<std::size_t>(j * (kSide + 1) + i + 1)] + row;
    }
  }
  const auto box = [&integral](int u, int v) {
    const auto corner = [&integral](int x, int y) {
      return integral[static_cast<std::size_t>(y * (kSide + 1) + x)];
    };
    return corner(u + kBox + 1, v + kBox + 1) - corner(u - kBox, v + kBox + 1) -
           corner(u + kBox + 1, v - kBox) + corner(u - kBox, v - kBox);
  };
  Descriptor bits{};
  for (std::size_t k = 0; k < 256; ++k) {
    const auto& at = comparisons()[k].at;
    if (box(at[0], at[1]) < box(at[2], at[3])) bits[k / 8] |= static_cast<std::uint8_t>(1U << (k % 8));
  }
  return bits;
}

/// Returns corners in the order of selection: alternately the strongest remaining one of the image and of a
/// cell.
std::vector<cv::KeyPoint> corners_of(const cv::Mat1b& grey, int most) {
  constexpr int kFastThreshold = 10, kCell_px = 40;
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(4 * most, 1.4142F, 6, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, kFastThreshold);
  std::vector<cv::KeyPoint> corners;
  orb->detect(grey, corners);
  std::stable_sort(corners.begin(), corners.end(),
                   [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
  const int columns = grey.cols / kCell_px + 1, rows = grey.rows / kCell_px + 1;
  std::vector<int> of_cell(static_cast<std::size_t>(columns * rows), 0);
  std::vector<std::pair<int, std::size_t>> by_cell;  // the strongest of every cell, then the second ...
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int cell =
        static_cast<int>(corners[i].pt.y) / kCell_px * columns + static_cast<int>(corners[i].pt.x) / kCell_px;
    by_cell.emplace_back(of_cell[static_cast<std::size_t>(cell)]++, i);
  }
  std::stable_sort(by_cell.begin(), by_cell.end());
  std::vector<cv::KeyPoint> mixed;
  std::vector<bool> taken(corners.size(), false);
  const auto take = [&](std::size_t i) {
    if (!taken[i]) mixed.push_back(corners[i]);
    taken[i] = true;
  };
  for (std::size_t i = 0; i < corners.size(); ++i) take(i), take(by_cell[i].second);
  return mixed;
}

}  // namespace

std::vector<SurfacePatch> describe_patches(const Frame& frame, int most) {
  constexpr int kSmallest_px = 64;
  std::vector<SurfacePatch> patches;
  if (std::min(frame.colour.width, frame.colour.height) < kSmallest_px || most <= 0) return patches;
  ColourView view{{cv::Mat1b()}, frame.colour_camera, frame.T_colour_depth.cast<float>()};
  const cv::Mat3b colour(frame.colour.height, frame.colour.width,
                         reinterpret_cast<cv::Vec3b*>(const_cast<Rgb*>(frame.colour.pixels.data())));
  cv::cvtColor(colour, view.mips.front(), cv::COLOR_RGB2GRAY);
  for (int mip = 1; mip < 5; ++mip) {
    cv::Mat1b half;
    cv::resize(view.mips.back(), half, {view.mips.back().cols / 2, view.mips.back().rows / 2}, 0, 0,
               cv::INTER_AREA);
    view.mips.push_back(half);
  }
  ViewPyramid pyramid;
  TargetView surface;
  const ViewConfig config{.levels = 1, .max_depth_m = 8.0F};
  make_pyramid(frame.depth_m, frame.depth_camera, config, pyramid, frame.depth_noise);
  make_target_view(pyramid, Eigen::Isometry3d::Identity(), config, surface);
  const TargetLevel& level = surface.levels.front();
  const Eigen::Isometry3d T_depth_colour = frame.T_colour_depth.inverse();

  Samples samples;
  for (const cv::KeyPoint& corner : corners_of(view.mips.front(), most)) {
    if (patches.size() >= static_cast<std::size_t>(most)) break;
    const auto p = surface_point_at(frame, T_depth_colour, static_cast<double>(corner.pt.x),
                                    static_cast<double>(corner.pt.y));
    if (!p) continue;
    const Eigen::Vector2d at_px = project(level.camera, p->cast<double>());
    const int x = static_cast<int>(std::lround(at_px.x())), y = static_cast<int>(std::lround(at_px.y()));
    if (!level.pixels.contains(x, y)) continue;
    const TargetPixel& plane = level.pixels.at(x, y);
    // A patch seen at more than 75 degrees is only a few pixels high.
    if (plane.inverse_sigma_per_m <= 0.0F || -plane.normal.dot(p->normalized()) < 0.26F) continue;
    const float seen_m = corner.size * p->z() / static_cast<float>(frame.colour_camera.fx_px);
    const int size = static_cast<int>(std::lround(std::log2(seen_m / patch_width_m(0))));
    if (size < 0 || size >= kPatchSizes) continue;
    Axes axes;
    axes.along = (Eigen::Vector3f::UnitX() - plane.normal.x() * plane.normal).normalized();
    axes.across = -plane.normal.cross(axes.along);
    if (!axes.along.allFinite()) continue;
    if (!sample(view, *p, axes, patch_width_m(size), samples) || !turn_to_brightness(samples, axes) ||
        !sample(view, *p, axes, patch_width_m(size), samples))
      continue;
    patches.push_back({*p, plane.normal, axes.along, static_cast<std::uint8_t>(size), compare(samples)});
  }
  return patches;
}

}  // namespace roomradar
