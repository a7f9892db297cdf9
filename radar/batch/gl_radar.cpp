// gl_radar.cpp: M unless cached, R through M, the least L of each query, one read-back.
#include "radar/batch/gl_radar.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/batch/tile_shaders.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {
namespace {

constexpr double kMaxDistance_m = 1e4;
constexpr std::size_t kMasksKept = 16;                       // at least, if the atlas may be that large
const Eigen::Vector2d kSample_px(kSampleX_px, kSampleY_px);  // as in tile_shaders.hpp

/// Returns the distance from 0 within which L counts as touching.
double touching_m(const RadarOutline& outline, double distance_m) {
  return 1e-5 + 1e-6 * (outline.length_m + distance_m);
}

bool is_usable(const GlQuery& query) {
  const double norm = query.direction_world.stableNorm();
  return query.direction_world.allFinite() && norm > 0.0 && query.distance_m > 0.0 &&
         query.distance_m <= kMaxDistance_m && query.object.mesh != nullptr &&
         query.object.mesh->triangle_count() > 0 && query.object.T_world_mesh.matrix().allFinite();
}

/// Returns the max error across the direction of the object's vertices in the renderer's floats; same formula
/// as kTileVertexShader.
double vertex_error_px(const GpuMesh& mesh, const RadarOutline& outline) {
  const Eigen::AlignedBox3d bounds = mesh.bounds();
  const Eigen::Vector3d farthest =
      (bounds.min() - mesh.origin()).cwiseAbs().cwiseMax((bounds.max() - mesh.origin()).cwiseAbs());
  const Eigen::Matrix<double, 3, 4> to_outline = outline_from_object(outline).cwiseAbs();
  return 4.3e-7 * (to_outline.leftCols<3>() * farthest + to_outline.col(3)).head<2>().maxCoeff();
}

/// Returns the query data for the shaders, without the keys of its draws.
TileQuery tile_query(const RadarOutline& outline, double distance_m, double tolerance_m,
                     std::array<int, 2> object_corner_px, std::array<int, 2> scene_corner_px) {
  TileQuery tile;
  tile.corners_px = {object_corner_px[0], object_corner_px[1], scene_corner_px[0], scene_corner_px[1]};
  tile.width_px = outline.width_px;
  tile.height_px = outline.height_px;
  tile.touching_m = static_cast<float>(touching_m(outline, distance_m));
  tile.far_m = static_cast<float>(distance_m) + 2.0F * tile.touching_m;
  tile.tolerance_m = static_cast<float>(std::min(tolerance_m, outline.length_m));
  tile.length_m = static_cast<float>(outline.length_m);
  return tile;
}

}  // namespace

void require_valid(const GlRadarConfig& config) {
  const ConfigCheck require{"radar"};
  require(config.resolution_px >= 1 && config.resolution_px <= 4096, "resolution_px", config.resolution_px,
          "in 1..4096");
  require(config.overlap_tolerance_m >= 0.0 && std::isfinite(config.overlap_tolerance_m),
          "overlap_tolerance_m", config.overlap_tolerance_m, ">= 0");
  require(config.atlas_px >= 1 && config.atlas_px <= 16384, "atlas_px", config.atlas_px, "in 1..16384");
}

GlRadar::GlRadar(GlContext& context, const GlRadarConfig& config)
    : config_((require_valid(config), config)),
      object_tiles_(context),
      scene_tiles_(context),
      object_draws_(context),
      scene_draws_(context),
      least_(context, config.minimum == GlMinimum::kOnRenderer ||
                          (config.minimum == GlMinimum::kAuto && !context.is_software())) {
  GLint max_size_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px);
  if (config.resolution_px > max_size_px) {
    throw Error("radar.resolution_px = " + std::to_string(config.resolution_px) + ": " + context.renderer() +
                " draws at most " + std::to_string(max_size_px));
  }
  config_.atlas_px = std::min(std::max(config.atlas_px, config.resolution_px), max_size_px);
  GLint geometry_blocks = 0;
  glGetIntegerv(GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS, &geometry_blocks);
  if (geometry_blocks < 1) {
    throw Error("radar: " + context.renderer() +
                " has no storage blocks in geometry shaders; use the software renderer "
                "(ROOMRADAR_RENDERER=software)");
  }
  clear_program_ = make_program("radar clear", {{GL_VERTEX_SHADER, {kTilePreamble, kClearVertexShader}},
                                                {GL_FRAGMENT_SHADER, {kTilePreamble, kClearFragmentShader}}});
  const auto make_tile_program = [](const char* name, const char* gap, const char* shader) {
    return make_program(
        name, {{GL_VERTEX_SHADER, {kTilePreamble, kTileVertexShader}},
               {GL_GEOMETRY_SHADER, {kTilePreamble, kTileGeometryInputs, kTileGeometryShader}},
               {GL_FRAGMENT_SHADER, {kTilePreamble, kTileFragmentInputs, kSpanSource, gap, shader}}});
  };
  object_program_ = make_tile_program("radar object", "", kObjectTileShader);
  scene_program_ = make_tile_program("radar scene", kGapSource, kSceneTileShader);
  if (!fit_atlases(1)) {
    throw Error("radar: " + context.renderer() + " does not draw into float textures of " +
                std::to_string(config.resolution_px) + " x " + std::to_string(config.resolution_px) +
                " pixels; use fewer or the software renderer (ROOMRADAR_RENDERER=software)");
  }
}

GlRadar::~GlRadar() {
  for (const unsigned program : {clear_program_, object_program_, scene_program_}) glDeleteProgram(program);
}

Contact GlRadar::query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                       std::span<const SceneMesh> scene) {
  const GlQuery query{object, direction_world, distance_m, GlQuery::kNotInScene};
  Contact contact;
  query_all({&query, 1}, scene, {&contact, 1});
  return contact;
}

void GlRadar::query_all(std::span<const GlQuery> queries, std::span<const SceneMesh> scene,
                        std::span<Contact> contacts) {
  assert(contacts.size() == queries.size());
  std::fill(contacts.begin(), contacts.end(), Contact{});
  shown_ = {};
  const auto has_bad_pose = [](const SceneMesh& s) {
    return s.instance.mesh != nullptr && !s.instance.T_world_mesh.matrix().allFinite();
  };
  if (std::any_of(scene.begin(), scene.end(), has_bad_pose)) return;
  forget_gl_errors();
  build(boxes_, scene);
  drawn_.clear();
  reaches_.clear();
  batch_.clear();
  batch_object_draws_.clear();
  batch_scene_draws_.clear();
  const bool is_fit = fit_atlases(queries.size());
  masks_.begin_round();
  least_.begin(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!is_usable(queries[i])) continue;
    if (is_fit && add(i, queries[i], scene, contacts[i])) continue;
    draw_batch();
    if (!is_fit || !add(i, queries[i], scene, contacts[i])) contacts[i].status = ContactStatus::kNoAnswer;
  }
  if (drawn_.empty()) return;
  draw_batch();
  const std::span<const TileResult> results = least_.read(drawn_.size());
  if (results.empty()) {
    masks_.forget();
    object_draws_.forget();
    scene_draws_.forget();
    least_.forget();
  }
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    const std::size_t q = drawn_[i].query;
    if (results.empty()) {
      contacts[q].status = ContactStatus::kNoAnswer;
    } else {
      contacts[q] = contact_of(queries[q], drawn_[i], results[i], scene);
      if (config_.exact_fallback) exact_fallback(queries[q], drawn_[i], scene, contacts[q]);
    }
  }
  TileAtlas::unbind();
}

/// Returns true if there is room for at least one query. Textures that grow lose their contents.
bool GlRadar::fit_atlases(std::size_t queries) {
  const auto side = static_cast<std::size_t>(std::max(config_.atlas_px / config_.resolution_px, 1));
  const auto fit = [&](TileAtlas& atlas, std::size_t tiles) {
    constexpr std::size_t kMostGroups = 255 * 255;  // work groups in one dispatch, one per tile; GL
                                                    // guarantees 65,535
    tiles = std::min({tiles, side * side, kMostGroups});
    if (atlas.tile_count() >= tiles) return false;
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(tiles))));
    const auto rows = (tiles + columns - 1) / columns;
    // A renderer without memory for all tiles may have it for one.
    const bool has_memory =
        atlas.resize(static_cast<int>(columns), static_cast<int>(rows), config_.resolution_px);
    if (!has_memory) (void)atlas.resize(1, 1, config_.resolution_px);
    return true;
  };
  if (fit(object_tiles_, std::max(queries, kMasksKept))) masks_.reset(object_tiles_.tile_count());
  fit(scene_tiles_, queries);
  return object_tiles_.tile_count() > 0 && scene_tiles_.tile_count() > 0;
}

/// Adds a query's draws to the batch; returns false if the batch has no tile left for them.
bool GlRadar::add(std::size_t index, const GlQuery& query, std::span<const SceneMesh> scene,
                  Contact& contact) {
  if (batch_.size() == scene_tiles_.tile_count()) return false;
  const Eigen::Vector3d u_mesh =
      (query.object.T_world_mesh.linear().transpose() * query.direction_world.stableNormalized())
          .normalized();
  const MaskKey key = mask_key(*query.object.mesh, u_mesh);
  std::size_t mask_tile = masks_.find(key);
  if (mask_tile == MaskCache::kNone) {
    mask_tile = masks_.claim(key);
    if (mask_tile == MaskCache::kNone) return false;
    masks_.mask(mask_tile).outline = fit_outline(*query.object.mesh, u_mesh, config_.resolution_px);
  }
  MaskCache::Mask& mask = masks_.mask(mask_tile);
  const RadarOutline& outline = mask.outline;
  const RadarVolume volume = volume_of(outline, query.object, query.distance_m);
  TileQuery tile = tile_query(outline, query.distance_m, config_.overlap_tolerance_m,
                              object_tiles_.corner_px(mask_tile), scene_tiles_.corner_px(batch_.size()));
  tile.query = static_cast<std::int32_t>(drawn_.size());
  tile.margin_px = static_cast<float>(2.0 * vertex_error_px(*query.object.mesh, outline));
  shown_ = {volume, tile, true, false};

  // The padding exceeds the float error of the renderer's own test for outside.
  const double pad_m = touching_m(outline, query.distance_m);
  const Eigen::Vector3d low(-pad_m / outline.pixel_m, -pad_m / outline.pixel_m, -outline.length_m - pad_m);
  const Eigen::Vector3d high(outline.width_px - low.x(), outline.height_px - low.y(),
                             query.distance_m + 2.0 * pad_m);
  Eigen::AlignedBox3d around = volume.bounds_world();
  around.min().array() -= 2.0 * pad_m;
  around.max().array() += 2.0 * pad_m;
  const std::size_t first_reach = reaches_.size();
  std::uint32_t next_key = 0;
  boxes_.visit(around, [&](std::size_t scene_index) {
    if (scene_index == query.own_index) return;
    const MeshInstance& instance = scene[scene_index].instance;
    const Eigen::Matrix<double, 3, 4> to_outline = outline_from_local(outline, query.object, instance);
    const Eigen::Matrix3d reach = to_outline.leftCols<3>().cwiseAbs();
    instance.mesh->visit_runs(
        [&](const Eigen::AlignedBox3d& box) {
          const Eigen::Vector3d centre = to_outline.leftCols<3>() * box.center() + to_outline.col(3);
          const Eigen::Vector3d half = reach * (0.5 * box.sizes());
          return ((centre + half).array() >= low.array()).all() &&
                 ((centre - half).array() <= high.array()).all();
        },
        [&](std::uint32_t first_triangle, std::uint32_t triangle_count) {
          reaches_.push_back({scene_index, first_triangle, next_key});
          TileDraw& draw = batch_scene_draws_.emplace_back();
          draw = {instance.mesh, first_triangle, triangle_count, to_outline.cast<float>(), tile};
          draw.query.first_key = next_key;
          next_key += triangle_count;
        });
  });
  if (reaches_.size() == first_reach) {
    contact.status = ContactStatus::kNoTarget;
    contact.lower_m = query.distance_m;
    contact.pixel_m = outline.pixel_m;
    return true;
  }
  if (!mask.is_drawn) {
    mask.is_drawn = true;
    batch_object_draws_.push_back({query.object.mesh, 0,
                                   static_cast<std::uint32_t>(query.object.mesh->triangle_count()),
                                   outline_from_object(outline).cast<float>(), tile});
  }
  shown_.is_drawn = true;
  batch_.push_back(tile);
  drawn_.push_back({index, outline, first_reach, reaches_.size() - first_reach});
  return true;
}

/// Draws both passes for the queries of the batch, and reduces their tiles.
void GlRadar::draw_batch() {
  if (!batch_.empty()) {
    const auto use = [](unsigned program, const TileAtlas& atlas) {
      glUseProgram(program);
      glUniform2f(0, 2.0F / static_cast<float>(atlas.width_px()),
                  2.0F / static_cast<float>(atlas.height_px()));
    };
    if (!batch_object_draws_.empty()) {
      object_draws_.upload(batch_object_draws_);
      object_tiles_.bind(false);
      use(clear_program_, object_tiles_);
      object_draws_.draw_rectangles();
      object_tiles_.bind(true);
      use(object_program_, object_tiles_);
      glUniform1i(1, 0);
      object_draws_.draw();
    }
    scene_draws_.upload(batch_scene_draws_);
    scene_tiles_.bind(true);
    scene_tiles_.clear(batch_.size(), kClearValue);
    use(scene_program_, scene_tiles_);
    glUniform1i(1, 1);
    glBindTextureUnit(0, object_tiles_.texture());
    scene_draws_.draw();
    least_.reduce(batch_, scene_tiles_);
    least_.find_keys(scene_draws_, object_tiles_);
  }
  batch_.clear();
  batch_object_draws_.clear();
  batch_scene_draws_.clear();
  masks_.begin_round();
}

Contact GlRadar::contact_of(const GlQuery& query, const Drawn& drawn, const TileResult& result,
                            std::span<const SceneMesh> scene) const {
  const RadarOutline& outline = drawn.outline;
  const double touching = touching_m(outline, query.distance_m);
  Contact contact;
  contact.pixel_m = outline.pixel_m;
  constexpr double kSubtraction = 1.0 - 2e-7;  // rounding of the z of scene and object to float
  contact.lower_m = std::min(kSubtraction * result.lower_m, query.distance_m);
  if (!(result.contact_distance_m <= query.distance_m + touching)) {
    contact.status = ContactStatus::kNoTarget;
    return contact;
  }
  if (result.contact_distance_m < -touching) {
    contact.status = ContactStatus::kOverlap;
    contact.contact_distance_m = contact.lower_m = contact.upper_m = result.contact_distance_m;
  } else {
    contact.status = ContactStatus::kContact;
    contact.contact_distance_m = std::max(static_cast<double>(result.contact_distance_m), 0.0);
    contact.lower_m = std::min(contact.lower_m, contact.contact_distance_m);
    contact.upper_m =
        std::max(static_cast<double>(result.upper_m) / kSubtraction, contact.contact_distance_m);
  }

  // The touched triangle at the pixel's centre line, in double.
  const RadarVolume volume = volume_of(outline, query.object, query.distance_m);
  contact.normal_world = -volume.u_world;
  Eigen::Vector3d at(result.x_px + kSample_px.x(), result.y_px + kSample_px.y(), result.contact_distance_m);
  const auto reaches = std::span(reaches_).subspan(drawn.first_reach, drawn.reach_count);
  const auto past =
      std::upper_bound(reaches.begin(), reaches.end(), result.key,
                       [](std::uint32_t key, const Reach& reach) { return key < reach.first_key; });
  if (result.key != std::numeric_limits<std::uint32_t>::max() && past != reaches.begin()) {
    const Reach& reach = *(past - 1);
    const SceneMesh& met = scene[reach.scene_index];
    const GpuMesh& mesh = *met.instance.mesh;
    const Triangle& triangle = mesh.triangles()[reach.first_triangle + (result.key - reach.first_key)];
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.vertices()[triangle[i]].cast<double>();
    const Eigen::Vector3d normal_local = (p[1] - p[0]).cross(p[2] - p[0]);
    const Eigen::Matrix<double, 3, 4> to_outline = outline_from_local(outline, query.object, met.instance);
    for (Eigen::Vector3d& corner : p) corner = to_outline.leftCols<3>() * corner + to_outline.col(3);
    const Eigen::Vector3d normal_outline = (p[1] - p[0]).cross(p[2] - p[0]);
    at.z() = p[0].z() - normal_outline.head<2>().dot(at.head<2>() - p[0].head<2>()) / normal_outline.z();
    contact.normal_world = (met.instance.T_world_mesh.linear() * normal_local).stableNormalized();
    if (contact.normal_world.dot(volume.u_world) > 0.0) contact.normal_world = -contact.normal_world;
    contact.touched = met.kind;
  }
  contact.point_world = volume.origin_world + at.x() * outline.pixel_m * volume.x_world +
                        at.y() * outline.pixel_m * volume.y_world +
                        (at.z() + outline.length_m) * volume.u_world;
  return contact;
}

/// Runs the exact test if scene is in the same pixel as the object, neither ahead nor behind.
void GlRadar::exact_fallback(const GlQuery& query, const Drawn& drawn, std::span<const SceneMesh> scene,
                             Contact& contact) {
  const bool is_doubtful = contact.status == ContactStatus::kNoTarget ||
                           (contact.status == ContactStatus::kContact && contact.contact_distance_m > 0.0);
  if (!is_doubtful || contact.lower_m > 0.0 || query.object.mesh->tree() == nullptr) return;
  exact_trees_.clear();
  std::size_t last_index = GlQuery::kNotInScene;
  for (const Reach& reach : std::span(reaches_).subspan(drawn.first_reach, drawn.reach_count)) {
    if (reach.scene_index == last_index) continue;  // another run of the same mesh
    last_index = reach.scene_index;
    const SceneMesh& s = scene[last_index];
    if (s.instance.mesh->tree() == nullptr) return;
    exact_trees_.push_back({{s.instance.mesh->tree(), s.instance.T_world_mesh}, s.kind});
  }
  const Contact exact = exact_radar_.query({.object = {query.object.mesh->tree(), query.object.T_world_mesh},
                                            .direction_world = query.direction_world,
                                            .distance_m = query.distance_m},
                                           {exact_trees_, {}});
  if (exact.status == ContactStatus::kInvalidInput || exact.status == ContactStatus::kNoAnswer) return;
  const double pixel_m = contact.pixel_m;
  contact = exact;
  contact.pixel_m = pixel_m;
}

RadarPictures GlRadar::pictures() const {
  RadarPictures result;
  if (!shown_.is_valid) return result;
  result.volume = shown_.volume;
  const TileQuery& tile = shown_.tile;
  const auto depth_m = static_cast<float>(shown_.volume.depth_m);
  result.range_m.resize(tile.width_px, tile.height_px, depth_m);
  result.mask_m.resize(tile.width_px, tile.height_px, depth_m);
  result.lookat_m.resize(tile.width_px, tile.height_px, std::numeric_limits<float>::quiet_NaN());
  if (!shown_.is_drawn) return result;
  const std::size_t count = result.mask_m.pixels.size();
  std::vector<float> object(4 * count, kClearValue), gap(4 * count, kClearValue);
  object_tiles_.read(tile.corners_px[0], tile.corners_px[1], tile.width_px, tile.height_px, object.data());
  scene_tiles_.read(tile.corners_px[2], tile.corners_px[3], tile.width_px, tile.height_px, gap.data());
  const auto distance_m = static_cast<float>(shown_.volume.depth_m - shown_.volume.length_m);
  for (std::size_t i = 0; i < count; ++i) {
    const float front_m = -object[4 * i + 1];
    const float gap_m = gap[4 * i + 2];
    if (-front_m < kNothingMet) result.mask_m.pixels[i] = distance_m - front_m;
    if (gap_m >= kNothingMet) continue;
    result.lookat_m.pixels[i] = gap_m;
    result.range_m.pixels[i] = gap_m + front_m + tile.length_m;
  }
  return result;
}

}  // namespace roomradar
