// board_views.hpp: the frames of a recording in which a checkerboard can be seen, one for each way it is
// held.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// A printed checkerboard, counted by the corners at which four squares meet.
struct Board {
  int columns = 8, rows = 6;  ///< 3 to 30 each, and not the same
  double square_m = 0.03;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const Board& board);

/// Corner (column, row) in the board's frame: z = 0, x along the columns.
inline Eigen::Vector3d corner_board(const Board& board, int column, int row) {
  return {column * board.square_m, row * board.square_m, 0.0};
}

struct DepthSample {
  double x_px, y_px;  ///< of the real depth image
  double reported_m;
};

struct BoardView {
  std::int64_t frame = 0;
  std::vector<Eigen::Vector2d> corners_px;  ///< in the real colour image, row by row
  std::vector<DepthSample> depth;           ///< where the depth image shows the board
};

struct BoardViews {
  std::vector<BoardView> views;
  Frame first;                  ///< the first frame with colour: sizes, and the cameras that it says
  std::int64_t frames = 0;      ///< read
  std::int64_t with_board = 0;  ///< of those that were searched
  /// Of frames that would be views, had they the depth that the board's size makes of its corners: the median
  /// of what they have over that.
  std::vector<double> off_plane_ratios;
};

/// Corners of the board to a fraction of a pixel, or nothing.
std::optional<std::vector<Eigen::Vector2d>> find_corners(const ColourImage& colour, const Board& board);

/// Reads the source to its end, or until `most` views are found. A frame becomes a view if the board is whole
/// in the colour image, hardly moves (colour and depth are not of the very same instant), stands elsewhere or
/// otherwise than in the views before, and the depth image shows it. Throws Error if the source has no
/// colour.
/// @param progress  called after every frame with the number of views so far
BoardViews find_board_views(FrameSource& source, const Board& board, std::size_t most,
                            const std::function<void(std::size_t)>& progress);

}  // namespace roomradar
