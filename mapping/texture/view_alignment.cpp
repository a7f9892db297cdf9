// view_alignment.cpp: photometric Gauss-Newton steps on pyramids of grey pictures.
#include "mapping/texture/view_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kAlignedPoints = 60'000;
constexpr std::array<int, 3> kFactors = {8, 4, 2};  // the pictures are reduced by
constexpr int kStepsPerFactor = 8;
constexpr float kHuber = 12.0F;  // of 255: differences beyond count less
// Prior: standard deviation of a correction, and of the differences of brightness.
constexpr double kPrior_m = 0.01, kPrior_rad = 0.01, kBrightnessSigma = 8.0;

// A sixteenth of the noise of an averaged pixel; gains of up to 8 fit 16 bits.
constexpr float kUnitsPerLevel = 32.0F;

/// Grey picture, evened by the view's gain, reduced by averaging.
struct GreyPicture {
  Image<std::uint16_t> grey;  // brightness (0..255) times kUnitsPerLevel
  float scale = 1.0F;         // from coordinates of the full picture
};

GreyPicture grey_of(const TextureView& view, int factor) {
  GreyPicture picture;
  picture.scale = 1.0F / static_cast<float>(factor);
  picture.grey.resize(view.colour.luma.width / factor, view.colour.luma.height / factor);
  const Eigen::Array3f gain(view.gain[0], view.gain[1], view.gain[2]);
  for (int y = 0; y < picture.grey.height; ++y)
    for (int x = 0; x < picture.grey.width; ++x)
      picture.grey.at(x, y) = static_cast<std::uint16_t>(std::lround(std::clamp(
          kUnitsPerLevel * (gain * mean_colour(view.colour, x * factor, y * factor, factor)).mean(), 0.0F,
          65535.0F)));
  return picture;
}

/// Brightness and its gradient per pixel of the full picture, at a pixel of the full picture.
struct Grey {
  bool is_inside = false;
  float value = 0.0F;
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();
};

Grey grey_at(const GreyPicture& picture, const Eigen::Vector2f& pixel) {
  const float x = (pixel.x() + 0.5F) * picture.scale - 0.5F, y = (pixel.y() + 0.5F) * picture.scale - 0.5F;
  const Image<std::uint16_t>& grey = picture.grey;
  if (!(x >= 1.0F && y >= 1.0F && x < static_cast<float>(grey.width - 2) &&
        y < static_cast<float>(grey.height - 2)))
    return {};
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
  const auto level = [&grey](int column, int row) {
    return static_cast<float>(grey.at(column, row)) / kUnitsPerLevel;
  };
  const float a = level(left, top), b = level(left + 1, top), c = level(left, top + 1),
              d = level(left + 1, top + 1);
  return {true,
          (1.0F - v) * ((1.0F - u) * a + u * b) + v * ((1.0F - u) * c + u * d),
          {picture.scale * ((1.0F - v) * (b - a) + v * (d - c)),
           picture.scale * ((1.0F - u) * (c - a) + u * (d - b))}};
}

constexpr float kOutside = -1.0F;

/// A view while it is aligned.
struct Aligned {
  TextureView* view = nullptr;
  Eigen::Isometry3f T_first;           // the view's first pose
  std::vector<std::uint32_t> visible;  // indices of points
  std::vector<float> values;           // brightness of visible, from the present pose; kOutside: none
  GreyPicture picture;
};

Aligned begin(std::span<const MeshPoint> points, TextureView& view) {
  Aligned aligned{&view, view.T_camera_local, {}, {}, {}};
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (shown(view, points[i].p_local, points[i].normal).score > 0.0F) aligned.visible.push_back(i);
  return aligned;
}

/// Returns the twist (translation, rotation) from the first to the present pose, in the camera frame.
Vector6d moved(const Aligned& aligned) {
  const Eigen::Isometry3d T = (aligned.view->T_camera_local * aligned.T_first.inverse()).cast<double>();
  const Eigen::AngleAxisd turn(T.linear());
  Vector6d twist;
  twist << T.translation(), turn.angle() * turn.axis();
  return twist;
}

/// Looks up the visible points in the view's picture.
void look(std::span<const MeshPoint> points, Aligned& aligned) {
  const TextureView& view = *aligned.view;
  aligned.values.resize(aligned.visible.size());
  for (std::size_t k = 0; k < aligned.visible.size(); ++k) {
    const Grey grey = grey_at(
        aligned.picture, pixel_of(view.camera, view.T_camera_local * points[aligned.visible[k]].p_local));
    aligned.values[k] = grey.is_inside ? grey.value : kOutside;
  }
}

/// One Gauss-Newton step of the view's pose.
void step(std::span<const MeshPoint> points, std::span<const float> brightness, Aligned& aligned) {
  TextureView& view = *aligned.view;
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  const auto fx = static_cast<float>(view.camera.fx_px), fy = static_cast<float>(view.camera.fy_px);
  for (std::size_t k = 0; k < aligned.visible.size(); ++k) {
    const std::uint32_t i = aligned.visible[k];
    if (brightness[i] < 0.0F) continue;
    const Eigen::Vector3f p = view.T_camera_local * points[i].p_local;
    if (!(p.z() > 0.1F)) continue;
    const Grey grey = grey_at(aligned.picture, pixel_of(view.camera, p));
    if (!grey.is_inside) continue;
    const float difference = grey.value - brightness[i];
    const float weight = std::min(1.0F, kHuber / std::max(std::abs(difference), 1e-3F));
    // Gradient by the point in the camera frame, then by a twist: p moves by t + r x p.
    const float gx = grey.gradient.x() * fx / p.z(), gy = grey.gradient.y() * fy / p.z();
    const Eigen::Vector3f g(gx, gy, -(gx * p.x() + gy * p.y()) / p.z());
    Eigen::Matrix<float, 6, 1> J;
    J << g, p.cross(g);
    const Vector6d row = J.cast<double>();
    H.noalias() += double{weight} * row * row.transpose();
    b.noalias() += double{weight * difference} * row;
  }
  Vector6d prior;
  const double variance = kBrightnessSigma * kBrightnessSigma;
  prior << Eigen::Vector3d::Constant(variance / (kPrior_m * kPrior_m)),
      Eigen::Vector3d::Constant(variance / (kPrior_rad * kPrior_rad));
  H.diagonal() += prior;
  b += prior.cwiseProduct(moved(aligned));
  const Vector6d twist = solve_symmetric(H, Vector6d(-b));
  if (!twist.allFinite() || twist.norm() > 0.1) return;
  const Eigen::Vector3d turn = twist.tail<3>();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
  T.translation() = twist.head<3>();
  view.T_camera_local = (T * view.T_camera_local.cast<double>()).cast<float>();
}

/// Sets each point's brightness to the mean over the views; negative if fewer than two show it.
void set_brightness(std::span<const Aligned> all, std::vector<float>& brightness) {
  std::vector<float> count(brightness.size(), 0.0F);
  std::fill(brightness.begin(), brightness.end(), 0.0F);
  for (const Aligned& aligned : all)
    for (std::size_t k = 0; k < aligned.visible.size(); ++k) {
      if (aligned.values[k] == kOutside) continue;
      brightness[aligned.visible[k]] += aligned.values[k];
      count[aligned.visible[k]] += 1.0F;
    }
  for (std::size_t i = 0; i < brightness.size(); ++i)
    brightness[i] = count[i] >= 2.0F ? brightness[i] / count[i] : -1.0F;
}

}  // namespace

MeshPoint mesh_point(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3f& weights) {
  MeshPoint point{triangle, weights, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t vertex = mesh.triangles[triangle][k];
    const float weight = weights[static_cast<Eigen::Index>(k)];
    point.p_local += weight * mesh.vertices[vertex];
    point.normal += weight * mesh.normals[vertex];
  }
  point.normal.normalize();
  return point;
}

std::vector<MeshPoint> sample_mesh(const Mesh& mesh, std::size_t count) {
  std::vector<double> area_until(mesh.triangles.size());
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const Eigen::Vector3f& a = mesh.vertices[corners[0]];
    area += double{(mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a).norm()};
    area_until[t] = area;
  }
  std::vector<MeshPoint> points;
  if (!(area > 0.0)) return points;
  points.reserve(count);
  std::size_t t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (t + 1 < area_until.size() &&
           area_until[t] < (static_cast<double>(i) + 0.5) / static_cast<double>(count) * area)
      ++t;
    CounterRandom random(1, i);
    const auto root = static_cast<float>(std::sqrt(random.uniform())),
               part = static_cast<float>(random.uniform());
    points.push_back(
        mesh_point(mesh, static_cast<std::uint32_t>(t), {1.0F - root, root * (1.0F - part), root * part}));
  }
  return points;
}

void align_views(const Mesh& mesh, std::span<TextureView> views) {
  const std::vector<MeshPoint> points = sample_mesh(mesh, kAlignedPoints);
  const unsigned threads = hardware_threads();
  std::vector<Aligned> all(views.size());
  parallel_for(views.size(), threads, [&](std::size_t v, unsigned) { all[v] = begin(points, views[v]); });
  std::vector<float> brightness(points.size());
  for (const int factor : kFactors) {
    parallel_for(all.size(), threads,
                 [&](std::size_t v, unsigned) { all[v].picture = grey_of(*all[v].view, factor); });
    for (int i = 0; i < kStepsPerFactor; ++i) {
      parallel_for(all.size(), threads, [&](std::size_t v, unsigned) { look(points, all[v]); });
      set_brightness(all, brightness);
      parallel_for(all.size(), threads, [&](std::size_t v, unsigned) { step(points, brightness, all[v]); });
    }
  }
}

void align_view(std::span<const MeshPoint> points, std::span<const float> brightness, TextureView& view) {
  Aligned aligned = begin(points, view);
  for (const int factor : kFactors) {
    aligned.picture = grey_of(view, factor);
    for (int i = 0; i < kStepsPerFactor; ++i) step(points, brightness, aligned);
  }
}

}  // namespace roomradar
