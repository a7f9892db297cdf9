// compose.cpp: composes virtual objects into the camera's picture.
#include "app/render/compose.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "app/render/edge_rules.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {
namespace {

constexpr std::uint8_t kNearEdge = 128, kNearShadowEdge = 255;

/// Marks the pixels within reach_px of a depth edge: with kNearShadowEdge if pixels on its two
/// sides differ in light, else with kNearEdge.
MaskImage band_along_edges(const DepthImage& depth_m, int reach_px, const Image<float>& light_left) {
  constexpr float kLightJump = 0.04F;  // smaller differences of light are hardly visible
  MaskImage band(depth_m.width, depth_m.height);
  const auto edge_between = [&](int x, int y, int xx, int yy) -> std::uint8_t {
    if (!band.contains(xx, yy)) return 0;
    if (!is_depth_jump(depth_m.at(x, y), depth_m.at(xx, yy))) return 0;
    return std::abs(light_left.at(x, y) - light_left.at(xx, yy)) < kLightJump ? kNearEdge : kNearShadowEdge;
  };
  for (int y = 0; y < band.height; ++y) {
    for (int x = 0; x < band.width; ++x) {
      const std::uint8_t edge = std::max(edge_between(x, y, x + 1, y), edge_between(x, y, x, y + 1));
      if (edge == 0) continue;
      const int first = std::max(x - reach_px + 1, 0), end = std::min(x + reach_px + 1, band.width);
      for (int v = std::max(y - reach_px + 1, 0); v < std::min(y + reach_px + 1, band.height); ++v)
        for (int u = first; u < end; ++u) band.at(u, v) = std::max(band.at(u, v), edge);
    }
  }
  return band;
}

/// A pixel away from depth edges.
struct Sample {
  int x, y;  ///< in the rectangle
  float z_m;
  Rgb colour;
};

/// Weighted least squares of a plane through samples, whose inverse depth is linear in the image.
struct Plane {
  Eigen::Matrix3f A = Eigen::Matrix3f::Zero();
  Eigen::Vector3f b = Eigen::Vector3f::Zero();
  float nearest_m = 0.0F, farthest_m = 0.0F;

  [[nodiscard]] float weight() const { return A(0, 0); }

  /// Adds a sample at an offset in units of the window. Samples come in ascending order of depth.
  void add(float dx, float dy, float z_m, float sample_weight) {
    const Eigen::Vector3f row(1.0F, dx, dy);
    A += sample_weight * row * row.transpose();
    b += sample_weight / z_m * row;
    if (nearest_m == 0.0F) nearest_m = z_m;
    farthest_m = z_m;
  }

  /// Returns the depth at offset 0, within the range of the samples' depths.
  [[nodiscard]] float depth_m() const {
    constexpr double kLevel = 1e-3;  // without evidence, a surface faces the camera
    Eigen::Matrix3d regular = A.cast<double>();
    regular.diagonal().tail<2>().array() += kLevel;
    const auto z_m = static_cast<float>(1.0 / solve_symmetric(regular, b.cast<double>())(0));
    return std::clamp(z_m, nearest_m, farthest_m);
  }
};

/// Returns the depth of the surface that a pixel belongs to, by its colour; 0 if no sample is similar.
/// Surfaces are samples between which there is no jump of depth.
/// @param samples  in ascending order of depth
float depth_of_pixel(std::span<const Sample> samples, int x, int y, const Rgb& colour, int window_px) {
  constexpr float kUnlike = 5.0F;  // -log weight beyond which samples are ignored
  const float unit = 1.0F / static_cast<float>(window_px);
  Plane heaviest, plane;
  for (const Sample& sample : samples) {
    const float dx = static_cast<float>(sample.x - x) * unit, dy = static_cast<float>(sample.y - y) * unit;
    const float unlike = squared_distance(sample.colour, colour) / kAlike2 + 0.5F * (dx * dx + dy * dy);
    if (unlike > kUnlike) continue;
    if (is_depth_jump(plane.farthest_m, sample.z_m)) {
      if (plane.weight() > heaviest.weight()) heaviest = plane;
      plane = {};
    }
    plane.add(dx, dy, sample.z_m, std::exp(-unlike));
  }
  if (plane.weight() > heaviest.weight()) heaviest = plane;
  return heaviest.weight() > 0.0F ? heaviest.depth_m() : 0.0F;
}

/// Sets each pixel with depth to the median of its neighbourhood of 3 x 3 pixels, of those with depth.
void remove_specks(DepthImage& depth_m) {
  const DepthImage before_m = depth_m;
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      if (!(before_m.at(x, y) > 0.0F)) continue;
      std::array<float, 9> near_m;
      auto end = near_m.begin();
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
          if (before_m.contains(u, v) && before_m.at(u, v) > 0.0F) *end++ = before_m.at(u, v);
      const auto middle = near_m.begin() + (end - near_m.begin()) / 2;
      std::nth_element(near_m.begin(), middle, end);
      depth_m.at(x, y) = *middle;
    }
  }
}

/// Corrects depth where a shadow ends at a depth edge, i.e. where a nearer surface begins. This edge is
/// ragged in the depth image and displaced by some pixels. Each pixel within reach_px of the edge is compared
/// with pixels away from depth edges, weighted by similarity of colour and by distance. It is assigned to the
/// surface with the largest sum of weights, and gets the depth of the plane fitted to that surface's pixels.
/// Pixels without such a surface keep their depth.
///
/// Source of the weights: Kopf et al., Joint bilateral upsampling, SIGGRAPH 2007.
///
/// @param camera_image  colour image without shadows
/// @param rect          rectangle of camera_image in which shadows may lie
/// @param depth_m       depth of real surfaces in the pixels of `rect`; 0: no surface
/// @param reach_px      max distance between an edge in the depth image and in the colour image, px.
///                      0: nothing is changed
/// @param light_left    fraction of light that the shadows leave in the pixels of `rect`, 0 to 1
/// @param[out] aligned_m  corrected depth, with the size of `rect`; 0 in pixels that keep their depth
/// @return false if no shadow ends at a depth edge, so that all pixels keep their depth
bool align_shadow_edges(const ColourImage& camera_image, const PixelRect& rect, const DepthImage& depth_m,
                        int reach_px, const Image<float>& light_left, DepthImage& aligned_m) {
  constexpr int kSpacing_px = 3;  // spacing of samples
  constexpr int kCell_px = 4;     // pixels of a cell share the samples
  aligned_m.resize(rect.width, rect.height);
  if (reach_px <= 0) return false;
  const MaskImage band = band_along_edges(depth_m, reach_px, light_left);
  bool has_edges = false;
  const int window_px = 3 * reach_px;  // from one side of the band well beyond the other
  std::vector<Sample> samples;
  const auto find_samples = [&](int x, int y) {
    samples.clear();
    for (int v = std::max(y - window_px, 0); v <= std::min(y + window_px, rect.height - 1);
         v += kSpacing_px) {
      for (int u = std::max(x - window_px, 0); u <= std::min(x + window_px, rect.width - 1);
           u += kSpacing_px) {
        const float z_m = depth_m.at(u, v);
        if (band.at(u, v) == 0 && z_m > 0.0F)
          samples.push_back({u, v, z_m, camera_image.at(rect.x + u, rect.y + v)});
      }
    }
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
      return std::tie(a.z_m, a.y, a.x) < std::tie(b.z_m, b.y, b.x);
    });
  };
  for (int cell_y = 0; cell_y < rect.height; cell_y += kCell_px) {
    for (int cell_x = 0; cell_x < rect.width; cell_x += kCell_px) {
      bool has_samples = false;
      for (int y = cell_y; y < std::min(cell_y + kCell_px, rect.height); ++y) {
        for (int x = cell_x; x < std::min(cell_x + kCell_px, rect.width); ++x) {
          if (band.at(x, y) != kNearShadowEdge) continue;
          if (!has_samples) find_samples(cell_x + kCell_px / 2, cell_y + kCell_px / 2);
          has_samples = has_edges = true;
          aligned_m.at(x, y) =
              depth_of_pixel(samples, x, y, camera_image.at(rect.x + x, rect.y + y), window_px);
        }
      }
    }
  }
  if (has_edges) remove_specks(aligned_m);
  return has_edges;
}

/// Returns the pixels that may show the volume in which the shadow is tabulated.
PixelRect shadowed_pixels(const ShadowCaster& caster, const Intrinsics& camera,
                          const Eigen::Isometry3d& T_world_camera) {
  const ContactShadow& shadow = *caster.shadow;
  if (shadow.covered.empty()) return {};
  constexpr double kNear_m = 0.05;
  const Eigen::Vector3f low(shadow.x0_m, shadow.y0_m, shadow.bottom_m - shadow.extent_m);
  const Eigen::Vector3f size(static_cast<float>(shadow.columns) * shadow.cell_m,
                             static_cast<float>(shadow.rows) * shadow.cell_m, 1.1F * shadow.extent_m);
  Eigen::AlignedBox3f bounds(low, low + size);
  if (caster.directed_fraction > 0.0F && caster.to_light_world.z() > kLowestLight) {
    const Eigen::Vector2f shift =
        -shadow.height_m / caster.to_light_world.z() * caster.to_light_world.head<2>();
    const Eigen::Vector3f moved(shift.x(), shift.y(), 0.0F);
    bounds.extend(Eigen::AlignedBox3f(low + moved, low + moved + size));
  }
  const Eigen::Isometry3d T_camera_shadow =
      T_world_camera.inverse() * Eigen::Translation3d(origin_world(shadow, caster.T_world_object));
  return pixels_of(bounds.cast<double>(), camera, T_camera_shadow, kNear_m);
}

PixelRect shadowed_pixels(std::span<const ShadowCaster> casters, const Intrinsics& camera,
                          const Eigen::Isometry3d& T_world_camera) {
  PixelRect rect;
  for (const ShadowCaster& caster : casters)
    if (caster.shadow != nullptr) rect = united(rect, shadowed_pixels(caster, camera, T_world_camera));
  return rect;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

/// Depth in a rectangle of an image.
struct DepthCutout {
  const DepthImage& depth_m;  ///< of the rectangle's size
  const PixelRect& rect;
};

/// Multiplies light_left by the fraction of light that the object's shadow leaves, in pixels with depth.
/// @param real        depth of real surfaces
/// @param light_left  of the size of real.depth_m
void darken(const ShadowCaster& caster, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
            const DepthCutout& real, float strength, Image<float>& light_left) {
  const auto& [depth_m, rect] = real;
  const PixelRect shadowed = shadowed_pixels(caster, camera, T_world_camera);
  const float directed_fraction = std::clamp(caster.directed_fraction, 0.0F, 1.0F) * std::min(1.0F, strength);
  // From pixel and depth directly to the shadow's frame, with world axes and its own origin.
  const Eigen::Matrix3f R_world_camera = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f camera_from_object_m =
      (T_world_camera.translation() - origin_world(*caster.shadow, caster.T_world_object)).cast<float>();
  const Eigen::Vector3f step_x = R_world_camera.col(0) / static_cast<float>(camera.fx_px);
  for (int y = shadowed.y; y < shadowed.y + shadowed.height; ++y) {
    const Eigen::Vector3f ray_at_column_0 = R_world_camera * back_project(camera, 0.0, y, 1.0).cast<float>();
    const float* row_m = depth_m.row(y - rect.y) - rect.x;
    float* left = light_left.row(y - rect.y) - rect.x;
    for (int x = shadowed.x; x < shadowed.x + shadowed.width; ++x) {
      if (!(row_m[x] > 0.0F)) continue;
      const Eigen::Vector3f ray = ray_at_column_0 + static_cast<float>(x) * step_x;
      const Eigen::Vector3f p_object_m = camera_from_object_m + row_m[x] * ray;
      const float taken = ambient_occlusion(*caster.shadow, p_object_m);
      const float in_shadow = directed_fraction > 0.0F
                                  ? light_occlusion(*caster.shadow, p_object_m, caster.to_light_world)
                                  : 0.0F;
      if (taken <= 0.0F && in_shadow <= 0.0F) continue;
      // A byte is about the square root of linear light.
      left[x] *= (1.0F - strength * taken) * std::sqrt(1.0F - directed_fraction * in_shadow);
    }
  }
}

void lay_over(const ObjectLayer& layer, const Occlusion& occlusion, ColourImage& picture) {
  const float part_a_sample = 1.0F / static_cast<float>(layer.samples * layer.samples);
  for (int y = 0; y < layer.rect.height; ++y) {
    for (int x = 0; x < layer.rect.width; ++x) {
      float r = 0.0F, g = 0.0F, b = 0.0F, covered = 0.0F;
      for (int j = 0; j < layer.samples; ++j) {
        const std::size_t first = layer.depth_m.index(x * layer.samples, y * layer.samples + j);
        for (std::size_t k = first; k < first + static_cast<std::size_t>(layer.samples); ++k) {
          if (!(layer.depth_m.pixels[k] > 0.0F)) continue;
          const Rgb& colour = layer.colour.pixels[k];
          r += static_cast<float>(colour.r);
          g += static_cast<float>(colour.g);
          b += static_cast<float>(colour.b);
          covered += part_a_sample;
        }
      }
      if (covered == 0.0F) continue;
      const int u = layer.rect.x + x - occlusion.rect.x, v = layer.rect.y + y - occlusion.rect.y;
      const float hidden = occlusion.hidden.at(u, v);
      const Rgb& front = occlusion.front.at(u, v);
      const float object_part = (1.0F - hidden) * part_a_sample;  // per covered sub-pixel
      const float front_part = hidden * covered;
      const float beside_part = 1.0F - covered;
      Rgb& pixel = picture.at(layer.rect.x + x, layer.rect.y + y);
      const auto mixed = [&](float object, std::uint8_t before, std::uint8_t beside) {
        return to_byte(object_part * object + front_part * static_cast<float>(before) +
                       beside_part * static_cast<float>(beside));
      };
      pixel = {mixed(r, front.r, pixel.r), mixed(g, front.g, pixel.g), mixed(b, front.b, pixel.b)};
    }
  }
}

template <typename Pixel>
void require_size(const char* what, const Image<Pixel>& image, int width_px, int height_px) {
  if (image.width == width_px && image.height == height_px) return;
  throw Error(std::string("compose: ") + what + " is " + std::to_string(image.width) + " x " +
              std::to_string(image.height) + " pixels; must be " + std::to_string(width_px) + " x " +
              std::to_string(height_px));
}

}  // namespace

void require_valid(const ComposeConfig& config) {
  require_valid(config.occlusion);
  require_valid(config.light);
  const ConfigCheck require{"compose"};
  const auto is_length = [](float value_m) { return value_m >= 0.0F && value_m <= 1.0F; };
  require(is_length(config.shadow_strength), "shadow_strength", config.shadow_strength, "in 0..1");
}

PixelRect pixels_to_compose(std::span<const ShadowCaster> casters, const Intrinsics& camera,
                            const Eigen::Isometry3d& T_world_camera, const ObjectLayer& layer,
                            const OcclusionConfig& config) {
  const int margin = occlusion_margin_px(config);
  const bool has_objects = layer.rect.width > 0 && layer.rect.height > 0;
  const PixelRect about_objects =
      has_objects ? PixelRect{layer.rect.x - margin, layer.rect.y - margin, layer.rect.width + 2 * margin,
                              layer.rect.height + 2 * margin}
                  : PixelRect{};
  return clamped(united(about_objects, shadowed_pixels(casters, camera, T_world_camera)), camera.width_px,
                 camera.height_px);
}

void cast_shadows(const ColourImage& background, const PosedDepth& real,
                  std::span<const ShadowCaster> casters, const ComposeConfig& config, ColourImage& picture,
                  const MaskImage* is_decided) {
  const DepthImage& real_depth_m = real.depth_m;
  const Intrinsics& camera = real.camera;
  const Eigen::Isometry3d& T_world_camera = real.T_world_camera;
  require_size("the background", background, camera.width_px, camera.height_px);
  require_size("the real depth", real_depth_m, camera.width_px, camera.height_px);
  picture.width = background.width;
  picture.height = background.height;
  picture.pixels = background.pixels;
  const PixelRect rect =
      clamped(shadowed_pixels(casters, camera, T_world_camera), camera.width_px, camera.height_px);
  const auto light_left_of = [&](const DepthImage& depth_m) {
    Image<float> light_left(rect.width, rect.height, 1.0F);
    for (const ShadowCaster& caster : casters)
      if (caster.shadow != nullptr)
        darken(caster, camera, T_world_camera, {depth_m, rect}, config.shadow_strength, light_left);
    return light_left;
  };
  DepthImage rect_depth_m(rect.width, rect.height), aligned_m;
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(real_depth_m.row(rect.y + y) + rect.x, rect.width, rect_depth_m.row(y));
  Image<float> light_left = light_left_of(rect_depth_m);
  if (align_shadow_edges(background, rect, rect_depth_m, config.occlusion.edge_reach_px, light_left,
                         aligned_m)) {
    const Image<float> aligned_light_left = light_left_of(aligned_m);
    for (int y = 0; y < rect.height; ++y) {
      for (int x = 0; x < rect.width; ++x) {
        if (is_decided != nullptr && is_decided->at(rect.x + x, rect.y + y) != 0) continue;
        if (aligned_m.at(x, y) > 0.0F) light_left.at(x, y) = aligned_light_left.at(x, y);
      }
    }
  }
  for (int y = 0; y < rect.height; ++y) {
    const float* left = light_left.row(y);
    Rgb* pixels = picture.row(rect.y + y) + rect.x;
    for (int x = 0; x < rect.width; ++x) {
      if (left[x] == 1.0F) continue;
      pixels[x] = {to_byte(left[x] * static_cast<float>(pixels[x].r)),
                   to_byte(left[x] * static_cast<float>(pixels[x].g)),
                   to_byte(left[x] * static_cast<float>(pixels[x].b))};
    }
  }
}

void lay_objects(const RenderedObjects& objects, const DepthImage& real_depth_m,
                 const OcclusionConfig& config, Occlusion& occlusion, ColourImage& picture,
                 const ColourImage* camera_image) {
  const ObjectLayer& layer = objects.layer;
  require_size("the real depth", real_depth_m, picture.width, picture.height);
  if (layer.rect.width <= 0 || layer.rect.height <= 0) return;
  if (!(clamped(layer.rect, picture.width, picture.height) == layer.rect))
    throw Error("compose: the objects' layer exceeds the picture");
  require_size("the layer's colour", layer.colour, layer.rect.width * layer.samples,
               layer.rect.height * layer.samples);
  require_size("the layer's depth", layer.depth_m, layer.rect.width * layer.samples,
               layer.rect.height * layer.samples);
  if (camera_image != nullptr)
    require_size("the camera's image", *camera_image, picture.width, picture.height);
  find_occlusion(camera_image != nullptr ? *camera_image : picture, picture, real_depth_m, objects, config,
                 occlusion);
  lay_over(layer, occlusion, picture);
}

void shade_depth(const DepthImage& depth_m, const Intrinsics& camera, ColourImage& picture) {
  picture.resize(depth_m.width, depth_m.height, Rgb{24, 26, 30});
  constexpr int kReach_px = 2;  // a wider baseline than adjacent pixels, since quantised depth has steps
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const float z_m = depth_m.at(x, y);
      if (!(z_m > 0.0F)) continue;
      // Slope along an axis, from the sides that belong to the same surface.
      const auto slope = [&](int dx, int dy) {
        float rise_m = 0.0F;
        int span = 0;
        for (const int side : {-kReach_px, kReach_px}) {
          const int xx = x + side * dx, yy = y + side * dy;
          if (!depth_m.contains(xx, yy)) continue;
          const float other_m = depth_m.at(xx, yy);
          if (!(other_m > 0.0F) || std::abs(other_m - z_m) > 0.03F * z_m * kReach_px) continue;
          rise_m += side > 0 ? other_m - z_m : z_m - other_m;
          span += kReach_px;
        }
        return span > 0 ? rise_m / static_cast<float>(span) : 0.0F;
      };
      const Eigen::Vector3f normal(slope(1, 0) * static_cast<float>(camera.fx_px) / z_m,
                                   slope(0, 1) * static_cast<float>(camera.fy_px) / z_m, -1.0F);
      const Eigen::Vector3f ray = back_project(camera, x, y, 1.0).cast<float>();
      const float facing = std::abs(normal.normalized().dot(ray.normalized()));
      const float nearness = 1.0F / (1.0F + 0.04F * z_m * z_m);
      const std::uint8_t grey = to_byte(235.0F * (0.2F + 0.8F * facing) * nearness);
      picture.at(x, y) = {grey, grey, grey};
    }
  }
}

}  // namespace roomradar
