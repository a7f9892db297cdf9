// parameter.cpp: default settings, and settings as text.
#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

Setting default_setting(const std::vector<Parameter>& parameters) {
  Setting setting;
  for (const Parameter& parameter : parameters) setting.push_back(parameter.defaults);
  return setting;
}

bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].is_load && setting[i] != parameters[i].defaults) return false;
  return true;
}

std::string describe(const std::vector<Parameter>& parameters, const Setting& setting) {
  std::string text;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (setting[i] != parameters[i].defaults)
      text += (text.empty() ? "" : ", ") + parameters[i].name + " " + parameters[i].words[setting[i]];
  return text.empty() ? "default" : text;
}

}  // namespace roomradar
