// run_work.hpp: what a run trades: frames of a session in saved rooms, judged by the truth.
#pragma once
#include <string>
#include <vector>

#include "app/evaluation/pareto/measured_setting.hpp"
#include "app/evaluation/trade/run_facts.hpp"
#include "app/evaluation/trade/trade_scale.hpp"

namespace roomradar {

/// The knobs of RunQuality, and the number of virtual objects, which is a load.
/// @param objects  how many of them are usual: 1, 5 or 20
std::vector<Parameter> run_parameters(int objects = 1);
RunSetting run_setting_of(const Setting& setting);

/// Scenes: rooms and recordings as for prescan_work(); each is mapped first, with the default quality and the
/// known poses. In a room a hand and a person move before a camera that is held by hand, and objects are
/// dropped on what is in view; then other objects are dropped and pushed onto surfaces that are hidden, as
/// `roomradar fallthrough` does, against the exact solids. In a recording, whose latter half is not in its
/// map, only times and poses are measured.
MeasuredWork run_work(const std::vector<std::string>& rooms, const std::vector<std::string>& recordings,
                      const TradeScale& scale, int objects = 1);

}  // namespace roomradar
