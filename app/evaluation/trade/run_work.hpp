// run_work.hpp: MeasuredWork of a run: frames of a session in saved rooms, with ground truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"
#include "app/evaluation/trade/run_facts.hpp"
#include "app/evaluation/trade/trade_scale.hpp"

namespace roomradar {

/// Returns the parameters of RunQuality, and the number of virtual objects as a load.
/// @param objects  default number of objects: 1, 5 or 20
std::vector<Parameter> run_parameters(int objects = 1);
RunSetting run_setting_of(const Setting& setting);

/// Scenes: rooms and recordings, named as for prescan_work(). Each is first mapped with the default quality
/// and known poses. In rooms, a hand and a person move in front of a hand-held camera, and objects are
/// dropped in view. Then other objects are dropped and pushed onto hidden surfaces, as in `roomradar
/// fallthrough`, and compared with the exact solids. In recordings, whose last part is not in the map, only
/// times and poses are measured.
MeasuredWork run_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                      const TradeScale& scale, int objects = 1);

}  // namespace roomradar
