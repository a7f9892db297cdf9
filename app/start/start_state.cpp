// start_state.cpp: preserves the chosen entries when the lists change.
#include "app/start/start_state.hpp"

#include <algorithm>

#include "mapping/map/map_files.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

bool is_same_path(const fs::path& a, const fs::path& b) {
  std::error_code fault;
  return a == b || (fs::equivalent(a, b, fault) && !fault);
}

bool has_source(const std::vector<SourceEntry>& entries, const SourceEntry& entry) {
  return std::any_of(entries.begin(), entries.end(), [&](const SourceEntry& each) {
    return each.source == entry.source || (each.kind == SourceKind::kRecording && entry.kind == each.kind &&
                                           is_same_path(each.source, entry.source));
  });
}

void add_missing(const std::vector<SourceEntry>& entries, std::vector<SourceEntry>& sources) {
  for (const SourceEntry& entry : entries)
    if (!has_source(sources, entry)) sources.push_back(entry);
}

/// Describes a source; a recording that is listed is not read again.
SourceEntry described(const StartState& state, const std::string& source) {
  for (const SourceEntry& each : state.sources)
    if (each.source == source && each.kind == SourceKind::kRecording) return each;
  return describe_source(source);
}

void choose_source(StartState& state, const std::string& source) {
  const auto found = std::find_if(state.sources.begin(), state.sources.end(),
                                  [&](const SourceEntry& each) { return each.source == source; });
  if (found != state.sources.end()) state.source = static_cast<std::size_t>(found - state.sources.begin());
}

void choose_map(StartState& state, const fs::path& folder) {
  const auto found = std::find_if(state.maps.begin(), state.maps.end(),
                                  [&](const MapEntry& each) { return is_same_path(each.folder, folder); });
  if (found != state.maps.end()) state.map = static_cast<std::size_t>(found - state.maps.begin());
}

}  // namespace

void refresh_sources(StartState& state, const std::vector<SourceEntry>& recordings) {
  const SourceEntry* before = chosen_source(state);
  const std::string first = state.given.empty() ? state.settings.last_source : state.given.back();
  const std::string chosen = before != nullptr ? before->source : first;
  std::vector<SourceEntry> sources;
  for (const std::string& source : state.given) add_missing({described(state, source)}, sources);
  add_missing(list_kinects(), sources);
  add_missing(recordings, sources);
  if (!state.settings.last_source.empty()) {
    const SourceEntry last = described(state, state.settings.last_source);
    if (last.fault.empty()) add_missing({last}, sources);
  }
  add_missing(list_simulated_rooms(), sources);
  state.sources = std::move(sources);
  state.source = 0;
  choose_source(state, chosen);
}

void refresh_maps(StartState& state) {
  const MapEntry* before = chosen_map(state);
  const fs::path chosen = before != nullptr ? before->folder : fs::path(state.settings.last_map);
  state.maps = list_maps(state.folder);
  std::vector<fs::path> others = state.given_maps;
  if (!state.settings.last_map.empty()) others.emplace_back(state.settings.last_map);
  for (const fs::path& other : others) {
    const bool is_listed = std::any_of(state.maps.begin(), state.maps.end(), [&](const MapEntry& each) {
      return is_same_path(each.folder, other);
    });
    if (!is_listed && is_map(other)) state.maps.push_back(describe_map(other));
  }
  state.map = 0;
  if (!chosen.empty()) choose_map(state, chosen);
}

void choose(StartState& state, const std::string& name) {
  std::error_code ignored;
  fs::path path = name;
  if (path.filename() == kMapInfoFile && fs::is_regular_file(path, ignored))
    path = fs::absolute(path).parent_path();
  if (!path.has_filename() && path.has_parent_path()) path = path.parent_path();  // a trailing slash
  if (is_map(path)) {
    state.given_maps.push_back(path);
    refresh_maps(state);
    choose_map(state, path);
    state.active = StartList::kMaps;
    return;
  }
  const SourceEntry entry = describe_source(path.string());
  if (!entry.fault.empty()) {
    state.message = {entry.fault, true};
    return;
  }
  if (!has_source(state.sources, entry)) {
    state.given.push_back(entry.source);
    state.sources.insert(state.sources.begin(), entry);
  }
  choose_source(state, entry.source);
  state.active = StartList::kSources;
}

const SourceEntry* chosen_source(const StartState& state) {
  return state.source < state.sources.size() ? &state.sources[state.source] : nullptr;
}

const MapEntry* chosen_map(const StartState& state) {
  return state.map < state.maps.size() ? &state.maps[state.map] : nullptr;
}

void move_choice(StartState& state, int rows) {
  const bool in_maps = state.active == StartList::kMaps;
  std::size_t& index = in_maps ? state.map : state.source;
  const std::size_t size = in_maps ? state.maps.size() : state.sources.size();
  if (size == 0) return;
  const auto last = static_cast<std::ptrdiff_t>(size) - 1;
  index = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(index) + rows, 0, last));
}

std::string why_not(const StartState& state, StartAction action) {
  const SourceEntry* source = chosen_source(state);
  const MapEntry* map = chosen_map(state);
  if (action == StartAction::kQuit || action == StartAction::kDoctor) return {};
  const bool needs_source =
      action == StartAction::kScan || action == StartAction::kPlay || action == StartAction::kScanMore;
  if (needs_source && source == nullptr) return "There is no source to choose.";
  if (needs_source && !source->fault.empty()) return source->fault;
  if (action == StartAction::kScan) return {};
  if (map == nullptr) return "There is no map so far; scan a room first (S).";
  if (action == StartAction::kDelete) return {};
  if (action == StartAction::kScanMore && map->has_unfinished_scan) return {};
  if (action == StartAction::kCompare && state.maps.size() < 2)
    return "There is only one map; Compare needs two.";
  return map->fault;
}

std::vector<std::string> command_of(const StartChoice& choice, const StartSettings& settings) {
  // A name that begins with a hyphen would be read as an option.
  const auto name = [](const std::string& path) { return path.starts_with('-') ? "./" + path : path; };
  std::vector<std::string> words = {choice.action == StartAction::kPlay ? "run" : "prescan",
                                    name(choice.source), "--map", name(choice.map), "--window"};
  if (choice.action == StartAction::kScanMore) words.emplace_back("--resume");
  if (settings.ui_scale) {
    words.emplace_back("--ui-scale");
    words.push_back(format_number(*settings.ui_scale));
  }
  return words;
}

}  // namespace roomradar
