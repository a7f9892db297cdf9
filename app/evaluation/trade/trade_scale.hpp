// trade_scale.hpp: amount of work for one measurement of a setting.
#pragma once

namespace roomradar {

struct TradeScale {
  int scan_px = 640;  ///< width of the simulated depth images of scans, 4:3
  int scan_frames = 75;
  double scan_rate_hz = 15.0;  ///< half a Kinect's rate: fewer frames for the same camera path
  int map_frames = 240;        ///< frames of the walk round a room from which a run's map is made
  int run_px = 640;            ///< width of the images of the map's walk and of the run
  int run_frames = 120;
  int scenarios = 24;  ///< drops and pushes onto hidden surfaces
};

/// Takes a few minutes, on small images: a functional test, not a basis for choosing presets.
inline constexpr TradeScale kQuickScale{.scan_px = 320,
                                        .scan_frames = 30,
                                        .scan_rate_hz = 15.0,
                                        .map_frames = 120,
                                        .run_px = 320,
                                        .run_frames = 60,
                                        .scenarios = 8};

}  // namespace roomradar
