// snapshot.hpp: copies a session's state after a frame for the window.
#pragma once
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/session/session.hpp"
#include "app/window/link/ui_channel.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Returns the map's surface, with its texture if the map has a texture that matches the surface. Throws
/// Error if the texture is damaged.
ShownRoom shown_room(const SavedMap& map);

/// Fills snapshots for the window from a session.
class SnapshotMaker {
 public:
  explicit SnapshotMaker(ShownRoom room) : room_(std::make_shared<const ShownRoom>(std::move(room))) {}

  /// Sets the fields of `shown` that come from the session. The radar's images are those of object
  /// `shown.chosen`. Reuses the memory of `shown`.
  void fill(const Session& session, const FrameResult& result, const StageTimes& times,
            const ViewsWanted& wanted, Snapshot& shown);

 private:
  std::shared_ptr<const ShownRoom> room_;
  std::int64_t tile_changes_ = 0;    ///< buildings: tiles loaded and dropped before room_ was made
  std::uint64_t room_revision_ = 0;  ///< revision of the session's room in room_; 0: none
  std::map<std::shared_ptr<const ObjectModel>, std::shared_ptr<const Mesh>> object_meshes_;
  /// Number of samples per stage before this frame.
  std::map<std::string, std::size_t, std::less<>> counted_;
  CyberRadar radar_;
  RadarPictures pictures_;
  std::string pictures_of_;  ///< name of the object in pictures_
  std::chrono::steady_clock::time_point pictures_due_{};

  void fill_radar(const Session& session, const std::string& chosen, ShownRadar& shown);
};

}  // namespace roomradar
