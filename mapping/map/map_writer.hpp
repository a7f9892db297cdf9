// map_writer.hpp: saves a map; its octree can be written, and freed, before the rest is ready.
#pragma once
#include <filesystem>
#include <optional>

#include "mapping/map/map_folder.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/lazy_part.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Writes the map to folder.partial-PID, syncs that folder to disk, and renames it to `folder` atomically.
/// Extracts the border of unknown space from map.octree and map.mesh, and writes it to unknown.bin. A texture
/// that does not fit the mesh is left out. Afterwards `folder` is the complete new map or, after an Error,
/// unchanged. Creates parent folders. Throws Error if `folder` exists and is not a map, the map has no
/// surface or too many triangles, or the disk fails.
void save_map(const std::filesystem::path& folder, const SavedMap& map);

/// Same as save_map(), in two steps. Until commit() succeeds, `folder` is unchanged; the destructor then
/// removes what was written.
class MapWriter {
 public:
  /// Writes nothing yet. Throws Error if the name is not usable.
  explicit MapWriter(const std::filesystem::path& folder);

  /// Writes the octree, and the border of unknown space. Call it once, before commit(). Throws Error as
  /// save_map() does.
  void write_octree(const StaticMap& octree, const Mesh& mesh);

  /// Returns the octree that was written. It is read from `folder` when it is first used, after commit().
  [[nodiscard]] LazyPart<StaticMap> written_octree() const;

  /// Writes the other parts, and replaces the folder. Does not use map.octree. Throws Error as save_map()
  /// does.
  void commit(const SavedMap& map);

 private:
  std::filesystem::path target_;
  std::optional<AtomicFolder> partial_;  ///< set by write_octree()
  double resolution_m_ = 0.0;            ///< of the octree
  MapCounts counts_;                     ///< of the octree
};

}  // namespace roomradar
