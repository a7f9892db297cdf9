// tile_window.cpp: the state of each tile, from the request to the drop.
#include "app/session/tiles/tile_window.hpp"

#include <algorithm>
#include <utility>

#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {
namespace {

bool is_listed(const BuildingInfo& building, const TileIndex& index) {
  const auto found = std::lower_bound(
      building.tiles.begin(), building.tiles.end(), index,
      [](const BuildingTile& tile, const TileIndex& of) { return is_before(tile.index, of); });
  return found != building.tiles.end() && found->index == index;
}

/// Removes the triangles on and beyond those faces of the cube that have a tile behind them.
/// @param cell_m  edge of the cells whose faces form the border
void open_faces(const BuildingInfo& building, const TileIndex& index, double cell_m, Mesh& border) {
  const Eigen::AlignedBox3d cube = box_of(building.grid, index);
  const double slack_m = 0.25 * cell_m;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      if (!is_listed(building, index + side * TileIndex::Unit(axis))) continue;
      const double face_m = (side < 0 ? cube.min() : cube.max())[axis] - border.origin[axis];
      const auto is_beyond = [&](std::uint32_t v) {
        return side * (static_cast<double>(border.vertices[v][axis]) - face_m) > -slack_m;
      };
      std::erase_if(border.triangles,
                    [&](const Triangle& t) { return is_beyond(t[0]) && is_beyond(t[1]) && is_beyond(t[2]); });
    }
}

}  // namespace

LoadedTile load_tile(const BuildingInfo& building, const std::filesystem::path& folder, std::size_t tile,
                     bool has_unknown) {
  const BuildingTile& listed = building.tiles.at(tile);
  LoadedTile loaded;
  loaded.mesh = read_tile_mesh(folder / listed.mesh.name);
  loaded.mesh.normals = {};
  loaded.mesh.colours = {};
  if (has_unknown) {
    loaded.unknown = read_unknown_surface(folder / listed.unknown.name);
    Mesh& border = loaded.unknown.mesh_world;
    open_faces(building, listed.index, loaded.unknown.grid.cell_m, border);
    loaded.unknown_tree.build_by_place(border);
    border = {};
  }
  loaded.tree.build_by_place(loaded.mesh);
  cut_into_pieces(loaded.tree.vertices(), loaded.tree.triangles(), loaded.pieces);
  loaded.pieces.chunked = {};
  loaded.pieces.places = {};
  return loaded;
}

namespace {

constexpr int kMostDropped = 2;  // tiles per frame: freeing a large one takes 2 ms
constexpr double kOverrun_ms = 33.0;
constexpr std::size_t kReserve_bytes = 30'000'000;  // images and buffers that frames still allocate

/// Loads a tile at low priority: frames go first.
LoadedTile load_aside(const TileWindowConfig& config, std::size_t tile) {
  constexpr int kNice = 5;
  lower_priority(0, kNice);
  LoadedTile loaded = load_tile(config.building, config.folder, tile, config.choice.has_unknown);
  release_unused_memory();
  return loaded;
}

}  // namespace

TileWindow::TileWindow(GlContext& context, TileWindowConfig config)
    : context_(context), config_(std::move(config)) {
  require_valid(config_.choice);
  const ConfigCheck require{"tiles"};
  require(config_.apply_after_s >= 0.0 && config_.apply_after_s <= 60.0, "apply_after_s",
          config_.apply_after_s, "in 0..60 s");
  const std::size_t count = config_.building.tiles.size();
  is_loaded_.assign(count, false);
  has_failed_.assign(count, false);
  missed_since_.resize(count);
}

TileWindow::~TileWindow() {
  if (loading_) loading_->done.wait();
}

bool TileWindow::begin_frame(double stamp_s) {
  stamp_s_ = stamp_s;
  const bool has_dropped = drop_unchosen();
  const bool has_taken = take_up_due();
  load_next();
  return has_dropped || has_taken;
}

void TileWindow::follow(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  set_velocity(T_world_camera.translation());
  limit_memory();
  const std::vector<std::size_t> in_view = in_view_of(frame, T_world_camera);
  chosen_ = chosen_at(T_world_camera.translation(), in_view);
  if (chosen_.empty() && !in_view.empty()) tell_too_little_memory(in_view.front());
  std::vector<std::optional<Clock::time_point>> missed_before(missed_since_.size());
  missed_before.swap(missed_since_);
  for (const std::size_t tile : in_view)
    if (!is_loaded_[tile] && !has_failed_[tile])
      missed_since_[tile] = missed_before[tile].value_or(Clock::now());
  load_next();
}

void TileWindow::set_velocity(const Eigen::Vector3d& position_world) {
  constexpr double kMost_mps = 3.0;  // faster motion is a jump, which predicts nothing
  constexpr double kSmoothing_s = 0.5;
  const double dt_s = stamp_s_ - position_stamp_s_;
  if (position_world_ && dt_s > 0.0 && (position_world - *position_world_).norm() < kMost_mps * dt_s) {
    const double part = dt_s / (dt_s + kSmoothing_s);
    velocity_world_mps_ += part * ((position_world - *position_world_) / dt_s - velocity_world_mps_);
  } else {
    velocity_world_mps_.setZero();
  }
  position_world_ = position_world;
  position_stamp_s_ = stamp_s_;
}

/// Sets the choice's memory: the limit less what the process takes without tiles. Later calls only lower it,
/// if the process exceeds the limit.
void TileWindow::limit_memory() {
  if (config_.max_process_bytes == 0) return;
  std::size_t& max_bytes = config_.choice.max_bytes;
  const std::size_t resident = resident_bytes();
  if (max_bytes == 0) {
    const std::size_t others = resident + kReserve_bytes;
    max_bytes = config_.max_process_bytes > others ? config_.max_process_bytes - others : 1;
  } else if (resident > config_.max_process_bytes) {
    max_bytes -= std::min(max_bytes - 1, resident - config_.max_process_bytes);
  }
}

/// Tells once that the limit leaves too little memory for the tile.
void TileWindow::tell_too_little_memory(std::size_t tile) {
  const TileChoiceConfig& choice = config_.choice;
  if (has_told_memory_ || choice.max_bytes == 0 || has_failed_[tile]) return;
  has_told_memory_ = true;
  const BuildingTile& listed = config_.building.tiles[tile];
  const auto mb = [](std::size_t bytes) { return std::to_string((bytes + 999'999) / 1'000'000) + " MB"; };
  fault_ = "--max-memory: " + mb(config_.max_process_bytes) + " leave " + mb(choice.max_bytes) +
           " for tiles, but the one in view takes " +
           mb(tile_bytes(listed, choice.has_unknown) + loading_bytes(listed, choice.has_unknown)) +
           "; the camera is not located there, so allow more";
}

std::vector<std::size_t> TileWindow::in_view_of(const Frame& frame,
                                                const Eigen::Isometry3d& T_world_camera) const {
  constexpr int kAcross = 24;  // points per row and column
  std::vector<Eigen::Vector3d> points_world;
  for (int row = 0; row < kAcross; ++row)
    for (int column = 0; column < kAcross; ++column) {
      const int x = (2 * column + 1) * frame.depth_m.width / (2 * kAcross);
      const int y = (2 * row + 1) * frame.depth_m.height / (2 * kAcross);
      if (frame.depth_m.pixels.empty() || !(frame.depth_m.at(x, y) > 0.0F)) continue;
      points_world.push_back(T_world_camera * back_project(frame.depth_camera, x, y,
                                                           static_cast<double>(frame.depth_m.at(x, y))));
    }
  return tiles_in_view(config_.building, T_world_camera.translation(), points_world);
}

std::vector<std::size_t> TileWindow::chosen_at(const Eigen::Vector3d& position_world,
                                               std::span<const std::size_t> in_view) const {
  std::vector<std::size_t> chosen = choose_tiles(config_.building, position_world, velocity_world_mps_,
                                                 in_view, is_loaded_, config_.choice);
  std::erase_if(chosen, [&](std::size_t tile) { return has_failed_[tile]; });
  return chosen;
}

bool TileWindow::is_ready_for(const Frame& frame, const Eigen::Isometry3d& T_world_camera) const {
  std::vector<std::size_t> needed = in_view_of(frame, T_world_camera);
  const std::vector<std::size_t> chosen = chosen_at(T_world_camera.translation(), needed);
  std::erase_if(needed, [&](std::size_t tile) {
    return std::find(chosen.begin(), chosen.end(), tile) == chosen.end();
  });
  return !needed.empty() &&
         std::all_of(needed.begin(), needed.end(), [&](std::size_t tile) { return is_loaded_[tile]; });
}

bool TileWindow::is_loaded(const Eigen::AlignedBox3d& box_world) const {
  const BuildingInfo& building = config_.building;
  for (std::size_t i = 0; i < building.tiles.size(); ++i)
    if (!is_loaded_[i] && box_of(building.grid, building.tiles[i].index).intersects(box_world)) return false;
  return true;
}

bool TileWindow::is_unknown_at(const Eigen::Vector3d& p_world) const {
  if (!p_world.allFinite()) return true;
  const TileIndex index = tile_at(config_.building.grid, p_world);
  const auto found = std::find_if(tiles_.begin(), tiles_.end(), [&](const auto& tile) {
    return config_.building.tiles[tile->index].index == index;
  });
  return found == tiles_.end() || is_unknown((*found)->unknown, p_world);
}

bool TileWindow::drop_unchosen() {
  const auto begun = Clock::now();
  int dropped = 0;
  std::erase_if(tiles_, [&](const std::unique_ptr<SessionTile>& tile) {
    if (dropped == kMostDropped || std::find(chosen_.begin(), chosen_.end(), tile->index) != chosen_.end())
      return false;
    is_loaded_[tile->index] = false;
    ++dropped;
    return true;
  });
  if (dropped == 0) return false;
  counts_.dropped += dropped;
  counts_.times.add_ms("frame", ms_since(begun));
  return true;
}

bool TileWindow::take_up_due() {
  if (!loading_) return false;
  const bool is_urgent = missed_since_[loading_->tile].has_value();
  if (config_.wait && !is_urgent && stamp_s_ < loading_->due_s) return false;
  if (!config_.wait && loading_->done.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return false;
  const auto begun = Clock::now();
  loading_->done.wait();
  if (config_.wait) counts_.times.add_ms("blocked", ms_since(begun));
  const std::size_t tile = loading_->tile;
  std::future<LoadedTile> done = std::move(loading_->done);
  loading_.reset();
  try {
    take_up(tile, done.get());
  } catch (const Error& fault) {
    has_failed_[tile] = true;
    fault_ =
        std::string(fault.what()) + "; this part of the building is left out, and objects in it do not move";
    return false;
  }
  return true;
}

void TileWindow::take_up(std::size_t tile, LoadedTile loaded) {
  const auto begun = Clock::now();
  auto taken = std::make_unique<SessionTile>(context_, tile);
  taken->pieces = std::move(loaded.pieces);
  taken->unknown = std::move(loaded.unknown);
  taken->unknown_tree = std::move(loaded.unknown_tree);
  taken->shape.set(loaded.mesh, std::move(loaded.tree));
  tiles_.push_back(std::move(taken));
  is_loaded_[tile] = true;
  ++counts_.loaded;
  const auto since = std::exchange(missed_since_[tile], std::nullopt);
  counts_.times.add_ms("late", since ? ms_since(*since) : 0.0);
  const double frame_ms = ms_since(begun);
  counts_.times.add_ms("frame", frame_ms);
  if (frame_ms > kOverrun_ms) ++counts_.frames_over_33_ms;
}

/// Begins to load the nearest chosen tile that is missing. Waits until all tiles that are no longer chosen
/// have been dropped, so that their memory is free.
void TileWindow::load_next() {
  if (loading_) return;
  const bool has_unchosen = std::any_of(tiles_.begin(), tiles_.end(), [&](const auto& tile) {
    return std::find(chosen_.begin(), chosen_.end(), tile->index) == chosen_.end();
  });
  if (has_unchosen) return;
  const auto next = std::find_if(chosen_.begin(), chosen_.end(),
                                 [&](std::size_t tile) { return !is_loaded_[tile] && !has_failed_[tile]; });
  if (next == chosen_.end()) return;
  loading_.emplace(Loading{*next, stamp_s_ + config_.apply_after_s,
                           std::async(std::launch::async, load_aside, std::cref(config_), *next)});
}

}  // namespace roomradar
