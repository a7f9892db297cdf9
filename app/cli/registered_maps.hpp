// registered_maps.hpp: two maps of one room, for commands that need to know how they stand to each other.
#pragma once
#include <string>

#include "app/cli/report.hpp"
#include "mapping/map/map_merge.hpp"

namespace roomradar {

/// By register_maps(); prints what was found and adds it to the report. Throws Error where it is not certain.
/// @param name_a,name_b  for messages
Registration require_registered(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                                const std::string& name_b, Report& report);

}  // namespace roomradar
