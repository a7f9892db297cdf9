// board_views.cpp: finds corners with OpenCV, and selects views.
#include "app/calibration/board_views.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "app/calibration/checkerboard.hpp"
#include "app/sources/formats/median.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr double kStill_px = 6.0;    // max motion between frames, RMS over the corners
constexpr double kNew_px = 22.0;     // min difference from every earlier view
constexpr int kDepthStep_px = 5;     // noise is correlated over some 3 pixels
constexpr double kNearPlane = 0.06;  // fraction of the depth: larger than any sensor error
constexpr std::size_t kLeastDepthSamples = 40;
constexpr std::int64_t kMostWithoutColour_frames = 60;  // a live source's first frames may have none

double distance_px(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Compares corners in both orders: a board upside down gives the same corners in reverse.
double distance_either_way_px(const std::vector<Eigen::Vector2d>& a, std::vector<Eigen::Vector2d> b) {
  const double one_way_px = distance_px(a, b);
  std::reverse(b.begin(), b.end());
  return std::min(one_way_px, distance_px(a, b));
}

/// Depth pixels whose rays, by the frame's declared cameras, hit the board well inside its corners'
/// rectangle.
struct DepthOnBoard {
  std::vector<DepthSample> samples;  ///< with a depth close to the board's
  std::vector<double> ratios;        ///< of all measured depths there to the board's
};

DepthOnBoard depth_on_board(const Frame& frame, const Board& board, const Eigen::Isometry3d& T_colour_board) {
  const Eigen::Isometry3d T_depth_board = frame.T_colour_depth.inverse() * T_colour_board;
  const Eigen::Vector3d normal = T_depth_board.linear().col(2);
  const double offset_m = normal.dot(T_depth_board.translation());
  const double margin_m = 0.25 * board.square_m;
  DepthOnBoard found;
  for (int y = 0; y < frame.depth_m.height; y += kDepthStep_px)
    for (int x = 0; x < frame.depth_m.width; x += kDepthStep_px) {
      const double reported_m = static_cast<double>(frame.depth_m.at(x, y));
      const Eigen::Vector3d ray = back_project(frame.depth_camera, x, y, 1.0);
      const double plane_m = offset_m / normal.dot(ray);
      if (!(reported_m > 0.0) || !(plane_m > 0.0) || !std::isfinite(plane_m)) continue;
      const Eigen::Vector3d p_board = T_depth_board.inverse() * (ray * plane_m);
      if (p_board.x() < margin_m || p_board.y() < margin_m ||
          p_board.x() > (board.columns - 1) * board.square_m - margin_m ||
          p_board.y() > (board.rows - 1) * board.square_m - margin_m)
        continue;
      found.ratios.push_back(reported_m / plane_m);
      if (std::abs(reported_m - plane_m) < kNearPlane * plane_m)
        found.samples.push_back({static_cast<double>(x), static_cast<double>(y), reported_m});
    }
  return found;
}

}  // namespace

void require_valid(const Board& board) {
  const auto require = [](bool holds, const std::string& what, const std::string& rule) {
    if (!holds) throw Error("board: " + what + ": must be " + rule);
  };
  for (const int corners : {board.columns, board.rows})
    require(corners >= 3 && corners <= 30, std::to_string(corners) + " inner corners along a side",
            "3 to 30");
  require(board.columns != board.rows,
          std::to_string(board.columns) + " by " + std::to_string(board.rows) +
              " inner corners (--columns, --rows)",
          "not square, so that its sides can be told apart");
  require(board.square_m >= 0.001 && board.square_m <= 1.0,
          "squares of " + format_number(board.square_m) + " m", "of 0.001 to 1 m");
}

std::optional<std::vector<Eigen::Vector2d>> find_corners(const ColourImage& colour, const Board& board) {
  const cv::Mat rgb(colour.height, colour.width, CV_8UC3,
                    const_cast<Rgb*>(colour.pixels.data()));  // read only
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  std::vector<cv::Point2f> found;
  const cv::Size size(board.columns, board.rows);
  // CALIB_CB_FAST_CHECK returns within milliseconds if there is no board.
  if (!cv::findChessboardCorners(
          grey, size, found,
          cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK))
    return std::nullopt;
  // The refinement window is smaller than a square, otherwise adjacent corners bias the result.
  double least_px = std::numeric_limits<double>::infinity();
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (i % columns != 0) least_px = std::min(least_px, cv::norm(found[i] - found[i - 1]));
    if (i >= columns) least_px = std::min(least_px, cv::norm(found[i] - found[i - columns]));
  }
  const int half_px = std::clamp(static_cast<int>(0.4 * least_px), 2, 11);
  cv::cornerSubPix(grey, found, cv::Size(half_px, half_px), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4));
  std::vector<Eigen::Vector2d> corners_px;
  for (const cv::Point2f& corner : found) corners_px.emplace_back(corner.x, corner.y);
  return corners_px;
}

BoardViews find_board_views(FrameSource& source, const Board& board, std::size_t most,
                            const std::function<void(const BoardViews&)>& progress) {
  require_valid(board);
  BoardViews result;
  std::vector<std::vector<Eigen::Vector2d>> off_plane_px;  // corners of each entry of result.off_plane_ratios
  std::vector<Eigen::Vector2d> before;  // corners of the previous frame; empty if it had none
  Frame frame;
  while (result.views.size() < most) {
    const ReadResult read = source.next(frame);
    if (read.status == ReadStatus::kEnd) break;
    if (read.status != ReadStatus::kFrame) {
      if (read.status == ReadStatus::kSkipped) progress(result);
      continue;
    }
    ++result.frames;
    if (frame.colour.empty()) {
      if (result.frames == kMostWithoutColour_frames && result.first.colour.empty()) break;
      before.clear();
      progress(result);
      continue;
    }
    if (result.first.colour.empty()) result.first = frame;
    const auto corners_px = find_corners(frame.colour, board);
    const bool still =
        corners_px && !before.empty() && distance_either_way_px(*corners_px, before) < kStill_px;
    if (corners_px) ++result.with_board;
    if (still) ++result.still;
    before = corners_px.value_or(std::vector<Eigen::Vector2d>{});
    const auto is_there = [&](const std::vector<Eigen::Vector2d>& known_px) {
      return distance_either_way_px(*corners_px, known_px) < kNew_px;
    };
    const auto is_known = [&](const BoardView& view) { return is_there(view.corners_px); };
    if (still && std::none_of(result.views.begin(), result.views.end(), is_known)) {
      const Eigen::Isometry3d T_colour_board = pose_of_board(*corners_px, board, frame.colour_camera, {});
      DepthOnBoard depth = depth_on_board(frame, board, T_colour_board);
      if (depth.samples.size() >= kLeastDepthSamples)
        result.views.push_back(
            {frame.index, *corners_px, std::move(depth.samples), T_colour_board.linear().col(2)});
      else if (depth.ratios.size() >= kLeastDepthSamples &&
               std::none_of(off_plane_px.begin(), off_plane_px.end(), is_there)) {
        result.off_plane_ratios.push_back(median_of(std::move(depth.ratios)));
        off_plane_px.push_back(*corners_px);
      }
    }
    progress(result);
  }
  if (result.frames > 0 && result.first.colour.empty())
    throw Error(source.name() + ": has no colour images, in which the board's corners would be found");
  return result;
}

std::size_t count_tilted(const BoardViews& views) {
  constexpr double kTilt_deg = 12.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> normals;
  for (const BoardView& view : views.views) {
    normals.push_back(view.normal_camera.z() < 0.0 ? Eigen::Vector3d(-view.normal_camera)
                                                   : view.normal_camera);
    mean += normals.back();
  }
  const double cosine = std::cos(kTilt_deg * std::numbers::pi / 180.0);
  return static_cast<std::size_t>(
      std::count_if(normals.begin(), normals.end(),
                    [&](const Eigen::Vector3d& normal) { return normal.dot(mean.normalized()) < cosine; }));
}

bool are_squares_off(const BoardViews& views) {
  constexpr std::size_t kFew = 4;
  return views.off_plane_ratios.size() >= kFew && views.off_plane_ratios.size() > views.views.size();
}

std::string advice_on(const BoardViews& views, const Board& board) {
  constexpr std::int64_t kPatience_frames = 15;  // half a second
  if (views.with_board == 0)
    return views.frames < kPatience_frames
               ? ""
               : "no board of " + std::to_string(board.columns) + " by " + std::to_string(board.rows) +
                     " inner corners is seen whole: count them, and give the numbers with --columns and "
                     "--rows";
  if (views.still == 0)
    return views.with_board < kPatience_frames ? "" : "the board always moves: hold it still for a second";
  if (are_squares_off(views)) {
    std::array<char, 128> text{};
    format_classic(text.data(), text.size(),
                   "the squares seem to be %.3g m, not %.3g m: measure one, and give its side with --square",
                   median_of(views.off_plane_ratios) * board.square_m, board.square_m);
    return text.data();
  }
  if (views.views.size() >= 8 && 3 * count_tilted(views) < views.views.size())
    return "tilt the board more, every way, by 30 to 50 degrees";
  return {};
}

bool is_registered(const Frame& frame) {
  return !frame.colour.empty() && frame.T_colour_depth.isApprox(Eigen::Isometry3d::Identity(), 1e-9) &&
         frame.colour_camera == frame.depth_camera;
}

}  // namespace roomradar
