// snapshot.cpp: copies the session's state, and queries the radar for the chosen object.
#include "app/window/link/snapshot.hpp"

#include <algorithm>

#include "app/window/link/player.hpp"
#include "mapping/types/codecs/jpeg.hpp"

namespace roomradar {
namespace {

constexpr double kLooksAhead_m = 0.3;
constexpr int kMostShown_px = 256;   // a pane has no more pixels
constexpr double kMoves_mps = 0.15;  // below this speed the query is along gravity

/// Returns the tree's triangles as a mesh without normals and colours.
Mesh mesh_of(const TriangleTree& tree) {
  Mesh mesh;
  mesh.origin = tree.origin();
  mesh.vertices.assign(tree.vertices().begin(), tree.vertices().end());
  mesh.triangles.assign(tree.triangles().begin(), tree.triangles().end());
  return mesh;
}

/// Adds a tree's triangles to a mesh with an origin of its own.
void add_to(Mesh& mesh, const TriangleTree& tree) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f shift_m = (tree.origin() - mesh.origin).cast<float>();
  for (const Eigen::Vector3f& vertex : tree.vertices()) mesh.vertices.emplace_back(vertex + shift_m);
  for (const Triangle& t : tree.triangles())
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// Returns the surfaces of the loaded tiles, for display.
Mesh mesh_of(const TileWindow& window) {
  Mesh mesh;
  if (!window.tiles().empty()) mesh.origin = window.tiles().front()->shape.touched.origin();
  for (const auto& tile : window.tiles()) add_to(mesh, tile->shape.touched);
  return mesh;
}

}  // namespace

ShownRoom shown_room(const SavedMap& map) {
  const std::shared_ptr<const SurfaceTexture> texture = fitting_texture(map);
  if (!texture) return {.mesh = map.mesh};
  TexturedMesh textured = textured_mesh(map.mesh, *texture);
  return {.mesh = std::move(textured.mesh),
          .texture_points = std::move(textured.texture_points),
          .texture = picture_of_jpeg(texture->atlas_jpeg, texture->width_px, texture->height_px,
                                     "the map's " + std::string(kMapTextureFile))};
}

void SnapshotMaker::fill(const Session& session, const FrameResult& result, const StageTimes& times,
                         const ViewsWanted& wanted, Snapshot& shown) {
  shown.result = result;
  shown.view = session.shown_view();
  shown.picture = session.picture();
  shown.stages_ms.clear();
  times.visit_newest([&](const std::string& stage, std::size_t count, float newest_ms) {
    auto& before = counted_[stage];
    if (count > before) shown.stages_ms.emplace_back(stage, newest_ms);
    before = count;
  });

  shown.objects.clear();
  for (const auto& object : session.objects()) {
    auto& mesh = object_meshes_[object->model];
    if (!mesh) mesh = std::make_shared<const Mesh>(mesh_of(object->model->shape.touched));
    shown.objects.push_back({object->body.name, mesh, object->body.T_world_object,
                             object->model->shape.drawn.bounds(), object->body.velocity_world_mps,
                             object->in_room, object->body.asleep, object->carried_to_world.has_value(),
                             object->placement.stuck, object->body.rests_on, object->body.mass.mass_kg,
                             on_room(object->body.material, session.config().physics)});
  }
  shown.surfaces = session.config().scene.surfaces;
  shown.unknown_is_solid = session.unknown_is_solid();
  shown.radar = session.config().radar;

  const TriangleTree& room = session.room().touched;
  if (room_revision_ != 0 && room_revision_ != room.revision())
    // Changed by a commit: the texture belongs to the saved surface.
    room_ = std::make_shared<const ShownRoom>(ShownRoom{.mesh = mesh_of(room)});
  room_revision_ = room.revision();
  if (session.building() != nullptr && wanted.models) {
    const TileCounts& counts = session.building()->tiles().counts();
    if (std::exchange(tile_changes_, counts.loaded + counts.dropped) != counts.loaded + counts.dropped)
      room_ = std::make_shared<const ShownRoom>(ShownRoom{.mesh = mesh_of(session.building()->tiles())});
  }
  shown.room = room_;
  shown.seen_world = wanted.models ? session.scene().dynamic_world().seen_world : Mesh{};
  shown.inferred_world = wanted.models ? session.scene().dynamic_world().inferred_world : Mesh{};
  shown.pointed_world.reset();
  if (wanted.point_px) {
    const Pointed pointed = pointed_at(session, *wanted.point_px);
    if (const auto& hit = pointed.object ? pointed.object : pointed.surface)
      shown.pointed_world = hit->point_world;
  }
  shown.shown_radar = {};
  if (wanted.radar) fill_radar(session, shown.chosen, shown.shown_radar);
}

void SnapshotMaker::fill_radar(const Session& session, const std::string& chosen, ShownRadar& shown) {
  const VirtualObject* found = find_object(session.objects(), chosen);
  if (found == nullptr || !found->in_room) return;
  const VirtualObject& object = *found;
  const Eigen::Vector3d& velocity = object.body.velocity_world_mps;
  const bool moves = velocity.norm() > kMoves_mps;
  shown.direction_world =
      moves ? velocity.normalized() : session.config().physics.gravity_world_mps2.normalized();
  const RadarQuery query{
      {&object.model->shape.touched, object.body.T_world_object}, shown.direction_world, kLooksAhead_m};
  const std::vector<SceneTree> scene = session.scene_without(&object);
  shown.contact = radar_.query(query, {scene, {}});
  // For a fine mesh the pictures take longer than a frame, so they get at most a tenth of the time.
  const auto begun = std::chrono::steady_clock::now();
  if (begun >= pictures_due_ || pictures_of_ != chosen) {
    const int resolution_px = std::min(session.config().radar.resolution_px, kMostShown_px);
    pictures_ = radar_pictures(query, {scene, {}}, resolution_px);
    pictures_of_ = chosen;
    const auto end = std::chrono::steady_clock::now();
    pictures_due_ = end + 9 * (end - begun);
  }
  shown.pictures = pictures_;
}

}  // namespace roomradar
