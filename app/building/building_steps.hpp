// building_steps.hpp: the steps from recordings to tiles. Each step is one job, which reads and writes files
// and depends only on the files that it reads.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mapping/building/tile_grid.hpp"
#include "mapping/types/pose_origin.hpp"

namespace roomradar {

/// Tracks the camera of one recording. Writes a submap (a map of consecutive frames that were tracked without
/// loss) to out/0, and the submap's features to out/0/features.bin; see load_features(). After each loss of
/// tracking, begins another submap, out/1 and so on; see split_at_losses().
struct TrackStep {
  std::string source;
  PoseOrigin poses = PoseOrigin::kAuto;
  std::filesystem::path out;  ///< folder, which must exist
};
int run(const TrackStep& step);

/// Compares the keyframes of two groups of submaps, or of one group with each other. Writes
/// out/similarity.bin; see load_similarity().
struct RetrieveStep {
  std::vector<std::filesystem::path> a, b;  ///< files of features; b is empty: within a
  std::filesystem::path out;
};
int run(const RetrieveStep& step);
inline constexpr const char* kFeaturesFile = "features.bin";
inline constexpr const char* kSimilarityFile = "similarity.bin";

/// Compares two submaps. Writes out/joins.bin; see load_joins(). The result depends only on these two
/// submaps, so changes of other recordings do not require running the step again.
struct JoinStep {
  std::filesystem::path a, b;  ///< folders of submaps
  std::filesystem::path out;
};
int run(const JoinStep& step);

/// Fuses a recording's frames with their poses in the building, and splits the octree into tiles with margins
/// of kSurfaceReach_voxels. Writes out/parts/TILE.octree for each tile in which the recording has surface.
/// Writes out/margins/TILE.octree for each other tile that the recording saw through, or in whose margin it
/// has surface. Also writes out/keyframes.bin with the recording's placed keyframes at their poses in the
/// building; see write_keyframe_database().
struct FuseStep {
  std::string source;
  std::vector<std::filesystem::path> submaps;  ///< folders
  std::vector<std::filesystem::path> placed;   ///< a file per submap; see save_placed_keyframes()
  TileGrid grid;
  bool remove_ghosts = true;
  std::filesystem::path out;
};
int run(const FuseStep& step);
inline constexpr const char* kPlacedKeyframesFile = "keyframes.bin";

/// Max cells of a tile's unknown space: 2.5 MB of bits, cells of 2 cm in a tile of 5 m.
inline constexpr double kTileUnknownCells = 2e7;

/// Merges the parts of one tile, and extracts its surface and the frontier of its unknown space. Writes
/// out/tile.json. If the tile has surface in its cube, also writes out/tile.octree (the tile's cube),
/// tile.mesh, tile.glb and tile.unknown (the frontier within the cube, closed on all sides).
struct TileStep {
  std::string tile;                          ///< name of the tile
  std::vector<std::filesystem::path> parts;  ///< files, in the order in which they are added
  TileGrid grid;
  double deviation_m = 0.002;
  double unknown_cells = kTileUnknownCells;  ///< max cells of unknown space
  std::filesystem::path out;
};
int run(const TileStep& step);

/// Writes a submap's keyframe poses in the building. Throws Error if the file cannot be written.
void save_placed_keyframes(const std::vector<Eigen::Isometry3d>& T_building_keyframe,
                           const std::filesystem::path& path);
/// Reads the keyframe poses. Throws Error naming the file and the fault if it is missing or damaged.
std::vector<Eigen::Isometry3d> load_placed_keyframes(const std::filesystem::path& path);

}  // namespace roomradar
