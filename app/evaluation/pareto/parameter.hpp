// knob.hpp: what a user can turn to trade time for accuracy, in steps.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// One field of a quality, and the words that it is tried with.
struct Parameter {
  std::string name;                ///< as in the quality, and the column's head
  std::vector<std::string> words;  ///< fastest first
  std::size_t defaults = 0;        ///< the default's place among them
  /// How much work there is, not how well it is done: turned alone, never mixed, and never on a front.
  bool is_load = false;
};

/// One word of each knob, by its place.
using Setting = std::vector<std::size_t>;

Setting default_setting(const std::vector<Parameter>& parameters);

/// Whether only knobs of quality are turned.
bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting);

/// What differs from the usual, "radar sampled, radar_px 32"; "default" if nothing does.
std::string describe(const std::vector<Parameter>& parameters, const Setting& setting);

}  // namespace roomradar
