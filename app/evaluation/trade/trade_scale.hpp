// trade_scale.hpp: how much is done to measure one setting once.
#pragma once

namespace roomradar {

struct TradeScale {
  int scan_px = 640;  ///< width of the simulated depth images that are scanned, 4:3
  int scan_frames = 75;
  double scan_rate_hz = 15.0;  ///< a hand moves the camera as far as ever in fewer frames
  int map_frames = 240;        ///< of the walk round a room that a run's map is made of
  int run_px = 640;            ///< width of the images of that walk and of a run
  int run_frames = 120;
  int scenarios = 24;  ///< drops and pushes onto hidden surfaces
};

/// A few minutes for all, on small images: to see that it works, not to choose by.
inline constexpr TradeScale kQuickScale{.scan_px = 320,
                                        .scan_frames = 30,
                                        .scan_rate_hz = 15.0,
                                        .map_frames = 120,
                                        .run_px = 320,
                                        .run_frames = 60,
                                        .scenarios = 8};

}  // namespace roomradar
