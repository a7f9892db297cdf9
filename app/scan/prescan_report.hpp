// prescan_report.hpp: results of a prescan, for its report and for the user.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/cli/options/prescan_options.hpp"
#include "app/evaluation/held_out.hpp"
#include "mapping/coverage/holes.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Returns the report's entries that are specific to prescans, except `held_out`.
nlohmann::json results_of(const PrescanResult& scanned);

/// Returns the value of the report's key `held_out`. Values that could not be measured are omitted.
nlohmann::json held_out_json(const HeldOutScore& score);

/// Prints a summary of a few lines to stdout.
/// @param held_out  unset: there is no score, since no frames were held out or the comparison failed
void print_summary(const PrescanOptions& options, const PrescanResult& scanned,
                   const std::optional<HeldOutScore>& held_out);

/// Prints to stdout the number of holes, and describes the first five inside the scan (not kOuterBorder).
/// They are numbered as in the report and coverage.png.
/// @param holes  sorted as by find_holes()
void print_holes(const std::vector<Hole>& holes);

}  // namespace roomradar
