// object_lod_test.cpp: coarser meshes are within their stated deviation, have the full mesh's shading, and
// are drawn only if the difference stays below a pixel.
#include "app/objects/object_lod.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/objects/object_model.hpp"
#include "app/objects/published_objects.hpp"
#include "app/objects/teapot.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/quality/quality.hpp"
#include "app/render/draw.hpp"
#include "mapping/mesh/triangle_distance.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::object_lod_test {
namespace {

/// Max distance of some of one mesh's vertices and triangle centres from the other's triangles.
float farthest_m(const Mesh& from, const Mesh& to, std::size_t every) {
  float farthest2 = 0.0F;
  for (std::size_t i = 0; i < from.triangles.size(); i += every) {
    const Triangle& t = from.triangles[i];
    const Eigen::Vector3f &a = from.vertices[t[0]], &b = from.vertices[t[1]], &c = from.vertices[t[2]];
    for (const Eigen::Vector3f& p : {a, Eigen::Vector3f((a + b + c) / 3.0F)}) {
      float nearest2 = 1e9F;
      for (const Triangle& other : to.triangles)
        nearest2 =
            std::min(nearest2, squared_distance_to_triangle(p, to.vertices[other[0]], to.vertices[other[1]],
                                                            to.vertices[other[2]]));
      farthest2 = std::max(farthest2, nearest2);
    }
  }
  return std::sqrt(farthest2);
}

/// A cube of 2 x 2 x 2 dm with n x n cells per face; faces share corners.
Mesh fine_cube(int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Eigen::Vector3f p;
          p[axis] = 0.1F * side;
          p[(axis + 1) % 3] = -0.1F + 0.2F * static_cast<float>(i) / static_cast<float>(n);
          p[(axis + 2) % 3] = -0.1F + 0.2F * static_cast<float>(j) / static_cast<float>(n);
          mesh.vertices.push_back(p);
        }
      }
      const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          Triangle one{at(i, j), at(i + 1, j), at(i + 1, j + 1)};
          Triangle other{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side < 0.0F) std::swap(one[1], one[2]), std::swap(other[1], other[2]);
          mesh.triangles.push_back(one);
          mesh.triangles.push_back(other);
        }
      }
    }
  }
  return mesh;
}

TEST(ObjectLevels, EachHasFewerTrianglesAndLiesWhereItSays) {
  const Mesh full = shapes::torus(120, 50, 0.08F, 0.035F, 0.01F);
  const std::vector<LevelOfDetail> levels = levels_of_detail(full);
  ASSERT_GE(levels.size(), 3U);
  std::size_t triangles = full.triangles.size();
  float deviation_m = 0.0F;
  for (const LevelOfDetail& level : levels) {
    EXPECT_LT(level.mesh.triangles.size(), triangles);
    EXPECT_GT(level.deviation_m, deviation_m);
    triangles = level.mesh.triangles.size();
    deviation_m = level.deviation_m;
    EXPECT_LE(farthest_m(level.mesh, full, triangles / 60 + 1), 1.05F * deviation_m);
    EXPECT_LE(farthest_m(full, level.mesh, full.triangles.size() / 60), 1.05F * deviation_m);
    ASSERT_EQ(level.mesh.normals.size(), level.mesh.vertices.size());
  }
  EXPECT_LT(triangles, 300U);
}

/// RMS angle between the coarse mesh's interpolated normals and those of the fine one's triangles, at some
/// triangles' centres.
double lit_off_deg(const Mesh& fine, const Mesh& coarse, std::size_t every) {
  double squares_deg2 = 0.0;
  int points = 0;
  for (std::size_t i = 0; i < fine.triangles.size(); i += every, ++points) {
    const Triangle& t = fine.triangles[i];
    const Eigen::Vector3f &a = fine.vertices[t[0]], &b = fine.vertices[t[1]], &c = fine.vertices[t[2]];
    const Eigen::Vector3f normal = (b - a).cross(c - a), p = (a + b + c) / 3.0F;
    float nearest2 = 1e9F;
    const Triangle* nearest = nullptr;
    for (const Triangle& other : coarse.triangles) {
      const float distance2 = squared_distance_to_triangle(
          p, coarse.vertices[other[0]], coarse.vertices[other[1]], coarse.vertices[other[2]]);
      if (distance2 < nearest2) nearest2 = distance2, nearest = &other;
    }
    Eigen::Vector3f shown = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {  // each vertex weighted by the part of the area opposite it
      const Eigen::Vector3f& across = coarse.vertices[(*nearest)[(k + 1) % 3]];
      const Eigen::Vector3f part = (across - p).cross(coarse.vertices[(*nearest)[(k + 2) % 3]] - p);
      shown += std::max(0.0F, part.dot(normal)) * coarse.normals[(*nearest)[k]];
    }
    const float off_deg = std::atan2(shown.cross(normal).norm(), shown.dot(normal)) * 57.29578F;
    squares_deg2 += static_cast<double>(off_deg * off_deg);
  }
  return std::sqrt(squares_deg2 / points);
}

TEST(ObjectLevels, EachIsLitAsTheFullMeshIs) {
  // With means of the merged vertices' normals: 8 degrees, and 14 to 17 from 4,000 triangles on.
  const Mesh full = shapes::torus(240, 100, 0.08F, 0.035F, 0.01F);
  int judged = 0;
  for (const LevelOfDetail& level : levels_of_detail(full)) {
    const std::size_t triangles = level.mesh.triangles.size();
    if (triangles < 1000) break;
    EXPECT_LT(lit_off_deg(full, level.mesh, 47), triangles > 8000 ? 7.5 : 13.0) << triangles;
    ++judged;
  }
  EXPECT_GE(judged, 4);
}

TEST(ObjectLevels, AFinelyMeshedCubeKeepsItsEdgesSharp) {
  const std::vector<LevelOfDetail> levels = levels_of_detail(fine_cube(30));
  ASSERT_FALSE(levels.empty());
  const Mesh& mesh = levels.back().mesh;
  EXPECT_LT(mesh.triangles.size(), 2500U);
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f face = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                     .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                     .normalized();
    for (const std::uint32_t vertex : t) EXPECT_GT(mesh.normals[vertex].dot(face), 0.9F);
  }
}

TEST(ObjectLevels, AMeshOfFewTrianglesHasNone) {
  EXPECT_TRUE(levels_of_detail(shapes::torus(30, 16, 0.08F, 0.035F, 0.01F)).empty());
  EXPECT_TRUE(levels_of_detail(Mesh{}).empty());
}

TEST(ObjectLevels, TheDrawnMeshIsCoarserTheFartherTheObjectAndNeverOffByMoreThanHalfAPixel) {
  GlContext context;
  const Mesh torus = shapes::torus(120, 50, 0.08F, 0.035F, 0.01F);
  VirtualObject object("torus", std::make_shared<const ObjectModel>(context, object_parts("torus", torus)));
  const Intrinsics camera{640, 480, 585.0, 585.0, 320.0, 240.0};
  const double radius_m = 0.5 * object.model->shape.drawn.bounds().sizes().norm();
  std::size_t before = object.model->shape.drawn.triangle_count() + 1;
  for (const double z_m : {0.1, 0.5, 1.0, 2.0, 4.0, 9.0}) {
    object.body.T_world_object.translation() = Eigen::Vector3d(0.1, 0.0, z_m);
    const GpuMesh& mesh = *drawn_object(object, camera, Eigen::Isometry3d::Identity(), 0.5).instance.mesh;
    EXPECT_LE(mesh.triangle_count(), before) << z_m;
    before = mesh.triangle_count();
    for (const DrawnLevel& level : object.model->levels()) {
      const double half_pixel_m = 0.5 * (z_m - radius_m) / camera.fx_px;
      if (&mesh == level.mesh.get()) {
        EXPECT_LE(static_cast<double>(level.deviation_m), half_pixel_m) << z_m;
      }
    }
    if (z_m < radius_m) {
      EXPECT_EQ(&mesh, &object.model->shape.drawn);
    }
  }
  EXPECT_LT(before, 1000U);
}

TEST(ObjectLevels, LevelsThatAreComputedLaterAreTheSame) {
  GlContext context;
  const Mesh torus = shapes::torus(120, 50, 0.08F, 0.035F, 0.01F);
  const ObjectModel at_once(context, object_parts("torus", torus));
  const ObjectModel later(context, object_parts_without_levels("torus", Model{.mesh = torus}));
  ASSERT_GT(at_once.levels().size(), 2U);
  ASSERT_EQ(later.levels().size(), at_once.levels().size());
  EXPECT_EQ(later.levels().size(), at_once.levels().size());  // not uploaded twice
  for (std::size_t i = 0; i < at_once.levels().size(); ++i) {
    const DrawnLevel &a = at_once.levels()[i], &b = later.levels()[i];
    EXPECT_EQ(a.deviation_m, b.deviation_m);
    EXPECT_TRUE(std::equal(a.mesh->triangles().begin(), a.mesh->triangles().end(),
                           b.mesh->triangles().begin(), b.mesh->triangles().end()));
  }
  // A model that is never drawn ends its thread.
  EXPECT_NO_THROW(ObjectModel(context, object_parts_without_levels("torus", Model{.mesh = torus})));
}

constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};

/// Red, green, blue and coverage of each pixel of kCamera, from a camera with `finer` times the resolution.
std::vector<Eigen::Vector4f> pixels_of(ObjectDrawer& drawer, const GpuMesh& mesh,
                                       const Eigen::Isometry3d& T_camera_mesh, int finer) {
  ObjectLayer layer;
  const DrawnObject object{.instance = {&mesh, T_camera_mesh}, .is_closed = true};
  drawer.draw({&object, 1}, scaled(kCamera, finer), Eigen::Isometry3d::Identity(), {}, layer);
  std::vector<Eigen::Vector4f> pixels(640 * 480, Eigen::Vector4f(100.0F, 100.0F, 100.0F, 0.0F));
  const int samples = finer * layer.samples;
  for (int y = 0; y < layer.depth_m.height; ++y)
    for (int x = 0; x < layer.depth_m.width; ++x) {
      if (!(layer.depth_m.at(x, y) > 0.0F)) continue;
      const int u = (layer.rect.x * layer.samples + x) / samples,
                v = (layer.rect.y * layer.samples + y) / samples;
      const Rgb colour = layer.colour.at(x, y);
      pixels[static_cast<std::size_t>(v * 640 + u)] +=
          Eigen::Vector4f(colour.r - 100.0F, colour.g - 100.0F, colour.b - 100.0F, 1.0F) /
          static_cast<float>(samples * samples);
    }
  return pixels;
}

TEST(ObjectLevels, ThePictureOfTheUsualOneIsNearlyThatOfTheFullMesh) {
  // RMS over the pixels that either covers. The full meshes themselves, drawn like the levels, differ by 2.8
  // and 2.3. With means of the merged vertices' normals: 7.6 and 6.4.
  GlContext context;
  ObjectDrawer drawer(context);
  const double usual_px = RunQuality{}.object_error_px, away_m = 1.5;
  const std::array<Mesh, 2> meshes{published_objects()[2], utah_teapot(40, 0.15)};
  const std::array<double, 2> most{6.0, 5.2};
  for (std::size_t i = 0; i < 2; ++i) {
    Mesh lit = meshes[i];
    lit.normals.assign(lit.vertices.size(), Eigen::Vector3f::Zero());
    for (const Triangle& t : lit.triangles)
      for (const std::uint32_t vertex : t)
        lit.normals[vertex] +=
            (lit.vertices[t[1]] - lit.vertices[t[0]]).cross(lit.vertices[t[2]] - lit.vertices[t[0]]);
    GpuMesh full(context), drawn(context);
    full.upload(lit, MeshUsage::kStatic);
    std::size_t triangles = lit.triangles.size();
    for (const LevelOfDetail& level : levels_of_detail(meshes[i])) {
      if (!is_fine_enough(level.deviation_m, (away_m - 0.15) / kCamera.fx_px, usual_px)) break;
      drawn.upload(level.mesh, MeshUsage::kStatic);
      triangles = level.mesh.triangles.size();
    }
    EXPECT_LT(triangles, lit.triangles.size() / 40);
    double squares = 0.0;
    int pixels = 0, off = 0;
    for (int k = 0; k < 4; ++k) {
      Eigen::Isometry3d T(Eigen::Translation3d(0.1, 0.1, away_m));
      T.rotate(Eigen::AngleAxisd(k, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
      const auto truth = pixels_of(drawer, full, T, 4), shown = pixels_of(drawer, drawn, T, 1);
      for (std::size_t p = 0; p < truth.size(); ++p) {
        if (truth[p].w() == 0.0F && shown[p].w() == 0.0F) continue;
        const double difference = (truth[p] - shown[p]).head<3>().cwiseAbs().maxCoeff();
        squares += difference * difference;
        off += difference > 8.0 ? 1 : 0;
        ++pixels;
      }
    }
    const double rms = std::sqrt(squares / pixels);
    std::printf("%zu of %zu triangles: %.1f off, %.1f %% of the pixels by more than 8\n", triangles,
                lit.triangles.size(), rms, 100.0 * off / pixels);
    EXPECT_LT(rms, most[i]);
  }
}

}  // namespace
}  // namespace roomradar::object_lod_test
