// gl_radar.cpp: draws M unless cached, then R through M, finds the least L of each query, and reads back
// once.
#include "radar/batch/gl_radar.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/batch/tile_shaders.hpp"
#include "radar/exact/radar_pictures.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {

void require_valid(const GlRadarConfig& config) {
  const ConfigCheck require{"radar"};
  require(config.resolution_px >= 1 && config.resolution_px <= 4096, "resolution_px", config.resolution_px,
          "in 1..4096");
  require(config.overlap_tolerance_m >= 0.0 && std::isfinite(config.overlap_tolerance_m),
          "overlap_tolerance_m", config.overlap_tolerance_m, ">= 0");
  require(config.atlas_px >= 1 && config.atlas_px <= 16384, "atlas_px", config.atlas_px, "in 1..16384");
}

bool is_usable(const GlQuery& query) {
  constexpr double kMaxDistance_m = 1e4;
  const double norm = query.direction_world.stableNorm();
  return query.direction_world.allFinite() && norm > 0.0 && query.distance_m > 0.0 &&
         query.distance_m <= kMaxDistance_m && query.object.mesh != nullptr &&
         query.object.mesh->triangle_count() > 0 && query.object.T_world_mesh.matrix().allFinite();
}

namespace {

const Eigen::Vector2d kSample_px(kSampleX_px, kSampleY_px);  // as in tile_shaders.hpp

}  // namespace

Contact contact_of(const GlQuery& query, const RadarOutline& outline, const TileResult& result,
                   std::span<const SceneRun> runs, std::span<const GpuSceneMesh> scene) {
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
  const auto past =
      std::upper_bound(runs.begin(), runs.end(), result.key,
                       [](std::uint32_t key, const SceneRun& run) { return key < run.first_key; });
  if (result.key != std::numeric_limits<std::uint32_t>::max() && past != runs.begin()) {
    const SceneRun& run = *(past - 1);
    const GpuSceneMesh& met = scene[run.scene_index];
    const GpuMesh& mesh = *met.instance.mesh;
    const Triangle& triangle = mesh.triangles()[run.first_triangle + (result.key - run.first_key)];
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

void TileBatch::clear() {
  queries.clear();
  object_draws.clear();
  scene_draws.clear();
}

TilePasses::TilePasses(GlContext& context) : object_(context), scene_(context) {
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
  object_.program = make_tile_program("radar object", "", kObjectTileShader);
  scene_.program = make_tile_program("radar scene", kGapSource, kSceneTileShader);
}

TilePasses::~TilePasses() {
  for (const unsigned program : {clear_program_, object_.program, scene_.program}) glDeleteProgram(program);
}

void TilePasses::forget() {
  object_.draws.forget();
  scene_.draws.forget();
}

void TilePasses::draw(TileBatch& batch, LeastGap& least) {
  const auto use = [](unsigned program, const TileAtlas& atlas) {
    glUseProgram(program);
    glUniform2f(0, 2.0F / static_cast<float>(atlas.width_px()), 2.0F / static_cast<float>(atlas.height_px()));
  };
  if (!batch.object_draws.empty()) {
    object_.draws.upload(batch.object_draws);
    object_.tiles.bind(false);
    use(clear_program_, object_.tiles);
    object_.draws.draw_rectangles();
    object_.tiles.bind(true);
    use(object_.program, object_.tiles);
    glUniform1i(1, 0);
    object_.draws.draw();
  }
  scene_.draws.upload(batch.scene_draws);
  scene_.tiles.bind(true);
  scene_.tiles.clear(batch.queries.size(), kClearValue);
  use(scene_.program, scene_.tiles);
  glUniform1i(1, 1);
  glBindTextureUnit(0, object_.tiles.texture());
  scene_.draws.draw();
  least.reduce(batch.queries, scene_.tiles);
  least.find_keys(scene_.draws, object_.tiles);
}

namespace {

constexpr std::size_t kMasksKept = 16;  // at least, if the atlas may be that large

/// Returns the config with an atlas_px that the renderer can draw. Throws Error if the config is invalid or
/// the renderer cannot draw resolution_px.
GlRadarConfig within_limits(GlRadarConfig config, const GlContext& context) {
  require_valid(config);
  GLint max_size_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px);
  if (config.resolution_px > max_size_px) {
    throw Error("radar.resolution_px = " + std::to_string(config.resolution_px) + ": " + context.renderer() +
                " draws at most " + std::to_string(max_size_px));
  }
  config.atlas_px = std::min(std::max(config.atlas_px, config.resolution_px), max_size_px);
  return config;
}

}  // namespace

GlRadar::GlRadar(GlContext& context, const GlRadarConfig& config)
    : config_(within_limits(config, context)),
      passes_(context),
      least_(context, config.minimum == GlMinimum::kOnRenderer ||
                          (config.minimum == GlMinimum::kAuto && !context.is_software())) {
  if (!fit_atlases(1)) {
    throw Error("radar: " + context.renderer() + " does not draw into float textures of " +
                std::to_string(config.resolution_px) + " x " + std::to_string(config.resolution_px) +
                " pixels; use fewer or the software renderer (ROOMRADAR_RENDERER=software)");
  }
}

Contact GlRadar::query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                       std::span<const GpuSceneMesh> scene) {
  const GlQuery query{object, direction_world, distance_m, GlQuery::kNotInScene};
  Contact contact;
  query_all({&query, 1}, scene, {&contact, 1});
  return contact;
}

void GlRadar::query_all(std::span<const GlQuery> queries, std::span<const GpuSceneMesh> scene,
                        std::span<Contact> contacts) {
  assert(contacts.size() == queries.size());
  std::fill(contacts.begin(), contacts.end(), Contact{});
  shown_ = {};
  const auto has_bad_pose = [](const GpuSceneMesh& s) {
    return s.instance.mesh != nullptr && !s.instance.T_world_mesh.matrix().allFinite();
  };
  if (std::any_of(scene.begin(), scene.end(), has_bad_pose)) return;
  forget_gl_errors();
  build(boxes_, scene);
  drawn_.clear();
  runs_.clear();
  batch_.clear();
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
    passes_.forget();
    least_.forget();
  }
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    const std::size_t q = drawn_[i].query;
    if (results.empty()) {
      contacts[q].status = ContactStatus::kNoAnswer;
    } else {
      contacts[q] = contact_of(queries[q], drawn_[i].outline, results[i], runs_of(drawn_[i]), scene);
      if (config_.exact_fallback) exact_fallback(queries[q], drawn_[i], scene, contacts[q]);
    }
  }
  TileAtlas::unbind();
}

/// Returns true if there is room for at least one query. Textures that grow lose their contents.
bool GlRadar::fit_atlases(std::size_t queries) {
  const auto side = static_cast<std::size_t>(std::max(config_.atlas_px / config_.resolution_px, 1));
  const auto fit = [&](TileAtlas& atlas, std::size_t tiles) {
    // Work groups in one dispatch, one per tile; GL guarantees 65,535.
    constexpr std::size_t kMostGroups = 255 * 255;
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
  if (fit(passes_.object_tiles(), std::max(queries, kMasksKept)))
    masks_.reset(passes_.object_tiles().tile_count());
  fit(passes_.scene_tiles(), queries);
  return passes_.object_tiles().tile_count() > 0 && passes_.scene_tiles().tile_count() > 0;
}

/// Adds a query's draws to the batch; returns false if the batch has no tile left for them.
bool GlRadar::add(std::size_t index, const GlQuery& query, std::span<const GpuSceneMesh> scene,
                  Contact& contact) {
  if (batch_.queries.size() == passes_.scene_tiles().tile_count()) return false;
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
                              passes_.object_tiles().corner_px(mask_tile),
                              passes_.scene_tiles().corner_px(batch_.queries.size()));
  tile.query = static_cast<std::int32_t>(drawn_.size());
  tile.margin_px = static_cast<float>(2.0 * vertex_error_px(*query.object.mesh, outline));
  shown_ = {volume, tile, true, false};

  const std::size_t first_run = runs_.size();
  add_scene_draws(query, outline, volume, tile, scene);
  if (runs_.size() == first_run) {
    contact.status = ContactStatus::kNoTarget;
    contact.lower_m = query.distance_m;
    contact.pixel_m = outline.pixel_m;
    return true;
  }
  if (!mask.is_drawn) {
    mask.is_drawn = true;
    batch_.object_draws.push_back({query.object.mesh, 0,
                                   static_cast<std::uint32_t>(query.object.mesh->triangle_count()),
                                   outline_from_object(outline).cast<float>(), tile});
  }
  shown_.is_drawn = true;
  batch_.queries.push_back(tile);
  drawn_.push_back({index, outline, first_run, runs_.size() - first_run});
  return true;
}

/// Adds a draw for each run of scene triangles that reaches the query's volume.
void GlRadar::add_scene_draws(const GlQuery& query, const RadarOutline& outline, const RadarVolume& volume,
                              const TileQuery& tile, std::span<const GpuSceneMesh> scene) {
  // The padding exceeds the float error of the renderer's own test for outside.
  const double pad_m = touching_m(outline, query.distance_m);
  const Eigen::Vector3d low(-pad_m / outline.pixel_m, -pad_m / outline.pixel_m, -outline.length_m - pad_m);
  const Eigen::Vector3d high(outline.width_px - low.x(), outline.height_px - low.y(),
                             query.distance_m + 2.0 * pad_m);
  Eigen::AlignedBox3d around = volume.bounds_world();
  around.min().array() -= 2.0 * pad_m;
  around.max().array() += 2.0 * pad_m;
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
          runs_.push_back({scene_index, first_triangle, next_key});
          TileDraw& draw = batch_.scene_draws.emplace_back();
          draw = {instance.mesh, first_triangle, triangle_count, to_outline.cast<float>(), tile};
          draw.query.first_key = next_key;
          next_key += triangle_count;
        });
  });
}

/// Draws the queries of the batch, and begins another.
void GlRadar::draw_batch() {
  if (!batch_.queries.empty()) passes_.draw(batch_, least_);
  batch_.clear();
  masks_.begin_round();
}

std::span<const SceneRun> GlRadar::runs_of(const Drawn& drawn) const {
  return std::span(runs_).subspan(drawn.first_run, drawn.run_count);
}

/// Runs the exact test if a pixel contains scene that is neither ahead of the object nor behind it.
void GlRadar::exact_fallback(const GlQuery& query, const Drawn& drawn, std::span<const GpuSceneMesh> scene,
                             Contact& contact) {
  const bool is_doubtful = contact.status == ContactStatus::kNoTarget ||
                           (contact.status == ContactStatus::kContact && contact.contact_distance_m > 0.0);
  if (!is_doubtful || contact.lower_m > 0.0 || query.object.mesh->tree() == nullptr) return;
  exact_trees_.clear();
  std::size_t last_index = GlQuery::kNotInScene;
  for (const SceneRun& run : runs_of(drawn)) {
    if (run.scene_index == last_index) continue;  // another run of the same mesh
    last_index = run.scene_index;
    const GpuSceneMesh& s = scene[last_index];
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
  passes_.object_tiles().read(tile.corners_px[0], tile.corners_px[1], tile.width_px, tile.height_px,
                              object.data());
  passes_.scene_tiles().read(tile.corners_px[2], tile.corners_px[3], tile.width_px, tile.height_px,
                             gap.data());
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
