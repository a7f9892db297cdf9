// object_script.cpp: names the objects, and makes their events.
#include "app/run/object_script.hpp"

#include <algorithm>
#include <string>

#include "app/session/script/session_events.hpp"

namespace roomradar {
namespace {

constexpr double kDropHeight_m = 0.05;  // above a point that the user gave

/// Returns true if an object of the script has this name.
bool is_taken(const Script& script, const std::string& name) {
  return std::any_of(script.events.begin(), script.events.end(),
                     [&](const ScriptEvent& event) { return object_of(event.action) == name; });
}

std::string free_name(const Script& script, const ObjectOption& object) {
  const std::string stem = object_name(object.source.mesh);
  std::string name = stem;
  for (int number = 2; is_taken(script, name); ++number) name = stem + std::to_string(number);
  return name;
}

}  // namespace

Script drop_objects(const std::vector<ObjectOption>& objects) {
  Script script;
  for (const ObjectOption& object : objects) {
    const std::string name = objects.size() == 1 ? kOnlyObject : free_name(script, object);
    DropObject drop{.name = name, .position_world = object.at_world};
    if (object.at_world) drop.height_m = kDropHeight_m;
    script.events.push_back({.action = AddObject{name, object.source, object.material}, .frame = 0});
    script.events.push_back({.action = drop, .frame = 0});
  }
  return script;
}

}  // namespace roomradar
