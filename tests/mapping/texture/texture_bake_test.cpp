// texture_bake_test.cpp: a baked wall has the wall's colours; exposure, poses and moved things are corrected.
#include "mapping/texture/texture_bake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "mapping/texture/exposure_gains.hpp"
#include "mapping/texture/view_alignment.hpp"
#include "mapping/texture/view_selection.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "tests/mapping/texture/texture_scene.hpp"

namespace roomradar::texture_bake_test {
namespace {

using test::wall_frame;
using test::wall_grey;
using test::wall_mesh;
using test::wall_poses;
using test::wall_scene;

std::vector<TextureView> wall_views(const Mesh& mesh, double gain_step = 1.0) {
  std::vector<TextureView> views;
  double gain = 1.0;
  for (const Eigen::Isometry3d& T_world_camera : wall_poses()) {
    views.push_back(
        make_texture_view(wall_frame(wall_scene(), T_world_camera, gain), T_world_camera, mesh, 0.0));
    gain *= gain_step;
  }
  return views;
}

/// Median difference of the texture from the wall's pattern, at points of the mesh within `reach_m` of its
/// middle.
double error_of(const Mesh& mesh, const SurfaceTexture& texture, float reach_m = 0.5F) {
  const ColourImage atlas = picture_of_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, "atlas");
  std::vector<double> differences;
  for (const MeshPoint& point : sample_mesh(mesh, 2000)) {
    if (point.p_local.cwiseAbs().maxCoeff() > reach_m) continue;
    Eigen::Array2f p = Eigen::Array2f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const AtlasPoint& corner = texture.corners[point.triangle][k];
      p += point.weights[static_cast<Eigen::Index>(k)] * Eigen::Array2f(corner[0], corner[1]) / 65535.0F;
    }
    const Rgb texel = atlas.at(static_cast<int>(p.x() * static_cast<float>(atlas.width)),
                               static_cast<int>(p.y() * static_cast<float>(atlas.height)));
    differences.push_back(
        std::abs(static_cast<double>(texel.g) - wall_grey(mesh.origin + point.p_local.cast<double>())));
  }
  std::nth_element(differences.begin(), differences.begin() + differences.size() / 2, differences.end());
  return differences[differences.size() / 2];
}

TEST(TextureBake, TheTextureHasTheSurfacesColours) {
  const Mesh mesh = wall_mesh();
  const SurfaceTexture texture = bake_texture(mesh, wall_views(mesh));
  ASSERT_TRUE(fits(texture, mesh));
  EXPECT_LT(error_of(mesh, texture), 2.5);
  // About a texel per pixel of the best view: 290 px at 1.2 m is 240 per metre.
  EXPECT_GT(texture.width_px * texture.height_px, 1.2 * 1.2 * 200 * 200);
  EXPECT_LT(texture.width_px * texture.height_px, 1.2 * 1.2 * 600 * 600);
}

TEST(TextureBake, TheSameViewsGiveTheSameTexture) {
  const Mesh mesh = wall_mesh();
  const std::vector<TextureView> views = wall_views(mesh);
  const SurfaceTexture first = bake_texture(mesh, views), second = bake_texture(mesh, views);
  EXPECT_EQ(first.atlas_jpeg, second.atlas_jpeg);
  EXPECT_EQ(first.corners, second.corners);
}

TEST(TextureBake, ExposureIsEvened) {
  const Mesh mesh = wall_mesh();
  std::vector<TextureView> views = wall_views(mesh, 0.8);
  even_exposure(mesh, views);
  for (std::size_t v = 1; v < views.size(); ++v)
    EXPECT_NEAR(views[v].gain[1] / views[v - 1].gain[1], 1.25F, 0.03F) << v;
  // The mean of the exposures is kept: 0.8^1.5.
  const Mesh& reference = mesh;
  for (TextureView& view : views)
    for (float& gain : view.gain) gain /= std::pow(0.8F, 1.5F);
  EXPECT_LT(error_of(reference, bake_texture(mesh, views)), 4.0);
}

TEST(TextureBake, AViewThatSeesSomethingElseIsLeftOutThere) {
  const Mesh mesh = wall_mesh();
  // In the best view, a box stands before the wall; its frame measures the box.
  const test::Scene with_box = test::nearest_of(
      wall_scene(), test::box({Eigen::Vector3d(1.5, -0.2, -0.2), Eigen::Vector3d(1.7, 0.2, 0.2)}));
  std::vector<TextureView> views = wall_views(mesh);
  Frame frame = test::exact_frame(with_box, test::kTextureCamera, wall_poses()[0]);
  test::paint_with([](const Eigen::Vector3d& p) { return p.x() < 1.9 ? 250.0 : wall_grey(p); }, frame,
                   wall_poses()[0]);
  views[0] = make_texture_view(frame, wall_poses()[0], mesh, 0.0);
  EXPECT_EQ(shown(views[0], {0, 0, 0}, {-1, 0, 0}).score, 0.0F);
  EXPECT_GT(shown(views[0], {0, 0.4F, 0}, {-1, 0, 0}).score, 0.0F);
  EXPECT_LT(error_of(mesh, bake_texture(mesh, views), 0.15F), 3.0);
}

TEST(TextureBake, AnOutlierAmongThreeViewsIsLeftOutWithoutDepth) {
  const Mesh mesh = wall_mesh();
  std::vector<TextureView> views = wall_views(mesh);
  for (std::size_t v = 0; v < views.size(); ++v) {
    // A reflection, which no depth tells, and greys far from its brightness.
    const Rgb colour = v == 0 ? Rgb{255, 0, 255} : Rgb{60, 60, 60};
    TextureView& view = views[v];
    view.colour = subsampled(ColourImage(view.camera.width_px, view.camera.height_px, colour));
    view.low = ColourImage(view.low.width, view.low.height, colour);
  }
  const SurfaceTexture texture = bake_texture(mesh, views);
  const ColourImage atlas = picture_of_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, "atlas");
  const Rgb middle = atlas.at(atlas.width / 2, atlas.height / 3);
  EXPECT_NEAR(middle.r, 60, 4);
  EXPECT_NEAR(middle.g, 60, 4);
}

TEST(TextureBake, SurfaceThatNoViewShowsKeepsTheMeshsColours) {
  Mesh mesh = wall_mesh(1.2F, 1);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& p :
       {Eigen::Vector3f(0, 5, 0), Eigen::Vector3f(0, 5, 1), Eigen::Vector3f(0, 6, 1)}) {
    mesh.vertices.push_back(p);
    mesh.normals.emplace_back(-1.0F, 0.0F, 0.0F);
    mesh.colours.push_back({200, 30, 30});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  const SurfaceTexture texture = bake_texture(mesh, wall_views(mesh));
  const ColourImage atlas = picture_of_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, "atlas");
  Eigen::Array2f p = Eigen::Array2f::Zero();
  for (const AtlasPoint& corner : texture.corners.back())
    p += Eigen::Array2f(corner[0], corner[1]) / (3.0F * 65535.0F);
  const Rgb texel = atlas.at(static_cast<int>(p.x() * static_cast<float>(atlas.width)),
                             static_cast<int>(p.y() * static_cast<float>(atlas.height)));
  EXPECT_NEAR(texel.r, 200, 12);
  EXPECT_NEAR(texel.g, 30, 12);
}

TEST(TextureBake, AnEarlierTextureFillsWhatNoViewShows) {
  const Mesh mesh = wall_mesh();
  const SurfaceTexture first = bake_texture(mesh, wall_views(mesh));
  // The same wall in other triangles, 5 mm away and in another frame of the mesh.
  Mesh again = wall_mesh(1.2F, 7);
  again.origin = {2.005, 0.5, 0.0};
  for (Eigen::Vector3f& vertex : again.vertices) vertex.y() -= 0.5F;
  std::vector<std::unique_ptr<const EarlierTexture>> earlier;
  earlier.push_back(std::make_unique<const EarlierTexture>(mesh, first));
  const SurfaceTexture second = bake_texture(again, {}, earlier);
  ASSERT_TRUE(fits(second, again));
  EXPECT_LT(error_of(again, second, 1.0F), 4.0);
  // Farther than 2 cm, it is another surface.
  again.origin.x() = 2.03;
  const SurfaceTexture grey = bake_texture(again, {}, earlier);
  EXPECT_GT(error_of(again, grey, 1.0F), 20.0);
}

TEST(TextureBake, NoViewsGiveNoTexture) {
  EXPECT_TRUE(bake_texture(wall_mesh(), {}).corners.empty());
  EXPECT_TRUE(bake_texture({}, wall_views(wall_mesh())).corners.empty());
}

TEST(ViewAlignment, AWrongPoseIsMovedToWhereColoursMeet) {
  const Mesh mesh = wall_mesh();
  const std::vector<MeshPoint> points = sample_mesh(mesh, 20'000);
  std::vector<float> brightness;
  for (const MeshPoint& point : points)
    brightness.push_back(static_cast<float>(wall_grey(mesh.origin + point.p_local.cast<double>())));
  TextureView view = wall_views(mesh)[1];
  const Eigen::Isometry3f right = view.T_camera_local;
  view.T_camera_local.pretranslate(Eigen::Vector3f(0.008F, -0.006F, 0.0F));
  const auto error_px = [&] {
    float sum = 0.0F;
    int count = 0;
    for (std::size_t i = 0; i < points.size(); i += 100, ++count) {
      const Eigen::Vector3f a = right * points[i].p_local, b = view.T_camera_local * points[i].p_local;
      sum += 290.0F * (a.head<2>() / a.z() - b.head<2>() / b.z()).norm();
    }
    return sum / static_cast<float>(count);
  };
  EXPECT_GT(error_px(), 1.5F);
  align_view(points, brightness, view);
  EXPECT_LT(error_px(), 0.25F);
}

TEST(ViewAlignment, PointsCoverTheSurfaceByArea) {
  Mesh mesh = wall_mesh(1.0F, 1);
  mesh.vertices[3] = {0.0F, 0.5F, 1.5F};  // the first triangle's third corner, the second's second
  const std::vector<MeshPoint> points = sample_mesh(mesh, 1000);
  ASSERT_EQ(points.size(), 1000U);
  for (const MeshPoint& point : points) {
    EXPECT_NEAR(point.weights.sum(), 1.0F, 1e-5F);
    EXPECT_GE(point.weights.minCoeff(), -1e-6F);
  }
}

TEST(ViewSelection, EachPartOfAScanGivesItsSlowestFrame) {
  std::vector<ViewCandidate> candidates;
  for (int i = 0; i < 100; ++i) {
    ViewCandidate candidate;
    candidate.T_world_camera.translation().x() = 0.01 * i;
    candidate.image_speed_pxps = i % 5 == 2 ? 10.0 : 100.0;
    candidates.push_back(candidate);
  }
  const std::vector<std::size_t> chosen = choose_views(candidates, 100);
  EXPECT_GE(chosen.size(), 15U);
  EXPECT_LE(chosen.size(), 21U);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    EXPECT_EQ(chosen[i] % 5, 2U);
    if (i > 0) {
      EXPECT_LT(chosen[i - 1], chosen[i]);
    }
  }
  EXPECT_LE(choose_views(candidates, 4).size(), 4U);
  EXPECT_GE(choose_views(candidates, 4).size(), 2U);
  EXPECT_TRUE(choose_views(candidates, 0).empty());
  EXPECT_TRUE(choose_views({}, 10).empty());
}

TEST(ViewSelection, ACameraThatStandsStillGivesOneView) {
  const std::vector<ViewCandidate> candidates(500);
  EXPECT_EQ(choose_views(candidates, 100).size(), 1U);
}

TEST(AtlasFill, GapsGetTheColourOfTheirNeighbours) {
  ColourImage atlas(9, 5, {10, 20, 30});
  MaskImage has_colour(9, 5);
  atlas.at(1, 1) = {200, 100, 50};
  has_colour.at(1, 1) = 255;
  fill_gaps(atlas, has_colour);
  for (const Rgb& pixel : atlas.pixels) EXPECT_EQ(pixel, (Rgb{200, 100, 50}));
  ColourImage empty(3, 3);
  fill_gaps(empty, MaskImage(3, 3));
  EXPECT_EQ(empty.at(2, 2), (Rgb{128, 128, 128}));
}

}  // namespace
}  // namespace roomradar::texture_bake_test
