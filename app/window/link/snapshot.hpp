// snapshot.hpp: copies a session's state after a frame for the window.
#pragma once
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/session/session.hpp"
#include "app/window/link/ui_channel.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

class SnapshotMaker {
 public:
  /// @param room  mesh of the saved room, copied once
  explicit SnapshotMaker(const Mesh& room) : room_(std::make_shared<const Mesh>(room)) {}

  /// Sets the fields of `shown` that come from the session; the radar's images are those of the object
  /// `shown.chosen`. Reuses the allocations of `shown`.
  void fill(const Session& session, const FrameResult& result, const StageTimes& times,
            const ViewsWanted& wanted, Snapshot& shown);

 private:
  std::shared_ptr<const Mesh> room_;
  std::uint64_t room_revision_ = 0;  ///< revision of the session's room that room_ copies; 0: none so far
  std::map<std::shared_ptr<const ObjectModel>, std::shared_ptr<const Mesh>> object_meshes_;
  std::map<std::string, std::size_t, std::less<>> counted_;  ///< samples per stage before this frame
  CyberRadar radar_;
  RadarPictures pictures_;
  std::string pictures_of_;  ///< name of the object in pictures_
  std::chrono::steady_clock::time_point pictures_due_{};

  void fill_radar(const Session& session, const std::string& chosen, ShownRadar& shown);
};

}  // namespace roomradar
