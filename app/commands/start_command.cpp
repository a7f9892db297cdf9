// start_command.cpp: the start view, and the commands that it starts.
#include "app/commands/commands.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "app/cli/shell_line.hpp"
#include "app/commands/command_line.hpp"
#include "app/start/start_state.hpp"
#include "app/window/start/start_window.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kWrongUsage = 2;  // exit status

struct CommandResult {
  int status = 0;
  StartMessage message;
};

/// Runs the command of a choice as if it had been typed.
int run_as_typed(const std::vector<std::string>& words) {
  std::vector<const char*> arguments = {"roomradar"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  std::fprintf(stderr, "roomradar %s\n", shell_line(words).c_str());
  const ParsedCommand command =
      parse_command_line(static_cast<int>(arguments.size()), arguments.data(), {.prescan = run, .run = run});
  return command.work ? command.work() : command.exit_status;
}

/// Carries out a choice. The message says how it ended; errors are printed, too.
CommandResult carry_out(const StartChoice& choice, const StartSettings& settings) {
  try {
    const int status = run_as_typed(command_of(choice, settings));
    std::fflush(stdout);
    if (status == kWrongUsage) return {status, {"The command was refused; the terminal says why.", true}};
    if (choice.action == StartAction::kPlay)
      return {status, {status == 0 ? "" : "The run ended with a fault, which the terminal names.", false}};
    const MapEntry map = describe_map(choice.map);
    return {status, {map.is_saved ? choice.map + " is saved." : "No map was saved.", false}};
  } catch (const std::bad_alloc&) {
    return {1,
            {"Memory ran out; close other programs, or use coarser cells (--resolution) on the command line.",
             true}};
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar: %s\n", error.what());
    return {1, {error.what(), true}};
  }
}

/// Keeps the settings; if that fails, the message says so.
void remember(StartState& state) {
  try {
    write_start_settings(state.settings, start_settings_file());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar: %s\n", error.what());
  }
}

StartState first_state(const StartOptions& options) {
  StartState state;
  state.folder = ".";
  const ReadSettings read = read_start_settings(start_settings_file());
  state.settings = read.settings;
  if (options.ui_scale) state.settings.ui_scale = options.ui_scale;
  state.message = {read.fault, !read.fault.empty()};
  if (!read.fault.empty()) std::fprintf(stderr, "roomradar: %s\n", read.fault.c_str());
  refresh_sources(state, {});
  refresh_maps(state);
  for (const std::string& name : options.names) choose(state, name);
  return state;
}

int show_start(StartWindow& window, const StartOptions& options) {
  StartState state = first_state(options);
  for (;;) {
    const StartChoice choice = window.show(state);
    if (choice.action != StartAction::kQuit) {
      state.settings.last_map = choice.map;
      state.settings.last_source = choice.source;
      if (const SourceEntry* source = chosen_source(state)) state.settings.last_source = source->source;
    }
    remember(state);
    if (choice.action == StartAction::kQuit) return 0;
    const CommandResult result = carry_out(choice, state.settings);
    if (window.was_closed()) return result.status;
    state.message = result.message;
    if (choice.action != StartAction::kPlay && is_map(choice.map)) choose(state, choice.map);
  }
}

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* display = std::getenv(name); display != nullptr && *display != '\0') return true;
  return false;
}

}  // namespace

int run(const StartOptions& options) {
  StartWindow window;
  return show_start(window, options);
}

int run_start_alone(const char* first_steps) {
  if (isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0 && has_display()) {
    std::optional<StartWindow> window;
    try {
      window.emplace();
    } catch (const Error& error) {
      std::fprintf(stderr, "roomradar: %s\n", error.what());
    }
    if (window) return show_start(*window, {});
  }
  std::fputs(first_steps, stderr);
  return kWrongUsage;
}

}  // namespace roomradar
