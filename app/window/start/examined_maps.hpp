// examined_maps.hpp: pictures and properties of the listed maps, computed in the background.
#pragma once
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>

#include "app/start/background_jobs.hpp"
#include "app/start/map_list.hpp"
#include "app/start/start_state.hpp"
#include "app/window/panes/gl_texture.hpp"

namespace roomradar {

struct ExaminedMap {
  std::time_t saved_at = 0;  ///< version of the map that is or was examined
  bool is_done = false;      ///< false: the fields below are not valid yet
  MapDetails details;
  GlTexture picture{/*smooth=*/true};  ///< empty if the map has no surface
};

/// The window's OpenGL context must be current for all calls.
class ExaminedMaps {
 public:
  /// Adds a job for the next map without details; the chosen map comes first. Call only if no job is queued.
  void examine_next(const StartState& state, BackgroundJobs& jobs);
  /// Returns the result for a map; null: there is no result yet.
  [[nodiscard]] const ExaminedMap* find(const MapEntry& map) const;

 private:
  std::map<std::filesystem::path, std::shared_ptr<ExaminedMap>> maps_;

  bool begin(const MapEntry& map, BackgroundJobs& jobs);
};

}  // namespace roomradar
