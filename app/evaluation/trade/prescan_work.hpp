// prescan_work.hpp: what a prescan trades: scans of simulated rooms and of recordings, judged by the truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"
#include "app/evaluation/trade/trade_scale.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

/// The knobs of ScanQuality, and the quality that a setting of them stands for.
std::vector<Parameter> scan_parameters();
ScanQuality scan_quality_of(const Setting& setting);

/// Scenes: the rooms (as `sim:` has them: "table", "random?seed=3"), then the recordings (folders with
/// poses). In a room the mesh is measured against the exact solids; of a recording every seventh frame is
/// held out and measured against the mesh. The trajectory, tracked, is measured against the room's or the
/// recording's.
MeasuredWork prescan_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                          const TradeScale& scale);

}  // namespace roomradar
