// start_state.hpp: the lists of the start view, the chosen entries, and the actions on them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/start/map_list.hpp"
#include "app/start/source_list.hpp"
#include "app/start/start_settings.hpp"

namespace roomradar {

enum class StartAction { kQuit, kScan, kPlay, kScanMore, kCompare, kExport, kRename, kDelete, kDoctor };
enum class StartList { kSources, kMaps };

/// Sentence below the lists.
struct StartMessage {
  std::string text;  ///< empty: none
  bool is_fault = false;
};

struct StartState {
  std::filesystem::path folder;    ///< the current folder, in which sources and maps are listed
  std::vector<std::string> given;  ///< sources that were named or dropped; listed first
  std::vector<std::filesystem::path> given_maps;  ///< maps that were named, dropped or last used
  std::vector<SourceEntry> sources;
  std::vector<MapEntry> maps;
  std::size_t source = 0, map = 0;         ///< index of the chosen entry in its list
  StartList active = StartList::kSources;  ///< list that the arrow keys move in
  StartMessage message;
  StartSettings settings;
};

/// The user's decision.
struct StartChoice {
  StartAction action = StartAction::kQuit;
  std::string source;  ///< in the syntax of open_source()
  std::string map;     ///< folder
};

/// Refresh the lists of sources and maps. A chosen entry that is still listed remains chosen.
/// @param recordings  result of list_recordings(), which may take a while
void refresh_sources(StartState& state, const std::vector<SourceEntry>& recordings);
void refresh_maps(StartState& state);

/// Adds and chooses a map or source that the user has named or dropped on the window. Sets an error message
/// if `name` is neither.
void choose(StartState& state, const std::string& name);

/// Returns the chosen entry; null if the list is empty.
const SourceEntry* chosen_source(const StartState& state);
const MapEntry* chosen_map(const StartState& state);

/// Moves the selection in the active list by a number of rows, clamped to the list.
void move_choice(StartState& state, int rows);

/// Returns a sentence on why an action cannot be done with the chosen entry; empty if it can.
std::string why_not(const StartState& state, StartAction action);

/// Returns the command line of a choice, without the program's name, such as "run sim:table --map maps/table
/// --window". The action must be kScan, kPlay or kScanMore.
std::vector<std::string> command_of(const StartChoice& choice, const StartSettings& settings);

}  // namespace roomradar
