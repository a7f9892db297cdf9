// occlusion.cpp: finds occluders by depth, and their edges by colour.
#include "app/render/occlusion.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/render/edge_rules.hpp"
#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void find_contacts(const Feet& feet, const PixelRect& rect, const DepthImage& real_depth_m,
                   const Image<float>& object_m, const DepthTolerance& tolerance, MaskImage& contact) {
  constexpr float kUneven_m = 0.006F;
  contact.resize(rect.width, rect.height);
  for (const Feet::Plane& plane : feet.planes) {
    for (int y = 0; y < rect.height; ++y) {
      for (int x = 0; x < rect.width; ++x) {
        const float z_m = object_m.at(x, y), real_m = real_depth_m.at(rect.x + x, rect.y + y);
        if (!(z_m > 0.0F && real_m > 0.0F) || contact.at(x, y) == kOnSupport) continue;
        const float rise = plane.up_camera.dot(
            back_project(feet.camera, rect.x + x, rect.y + y, 1.0).cast<float>());  // per metre of depth
        const float level_m = tolerance.constant_m + kUneven_m + tolerance.per_m2 * z_m * z_m;
        if (std::abs(plane.camera_m + rise * z_m) < feet.height_m)
          contact.at(x, y) = std::abs(plane.camera_m + rise * real_m) < level_m ? kOnSupport : kAtFoot;
      }
    }
  }
}

void soften(const Image<float>& hidden, const MaskImage& covered, const MaskImage& contact,
            Image<float>& softened) {
  softened.resize(hidden.width, hidden.height);
  for (int y = 0; y < hidden.height; ++y) {
    for (int x = 0; x < hidden.width; ++x) {
      const float own = hidden.at(x, y);
      const auto at = [&](int u, int v) {
        return covered.contains(u, v) && covered.at(u, v) != 0 ? hidden.at(u, v) : own;
      };
      float sum = 4.0F * at(x, y);
      sum += 2.0F * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1));
      sum += at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
      const std::uint8_t kind = contact.at(x, y);
      const bool is_shown = kind == kOnSupport || (kind == kAtFoot && own < 0.5F);
      softened.at(x, y) = is_shown ? 0.0F : sum / 16.0F;
    }
  }
}

namespace {

constexpr int kTapStep_px = 3;     // spacing of colour samples
constexpr int kPastBand_taps = 3;  // samples beyond the band

int taps_each_way(int reach_px) { return (reach_px + kTapStep_px - 1) / kTapStep_px + kPastBand_taps; }

/// Computes the objects' depth and coverage at the pixels of `rect`. Pixels that no object covers get the
/// depth of a covered pixel nearby.
void spread_object_depth(const ObjectLayer& layer, const PixelRect& rect, Image<float>& object_m,
                         MaskImage& covered_mask) {
  object_m.resize(rect.width, rect.height);
  covered_mask.resize(rect.width, rect.height);
  for (int y = 0; y < layer.rect.height; ++y) {
    float* row = object_m.row(y + layer.rect.y - rect.y) + (layer.rect.x - rect.x);
    for (int x = 0; x < layer.rect.width; ++x) {
      float sum_m = 0.0F, covered = 0.0F;
      for (int j = 0; j < layer.samples; ++j) {
        const float* depth_m = layer.depth_m.row(y * layer.samples + j) + x * layer.samples;
        for (int i = 0; i < layer.samples; ++i) {
          sum_m += depth_m[i];
          covered += depth_m[i] > 0.0F ? 1.0F : 0.0F;
        }
      }
      row[x] = covered > 0.0F ? sum_m / covered : 0.0F;
    }
  }
  std::transform(object_m.pixels.begin(), object_m.pixels.end(), covered_mask.pixels.begin(),
                 [](float z_m) { return static_cast<std::uint8_t>(z_m > 0.0F ? 255 : 0); });
  int filled_rows = 0;
  for (int y = 0; y < rect.height; ++y) {
    float* row = object_m.row(y);
    const float* first = std::find_if(row, row + rect.width, [](float z_m) { return z_m > 0.0F; });
    if (first == row + rect.width) {
      if (filled_rows > 0) std::copy_n(object_m.row(y - 1), rect.width, row);
      continue;
    }
    float last_m = *first;
    for (int x = 0; x < rect.width; ++x) {
      if (row[x] > 0.0F) last_m = row[x];
      row[x] = last_m;
    }
    if (filled_rows++ == 0)
      for (int above = 0; above < y; ++above) std::copy_n(row, rect.width, object_m.row(above));
  }
}

/// Sums the (2 reach + 1)^2 pixels around each pixel, clipped to the image.
void sum_about(const Image<std::uint8_t>& image, int reach, std::vector<int>& column_sums, Image<int>& sums) {
  sums.resize(image.width, image.height);
  column_sums.assign(static_cast<std::size_t>(image.width), 0);
  const auto add_row = [&](int y, int sign) {
    if (y < 0 || y >= image.height) return;
    const std::uint8_t* row = image.row(y);
    for (int x = 0; x < image.width; ++x) column_sums[static_cast<std::size_t>(x)] += sign * row[x];
  };
  const auto column = [&](int x) {
    return x >= 0 && x < image.width ? column_sums[static_cast<std::size_t>(x)] : 0;
  };
  for (int y = 0; y < reach; ++y) add_row(y, 1);
  for (int y = 0; y < image.height; ++y) {
    add_row(y + reach, 1);
    add_row(y - reach - 1, -1);
    int sum = 0;
    for (int x = 0; x < reach; ++x) sum += column(x);
    int* out = sums.row(y);
    for (int x = 0; x < image.width; ++x) {
      sum += column(x + reach) - column(x - reach - 1);
      out[x] = sum;
    }
  }
}

/// Returns true if one of two adjacent pixels shows an occluding surface, the other does not, and there is a
/// depth jump between them.
bool is_edge(float a_m, float b_m, std::uint8_t hidden_a, std::uint8_t hidden_b) {
  return std::abs(int{hidden_a} - int{hidden_b}) >= 128 && is_depth_jump(a_m, b_m);
}

/// Colours on one side of an edge: an isotropic Gaussian.
struct SideColours {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float squares = 0.0F;
  float count = 0.0F;

  void add(const Eigen::Vector3f& colour) {
    sum += colour;
    squares += colour.squaredNorm();
    count += 1.0F;
  }
  [[nodiscard]] Eigen::Vector3f mean() const { return sum / count; }
  [[nodiscard]] float variance() const {  // per channel
    constexpr float kCameraNoise2 = 64.0F;
    return std::max(0.0F, squares / count - mean().squaredNorm()) / 3.0F + kCameraNoise2;
  }
};

Eigen::Vector3f as_vector(const Rgb& colour) {
  return {static_cast<float>(colour.r), static_cast<float>(colour.g), static_cast<float>(colour.b)};
}

Rgb as_rgb(const Eigen::Vector3f& colour) {
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
  };
  return {byte(colour.x()), byte(colour.y()), byte(colour.z())};
}

bool look_alike(const SideColours& front, const SideColours& behind) {
  return (front.mean() - behind.mean()).squaredNorm() < front.variance() + behind.variance();
}

/// Returns the log likelihood ratio of a colour, occluder against background.
float said_by(const Eigen::Vector3f& colour, const SideColours& front, const SideColours& behind) {
  constexpr float kMostSaid = 2.5F;  // limited, since surfaces have more than one colour
  const float front_variance = front.variance(), behind_variance = behind.variance();
  const float said = 0.5F * ((colour - behind.mean()).squaredNorm() / behind_variance -
                             (colour - front.mean()).squaredNorm() / front_variance) +
                     1.5F * std::log(behind_variance / front_variance);
  return std::clamp(said, -kMostSaid, kMostSaid);
}

void hide_by_depth(const DepthImage& real_depth_m, const OcclusionConfig& config, Occlusion& occlusion) {
  const PixelRect& rect = occlusion.rect;
  occlusion.by_depth.resize(rect.width, rect.height);
  for (int y = 0; y < rect.height; ++y) {
    const float* real_m = real_depth_m.row(rect.y + y) + rect.x;
    const float* object_m = occlusion.object_m.row(y);
    std::uint8_t* hidden = occlusion.by_depth.row(y);
    for (int x = 0; x < rect.width; ++x) {
      const float tolerance_m = config.tolerance_m + config.tolerance_per_m2 * object_m[x] * object_m[x];
      const float past_m = real_m[x] > 0.0F ? object_m[x] - real_m[x] - tolerance_m : 0.0F;
      hidden[x] =
          static_cast<std::uint8_t>(255.0F * std::clamp(past_m / config.softness_m, 0.0F, 1.0F) + 0.5F);
    }
  }
}

bool find_edges(const DepthImage& real_depth_m, Occlusion& occlusion) {
  const PixelRect& rect = occlusion.rect;
  bool found = false;
  occlusion.edges.resize(rect.width, rect.height);
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (!occlusion.edges.contains(x + dx, y + dy)) continue;
        if (!is_edge(real_depth_m.at(rect.x + x, rect.y + y),
                     real_depth_m.at(rect.x + x + dx, rect.y + y + dy), occlusion.by_depth.at(x, y),
                     occlusion.by_depth.at(x + dx, y + dy)))
          continue;
        occlusion.edges.at(x, y) = occlusion.edges.at(x + dx, y + dy) = 1;
        found = true;
      }
    }
  }
  return found;
}

/// Colours of the two sides of an edge.
struct EdgeColours {
  SideColours front, behind;
};

/// Collects the colours of both sides around a pixel of the rectangle, from pixels away from edges.
EdgeColours look_about(const ColourImage& camera_image, const Occlusion& occlusion, int x, int y, int taps) {
  EdgeColours sides;
  for (int v = y - taps * kTapStep_px; v <= y + taps * kTapStep_px; v += kTapStep_px) {
    for (int u = x - taps * kTapStep_px; u <= x + taps * kTapStep_px; u += kTapStep_px) {
      if (!occlusion.by_depth.contains(u, v) || occlusion.near_edges.at(u, v) != 0) continue;
      const std::uint8_t hidden = occlusion.by_depth.at(u, v);
      if (hidden != 0 && hidden != 255) continue;
      (hidden == 255 ? sides.front : sides.behind)
          .add(as_vector(camera_image.at(occlusion.rect.x + u, occlusion.rect.y + v)));
    }
  }
  return sides;
}

/// Lists the pixels near edges, with each pixel's own odds from depth and colour.
void judge_alone(const ColourImage& camera_image, int reach_px, Occlusion& occlusion) {
  constexpr int kCell_px = 4;  // pixels of a cell share the sides' colours
  constexpr float kDepthWeight = 1.5F;
  constexpr float kFewest = 4.0F;  // min samples to estimate a side's colours
  const PixelRect& rect = occlusion.rect;
  sum_about(occlusion.edges, reach_px, occlusion.column_sums, occlusion.near_edges);
  sum_about(occlusion.by_depth, reach_px, occlusion.column_sums, occlusion.near_hidden);
  const int taps = taps_each_way(reach_px);
  occlusion.band.clear();
  for (int cell_y = 0; cell_y < rect.height; cell_y += kCell_px) {
    for (int cell_x = 0; cell_x < rect.width; cell_x += kCell_px) {
      EdgeColours sides;
      bool has_looked = false;
      for (int y = cell_y; y < std::min(cell_y + kCell_px, rect.height); ++y) {
        for (int x = cell_x; x < std::min(cell_x + kCell_px, rect.width); ++x) {
          if (occlusion.near_edges.at(x, y) == 0) continue;
          if (!has_looked)
            sides = look_about(camera_image, occlusion, cell_x + kCell_px / 2, cell_y + kCell_px / 2, taps);
          has_looked = true;
          const auto& [front, behind] = sides;
          if (front.count < kFewest || behind.count < kFewest || look_alike(front, behind)) continue;
          const int neighbours = (std::min(x + reach_px, rect.width - 1) - std::max(x - reach_px, 0) + 1) *
                                 (std::min(y + reach_px, rect.height - 1) - std::max(y - reach_px, 0) + 1);
          const float near_hidden = std::clamp(
              static_cast<float>(occlusion.near_hidden.at(x, y)) / (255.0F * static_cast<float>(neighbours)),
              0.02F, 0.98F);
          const Eigen::Vector3f colour = as_vector(camera_image.at(rect.x + x, rect.y + y));
          occlusion.band.push_back(
              {x, y,
               kDepthWeight * std::log(near_hidden / (1.0F - near_hidden)) + said_by(colour, front, behind),
               as_rgb(front.mean())});
        }
      }
    }
  }
}

/// Assigns adjacent pixels of similar colour to the same side: some rounds of mean field on a Potts model.
void agree_with_neighbours(const ColourImage& camera_image, Occlusion& occlusion) {
  constexpr int kRounds = 4;
  constexpr float kPull = 1.5F;  // weight of a neighbour of identical colour
  const PixelRect& rect = occlusion.rect;
  Image<float>& hidden = occlusion.unsoftened;
  const auto colour_at = [&](int x, int y) { return camera_image.at(rect.x + x, rect.y + y); };
  for (const Occlusion::EdgePixel& pixel : occlusion.band)
    hidden.at(pixel.x, pixel.y) = 1.0F / (1.0F + std::exp(-pixel.odds));
  for (int round = 0; round < kRounds; ++round) {
    for (const Occlusion::EdgePixel& pixel : occlusion.band) {
      const Rgb colour = colour_at(pixel.x, pixel.y);
      float odds = pixel.odds;
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}}) {
        const int x = pixel.x + dx, y = pixel.y + dy;
        if (!hidden.contains(x, y)) continue;
        const float alike = std::exp(-squared_distance(colour_at(x, y), colour) / kAlike2);
        odds += kPull * (0.3F + alike) * (2.0F * hidden.at(x, y) - 1.0F);
      }
      hidden.at(pixel.x, pixel.y) = 1.0F / (1.0F + std::exp(-odds));
    }
  }
  for (const Occlusion::EdgePixel& pixel : occlusion.band) {
    const float part = hidden.at(pixel.x, pixel.y);
    Rgb& front = occlusion.front.at(pixel.x, pixel.y);
    front = as_rgb(part * as_vector(front) + (1.0F - part) * as_vector(pixel.front));
  }
}

}  // namespace

void require_valid(const OcclusionConfig& config) {
  const ConfigCheck require{"occlusion"};
  const auto is_length = [](float value_m) { return value_m >= 0.0F && value_m <= 1.0F; };
  require(is_length(config.tolerance_m), "tolerance_m", config.tolerance_m, "in 0..1");
  require(is_length(config.tolerance_per_m2), "tolerance_per_m2", config.tolerance_per_m2, "in 0..1");
  require(config.softness_m > 0.0F && config.softness_m <= 1.0F, "softness_m", config.softness_m,
          "in 0..1, not 0");
  require(config.edge_reach_px >= 0 && config.edge_reach_px <= 32, "edge_reach_px",
          static_cast<float>(config.edge_reach_px), "in 0..32");
}

int occlusion_margin_px(const OcclusionConfig& config) {
  return config.edge_reach_px > 0 ? taps_each_way(config.edge_reach_px) * kTapStep_px + 1 : 1;
}

void find_occlusion(const ColourImage& camera_image, const ColourImage& background,
                    const DepthImage& real_depth_m, const RenderedObjects& objects,
                    const OcclusionConfig& config, Occlusion& occlusion) {
  const ObjectLayer& layer = objects.layer;
  const int margin = occlusion_margin_px(config);
  const PixelRect rect = clamped({layer.rect.x - margin, layer.rect.y - margin, layer.rect.width + 2 * margin,
                                  layer.rect.height + 2 * margin},
                                 background.width, background.height);
  occlusion.rect = rect;
  spread_object_depth(layer, rect, occlusion.object_m, occlusion.covered);

  hide_by_depth(real_depth_m, config, occlusion);
  find_contacts(objects.feet, rect, real_depth_m, occlusion.object_m,
                {config.tolerance_m, config.tolerance_per_m2}, occlusion.contact);
  for (std::size_t i = 0; i < occlusion.contact.pixels.size(); ++i)
    if (occlusion.contact.pixels[i] == kOnSupport) occlusion.by_depth.pixels[i] = 0;
  occlusion.front.resize(rect.width, rect.height);
  occlusion.unsoftened.resize(rect.width, rect.height);
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(background.row(rect.y + y) + rect.x, rect.width, occlusion.front.row(y));
  std::transform(occlusion.by_depth.pixels.begin(), occlusion.by_depth.pixels.end(),
                 occlusion.unsoftened.pixels.begin(),
                 [](std::uint8_t hidden) { return static_cast<float>(hidden) / 255.0F; });
  if (config.edge_reach_px > 0 && find_edges(real_depth_m, occlusion)) {
    judge_alone(camera_image, config.edge_reach_px, occlusion);
    agree_with_neighbours(camera_image, occlusion);
  }
  soften(occlusion.unsoftened, occlusion.covered, occlusion.contact, occlusion.hidden);
}

}  // namespace roomradar
