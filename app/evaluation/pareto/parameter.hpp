// parameter.hpp: parameters that trade time for accuracy, with the values to measure.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// One field of ScanQuality or RunQuality, and the values to measure, as words.
struct Parameter {
  std::string name;                ///< name of the field and of the CSV column
  std::vector<std::string> words;  ///< fastest first
  std::size_t defaults = 0;        ///< index of the default in `words`
  /// True: the parameter sets the amount of work (load), not its quality. It is never changed together with
  /// other parameters. Settings that change a load parameter are never on a Pareto front.
  bool is_load = false;
};

/// A value for each parameter, as index in Parameter::words.
using Setting = std::vector<std::size_t>;

Setting default_setting(const std::vector<Parameter>& parameters);

/// Returns true if all load parameters have their defaults.
bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting);

/// Returns the differences from the default, such as "radar sampled, radar_px 32", or "default" if there are
/// none.
std::string describe(const std::vector<Parameter>& parameters, const Setting& setting);

/// Returns the differences from the default as one word, such as "radar=sampled,radar_px=32", or "default".
std::string setting_words(const std::vector<Parameter>& parameters, const Setting& setting);
/// Returns the setting that setting_words() wrote. Throws Error if a parameter or its value is unknown, or a
/// parameter occurs twice.
Setting setting_from(const std::vector<Parameter>& parameters, const std::string& words);

}  // namespace roomradar
