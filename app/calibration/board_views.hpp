// board_views.hpp: selects the frames of a recording that show a checkerboard, one frame per checkerboard
// pose.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/calibration/checkerboard.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Throws Error if a field is out of range, naming the field, its value and the valid range.
void require_valid(const Board& board);

struct DepthSample {
  double x_px, y_px;  ///< in the distorted depth image
  double reported_m;  ///< depth reported by the sensor
};

/// A selected frame, with its measurements of the checkerboard.
struct BoardView {
  std::int64_t frame = 0;
  std::vector<Eigen::Vector2d> corners_px;  ///< inner corners in the distorted colour image, row by row
  std::vector<DepthSample> depth;           ///< depth pixels on the checkerboard
  /// Unit normal of the checkerboard in the colour camera's frame, computed with the source's uncalibrated
  /// intrinsics and no distortion.
  Eigen::Vector3d normal_camera = Eigen::Vector3d::UnitZ();
};

struct BoardViews {
  std::vector<BoardView> views;
  Frame first;                  ///< first frame with colour; provides image sizes and uncalibrated intrinsics
  std::int64_t frames = 0;      ///< number of frames read
  std::int64_t with_board = 0;  ///< number of frames in which the checkerboard was found
  /// Number of frames in which the checkerboard was found and had moved by at most 6 px (RMS) since the
  /// previous frame.
  std::int64_t still = 0;
  /// One entry per checkerboard pose that was rejected only because its depth does not fit the checkerboard's
  /// plane. The entry is the median ratio of measured to expected depth. The expected depth is computed from
  /// the corners and Board::square_m. Similar ratios other than 1 in all entries indicate a wrong square_m.
  std::vector<double> off_plane_ratios;
};

/// Finds the checkerboard's inner corners with subpixel precision. Returns nullopt unless all of them are
/// found.
std::optional<std::vector<Eigen::Vector2d>> find_corners(const ColourImage& colour, const Board& board);

/// Reads the source to its end, or until `most` views are found. A frame becomes a view if the whole
/// checkerboard is in its colour image and measured by its depth image. The frame is rejected if the
/// checkerboard has moved noticeably since the previous frame, since colour and depth images are not taken at
/// the same instant. It is also rejected if the checkerboard's pose is similar to that in an earlier view.
/// Throws Error as require_valid(Board) does, or if none of the first 60 frames has colour.
/// @param progress  called after each frame with the views found so far
BoardViews find_board_views(FrameSource& source, const Board& board, std::size_t most,
                            const std::function<void(const BoardViews&)>& progress);

/// Returns the number of views with a checkerboard normal that differs by at least 12 degrees from the mean
/// normal of all views.
std::size_t count_tilted(const BoardViews& views);

/// Returns true if Board::square_m seems to be wrong: at least 4 poses were rejected because of their depth
/// (BoardViews::off_plane_ratios), and more poses were rejected than accepted.
bool are_squares_off(const BoardViews& views);

/// Returns a short text on the problem with the views found so far and its remedy. Returns an empty string if
/// there is no problem. Problems are: no checkerboard of that size, a checkerboard never held still, squares
/// of another size, and too few tilted views.
std::string advice_on(const BoardViews& views, const Board& board);

/// Returns true if the frame's depth is registered to colour. Both images then have the same camera, so the
/// cameras' relative pose cannot be estimated.
bool is_registered(const Frame& frame);

}  // namespace roomradar
