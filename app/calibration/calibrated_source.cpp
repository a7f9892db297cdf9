// calibrated_source.cpp: remaps images with one table per camera, from ideal to real pixels.
#include "app/calibration/calibrated_source.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns the position in the real image of pixel (x, y) of the ideal camera.
PlanePoint<double> real_pixel(const Intrinsics& camera, const Lens& lens, int x, int y) {
  const PlanePoint<double> p =
      distorted({(x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px}, lens);
  return {camera.fx_px * p.x + camera.cx_px, camera.fy_px * p.y + camera.cy_px};
}

class CalibratedSource final : public WrappedSource {
 public:
  CalibratedSource(std::unique_ptr<FrameSource> source, const Calibration& calibration)
      : WrappedSource(std::move(source)), calibration_(calibration) {
    const Intrinsics& depth = calibration_.rig.depth_camera;
    depth_table_.resize(depth.width_px, depth.height_px);
    for (int y = 0; y < depth.height_px; ++y)
      for (int x = 0; x < depth.width_px; ++x) {
        const PlanePoint<double> at = real_pixel(depth, calibration_.depth_lens, x, y);
        const double nearest_x = std::round(at.x), nearest_y = std::round(at.y);
        if (!(nearest_x >= 0.0 && nearest_y >= 0.0 && nearest_x < depth.width_px &&
              nearest_y < depth.height_px))
          continue;
        const int real_x = static_cast<int>(nearest_x), real_y = static_cast<int>(nearest_y);
        depth_table_.at(x, y) = {
            real_y * depth.width_px + real_x,
            static_cast<float>(offset_per_m(calibration_.depth_correction, depth.width_px, depth.height_px,
                                            real_x, real_y))};
      }
    if (!calibration_.rig.colour_camera) return;
    const Intrinsics& colour = *calibration_.rig.colour_camera;
    colour_x_.create(colour.height_px, colour.width_px, CV_32FC1);
    colour_y_.create(colour.height_px, colour.width_px, CV_32FC1);
    for (int y = 0; y < colour.height_px; ++y)
      for (int x = 0; x < colour.width_px; ++x) {
        const PlanePoint<double> at = real_pixel(colour, calibration_.colour_lens, x, y);
        colour_x_.at<float>(y, x) = static_cast<float>(at.x);
        colour_y_.at<float>(y, x) = static_cast<float>(at.y);
      }
  }

  ReadResult next(Frame& frame) override {
    const ReadResult result = source_.next(frame);
    if (result.status != ReadStatus::kFrame) return result;
    correct_depth(frame);
    // Also for a frame without colour image: all frames of a recording must have the same cameras.
    const bool has_colour_camera = !frame.colour.empty() || frame.colour_camera.width_px > 0;
    if (calibration_.rig.colour_camera && has_colour_camera) correct_colour(frame);
    return result;
  }

 private:
  struct RealPixel {
    int index = -1;  ///< in the real image; -1: outside
    float offset_per_m = 0.0F;
  };

  void require_size(const char* which, int width_px, int height_px, const Intrinsics& camera) const {
    if (width_px == camera.width_px && height_px == camera.height_px) return;
    throw Error(source_.name() + ": its " + which + " images are " + std::to_string(width_px) + " x " +
                std::to_string(height_px) + ", but the calibration is for " +
                std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) +
                "; calibrate in the mode that you record in");
  }

  void correct_depth(Frame& frame) {
    const Intrinsics& camera = calibration_.rig.depth_camera;
    require_size("depth", frame.depth_m.width, frame.depth_m.height, camera);
    real_depth_m_.pixels.swap(frame.depth_m.pixels);
    frame.depth_m.resize(camera.width_px, camera.height_px);
    const double inverse_scale = calibration_.depth_correction.inverse_scale;
    for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i) {
      const RealPixel& real = depth_table_.pixels[i];
      if (real.index >= 0)
        frame.depth_m.pixels[i] =
            corrected_depth_m(real_depth_m_.pixels[static_cast<std::size_t>(real.index)], inverse_scale,
                              static_cast<double>(real.offset_per_m));
    }
    frame.depth_camera = camera;
  }

  void correct_colour(Frame& frame) {
    const Intrinsics& camera = *calibration_.rig.colour_camera;
    frame.colour_camera = camera;
    frame.T_colour_depth = calibration_.rig.T_colour_depth;
    if (frame.colour.empty()) return;
    require_size("colour", frame.colour.width, frame.colour.height, camera);
    real_colour_.pixels.swap(frame.colour.pixels);
    frame.colour.resize(camera.width_px, camera.height_px);
    const cv::Mat real(camera.height_px, camera.width_px, CV_8UC3, real_colour_.pixels.data());
    cv::Mat ideal(camera.height_px, camera.width_px, CV_8UC3, frame.colour.pixels.data());
    cv::remap(real, ideal, colour_x_, colour_y_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  }

  Calibration calibration_;
  Image<RealPixel> depth_table_;
  cv::Mat colour_x_, colour_y_;
  DepthImage real_depth_m_;
  ColourImage real_colour_;
};

}  // namespace

std::unique_ptr<FrameSource> calibrated(std::unique_ptr<FrameSource> source, const Calibration& calibration) {
  return std::make_unique<CalibratedSource>(std::move(source), calibration);
}

}  // namespace roomradar
