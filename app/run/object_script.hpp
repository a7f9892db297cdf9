// object_script.hpp: the script of a run without --script.
#pragma once
#include <vector>

#include "app/cli/options/object_options.hpp"
#include "app/session/script/script.hpp"

namespace roomradar {

/// Returns a script that adds the objects and drops each 5 cm above its point, or over the best level surface
/// in view. One object is named kOnlyObject; several are named after their files.
Script drop_objects(const std::vector<ObjectOption>& objects);

}  // namespace roomradar
