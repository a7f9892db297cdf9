// least_gap.cpp: minimum by a compute shader or the same loop on the CPU, then one copy back.
#include "radar/batch/least_gap.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "radar/batch/tile_shaders.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {
namespace {

constexpr GLuint kQueriesBinding = 0, kResultsBinding = 1;
constexpr GLuint64 kPatience_ns = 5'000'000'000;  // a slower renderer counts as lost

}  // namespace

LeastGap::LeastGap(GlContext& /*context*/, bool on_renderer) : on_renderer_(on_renderer) {
  static_assert(sizeof(TileQuery) == 64 && sizeof(TileResult) == 32, "as the shaders lay them out");
  if (on_renderer_) {
    least_program_ = make_program("radar least", {{GL_COMPUTE_SHADER, {kTilePreamble, kLeastShader}}});
  }
  which_program_ = make_program(
      "radar which",
      {{GL_VERTEX_SHADER, {kTilePreamble, kTileVertexShader}},
       {GL_GEOMETRY_SHADER, {kTilePreamble, kTileGeometryInputs, kSpanSource, kGapSource, kWhichShader}}});
  glCreateBuffers(1, &queries_buffer_);
}

LeastGap::~LeastGap() {
  for (const GLuint buffer : {queries_buffer_, results_buffer_, host_buffer_}) glDeleteBuffers(1, &buffer);
  glDeleteProgram(which_program_);
  glDeleteProgram(least_program_);
}

void LeastGap::begin(std::size_t queries) {
  ++stamp_;
  if (queries <= results_capacity_) return;
  results_capacity_ = queries + queries / 2;
  const auto size_bytes = static_cast<GLsizeiptr>(results_capacity_ * sizeof(TileResult));
  for (GLuint* buffer : {&results_buffer_, &host_buffer_}) {
    glDeleteBuffers(1, buffer);
    glCreateBuffers(1, buffer);
  }
  glNamedBufferStorage(results_buffer_, size_bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
  constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glNamedBufferStorage(host_buffer_, size_bytes, nullptr, kMapping | GL_CLIENT_STORAGE_BIT);
  host_results_ =
      static_cast<const TileResult*>(glMapNamedBufferRange(host_buffer_, 0, size_bytes, kMapping));
  if (host_results_ == nullptr) results_capacity_ = 0;  // try again next time
}

void LeastGap::reduce(std::span<const TileQuery> queries, const TileAtlas& scene_tiles) {
  if (queries.empty() || host_results_ == nullptr) return;
  if (!on_renderer_) {
    int rows_px = 0;
    for (const TileQuery& query : queries) rows_px = std::max(rows_px, query.corners_px[3] + query.height_px);
    const auto row_pixels = static_cast<std::size_t>(scene_tiles.width_px());
    pixels_.resize(4 * row_pixels * static_cast<std::size_t>(rows_px));
    scene_tiles.read(0, 0, scene_tiles.width_px(), rows_px, pixels_.data());
    for (const TileQuery& query : queries) {
      const TileResult result = least_of(query, pixels_.data(), row_pixels);
      glNamedBufferSubData(results_buffer_,
                           static_cast<GLintptr>(static_cast<std::size_t>(query.query) * sizeof(TileResult)),
                           sizeof(TileResult), &result);
    }
    return;
  }
  if (queries.size() > queries_capacity_) {
    queries_capacity_ = queries.size() + queries.size() / 2;
    glNamedBufferData(queries_buffer_, static_cast<GLsizeiptr>(queries_capacity_ * sizeof(TileQuery)),
                      nullptr, GL_STREAM_DRAW);
  }
  glInvalidateBufferData(queries_buffer_);
  glNamedBufferSubData(queries_buffer_, 0, static_cast<GLsizeiptr>(queries.size_bytes()), queries.data());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kQueriesBinding, queries_buffer_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kResultsBinding, results_buffer_);
  glBindTextureUnit(0, scene_tiles.texture());
  glUseProgram(least_program_);
  glUniform1ui(0, stamp_);
  glDispatchCompute(static_cast<GLuint>(queries.size()), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LeastGap::find_keys(const TileDraws& draws, const TileAtlas& object_tiles) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kResultsBinding, results_buffer_);
  glBindTextureUnit(0, object_tiles.texture());
  glUseProgram(which_program_);
  glEnable(GL_RASTERIZER_DISCARD);
  draws.draw();
  glDisable(GL_RASTERIZER_DISCARD);
}

std::span<const TileResult> LeastGap::read(std::size_t count) {
  if (host_results_ == nullptr) return {};
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(results_buffer_, host_buffer_, 0, 0,
                           static_cast<GLsizeiptr>(count * sizeof(TileResult)));
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  const GLsync done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  const GLenum waited = glClientWaitSync(done, GL_SYNC_FLUSH_COMMANDS_BIT, kPatience_ns);
  glDeleteSync(done);
  const bool is_done = (waited == GL_ALREADY_SIGNALED || waited == GL_CONDITION_SATISFIED) &&
                       glGetGraphicsResetStatus() == GL_NO_ERROR &&
                       glGetError() == GL_NO_ERROR;  // out of memory while drawing
  // Without a context all of the above does nothing and returns 0; stamps distinguish old results from new.
  const std::span<const TileResult> results(host_results_, is_done ? count : 0);
  const bool are_new = std::all_of(results.begin(), results.end(),
                                   [&](const TileResult& result) { return result.stamp == stamp_; });
  return are_new ? results : std::span<const TileResult>{};
}

/// Same as kLeastShader.
TileResult LeastGap::least_of(const TileQuery& query, const float* pixels, std::size_t row_pixels) const {
  TileResult result{
      stamp_, kClearValue, kClearValue, kClearValue, -1, -1, std::numeric_limits<std::uint32_t>::max(), 0};
  const auto at = [&](int x, int y) {
    return pixels + 4 * (static_cast<std::size_t>(query.corners_px[3] + y) * row_pixels +
                         static_cast<std::size_t>(query.corners_px[2] + x));
  };
  for (int y = 0; y < query.height_px; ++y) {
    for (int x = 0; x < query.width_px; ++x) {
      const float* pixel = at(x, y);
      result.lower_m = std::min(result.lower_m, pixel[0]);
      result.upper_m = std::min(result.upper_m, pixel[1]);
      result.contact_distance_m = std::min(result.contact_distance_m, pixel[2]);
    }
  }
  if (!(result.contact_distance_m < kNothingMet)) return result;
  const float equal_m = result.contact_distance_m + query.touching_m;
  int x_min = query.width_px, x_max = -1, y_min = query.height_px, y_max = -1;
  for (int y = 0; y < query.height_px; ++y) {
    for (int x = 0; x < query.width_px; ++x) {
      if (at(x, y)[2] > equal_m) continue;
      x_min = std::min(x_min, x);
      x_max = std::max(x_max, x);
      y_min = std::min(y_min, y);
      y_max = std::max(y_max, y);
    }
  }
  int least_off = std::numeric_limits<int>::max();
  for (int y = y_min; y <= y_max; ++y) {
    for (int x = x_min; x <= x_max; ++x) {
      const int dx = 2 * x - x_min - x_max, dy = 2 * y - y_min - y_max;
      if (at(x, y)[2] > equal_m || dx * dx + dy * dy >= least_off) continue;
      least_off = dx * dx + dy * dy;
      result.x_px = x;
      result.y_px = y;
    }
  }
  return result;
}

}  // namespace roomradar
