// prescan_work.hpp: MeasuredWork of a prescan: scans of simulated rooms and of recordings, with ground truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"
#include "app/evaluation/trade/trade_scale.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

/// Returns the parameters of ScanQuality, and the quality for a setting of them.
std::vector<Parameter> scan_parameters();
ScanQuality scan_quality_of(const Setting& setting);

/// Scenes: the rooms (as in `sim:`, "table", "random?seed=3"), then the recordings (folders with poses). In
/// rooms, the mesh is compared with the exact solids; in recordings, with held-out frames (every seventh).
/// The tracked trajectory is compared with the room's or the recording's poses.
MeasuredWork prescan_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                          const TradeScale& scale);

}  // namespace roomradar
