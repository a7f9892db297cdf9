// front_map.cpp: enter boxes and planes from the front to the back, then the greatest of four and four.
#include "radar/front_map.hpp"

#include <bit>

namespace roomradar {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();

/// Greatest value of g . p over the tree's vertices in use.
double support(const TriangleTree& tree, const Eigen::Vector3d& g, std::vector<PendingNode>& pending) {
  const Eigen::Vector3f direction = g.cast<float>();
  const float slack_m = kRounding * tree.half_size().sum();
  double best = -std::numeric_limits<double>::infinity();
  pending.clear();
  pending.push_back({-kInfinity, 0, 0});  // low_m: minus the greatest value that can be below
  while (!pending.empty()) {
    const PendingNode next = pending.back();
    pending.pop_back();
    if (!(-next.low_m > best)) continue;
    if (next.count > 0) {
      for (std::uint32_t t = next.first; t < next.first + next.count; ++t) {
        for (const std::uint32_t v : tree.triangles()[t]) {
          best = std::max(best, g.dot(tree.vertices()[v].cast<double>() - tree.centre()));
        }
      }
      continue;
    }
    const TreeNode& node = tree.nodes()[next.first];
    LinearOverBoxes f;
    linear_over_boxes(node, direction, f);
    const std::size_t first_new = pending.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      pending.push_back({-(f.value[i] + f.reach[i] + slack_m), node.first[i], node.count[i]});
    }
    for (std::size_t i = first_new + 1; i < pending.size(); ++i) {
      for (std::size_t j = i; j > first_new && pending[j].low_m > pending[j - 1].low_m; --j) {
        std::swap(pending[j], pending[j - 1]);
      }
    }
  }
  return best;
}

}  // namespace

Eigen::AlignedBox3d turned_bounds(const TurnedTree& object, std::vector<PendingNode>& pending) {
  const double slack_m = 1e-15 * object.tree->half_size().cast<double>().sum() + object.margin_m;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d g = object.R_frame_mesh.row(axis);
    high[axis] = support(*object.tree, g, pending) + slack_m;
    low[axis] = -support(*object.tree, -g, pending) - slack_m;
  }
  return {low, high};
}

bool FrontMap::build(const TurnedTree& object, int resolution_px) {
  if (revision_ == object.tree->revision() && R_frame_mesh_ == object.R_frame_mesh &&
      margin_m_ == object.margin_m && resolution_px_ == resolution_px) {
    return false;
  }
  revision_ = object.tree->revision();
  R_frame_mesh_ = object.R_frame_mesh;
  margin_m_ = object.margin_m;
  resolution_px_ = resolution_px;

  bounds_ = turned_bounds(object, pending_);
  const Eigen::Vector3d size_m = bounds_.sizes();
  constexpr double kLeastSide_m = 1e-6;  // an object seen edge-on still gets pixels
  pixel_m_ = std::max({size_m.x(), size_m.y(), kLeastSide_m}) / resolution_px;
  const auto pixels = [&](double side_m) {
    return std::clamp(static_cast<int>(std::ceil(side_m / pixel_m_ - 1e-9)), 1, resolution_px);
  };
  const int width = pixels(size_m.x()), height = pixels(size_m.y());
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
  heights_.assign(count, -kInfinity);

  const TriangleTree& tree = *object.tree;
  const Eigen::Matrix3f R = object.R_frame_mesh.cast<float>();
  const Eigen::Vector3f x_axis = R.row(0), y_axis = R.row(1), z_axis = R.row(2);
  const float slack_m =
      kRounding * tree.half_size().sum() + static_cast<float>(object.margin_m) * (1.0F + kRounding);
  pending_.clear();
  pending_.push_back({-kInfinity, 0, 0});
  while (!pending_.empty()) {
    const PendingNode next = pending_.back();
    pending_.pop_back();
    const TreeNode& node = tree.nodes()[next.first];
    LinearOverBoxes x, y, z;
    linear_over_boxes(node, x_axis, x);
    linear_over_boxes(node, y_axis, y);
    linear_over_boxes(node, z_axis, z);
    // The highest first: what it covers hides the rest.
    std::array<std::uint32_t, TreeNode::kWidth> order;
    std::array<float, TreeNode::kWidth> top;
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      top[i] = z.value[i] + z.reach[i] + slack_m;
      std::uint32_t j = i;
      for (; j > 0 && top[order[j - 1]] < top[i]; --j) order[j] = order[j - 1];
      order[j] = i;
    }
    const std::size_t first_new = pending_.size();
    for (std::uint32_t k = 0; k < node.child_count; ++k) {
      const std::uint32_t i = order[k];
      const float half_x = x.reach[i] + slack_m, half_y = y.reach[i] + slack_m;
      const int px0 =
          std::clamp(static_cast<int>((x.value[i] - half_x - x0_) * per_m_ - kRounding), 0, width - 1);
      const int px1 =
          std::clamp(static_cast<int>((x.value[i] + half_x - x0_) * per_m_ + kRounding), 0, width - 1);
      const int py0 =
          std::clamp(static_cast<int>((y.value[i] - half_y - y0_) * per_m_ - kRounding), 0, height - 1);
      const int py1 =
          std::clamp(static_cast<int>((y.value[i] + half_y - y0_) * per_m_ + kRounding), 0, height - 1);
      if (is_under(px0, px1, py0, py1, top[i])) continue;
      const bool is_small = px1 - px0 <= 1 && py1 - py0 <= 1;
      if (is_small) {
        enter_box(px0, px1, py0, py1, top[i]);
      } else if (node.count[i] > 0) {
        for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t)
          enter_triangle(object, t);
      } else {
        pending_.push_back({0.0F, node.first[i], 0});
      }
    }
    std::reverse(pending_.begin() + static_cast<std::ptrdiff_t>(first_new), pending_.end());
  }

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
  return true;
}

/// Large rectangles are not looked through.
bool FrontMap::is_under(int x0, int x1, int y0, int y1, float height) const {
  if (x1 - x0 > 8 || y1 - y0 > 8) return false;
  for (int y = y0; y <= y1; ++y) {
    const float* row = &heights_[static_cast<std::size_t>(y) * levels_[0].width];
    for (int x = x0; x <= x1; ++x) {
      if (row[x] < height) return false;
    }
  }
  return true;
}

void FrontMap::enter_box(int x0, int x1, int y0, int y1, float height) {
  for (int y = y0; y <= y1; ++y) {
    float* row = &heights_[static_cast<std::size_t>(y) * levels_[0].width];
    for (int x = x0; x <= x1; ++x) row[x] = std::max(row[x], height);
  }
}

void FrontMap::enter_triangle(const TurnedTree& object, std::uint32_t triangle) {
  const FrameTriangle t = turned_triangle(object, triangle);
  const auto& c = t.corners;
  const float size_m = object.tree->half_size().sum();
  const auto margin_m = static_cast<float>(object.margin_m) * (1.0F + kRounding);
  const float slack_m = kRounding * size_m + margin_m;
  const auto low = [&](int axis) {
    return static_cast<float>(std::min({c[0][axis], c[1][axis], c[2][axis]})) - slack_m;
  };
  const auto high = [&](int axis) {
    return static_cast<float>(std::max({c[0][axis], c[1][axis], c[2][axis]})) + slack_m;
  };
  const int width = levels_[0].width, height = levels_[0].height;
  const int px0 = std::clamp(static_cast<int>((low(0) - x0_) * per_m_ - kRounding), 0, width - 1);
  const int px1 = std::clamp(static_cast<int>((high(0) - x0_) * per_m_ + kRounding), 0, width - 1);
  const int py0 = std::clamp(static_cast<int>((low(1) - y0_) * per_m_ - kRounding), 0, height - 1);
  const int py1 = std::clamp(static_cast<int>((high(1) - y0_) * per_m_ + kRounding), 0, height - 1);
  const float top = high(2);

  // A strip a side: outward distance from the edge, at most `reach` within a pixel that is touched; for a
  // triangle edge-on both sides of its edges count, which the same strips say with both signs.
  const double area =
      (c[1].x() - c[0].x()) * (c[2].y() - c[0].y()) - (c[1].y() - c[0].y()) * (c[2].x() - c[0].x());
  const auto half_px = static_cast<float>(0.5 * pixel_m_ * (1.0 + 1e-6)) + slack_m;
  struct Line {
    float a = 0.0F, b = 0.0F, c = 0.0F;  // a x + b y + c <= 0 for pixels that may be touched
  };
  std::array<Line, 3> lines;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d edge = (c[(i + 1) % 3] - c[i]).head<2>();
    const double length = edge.norm();
    if (!(length > 1e-9 * size_m)) continue;
    const Eigen::Vector2d outward = Eigen::Vector2d(edge.y(), -edge.x()) / (area >= 0.0 ? length : -length);
    // The greatest of all three corners, so that a sliver's rounding cannot shut itself out.
    double most = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& corner : c) most = std::max(most, outward.dot(corner.head<2>()));
    lines[i] = {static_cast<float>(outward.x()), static_cast<float>(outward.y()),
                static_cast<float>(-most - (std::abs(outward.x()) + std::abs(outward.y())) * half_px) -
                    kRounding * size_m};
  }
  float gx = 0.0F, gy = 0.0F, plane = top;
  if (std::abs(t.normal.z()) > 1e-3) {
    const double dx = -t.normal.x() / t.normal.z(), dy = -t.normal.y() / t.normal.z();
    gx = static_cast<float>(dx);
    gy = static_cast<float>(dy);
    const float slope = std::abs(gx) + std::abs(gy);
    plane = static_cast<float>(t.normal.dot(c[0]) / t.normal.z()) + slope * half_px + slack_m +
            kRounding * (1.0F + slope) * size_m;
  }
  const auto pixel = static_cast<float>(pixel_m_);
  for (int py = py0; py <= py1; ++py) {
    const float y = y0_ + (static_cast<float>(py) + 0.5F) * pixel;
    float* row = &heights_[static_cast<std::size_t>(py) * width];
    for (int px = px0; px <= px1; ++px) {
      const float x = x0_ + (static_cast<float>(px) + 0.5F) * pixel;
      const float outside = std::max(std::max(lines[0].a * x + lines[0].b * y + lines[0].c,
                                              lines[1].a * x + lines[1].b * y + lines[1].c),
                                     lines[2].a * x + lines[2].b * y + lines[2].c);
      const float z = std::min(top, plane + gx * x + gy * y);
      row[px] = outside <= 0.0F ? std::max(row[px], z) : row[px];
    }
  }
}

float FrontMap::max_under(float x0_m, float x1_m, float y0_m, float y1_m) const {
  const int width = levels_[0].width, height = levels_[0].height;
  // A hair wider: what a pixel's border is, both must agree on.
  const float fx0 = (x0_m - x0_) * per_m_ - 1e-3F, fx1 = (x1_m - x0_) * per_m_ + 1e-3F;
  const float fy0 = (y0_m - y0_) * per_m_ - 1e-3F, fy1 = (y1_m - y0_) * per_m_ + 1e-3F;
  if (!(fx1 >= -0.01F && fy1 >= -0.01F && fx0 <= static_cast<float>(width) + 0.01F &&
        fy0 <= static_cast<float>(height) + 0.01F)) {
    return -kInfinity;
  }
  int x0 = static_cast<int>(std::clamp(fx0, 0.0F, static_cast<float>(width - 1)));
  int x1 = static_cast<int>(std::clamp(fx1, 0.0F, static_cast<float>(width - 1)));
  int y0 = static_cast<int>(std::clamp(fy0, 0.0F, static_cast<float>(height - 1)));
  int y1 = static_cast<int>(std::clamp(fy1, 0.0F, static_cast<float>(height - 1)));
  // At most three by three.
  const int level =
      std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(x1 - x0, y1 - y0)))) - 1, 0);
  x0 >>= level, x1 >>= level, y0 >>= level, y1 >>= level;
  const Level& l = levels_[static_cast<std::size_t>(level)];
  float most = -kInfinity;
  for (int y = y0; y <= y1; ++y) {
    const float* row = &heights_[l.first + static_cast<std::size_t>(y) * l.width];
    for (int x = x0; x <= x1; ++x) most = std::max(most, row[x]);
  }
  return most;
}

}  // namespace roomradar
