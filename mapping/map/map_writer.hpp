// map_writer.hpp: saves a map; parts that are ready early can be written, and freed, before the rest.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/lazy_part.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Writes the map to folder.partial-PID, syncs that folder to disk, and renames it to `folder` atomically.
/// Extracts the border of unknown space from map.octree and map.mesh, and writes it to unknown.bin. A texture
/// that does not fit the mesh is left out. A map that was in `folder` stays as an earlier revision (see
/// map_history.hpp). Afterwards `folder` is the complete new map or, after an Error,
/// unchanged. Creates parent folders. Throws Error if `folder` exists and is not a map, the map has no
/// surface or too many triangles, or the disk fails.
void save_map(const std::filesystem::path& folder, const SavedMap& map);

/// Same as save_map(), in steps. Until commit() succeeds, `folder` is unchanged; the destructor then removes
/// what was written. Each member function throws Error as save_map() does.
class MapWriter {
 public:
  /// Writes nothing yet. Throws Error if the name is not usable.
  explicit MapWriter(const std::filesystem::path& folder);

  /// Writes the keyframes. Returns them as a part that is read from `folder` when it is used after commit().
  LazyPart<KeyframeDatabase> write_keyframes(const KeyframeDatabase& keyframes);

  /// Writes the octree, and the border of unknown space. Returns the octree as write_keyframes() does.
  LazyPart<StaticMap> write_octree(const StaticMap& octree, const Mesh& mesh);

  /// Writes the parts that were not written yet, and replaces the folder. Does not use those that were.
  void commit(const SavedMap& map);

 private:
  const std::filesystem::path& begin();  // returns the partial folder

  std::filesystem::path target_;
  std::optional<AtomicFolder> partial_;   // unset: nothing was written
  std::optional<std::size_t> keyframes_;  // number; unset: not written
  std::optional<double> resolution_m_;    // of the octree; unset: not written
  MapCounts counts_;                      // of the octree
};

}  // namespace roomradar
