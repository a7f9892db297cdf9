// registered_maps.hpp: registers two maps of one room, prints the result and adds it to the report.
#pragma once
#include <string>

#include "app/cli/report.hpp"
#include "mapping/map/map_merge.hpp"

namespace roomradar {

/// Registers map b to map a (register_maps()), prints the result and adds it to the report. Throws Error if
/// the registration is not reliable.
/// @param name_a, name_b names of the maps in messages
Registration require_registered(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                                const std::string& name_b, Report& report);

}  // namespace roomradar
