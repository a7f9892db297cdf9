// config_check.hpp: range checks of settings, with one form of error message.
#pragma once
#include <string>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

/// Checks the settings of one group. If `holds` is false, a call throws an Error such as "fusion.max_range_m
/// = -1: must be in 0..100 m".
struct ConfigCheck {
  const char* group;
  template <typename Number>
  void operator()(bool holds, const char* field, Number value, const char* rule) const {
    if (!holds)
      throw Error(std::string(group) + "." + field + " = " + format_number(value) + ": must be " + rule);
  }
};

}  // namespace roomradar
