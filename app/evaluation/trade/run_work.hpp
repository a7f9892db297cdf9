// run_work.hpp: benchmark of `roomradar run` (a MeasuredWork). Runs sessions in mapped rooms and recordings,
// and compares the result with ground truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_work.hpp"
#include "app/evaluation/trade/run_facts.hpp"
#include "app/evaluation/trade/trade_frames.hpp"

namespace roomradar {

/// Returns one parameter per field of RunQuality, and the number of virtual objects as the load parameter.
/// @param objects  default number of objects: 1, 5 or 20
std::vector<Parameter> run_parameters(int objects = 1);
/// Returns quality and number of objects for a setting of run_parameters().
RunSetting run_setting_of(const Setting& setting);

/// Returns the benchmark of a run. Its scenes are rooms and recordings, named as for prescan_work(). Rooms
/// and recordings are mapped with the default quality and known poses. In rooms, a hand and a person move in
/// front of a hand-held camera, and objects are dropped in view. Other objects are then dropped and pushed
/// onto hidden surfaces, as in `roomradar fallthrough`, and their contacts are compared with the analytic
/// ground truth. In recordings, only times and poses are measured, on the last frames, which are not in the
/// map.
MeasuredWork run_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                      const TradeScale& scale, int objects = 1);

}  // namespace roomradar
