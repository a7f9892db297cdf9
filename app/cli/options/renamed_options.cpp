// renamed_options.cpp: hidden options that pass their value to the option of the new name.
#include "app/cli/options/renamed_options.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace roomradar {
namespace {

void pass_on(CLI::App& command, const std::string& old_name, const std::string& name,
             const std::string& value) {
  std::fprintf(stderr, "roomradar: %s is now %s; the old name will go in the next version\n",
               old_name.c_str(), name.c_str());
  command.get_option(name)->add_result(value);
}

}  // namespace

void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name) {
  command
      .add_option_function<std::string>(
          old_name,
          [&command, old_name, name](const std::string& word) { pass_on(command, old_name, name, word); })
      ->group("");
}

void add_old_flag(CLI::App& command, const std::string& old_name, const std::string& name) {
  command
      .add_flag_callback(old_name, [&command, old_name, name] { pass_on(command, old_name, name, "true"); })
      ->group("");
}

}  // namespace roomradar
