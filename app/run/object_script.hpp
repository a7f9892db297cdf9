// object_script.hpp: the script of a run without --script.
#pragma once
#include <vector>

#include "app/cli/options/object_options.hpp"
#include "app/session/script/script.hpp"

namespace roomradar {

/// Returns a script that adds the objects and drops each of them. An object is dropped from 5 cm above its
/// given point, or above a level surface in view if no point is given. A single object is named kOnlyObject.
/// Several objects are named after their files.
Script drop_objects(const std::vector<ObjectOption>& objects);

}  // namespace roomradar
