// input_lines.hpp: prints the decisions about a recording, one line each.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "app/cli/options/input_options.hpp"
#include "app/sources/formats/input_report.hpp"

namespace roomradar {

/// Prints to stderr the decisions that have been added since the last call.
class InputLines {
 public:
  /// @param report  must outlive this object
  /// @param source  name of the recording, for the lines
  InputLines(const InputReport& report, std::string source) : report_(report), source_(std::move(source)) {}
  void say();

 private:
  const InputReport& report_;
  std::string source_;
  std::size_t said_ = 0;
};

/// Adds the options that were given to a report's settings.
void add_to(nlohmann::json& settings, const InputOptions& options);

}  // namespace roomradar
