// examined_maps.cpp: one job per map.
#include "app/window/start/examined_maps.hpp"

namespace roomradar {
namespace {

constexpr int kPicture_px = 900;
constexpr Rgb kGround{0, 0, 0};  // no surface is as dark

/// Returns the picture in RGBA, transparent where no surface is.
Image<std::uint32_t> without_ground(const ColourImage& picture) {
  Image<std::uint32_t> rgba(picture.width, picture.height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const Rgb c = picture.pixels[i];
    if (!(c == kGround)) rgba.pixels[i] = 0xFF000000U | (c.b * 0x10000U) | (c.g * 0x100U) | c.r;
  }
  return rgba;
}

}  // namespace

void ExaminedMaps::examine_next(const StartState& state, BackgroundJobs& jobs) {
  if (const MapEntry* map = chosen_map(state); map != nullptr && begin(*map, jobs)) return;
  for (const MapEntry& map : state.maps)
    if (begin(map, jobs)) return;
}

const ExaminedMap* ExaminedMaps::find(const MapEntry& map) const {
  const auto found = maps_.find(map.folder);
  return found != maps_.end() && found->second->is_done && found->second->saved_at == map.saved_at
             ? found->second.get()
             : nullptr;
}

/// Returns false if there is nothing to do for this map.
bool ExaminedMaps::begin(const MapEntry& map, BackgroundJobs& jobs) {
  if (!map.fault.empty()) return false;
  std::shared_ptr<ExaminedMap>& examined = maps_[map.folder];
  if (examined && examined->saved_at == map.saved_at) return false;
  examined = std::make_shared<ExaminedMap>();
  examined->saved_at = map.saved_at;
  jobs.add([folder = map.folder] { return examine_map(folder, kPicture_px, kGround); },
           [into = examined](MapDetails details) {
             if (!details.picture.empty()) into->picture.upload(without_ground(details.picture));
             into->details = std::move(details);
             into->details.picture = {};
             into->is_done = true;
           },
           [](const std::string&) {});
  return true;
}

}  // namespace roomradar
