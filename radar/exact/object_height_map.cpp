// object_height_map.cpp: enters boxes and planes from front to back, then builds the max pyramid.
#include "radar/exact/object_height_map.hpp"

#include <algorithm>
#include <bit>

#include "radar/exact/turned_bounds.hpp"
#include "radar/geometry/frame_along.hpp"
#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

constexpr int kLanes = 8;  // pixels processed together

/// Returns the pixel that contains a position, or the nearest pixel.
int to_pixel(float at_px, float last) {
  const float above = at_px > 0.0F ? at_px : 0.0F;
  return static_cast<int>(above < last ? above : last);
}

/// Eight boxes of a node: their first and last pixels, and their greatest heights.
struct PixelBoxes {
  alignas(32) std::array<float, TreeNode::kWidth> top;
  alignas(32) std::array<int, TreeNode::kWidth> x0, x1, y0, y1;
};

/// Maps boxes of a tree to a grid of pixels.
struct PixelPlaces {
  Eigen::Matrix3f R_frame_mesh;
  float x0_m, y0_m, per_m, last_x, last_y, slack_m;

  /// A function of its own, branch-free, so compilers vectorise it.
  [[gnu::noinline]] void of(const TreeNode& node, PixelBoxes& boxes) const {
    LinearOverBoxes x, y, z;
    linear_over_boxes(node, R_frame_mesh.row(0), x);
    linear_over_boxes(node, R_frame_mesh.row(1), y);
    linear_over_boxes(node, R_frame_mesh.row(2), z);
    for (std::size_t i = 0; i < TreeNode::kWidth; ++i) {
      boxes.top[i] = z.value[i] + z.reach[i] + slack_m;
      boxes.x0[i] = to_pixel((x.value[i] - x.reach[i] - slack_m - x0_m) * per_m, last_x);
      boxes.x1[i] = to_pixel((x.value[i] + x.reach[i] + slack_m - x0_m) * per_m, last_x);
      boxes.y0[i] = to_pixel((y.value[i] - y.reach[i] - slack_m - y0_m) * per_m, last_y);
      boxes.y1[i] = to_pixel((y.value[i] + y.reach[i] + slack_m - y0_m) * per_m, last_y);
    }
  }
};

/// Half plane: a x + b y + c <= 0 at the middle of a pixel that a triangle may touch.
struct Line {
  float a, b, c;
};
/// Returns lines along the edges, moved out by `half_px`. Each goes through the corner farthest out,
/// whichever it is, so rounding cannot make a sliver exclude itself.
std::array<Line, 3> outlines_of(const std::array<Eigen::Vector3f, 3>& corners, float half_px) {
  const Eigen::Vector3f e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const float area = e1.x() * e2.y() - e1.y() * e2.x();
  std::array<Line, 3> lines;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f edge = corners[(i + 1) % 3] - corners[i];
    const float a = area >= 0.0F ? edge.y() : -edge.y(), b = area >= 0.0F ? -edge.x() : edge.x();
    float most = a * corners[0].x() + b * corners[0].y();
    for (const Eigen::Vector3f& corner : corners) most = std::max(most, a * corner.x() + b * corner.y());
    lines[i] = {a, b, -most - (std::abs(a) + std::abs(b)) * half_px};
  }
  return lines;
}
float outside_by(const std::array<Line, 3>& lines, float x, float y) {
  return std::max(
      std::max(lines[0].a * x + lines[0].b * y + lines[0].c, lines[1].a * x + lines[1].b * y + lines[1].c),
      lines[2].a * x + lines[2].b * y + lines[2].c);
}

}  // namespace

bool ObjectHeightMap::holds(const TurnedTree& object) const {
  return revision_ == object.tree->revision() && R_frame_mesh_ == object.R_frame_mesh &&
         margin_m_ == object.margin_m;
}

void ObjectHeightMap::turn(const TurnedTree& object) {
  if (holds(object)) return;
  revision_ = object.tree->revision();
  R_frame_mesh_ = object.R_frame_mesh;
  margin_m_ = object.margin_m;
  resolution_px_ = 0;
  constexpr double kTolerance = 5e-3;  // fraction of the size: many vertices are nearly as far out
  bounds_ = turned_bounds(object, kTolerance * object.tree->half_size().cast<double>().sum(), pending_);
}

void ObjectHeightMap::build(const TurnedTree& object, int resolution_px) {
  turn(object);
  if (resolution_px_ == resolution_px) return;
  resolution_px_ = resolution_px;
  const Eigen::Vector3d size_m = bounds_.sizes();
  const PixelGrid grid = fit_pixels(size_m.x(), size_m.y(), resolution_px);
  pixel_m_ = grid.pixel_m;
  const int width = grid.width_px, height = grid.height_px;
  x0_ = static_cast<float>(bounds_.center().x() - 0.5 * width * pixel_m_);
  y0_ = static_cast<float>(bounds_.center().y() - 0.5 * height * pixel_m_);
  per_m_ = static_cast<float>(1.0 / pixel_m_);
  levels_.clear();
  std::size_t count = 0;
  for (int w = width, h = height;; w = (w + 1) / 2, h = (h + 1) / 2) {
    levels_.push_back({w, h, count});
    count += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    if (w == 1 && h == 1) break;
  }
  heights_.assign(count + kLanes, -kInfinity<float>);  // padding for reads past the last pixel

  enter_tree(object);
  build_levels();
}

/// Enters the tree from front to back, as higher boxes hide the rest.
void ObjectHeightMap::enter_tree(const TurnedTree& object) {
  const TriangleTree& tree = *object.tree;
  const PixelPlaces places{object.R_frame_mesh.cast<float>(),
                           x0_,
                           y0_,
                           per_m_,
                           static_cast<float>(levels_[0].width - 1),
                           static_cast<float>(levels_[0].height - 1),
                           kHeightRounding * tree.half_size().sum() +
                               static_cast<float>(object.margin_m) * (1.0F + kHeightRounding)};
  PixelBoxes boxes;
  pending_.clear();
  pending_.push_back({-kInfinity<float>, 0, 0});
  while (!pending_.empty()) {
    const TreeNode& node = tree.nodes()[pending_.back().first];
    pending_.pop_back();
    places.of(node, boxes);
    const std::size_t first_new = pending_.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const int x0 = boxes.x0[i], x1 = boxes.x1[i], y0 = boxes.y0[i], y1 = boxes.y1[i];
      if (x1 - x0 <= 1 && y1 - y0 <= 1) {
        enter_box(x0, x1, y0, y1, boxes.top[i]);
      } else if (is_under(x0, x1, y0, y1, boxes.top[i])) {
        continue;
      } else if (node.count[i] > 0) {
        for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t)
          enter_triangle(object, t);
      } else {
        pending_.push_back({-boxes.top[i], node.first[i], 0});
      }
    }
    put_nearest_last(pending_, first_new);
  }
}

/// Each level is the maximum over two by two pixels of the level below.
void ObjectHeightMap::build_levels() {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const Level& fine = levels_[level - 1];
    const Level& coarse = levels_[level];
    for (int y = 0; y < coarse.height; ++y) {
      const float* above = &heights_[fine.first + static_cast<std::size_t>(2 * y) * fine.width];
      const float* below = 2 * y + 1 < fine.height ? above + fine.width : above;
      float* out = &heights_[coarse.first + static_cast<std::size_t>(y) * coarse.width];
      for (int x = 0; x < coarse.width; ++x) {
        const int left = 2 * x, right = std::min(2 * x + 1, fine.width - 1);
        out[x] = std::max(std::max(above[left], above[right]), std::max(below[left], below[right]));
      }
    }
  }
}

/// Returns true if all pixels of the rectangle are at least this high. Large rectangles are not examined
/// (false).
bool ObjectHeightMap::is_under(int x0, int x1, int y0, int y1, float height) const {
  if (x1 - x0 > 8 || y1 - y0 > 8) return false;
  for (int y = y0; y <= y1; ++y) {
    const float* row = &heights_[static_cast<std::size_t>(y) * levels_[0].width];
    for (int x = x0; x <= x1; ++x) {
      if (row[x] < height) return false;
    }
  }
  return true;
}

void ObjectHeightMap::enter_box(int x0, int x1, int y0, int y1, float height) {
  for (int y = y0; y <= y1; ++y) {
    float* row = &heights_[static_cast<std::size_t>(y) * levels_[0].width];
    for (int x = x0; x <= x1; ++x) row[x] = std::max(row[x], height);
  }
}

void ObjectHeightMap::enter_triangle(const TurnedTree& object, std::uint32_t triangle) {
  const TriangleTree& tree = *object.tree;
  const Eigen::Matrix3f R = object.R_frame_mesh.cast<float>();
  const Eigen::Vector3f centre = tree.centre().cast<float>();
  std::array<Eigen::Vector3f, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = R * (tree.vertices()[tree.triangles()[triangle][i]] - centre);
  const float size_m = tree.half_size().sum();
  const float rounding_m = kHeightRounding * size_m + tree.rounding_m();
  const float slack_m = rounding_m + static_cast<float>(object.margin_m) * (1.0F + kHeightRounding);
  const Eigen::Vector3f low = c[0].cwiseMin(c[1]).cwiseMin(c[2]).array() - slack_m;
  const Eigen::Vector3f high = c[0].cwiseMax(c[1]).cwiseMax(c[2]).array() + slack_m;
  const float top = high.z();
  const auto last_x = static_cast<float>(levels_[0].width - 1);
  const auto last_y = static_cast<float>(levels_[0].height - 1);
  const int px0 = to_pixel((low.x() - x0_) * per_m_, last_x),
            px1 = to_pixel((high.x() - x0_) * per_m_, last_x);
  const int py0 = to_pixel((low.y() - y0_) * per_m_, last_y),
            py1 = to_pixel((high.y() - y0_) * per_m_, last_y);
  if (px1 - px0 <= 1 && py1 - py0 <= 1) return enter_box(px0, px1, py0, py1, top);

  const float half_px = static_cast<float>(0.5 * pixel_m_ * (1.0 + 1e-6)) + slack_m;
  const std::array<Line, 3> lines = outlines_of(c, half_px + kHeightRounding * size_m);
  // The plane, unless it is too steep for float precision.
  const Eigen::Vector3f e1 = c[1] - c[0], e2 = c[2] - c[0];
  const float area = e1.x() * e2.y() - e1.y() * e2.x();
  float gx = 0.0F, gy = 0.0F, plane = top;
  const float size2 = e1.squaredNorm() + e2.squaredNorm();
  if (std::abs(area) > 1e-3F * size2) {
    gx = (e1.z() * e2.y() - e2.z() * e1.y()) / area;
    gy = (e2.z() * e1.x() - e1.z() * e2.x()) / area;
    // Corners off by rounding_m tilt the plane by rounding_m over the triangle's least height, which is area
    // over longest edge. Where the plane is used, over the triangle, it stays within three times that and
    // more.
    const float slope = std::abs(gx) + std::abs(gy);
    const float tilt = 4.0F * rounding_m * std::sqrt(size2) / std::abs(area) * (1.0F + slope);
    plane = c[0].z() - gx * c[0].x() - gy * c[0].y() + slope * half_px + slack_m +
            kHeightRounding * (1.0F + slope) * size_m + tilt * (std::sqrt(size2) + 2.0F * half_px);
  }
  const auto pixel = static_cast<float>(pixel_m_);
  for (int py = py0; py <= py1; ++py) {
    const float y = y0_ + (static_cast<float>(py) + 0.5F) * pixel;
    float* row = &heights_[static_cast<std::size_t>(py) * static_cast<std::size_t>(levels_[0].width)];
    for (int px = px0; px <= px1; ++px) {
      const float x = x0_ + (static_cast<float>(px) + 0.5F) * pixel;
      const float outside = outside_by(lines, x, y);
      const float z = std::min(top, plane + gx * x + gy * y);
      row[px] = outside <= 0.0F ? std::max(row[px], z) : row[px];
    }
  }
}

float ObjectHeightMap::max_under(float x0_m, float x1_m, float y0_m, float y1_m) const {
  const int width = levels_[0].width, height = levels_[0].height;
  // Slightly wider, so both sides of a pixel's border are included despite rounding.
  const float fx0 = (x0_m - x0_) * per_m_ - 1e-3F, fx1 = (x1_m - x0_) * per_m_ + 1e-3F;
  const float fy0 = (y0_m - y0_) * per_m_ - 1e-3F, fy1 = (y1_m - y0_) * per_m_ + 1e-3F;
  if (!(fx1 >= -0.01F && fy1 >= -0.01F && fx0 <= static_cast<float>(width) + 0.01F &&
        fy0 <= static_cast<float>(height) + 0.01F)) {
    return -kInfinity<float>;
  }
  int x0 = static_cast<int>(std::clamp(fx0, 0.0F, static_cast<float>(width - 1)));
  int x1 = static_cast<int>(std::clamp(fx1, 0.0F, static_cast<float>(width - 1)));
  int y0 = static_cast<int>(std::clamp(fy0, 0.0F, static_cast<float>(height - 1)));
  int y1 = static_cast<int>(std::clamp(fy1, 0.0F, static_cast<float>(height - 1)));
  // At most three by three pixels.
  const int level =
      std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(x1 - x0, y1 - y0)))) - 1, 0);
  x0 >>= level, x1 >>= level, y0 >>= level, y1 >>= level;
  const Level& l = levels_[static_cast<std::size_t>(level)];
  float most = -kInfinity<float>;
  for (int y = y0; y <= y1; ++y) {
    const float* row = &heights_[l.first + static_cast<std::size_t>(y) * l.width];
    for (int x = x0; x <= x1; ++x) most = std::max(most, row[x]);
  }
  return most;
}

float ObjectHeightMap::least_gap_under(const FrameTriangle& scene) const {
  std::array<Eigen::Vector3f, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = scene.corners[i].cast<float>();
  const Eigen::Vector3f low = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
  const Eigen::Vector3f high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  const float size_m = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  if (!(size_m < 1e15F)) return -kInfinity<float>;
  const float slack_m = kHeightRounding * size_m;
  const Level& finest = levels_[0];
  const auto last_x = static_cast<float>(finest.width - 1), last_y = static_cast<float>(finest.height - 1);
  // Slightly wider, as in max_under().
  const float fx0 = (low.x() - slack_m - x0_) * per_m_ - 1e-3F,
              fx1 = (high.x() + slack_m - x0_) * per_m_ + 1e-3F;
  const float fy0 = (low.y() - slack_m - y0_) * per_m_ - 1e-3F,
              fy1 = (high.y() + slack_m - y0_) * per_m_ + 1e-3F;
  if (!(fx1 >= -0.01F && fy1 >= -0.01F && fx0 <= last_x + 1.01F && fy0 <= last_y + 1.01F))
    return kInfinity<float>;
  int px0 = to_pixel(fx0, last_x), px1 = to_pixel(fx1, last_x);
  int py0 = to_pixel(fy0, last_y), py1 = to_pixel(fy1, last_y);
  constexpr unsigned kMostSide = 2 * kLanes - 1;
  const auto side = static_cast<unsigned>(std::max(px1 - px0, py1 - py0));
  const int level = static_cast<int>(std::bit_width(side / (kMostSide + 1)));
  px0 >>= level, px1 >>= level, py0 >>= level, py1 >>= level;
  const Level& l = levels_[static_cast<std::size_t>(level)];
  const auto pixel = static_cast<float>(pixel_m_) * static_cast<float>(1 << level);
  const float half_px = 0.5F * pixel * (1.0F + 1e-3F) + slack_m;

  // The plane's height at the middle of a pixel, minus its greatest drop towards the pixel's corners.
  float gx = 0.0F, gy = 0.0F, at0 = low.z() - slack_m;
  const Eigen::Vector3f n = scene.normal.cast<float>();
  if (std::abs(n.z()) > 1e-2F) {
    gx = -n.x() / n.z();
    gy = -n.y() / n.z();
    const float slope = std::abs(gx) + std::abs(gy);
    at0 = c[0].z() - gx * c[0].x() - gy * c[0].y() - slope * half_px -
          kHeightRounding * (1.0F + slope) * (size_m + pixel);
  }
  const auto lines = outlines_of(c, half_px + kHeightRounding * size_m);
  const float low_z = low.z() - slack_m, x_of_0 = x0_ + 0.5F * pixel;
  alignas(32) std::array<float, kLanes> least;
  least.fill(kInfinity<float>);
  for (int py = py0; py <= py1; ++py) {
    const float y = y0_ + (static_cast<float>(py) + 0.5F) * pixel;
    const float* row = &heights_[l.first + static_cast<std::size_t>(py) * static_cast<std::size_t>(l.width)];
    for (int px = px0; px <= px1; px += kLanes) {
      // Branch-free, so compilers vectorise all eight; pixels past px1 count as outside.
      for (int i = 0; i < kLanes; ++i) {
        const float x = x_of_0 + static_cast<float>(px + i) * pixel;
        const float gap = std::max(low_z, at0 + gx * x + gy * y) - row[px + i];
        const float outside = std::max(outside_by(lines, x, y), static_cast<float>(px + i - px1));
        const float inside_gap = outside > 0.0F ? kInfinity<float> : gap;
        least[static_cast<std::size_t>(i)] = std::min(least[static_cast<std::size_t>(i)], inside_gap);
      }
    }
  }
  return *std::min_element(least.begin(), least.end());
}

}  // namespace roomradar
