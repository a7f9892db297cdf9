// coverage.cpp: holes in observed space and in the surface, and a picture of both: orthographic projections
// of the mesh, with the holes drawn over them.
#include "mapping/coverage/coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

#include "mapping/coverage/frontier.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 1600, kMostHeight = 1200, kMargin = 28, kPanelWidth = 420;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr std::size_t kNumbered = 12;  // holes with a badge and a line in the list

// OpenCV's colour order: blue, green, red.
const cv::Scalar kPaper(250, 248, 246), kInk(60, 48, 40), kFaint(170, 160, 152), kOrange(40, 130, 245),
    kViolet(190, 40, 170), kBlue(215, 150, 70), kWay(60, 120, 40);

void put(cv::Mat3b& picture, const std::string& text, cv::Point at, double size,
         const cv::Scalar& colour = kInk, int thickness = 1) {
  cv::putText(picture, text, at, kFont, size, colour, thickness, cv::LINE_AA);
}

// One orthographic projection. `right`, `down` and `into` are the picture's axes in the world.
struct Projection {
  Vector3d right, down, into;
  double px_per_m = 1.0;
  double left_m = 0.0, top_m = 0.0;  // panel's upper left corner, along `right` and `down`
  cv::Rect panel;
  std::string title;

  [[nodiscard]] cv::Point2d at(const Vector3d& p_world) const {
    return {panel.x + (p_world.dot(right) - left_m) * px_per_m,
            panel.y + (p_world.dot(down) - top_m) * px_per_m};
  }
};

// Returns the angle between most upright surfaces and the world's axes, -45 to 45 degrees, in radians.
double yaw_of_walls_rad(const Mesh& mesh) {
  std::complex<double> sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Vector3d c = mesh.vertices[t[2]].cast<double>();
    const Vector3d normal = (b - a).cross(c - a);
    if (std::hypot(normal.x(), normal.y()) < 0.95 * normal.norm()) continue;
    sum += std::polar(normal.norm(), 4.0 * std::atan2(normal.y(), normal.x()));
  }
  return std::abs(sum) > 0.0 ? std::arg(sum) / 4.0 : 0.0;
}

// Returns per vertex whether its surface is well observed.
std::vector<std::uint8_t> seen_well(const StaticMap& map, const Mesh& mesh) {
  const double least_weight = std::pow(double{kUnitWeightSigma_m} / kSeenWell_m, 2);
  std::vector<std::uint8_t> well(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d p_world = mesh.origin + mesh.vertices[i].cast<double>();
    float weight = 0.0F;  // a vertex lies between samples: the best one counts
    for (int n = 0; n < 8; ++n) {
      const Vector3d half(n & 1 ? 0.5 : -0.5, n & 2 ? 0.5 : -0.5, n & 4 ? 0.5 : -0.5);
      const auto sample = map.sample_at(p_world + map.resolution_m() * half);
      if (sample) weight = std::max(weight, sample->weight);
    }
    well[i] = weight >= least_weight ? 1 : 0;
  }
  return well;
}

void draw_surface(const Mesh& mesh, const std::vector<std::uint8_t>& well, const Projection& view,
                  cv::Mat3b& picture) {
  cv::Mat1f nearest(view.panel.size(), std::numeric_limits<float>::infinity());
  std::vector<cv::Point2d> pixels(mesh.vertices.size());
  std::vector<float> depth_m(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d p_world = mesh.origin + mesh.vertices[i].cast<double>();
    pixels[i] = view.at(p_world) - cv::Point2d(view.panel.tl());
    depth_m[i] = static_cast<float>(p_world.dot(view.into));
  }
  const Vector3d light = (-view.into - 0.45 * view.right - 0.3 * view.down).normalized();
  for (const Triangle& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Vector3d normal =
        (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
    if (!(normal.dot(view.into) < 0.0)) continue;
    const double shade = 0.45 + 0.55 * std::max(normal.normalized().dot(light), 0.0);
    cv::Vec3d mean(200, 200, 200);
    if (!mesh.colours.empty()) {
      mean = {0, 0, 0};
      for (const std::uint32_t v : t)
        mean += cv::Vec3d(mesh.colours[v].b, mesh.colours[v].g, mesh.colours[v].r) / 3.0;
    }
    mean = shade * (0.62 * mean + cv::Vec3d(92, 92, 92));  // lightened, so marks stand out
    if (well[t[0]] + well[t[1]] + well[t[2]] < 2)
      mean = 0.35 * mean + 0.65 * shade * cv::Vec3d(kOrange[0], kOrange[1], kOrange[2]);
    const cv::Vec3b colour(cv::saturate_cast<std::uint8_t>(mean[0]), cv::saturate_cast<std::uint8_t>(mean[1]),
                           cv::saturate_cast<std::uint8_t>(mean[2]));
    const cv::Point2d p = pixels[t[0]], q = pixels[t[1]], r = pixels[t[2]];
    const double area = (q - p).cross(r - p);
    if (std::abs(area) < 1e-9) continue;
    const auto first = [](double x, double y, double z) {
      return static_cast<int>(std::ceil(std::min({x, y, z})));
    };
    const auto last = [](double x, double y, double z) {
      return static_cast<int>(std::floor(std::max({x, y, z})));
    };
    for (int y = std::max(first(p.y, q.y, r.y), 0); y <= std::min(last(p.y, q.y, r.y), nearest.rows - 1); ++y)
      for (int x = std::max(first(p.x, q.x, r.x), 0); x <= std::min(last(p.x, q.x, r.x), nearest.cols - 1);
           ++x) {
        const cv::Point2d at(x, y);
        const double wq = (at - p).cross(r - p) / area, wr = (q - p).cross(at - p) / area;
        if (wq < -1e-9 || wr < -1e-9 || wq + wr > 1.0 + 1e-9) continue;
        const double depth = (1.0 - wq - wr) * depth_m[t[0]] + wq * depth_m[t[1]] + wr * depth_m[t[2]];
        if (depth >= static_cast<double>(nearest(y, x))) continue;
        nearest(y, x) = static_cast<float>(depth);
        picture(view.panel.y + y, view.panel.x + x) = colour;
      }
  }
}

void draw_border(const Frontier& frontier, const Projection& view, cv::Mat3b& picture) {
  // Cells that face into or out of the picture would cover it, so only the outline of the outer border is
  // drawn.
  cv::Mat1b inside(picture.size(), std::uint8_t{0}), outside = inside.clone();
  const double half_px = 0.5 * frontier.cell_m * view.px_per_m;
  for (const FrontierCell& cell : frontier.cells) {
    if (cell.hole < 0) continue;
    const Hole& hole = frontier.holes[static_cast<std::size_t>(cell.hole)];
    const bool is_outer = !is_inside_scan(hole);
    if (is_outer && std::abs(hole.look_direction_world.dot(view.into)) > 0.5) continue;
    const cv::Point2d at = view.at(cell.centre_world);
    cv::rectangle(is_outer ? outside : inside,
                  cv::Rect(cv::Point(at - cv::Point2d(half_px, half_px)),
                           cv::Point(at + cv::Point2d(half_px, half_px))) &
                      view.panel,
                  cv::Scalar(255), cv::FILLED);
  }
  for (const auto& [mask, colour, strength] :
       {std::tuple{&outside, kBlue, 0.30}, std::tuple{&inside, kViolet, 0.40}}) {
    for (int y = view.panel.y; y < view.panel.br().y; ++y)
      for (int x = view.panel.x; x < view.panel.br().x; ++x) {
        if ((*mask)(y, x) == 0) continue;
        const double part = (x + y) % 7 < 2 ? 0.85 : strength;  // hatched
        for (int c = 0; c < 3; ++c)
          picture(y, x)[c] =
              cv::saturate_cast<std::uint8_t>((1.0 - part) * picture(y, x)[c] + part * colour[c]);
      }
  }
}

void draw_badge(cv::Mat3b& picture, cv::Point at, const std::string& text, const cv::Scalar& colour) {
  cv::circle(picture, at, 12, cv::Scalar(255, 255, 255), cv::FILLED, cv::LINE_AA);
  cv::circle(picture, at, 11, colour, cv::FILLED, cv::LINE_AA);
  const cv::Size size = cv::getTextSize(text, kFont, 0.42, 1, nullptr);
  put(picture, text, at + cv::Point(-size.width / 2, size.height / 2), 0.42, cv::Scalar(255, 255, 255));
}

const cv::Scalar& colour_of(HoleKind kind) { return kind == HoleKind::kOuterBorder ? kBlue : kViolet; }

void draw_axes(const Projection& view, cv::Mat3b& picture) {
  const cv::Point origin(view.panel.x + 26, view.panel.br().y - 26);
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d unit = Vector3d::Unit(axis);
    const cv::Point2d way(unit.dot(view.right), unit.dot(view.down));
    if (std::hypot(way.x, way.y) < 0.3) continue;
    const cv::Point tip = origin + cv::Point(28.0 * way);
    cv::arrowedLine(picture, origin, tip, kInk, 1, cv::LINE_AA, 0, 0.25);
    put(picture, kNames[static_cast<std::size_t>(axis)], origin + cv::Point(38.0 * way) + cv::Point(-4, 4),
        0.42);
  }
}

// The scan that a coverage picture shows.
struct DrawnScan {
  const Mesh& mesh;
  const std::vector<std::uint8_t>& well;  // see seen_well()
  const Frontier& frontier;
  std::span<const Hole> holes;
  std::span<const TimedPose> trajectory;
};

void draw_view(const DrawnScan& scan, const Projection& view, cv::Mat3b& picture) {
  const auto& [mesh, well, frontier, holes, trajectory] = scan;
  draw_surface(mesh, well, view, picture);
  draw_border(frontier, view, picture);
  std::vector<cv::Point> way;
  for (const TimedPose& pose : trajectory) way.emplace_back(view.at(pose.T_world_camera.translation()));
  cv::polylines(picture, way, false, kWay, 1, cv::LINE_AA);
  if (!way.empty()) {
    cv::circle(picture, way.front(), 4, kWay, cv::FILLED, cv::LINE_AA);
    cv::circle(picture, way.back(), 4, kWay, 1, cv::LINE_AA);
  }
  for (std::size_t i = std::min(holes.size(), kNumbered); i-- > 0;)
    draw_badge(picture, cv::Point(view.at(holes[i].position_world)), std::to_string(i + 1),
               colour_of(holes[i].kind));
  cv::rectangle(picture, view.panel, kFaint);
  put(picture, view.title, view.panel.tl() + cv::Point(0, -8), 0.45);
  draw_axes(view, picture);
}

// Draws the scale to the right of the plan, where nothing else is.
// @param room_px  width of the free place
void draw_scale(const Projection& view, int room_px, cv::Mat3b& picture) {
  double length_m = 1.0;
  for (const double shorter_m : {0.5, 0.2, 0.1, 0.05})
    if (length_m * view.px_per_m > room_px) length_m = shorter_m;
  const cv::Point left = view.panel.br() + cv::Point(16, -16);
  const cv::Point right = left + cv::Point(static_cast<int>(std::lround(length_m * view.px_per_m)), 0);
  cv::line(picture, left, right, kInk, 2, cv::LINE_AA);
  for (const cv::Point end : {left, right})
    cv::line(picture, end - cv::Point(0, 5), end + cv::Point(0, 5), kInk, 1);
  put(picture, format_number(length_m) + " m", left + cv::Point(0, -9), 0.42);
}

// Returns the y coordinate of its end.
int draw_legend(std::span<const Hole> holes, double resolution_m, cv::Point panel, cv::Mat3b& picture) {
  int y = panel.y + 22;
  const auto line = [&](const std::string& text, int x, double size, const cv::Scalar& colour = kInk) {
    put(picture, text, {panel.x + x, y}, size, colour);
  };
  line("Coverage", 0, 0.8);
  y += 26;
  char text[128];
  format_classic(text, sizeof(text), "cells of %g mm", 1e3 * resolution_m);
  line(text, 0, 0.42, kFaint);
  y += 30;
  const auto entry = [&](const cv::Scalar& colour, const std::string& words) {
    cv::rectangle(picture, cv::Rect(panel.x, y - 12, 22, 14), colour, cv::FILLED);
    line(words, 32, 0.45);
    y += 24;
  };
  entry(cv::Scalar(196, 200, 202), "seen well (known to 3 mm)");
  entry(kOrange, "seen thinly");
  entry(kViolet, "not seen: unknown space, surface border");
  entry(kBlue, "the scan ends here");
  cv::line(picture, {panel.x, y - 5}, {panel.x + 22, y - 5}, kWay, 2, cv::LINE_AA);
  line("the camera's way (dot: its start)", 32, 0.45);
  y += 40;
  if (holes.empty()) {
    line("No holes: all of the scan's inside was seen.", 0, 0.45);
    return y;
  }
  line("Largest holes", 0, 0.55);
  y += 26;
  for (std::size_t i = 0; i < std::min(holes.size(), kNumbered); ++i) {
    const Hole& hole = holes[i];
    draw_badge(picture, {panel.x + 11, y - 5}, std::to_string(i + 1), colour_of(hole.kind));
    format_classic(text, sizeof(text), "%s, %.2f m2, %.1f m wide", std::string(to_string(hole.kind)).c_str(),
                   hole.area_m2, hole.size_m);
    line(text, 32, 0.43);
    y += 17;
    const Vector3d p = rounded(hole.position_world, 2);
    format_classic(text, sizeof(text), "at %.2f, %.2f, %.2f", p.x(), p.y(), p.z());
    std::string where = text;
    if (hole.viewpoint_world) {
      const Vector3d s = rounded(*hole.viewpoint_world, 2);
      format_classic(text, sizeof(text), "; look from %.2f, %.2f, %.2f", s.x(), s.y(), s.z());
      where += text;
    }
    line(where, 32, 0.38, kFaint);
    y += 25;
  }
  if (holes.size() > kNumbered)
    line("and " + std::to_string(holes.size() - kNumbered) + " more in the report", 32, 0.42);
  return y + 20;
}

// Lays out the three projections in their panel, at one scale.
std::array<Projection, 3> lay_out(const Mesh& mesh, const Frontier& frontier,
                                  std::span<const TimedPose> trajectory) {
  const double yaw = yaw_of_walls_rad(mesh);
  const Vector3d east(std::cos(yaw), std::sin(yaw), 0.0), north(-std::sin(yaw), std::cos(yaw), 0.0);
  const Vector3d up = Vector3d::UnitZ();
  Eigen::AlignedBox3d box;  // along east, north and up
  const auto extend = [&](const Vector3d& p_world) {
    box.extend(Vector3d(p_world.dot(east), p_world.dot(north), p_world.z()));
  };
  for (const Eigen::Vector3f& v : mesh.vertices) extend(mesh.origin + v.cast<double>());
  for (const TimedPose& pose : trajectory) extend(pose.T_world_camera.translation());
  for (const FrontierCell& cell : frontier.cells)
    if (cell.hole >= 0 && is_inside_scan(frontier.holes[static_cast<std::size_t>(cell.hole)]))
      extend(cell.centre_world);
  constexpr double kRim_m = 0.15;
  const Vector3d low = box.min().array() - kRim_m;
  const Vector3d size = box.sizes().array() + 2.0 * kRim_m;
  // The plan is above the view from the south; the view from the east is to the right of that view.
  const int inner_width = kWidth - kPanelWidth - 4 * kMargin, inner_height = kMostHeight - 3 * kMargin;
  const double px_per_m =
      std::min(inner_width / (size.x() + size.y()), inner_height / std::max(size.y() + size.z(), 0.1));
  const auto px = [&](double length_m) { return std::max(static_cast<int>(length_m * px_per_m), 1); };
  std::array<Projection, 3> views;
  views[0] = {east,
              -north,
              -up,
              px_per_m,
              low.x(),
              -(low.y() + size.y()),
              cv::Rect(kMargin, kMargin, px(size.x()), px(size.y())),
              "from above"};
  views[1] = {east,
              -up,
              north,
              px_per_m,
              low.x(),
              -(low.z() + size.z()),
              cv::Rect(kMargin, 2 * kMargin + px(size.y()), px(size.x()), px(size.z())),
              "from the plan's lower edge"};
  views[2] = {north,
              -up,
              -east,
              px_per_m,
              low.y(),
              -(low.z() + size.z()),
              cv::Rect(2 * kMargin + px(size.x()), 2 * kMargin + px(size.y()), px(size.y()), px(size.z())),
              "from the plan's right edge"};
  return views;
}

}  // namespace

ColourImage draw_coverage(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                          std::span<const Hole> holes, std::span<const TimedPose> trajectory) {
  cv::Mat3b picture(kMostHeight, kWidth);
  int height = 0;  // of the used part
  picture.setTo(kPaper);
  if (surface.triangles.empty()) {
    put(picture, "There is no surface.", {kMargin, 2 * kMargin}, 0.8);
  } else {
    const std::array<Projection, 3> views = lay_out(surface, frontier, trajectory);
    const std::vector<std::uint8_t> well = seen_well(map, surface);
    const DrawnScan scan{surface, well, frontier, holes, trajectory};
    for (const Projection& view : views) draw_view(scan, view, picture);
    draw_scale(views[0], views[2].panel.width, picture);
    height = views[2].panel.br().y;
  }
  height = std::max(height, draw_legend(holes, map.resolution_m(),
                                        cv::Point(kWidth - kPanelWidth - kMargin, kMargin), picture));
  height = std::min(height + kMargin, kMostHeight);
  ColourImage image(kWidth, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < kWidth; ++x) image.at(x, y) = {picture(y, x)[2], picture(y, x)[1], picture(y, x)[0]};
  return image;
}

Coverage survey_coverage(const StaticMap& octree, const Mesh& mesh,
                         const std::vector<TimedPose>& trajectory) {
  const Frontier frontier = find_frontier(octree);
  Coverage coverage;
  coverage.holes = find_holes(octree, mesh, frontier);
  coverage.picture_png = encode_png(draw_coverage(octree, mesh, frontier, coverage.holes, trajectory));
  return coverage;
}

}  // namespace roomradar
