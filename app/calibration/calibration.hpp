// calibration.hpp: calibration of a Kinect, and its file format.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// Depth correction: 1 / depth = inverse_scale / reported depth + offset(x, y). The correction is linear in
/// disparity, the quantity that a structured-light sensor measures. The offset (1/m) is interpolated
/// bilinearly between the nodes of a grid, stored row by row. The grid extends from the centre of the image's
/// first pixel to the centre of its last. Without nodes, the offset is 0.
struct DepthCorrection {
  double inverse_scale = 1.0;
  int columns = 0, rows = 0;  ///< both 0, or both 2 to 256
  std::vector<double> offset_per_m;
};

/// Position of a pixel in the node grid. Column and row are those of the node above and to the left. The
/// pixel's offset from that node is in fractions of a cell, 0 to 1.
struct GridPlace {
  int column = 0, row = 0;
  double right = 0.0, down = 0.0;
};
GridPlace grid_place(int columns, int rows, int width_px, int height_px, double x_px, double y_px);

/// Returns the offset (1/m) at a pixel of an image of the given size.
double offset_per_m(const DepthCorrection& correction, int width_px, int height_px, double x_px, double y_px);

/// Returns the corrected depth (m), or 0 if the reported depth is 0 or the result is negative or above 1 km.
inline float corrected_depth_m(float reported_m, double inverse_scale, double offset_per_m) {
  if (!(reported_m > 0.0F)) return 0.0F;
  const double inverse = inverse_scale / reported_m + offset_per_m;
  return inverse > 1e-3 ? static_cast<float>(1.0 / inverse) : 0.0F;
}

struct Calibration {
  CameraRig rig;
  Lens depth_lens, colour_lens;
  DepthCorrection depth_correction;
};

/// Reads and writes calibration.json:
///  {"format": "roomradar calibration", "version": 1, "depth", "colour", "T_colour_depth": as in camera.json,
///   "depth_lens", "colour_lens": {"k1", "k2", "p1", "p2", "k3"},
///   "depth_correction": {"inverse_scale", "columns", "rows", "offset_per_m": [columns * rows numbers]}}
/// Throws Error naming the file and the field if a field is missing, has the wrong type or an invalid value.
/// A lens is invalid if it moves a corner of the image by more than half the corner's distance from the
/// principal point. inverse_scale must be between 0.5 and 2, and the magnitude of an offset at most 0.2 / m.
/// Without a colour camera, "colour", "colour_lens" and "T_colour_depth" are absent.
Calibration read_calibration(const std::filesystem::path& path);
/// Throws Error "WHERE, depth_lens: ..." if read_calibration() would reject these numbers.
void require_valid(const Calibration& calibration, const std::string& where);
void write_calibration(const Calibration& calibration, const std::filesystem::path& path);

}  // namespace roomradar
