// trade_scale.hpp: image sizes and numbers of frames for one measurement of a setting.
#pragma once

namespace roomradar {

struct TradeScale {
  int scan_px = 640;  ///< width of the simulated 4:3 depth images of scans
  int scan_frames = 75;
  double scan_rate_hz = 15.0;  ///< half a Kinect's rate, for fewer frames on the same camera path
  int map_frames = 240;        ///< number of frames of the prescan from which a run's map is made
  int run_px = 640;            ///< width of the images of the run and of its prescan
  int run_frames = 120;
  int scenarios = 24;  ///< number of drops and pushes onto hidden surfaces
};

/// Scale for functional tests, not for choosing presets. A sweep with small images takes a few minutes.
inline constexpr TradeScale kQuickScale{.scan_px = 320,
                                        .scan_frames = 30,
                                        .scan_rate_hz = 15.0,
                                        .map_frames = 120,
                                        .run_px = 320,
                                        .run_frames = 60,
                                        .scenarios = 8};

}  // namespace roomradar
