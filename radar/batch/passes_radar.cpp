// passes_radar.cpp: uploads trees, renders the passes, and leaves the rest to the exact radar.
#include "radar/batch/passes_radar.hpp"

#include <algorithm>
#include <limits>

#include "mapping/types/mesh.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns the contact of an object with two parts of a scene.
Contact nearer_of(const Contact& a, const Contact& b) {
  const auto is_failed = [](const Contact& contact) {
    return contact.status == ContactStatus::kInvalidInput || contact.status == ContactStatus::kNoAnswer;
  };
  if (is_failed(a)) return a;
  if (is_failed(b)) return b;
  const auto distance_m = [](const Contact& contact) {
    return contact ? contact.contact_distance_m : std::numeric_limits<double>::infinity();
  };
  Contact nearer = distance_m(b) < distance_m(a) ? b : a;
  nearer.lower_m = std::min(a.lower_m, b.lower_m);
  nearer.upper_m = std::min(a.upper_m, b.upper_m);
  nearer.pixel_m = a.pixel_m;
  return nearer;
}

}  // namespace

PassesRadar::PassesRadar(GlContext& context, int resolution_px)
    : context_(context), passes_(context, {.resolution_px = resolution_px, .exact_fallback = false}) {}

/// Returns the tree's mesh in OpenGL buffers. Replaces a mesh that the last queries have not used, if there
/// is one.
const GpuMesh& PassesRadar::mesh_of(const TriangleTree& tree) {
  constexpr std::uint64_t kKept_queries = 256;
  Uploaded* place = nullptr;
  for (Uploaded& each : uploaded_) {
    if (each.revision == tree.revision() && each.mesh->tree() == &tree) {
      each.last_query = queries_;
      return *each.mesh;
    }
    if (each.last_query + kKept_queries < queries_ &&
        (place == nullptr || each.last_query < place->last_query))
      place = &each;
  }
  if (place == nullptr)
    place = &uploaded_.emplace_back(Uploaded{.mesh = std::make_unique<GpuMesh>(context_)});
  place->revision = 0;  // in case the upload fails
  Mesh mesh;
  mesh.origin = tree.origin();
  mesh.vertices.assign(tree.vertices().begin(), tree.vertices().end());
  mesh.triangles.assign(tree.triangles().begin(), tree.triangles().end());
  place->mesh->upload(mesh, MeshUsage::kStreamed, tree);
  place->revision = tree.revision();
  place->last_query = queries_;
  uploaded_triangles_ += tree.triangle_count();
  return *place->mesh;
}

Contact PassesRadar::query(const RadarQuery& query, const RadarScene& scene) {
  if (query.margin_m > 0.0 || !scene.depths.empty() || !is_valid(query)) return exact_.query(query, scene);
  try {
    return query_passes(query, scene);
  } catch (const Error&) {  // the renderer is lost or has no memory
    Contact failed;
    failed.status = ContactStatus::kNoAnswer;
    return failed;
  }
}

Contact PassesRadar::query_passes(const RadarQuery& query, const RadarScene& scene) {
  ++queries_;
  meshes_.clear();
  one_sided_.clear();
  for (std::size_t i = 0; i < scene.trees.size(); ++i) {
    const SceneTree& surface = scene.trees[i];
    if (i == query.own_tree || !has_surface(surface)) continue;
    if (is_one_sided(surface.kind))
      one_sided_.push_back(surface);
    else
      meshes_.push_back({{&mesh_of(*surface.instance.tree), surface.instance.T_world_mesh}, surface.kind});
  }
  const GlQuery passes{.object = {&mesh_of(*query.object.tree), query.object.T_world_mesh},
                       .direction_world = query.direction_world,
                       .distance_m = query.distance_m};
  Contact contact;
  passes_.query_all({&passes, 1}, meshes_, {&contact, 1});
  const bool is_doubtful =
      contact.status == ContactStatus::kContact || contact.status == ContactStatus::kNoTarget;
  if (is_doubtful && contact.lower_m < std::min(contact.pixel_m, query.distance_m) &&
      contact.upper_m > contact.lower_m)
    return exact_.query(query, scene);
  if (one_sided_.empty()) return contact;
  RadarQuery of_one_sided = query;
  of_one_sided.own_tree = RadarQuery::kNotInScene;
  return nearer_of(contact, exact_.query(of_one_sided, {one_sided_, {}}));
}

std::unique_ptr<Radar> make_radar(const RadarConfig& config, GlContext& context) {
  require_valid(config);
  if (config.mode == RadarMode::kPasses) return std::make_unique<PassesRadar>(context, config.resolution_px);
  return std::make_unique<CyberRadar>(config);
}

}  // namespace roomradar
