// tile_passes.cpp: draws M unless cached, then R through M.
#include "radar/batch/tile_passes.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "mapping/types/system/error.hpp"
#include "radar/batch/tile_shaders.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {

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

}  // namespace roomradar
