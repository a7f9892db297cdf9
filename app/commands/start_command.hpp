// start_command.hpp: roomradar start, or roomradar without arguments: offers maps and actions in a window.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace roomradar {

struct StartOptions {
  /// Maps, recordings or other sources that are listed first; the last one is chosen.
  std::vector<std::string> names;
  /// Scale of the window's text and panes; unset: the remembered one, or the monitor's.
  std::optional<double> ui_scale;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, StartOptions& options);

/// Shows the start view, performs the chosen action in the same window, and shows the view again, until the
/// user closes the window. The view shows the error messages of failed actions. Returns the exit status: that
/// of the last action if the window was closed during it, else 0.
/// @throws Error if there is no window
int run(const StartOptions& options);

/// Does what run() does if stdin and stdout are a terminal and there is a display. Otherwise prints
/// `first_steps` to stderr and returns 2, the exit status of wrong usage.
int run_start_alone(const char* first_steps);

}  // namespace roomradar
