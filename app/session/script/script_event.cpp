// script_event.cpp: tells which object an action names, and when an event is due.
#include "app/session/script/script_event.hpp"

namespace roomradar {

std::string object_of(const Action& action) {
  return std::visit(
      [](const auto& kind) -> std::string {
        if constexpr (requires { kind.name; })
          return kind.name;
        else
          return {};
      },
      action);
}

bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s) {
  return event.frame ? *event.frame <= run_frame : event.time_s && *event.time_s <= run_time_s;
}

}  // namespace roomradar
