// measured_view.cpp: projects measured pixels, and merges them with the modelled surfaces.
#include "app/render/measured_view.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "app/render/edge_rules.hpp"

namespace roomradar {
namespace {

/// Returns the pixels of the depth image that may be seen in `rect` of the view.
PixelRect pixels_that_reach(const PixelRect& rect, const Intrinsics& depth_camera,
                            const Eigen::Isometry3d& T_view_depth, const Intrinsics& view_camera) {
  constexpr double kNearest_m = 0.4, kFarthest_m = 20.0;
  constexpr double kMargin_px = 2.0;
  const PixelRect all{0, 0, depth_camera.width_px, depth_camera.height_px};
  const Eigen::Isometry3d T_depth_view = T_view_depth.inverse();
  Eigen::AlignedBox2d bounds;
  for (const int x : {rect.x, rect.x + rect.width}) {
    for (const int y : {rect.y, rect.y + rect.height}) {
      for (const double z_m : {kNearest_m, kFarthest_m}) {
        const Eigen::Vector3d p = T_depth_view * back_project(view_camera, x, y, z_m);
        if (!(p.z() > 0.05)) return all;
        bounds.extend(Eigen::Vector2d(p.x() / p.z() * depth_camera.fx_px + depth_camera.cx_px,
                                      p.y() / p.z() * depth_camera.fy_px + depth_camera.cy_px));
      }
    }
  }
  const Eigen::Vector2d low = bounds.min().array() - kMargin_px, high = bounds.max().array() + kMargin_px;
  if (!(low.minCoeff() > -1e6 && high.maxCoeff() < 1e6)) return all;
  const int x = static_cast<int>(std::floor(low.x())), y = static_cast<int>(std::floor(low.y()));
  return clamped({x, y, static_cast<int>(std::ceil(high.x())) - x, static_cast<int>(std::ceil(high.y())) - y},
                 depth_camera.width_px, depth_camera.height_px);
}

bool is_one_surface(float a_m, float b_m) {
  constexpr float kJump = 0.03F;
  return a_m > 0.0F && b_m > 0.0F && std::abs(a_m - b_m) <= kJump * std::min(a_m, b_m);
}

/// Sets pixels that nothing reached, between two pixels of one surface beside or above and below them.
void close_cracks(MeasuredView& view) {
  const PixelRect& rect = view.rect;
  for (int y = rect.y + 1; y + 1 < rect.y + rect.height; ++y) {
    for (int x = rect.x + 1; x + 1 < rect.x + rect.width; ++x) {
      float& z_m = view.depth_m.at(x, y);
      if (z_m > 0.0F) continue;
      const auto width = static_cast<std::size_t>(view.depth_m.width);
      const std::size_t i = view.depth_m.index(x, y);
      for (const auto& [a, b] : {std::pair{i - 1, i + 1}, std::pair{i - width, i + width}}) {
        const float a_m = view.depth_m.pixels[a], b_m = view.depth_m.pixels[b];
        if (!is_one_surface(a_m, b_m)) continue;
        z_m = 0.5F * (a_m + b_m);
        view.is_dynamic.pixels[i] = view.is_dynamic.pixels[a] & view.is_dynamic.pixels[b];
        view.is_revealed.pixels[i] = view.is_revealed.pixels[a] & view.is_revealed.pixels[b];
      }
    }
  }
}

/// Marks the pixels of the rectangle within reach_px of a dynamic one. Returns false if there is none.
bool find_near_dynamic(int reach_px, MeasuredView& view) {
  const PixelRect& rect = view.rect;
  view.is_near.resize(rect.width, rect.height);
  view.counts.assign(static_cast<std::size_t>(rect.width), 0);
  bool found = false;
  const auto add_row = [&](int y, int sign) {
    if (y < 0 || y >= rect.height) return;
    const std::uint8_t* row = view.is_dynamic.row(rect.y + y) + rect.x;
    for (int x = 0; x < rect.width; ++x) view.counts[static_cast<std::size_t>(x)] += row[x] != 0 ? sign : 0;
  };
  for (int y = 0; y < reach_px; ++y) add_row(y, 1);
  for (int y = 0; y < rect.height; ++y) {
    add_row(y + reach_px, 1);
    add_row(y - reach_px - 1, -1);
    std::uint8_t* near = view.is_near.row(y);
    int last = -2 * reach_px - 1;  // column with a dynamic pixel
    for (int x = -reach_px; x < rect.width; ++x) {
      const int ahead = x + reach_px;
      if (ahead < rect.width && view.counts[static_cast<std::size_t>(ahead)] > 0) last = ahead;
      if (x >= 0 && last >= x - reach_px) near[x] = 255, found = true;
    }
  }
  return found;
}

/// A measured pixel of the view.
struct ColourSample {
  int x, y;
  float z_m;
  bool is_dynamic;
  Rgb colour;
};

constexpr int kGapReach_px = 20;

/// Returns the depth of the dynamic surface that an unmeasured pixel belongs to, by its colour; 0: to none.
float depth_in_gap(std::span<const ColourSample> samples, int x, int y, const Rgb& colour, float model_m) {
  constexpr float kNearer_m = 0.02F;
  constexpr float kUnit = 1.0F / static_cast<float>(kGapReach_px);
  struct Side {
    float weights = 0.0F, count = 0.0F;
    /// Between sum and mean: a thin finger has few pixels, and a surface that is hardly there has fewer.
    [[nodiscard]] float likelihood() const { return weights / std::sqrt(std::max(count, 1.0F)); }
  };
  Side dynamic, other;
  float inverse_depths = 0.0F, best = 0.0F, best_m = 0.0F;
  for (const ColourSample& sample : samples) {
    const float dx = static_cast<float>(sample.x - x) * kUnit, dy = static_cast<float>(sample.y - y) * kUnit;
    const float alike =
        1.0F / (1.0F + squared_distance(sample.colour, colour) / kAlike2 + 0.5F * (dx * dx + dy * dy));
    const float weight = alike * alike * alike;  // heavy tails: creases and highlights are like nothing else
    const bool is_dynamic = sample.is_dynamic && (!(model_m > 0.0F) || sample.z_m < model_m - kNearer_m);
    Side& side = is_dynamic ? dynamic : other;
    side.weights += weight;
    side.count += 1.0F;
    if (!is_dynamic) continue;
    if (weight > best) best = weight, best_m = sample.z_m;
    inverse_depths += weight / sample.z_m;
  }
  if (!(dynamic.likelihood() > other.likelihood())) return 0.0F;
  const float mean_m = dynamic.weights / inverse_depths;
  return is_one_surface(mean_m, best_m) ? mean_m : best_m;
}

}  // namespace

void view_measured(const MeasuredFrame& frame, const Eigen::Isometry3d& T_view_depth,
                   const Intrinsics& view_camera, const PixelRect& rect, MeasuredView& view) {
  const DepthImage& depth_m = frame.depth_m;
  const Intrinsics& depth_camera = frame.camera;
  view.rect = rect;
  const auto fit = [&](auto& image) {
    if (image.width != view_camera.width_px || image.height != view_camera.height_px)
      image.resize(view_camera.width_px, view_camera.height_px);
  };
  fit(view.depth_m);
  fit(view.is_dynamic);
  fit(view.is_revealed);
  fit(view.is_decided);
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    std::fill_n(view.depth_m.row(y) + rect.x, rect.width, 0.0F);
    for (MaskImage* mask : {&view.is_dynamic, &view.is_revealed, &view.is_decided})
      std::fill_n(mask->row(y) + rect.x, rect.width, std::uint8_t{0});
  }
  const PixelRect from = pixels_that_reach(rect, depth_camera, T_view_depth, view_camera);
  const Eigen::Isometry3f T = T_view_depth.cast<float>();
  const auto fx = static_cast<float>(view_camera.fx_px), fy = static_cast<float>(view_camera.fy_px);
  const auto cx = static_cast<float>(view_camera.cx_px), cy = static_cast<float>(view_camera.cy_px);
  const float per_pixel = fx / static_cast<float>(depth_camera.fx_px);  // at equal depths
  const Eigen::Vector3f step_x = T.linear().col(0) / static_cast<float>(depth_camera.fx_px);
  const int x_end = rect.x + rect.width, y_end = rect.y + rect.height;
  const float margin = per_pixel + 1.0F;  // half of the widest pixel, as far as it matters
  const float low_x = static_cast<float>(rect.x) - margin, high_x = static_cast<float>(x_end) + margin;
  const float low_y = static_cast<float>(rect.y) - margin, high_y = static_cast<float>(y_end) + margin;
  for (int v = from.y; v < from.y + from.height; ++v) {
    const float* row_m = depth_m.row(v);
    const auto row_of = [&](const MaskImage& mask) {
      return mask.empty() ? nullptr : mask.row(v * mask.height / depth_m.height);
    };
    const auto value_at = [&](const MaskImage& mask, const std::uint8_t* row, int u) {
      return row == nullptr ? std::uint8_t{0} : row[u * mask.width / depth_m.width];
    };
    const std::uint8_t *dynamic = row_of(frame.dynamic_mask), *revealed = row_of(frame.revealed_mask);
    const Eigen::Vector3f ray_at_column_0 =
        T.linear() * back_project(depth_camera, 0.0, v, 1.0).cast<float>();
    for (int u = from.x; u < from.x + from.width; ++u) {
      const float z_m = row_m[u];
      if (!(z_m > 0.0F)) continue;
      const Eigen::Vector3f p = (ray_at_column_0 + static_cast<float>(u) * step_x) * z_m + T.translation();
      if (!(p.z() > 0.05F)) continue;
      const float inverse = 1.0F / p.z();
      const float x = p.x() * inverse * fx + cx, y = p.y() * inverse * fy + cy;
      if (!(x > low_x && y > low_y && x < high_x && y < high_y)) continue;
      const std::uint8_t is_dynamic = value_at(frame.dynamic_mask, dynamic, u),
                         is_revealed = value_at(frame.revealed_mask, revealed, u);
      const auto set = [&](int xx, int yy) {
        const std::size_t i = view.depth_m.index(xx, yy);
        if (view.depth_m.pixels[i] > 0.0F && view.depth_m.pixels[i] <= p.z()) return;
        view.depth_m.pixels[i] = p.z();
        view.is_dynamic.pixels[i] = is_dynamic;
        view.is_revealed.pixels[i] = is_revealed;
      };
      const float half = 0.5F * per_pixel * z_m * inverse;
      if (half <= 0.5F) {
        const int xx = static_cast<int>(x + 0.5F), yy = static_cast<int>(y + 0.5F);
        if (xx >= rect.x && yy >= rect.y && xx < x_end && yy < y_end) set(xx, yy);
        continue;
      }
      const int x0 = std::max(static_cast<int>(std::ceil(x - half)), rect.x);
      const int y0 = std::max(static_cast<int>(std::ceil(y - half)), rect.y);
      for (int yy = y0; yy < y_end && static_cast<float>(yy) < y + half; ++yy)
        for (int xx = x0; xx < x_end && static_cast<float>(xx) < x + half; ++xx) set(xx, yy);
    }
  }
  close_cracks(view);
}

void add_measured(const MeasuredView& view, const DepthNoise& noise, DepthImage& real_depth_m) {
  constexpr float kLeastNearer_m = 0.02F;  // error of poses and model
  constexpr float kSigmas = 4.0F;
  constexpr int kFewest = 6;  // of 5 x 5 pixels
  const PixelRect& rect = view.rect;
  const int x_end = rect.x + rect.width, y_end = rect.y + rect.height;
  const auto is_nearer = [&](float z_m, float model_m) {
    return z_m > 0.0F && z_m < model_m - kLeastNearer_m &&
           z_m < model_m - kSigmas * depth_sigma_m(noise, model_m);
  };
  // Depth measured behind a part of the room that is gone, at a pixel or at most of the measured ones around
  // it.
  const auto revealed_m = [&](int x, int y) {
    if (view.depth_m.at(x, y) > 0.0F) return view.is_revealed.at(x, y) != 0 ? view.depth_m.at(x, y) : 0.0F;
    int revealed = 0, measured = 0;
    float sum_m = 0.0F;
    for (int v = std::max(y - 2, rect.y); v <= std::min(y + 2, y_end - 1); ++v)
      for (int u = std::max(x - 2, rect.x); u <= std::min(x + 2, x_end - 1); ++u) {
        measured += view.depth_m.at(u, v) > 0.0F ? 1 : 0;
        if (view.is_revealed.at(u, v) == 0) continue;
        ++revealed;
        sum_m += view.depth_m.at(u, v);
      }
    return revealed >= kFewest && 2 * revealed > measured ? sum_m / static_cast<float>(revealed) : 0.0F;
  };
  std::vector<std::size_t> nearer, without_model;
  std::vector<std::pair<std::size_t, float>> behind;
  for (int y = rect.y; y < y_end; ++y) {
    const float* seen_m = view.depth_m.row(y);
    const float* model_m = real_depth_m.row(y);
    for (int x = rect.x; x < x_end; ++x) {
      if (!(model_m[x] > 0.0F) && seen_m[x] > 0.0F) without_model.push_back(view.depth_m.index(x, y));
      if (const float z_m = revealed_m(x, y); is_nearer(model_m[x], z_m))
        behind.emplace_back(view.depth_m.index(x, y), z_m);
      if (!is_nearer(seen_m[x], model_m[x])) continue;
      int supported = 0;
      for (int v = std::max(y - 2, rect.y); v <= std::min(y + 2, y_end - 1); ++v)
        for (int u = std::max(x - 2, rect.x); u <= std::min(x + 2, x_end - 1); ++u)
          supported += is_one_surface(view.depth_m.at(u, v), seen_m[x]) &&
                               (view.is_dynamic.at(u, v) != 0 ||
                                is_nearer(view.depth_m.at(u, v), real_depth_m.at(u, v)))
                           ? 1
                           : 0;
      if (supported >= kFewest) nearer.push_back(view.depth_m.index(x, y));
    }
  }
  for (const std::vector<std::size_t>* pixels : {&nearer, &without_model})
    for (const std::size_t i : *pixels) real_depth_m.pixels[i] = view.depth_m.pixels[i];
  for (const auto& [i, z_m] : behind) real_depth_m.pixels[i] = z_m;
}

void bridge_gaps(const ColourImage& camera_image, MeasuredView& view, DepthImage& real_depth_m) {
  constexpr int kStep_px = 3;  // spacing of samples
  constexpr int kCell_px = 4;  // pixels of a cell share the samples
  const PixelRect& rect = view.rect;
  if (!find_near_dynamic(kGapReach_px, view)) return;
  const int x_end = rect.x + rect.width, y_end = rect.y + rect.height;
  for (int y = rect.y; y < y_end; ++y)
    for (int x = rect.x; x < x_end; ++x)
      if (view.depth_m.at(x, y) > 0.0F && view.is_dynamic.at(x, y) != 0) view.is_decided.at(x, y) = 255;
  std::vector<ColourSample> samples;
  const auto find_samples = [&](int x, int y) {
    samples.clear();
    for (int v = y - kGapReach_px; v <= y + kGapReach_px; v += kStep_px) {
      for (int u = x - kGapReach_px; u <= x + kGapReach_px; u += kStep_px) {
        if (u < rect.x || v < rect.y || u >= x_end || v >= y_end) continue;
        const float z_m = view.depth_m.at(u, v);
        if (z_m > 0.0F) samples.push_back({u, v, z_m, view.is_dynamic.at(u, v) != 0, camera_image.at(u, v)});
      }
    }
  };
  for (int cell_y = rect.y; cell_y < y_end; cell_y += kCell_px) {
    for (int cell_x = rect.x; cell_x < x_end; cell_x += kCell_px) {
      bool has_samples = false;
      for (int y = cell_y; y < std::min(cell_y + kCell_px, y_end); ++y) {
        for (int x = cell_x; x < std::min(cell_x + kCell_px, x_end); ++x) {
          if (view.depth_m.at(x, y) > 0.0F || view.is_near.at(x - rect.x, y - rect.y) == 0) continue;
          if (!has_samples) find_samples(cell_x + kCell_px / 2, cell_y + kCell_px / 2);
          has_samples = true;
          float& real_m = real_depth_m.at(x, y);
          const float gap_m = depth_in_gap(samples, x, y, camera_image.at(x, y), real_m);
          if (gap_m > 0.0F) real_m = gap_m;
          view.is_decided.at(x, y) = 255;
        }
      }
    }
  }
}

}  // namespace roomradar
