// prescan_work.hpp: MeasuredWork for the prescan. Scans simulated rooms and recordings, and compares the
// result with ground truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_work.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

/// Returns one parameter per field of ScanQuality.
std::vector<Parameter> scan_parameters();
/// Returns the quality for a setting of scan_parameters().
ScanQuality scan_quality_of(const Setting& setting);

/// Returns the work. Its scenes are the rooms, then the recordings. In rooms, the mesh is compared with the
/// exact solids. In recordings, it is compared with every seventh frame, held out for this purpose. The
/// tracked trajectory is compared with the poses of the room or recording.
/// @param rooms  specs as after `sim:`, such as "table" or "random?seed=3"
/// @param recordings  folders of recordings with poses
MeasuredWork prescan_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                          const TradeScale& scale);

}  // namespace roomradar
