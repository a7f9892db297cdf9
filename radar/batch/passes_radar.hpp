// passes_radar.hpp: the two depth passes of Cyber Radar for scenes of triangle trees.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "radar/batch/gl_radar.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/exact/radar.hpp"

namespace roomradar {

/// Answers queries with GlRadar: R and M are rendered, L is their gap per pixel. lower_m and upper_m bound
/// the true distance, so objects that move by lower_m never pass a surface. Trees are uploaded when a query
/// first sees them.
///
/// CyberRadar answers what the passes cannot: queries with a margin, scenes with depth images, one-sided
/// surfaces (is_one_sided()), and queries whose lower_m is less than a pixel, where the passes cannot tell a
/// surface ahead from one beside the object. So an object comes to rest where it does with the exact radar.
/// Returns kNoAnswer if the renderer fails. Not thread safe: call all functions, and the constructor, on the
/// thread of the context.
class PassesRadar final : public Radar {
 public:
  /// @param context  must outlive the radar
  /// @param resolution_px  see GlRadarConfig
  /// @throws Error if resolution_px is not in 1..4096 or the renderer lacks a required feature
  PassesRadar(GlContext& context, int resolution_px);

  Contact query(const RadarQuery& query, const RadarScene& scene) override;
  /// Returns the number of triangles uploaded since construction.
  [[nodiscard]] std::uint64_t uploaded_triangles() const { return uploaded_triangles_; }

 private:
  struct Uploaded {
    std::uint64_t revision = 0;  ///< of the tree
    std::uint64_t last_query = 0;
    std::unique_ptr<GpuMesh> mesh;
  };
  GlContext& context_;
  GlRadar passes_;
  CyberRadar exact_;
  std::vector<Uploaded> uploaded_;
  std::uint64_t queries_ = 0, uploaded_triangles_ = 0;
  // Scratch memory of one query.
  std::vector<GpuSceneMesh> meshes_;
  std::vector<SceneTree> one_sided_;

  const GpuMesh& mesh_of(const TriangleTree& tree);
  Contact query_passes(const RadarQuery& query, const RadarScene& scene);
};

/// Returns the radar that config.mode names. `context` is used by RadarMode::kPasses only, and must outlive
/// the radar.
/// @throws Error as the radars' constructors do
std::unique_ptr<Radar> make_radar(const RadarConfig& config, GlContext& context);

}  // namespace roomradar
