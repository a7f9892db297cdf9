// parameter.hpp: parameters that trade time for accuracy, with the values to try.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// One field of a quality (ScanQuality, RunQuality), and the values to try, as words.
struct Parameter {
  std::string name;                ///< field name, and column name
  std::vector<std::string> words;  ///< fastest first
  std::size_t defaults = 0;        ///< index of the default among the words
  /// True: sets the amount of work, not its quality. Changed only alone, and never on a front.
  bool is_load = false;
};

/// A value for each parameter: index into its words.
using Setting = std::vector<std::size_t>;

Setting default_setting(const std::vector<Parameter>& parameters);

/// Returns true if all load parameters have their defaults.
bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting);

/// Returns the differences from the default, "radar sampled, radar_px 32"; "default" if there are none.
std::string describe(const std::vector<Parameter>& parameters, const Setting& setting);

}  // namespace roomradar
