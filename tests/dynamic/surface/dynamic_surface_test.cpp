// dynamic_surface_test.cpp: few triangles, close to the measured depth, closed by a back that stays in front
// of the room.
#include "dynamic/surface/dynamic_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <tuple>

#include "dynamic/surface/depth_mesh.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/dynamic/mesh_raster.hpp"
#include "tests/support/allocation_count.hpp"

namespace roomradar::test::dynamic_surface_test {
namespace {

constexpr Intrinsics kKinect{640, 480, 585.0, 585.0, 320.0, 240.0};
constexpr float kWall_m = 2.0F;

Eigen::Isometry3d somewhere() {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()));
  T_world_camera.pretranslate(Eigen::Vector3d(100.0, -20.0, 3.0));
  return T_world_camera;
}

/// Depth image, mask of the pixels that moved, and depth of the room behind them.
struct Scene {
  DepthImage depth_m{640, 480, kWall_m};
  MaskImage mask{640, 480, 0};
  DepthImage expected_m{640, 480, kWall_m};
  Eigen::Isometry3d T_world_camera = somewhere();

  void put(int x, int y, float z) {
    depth_m.at(x, y) = z;
    mask.at(x, y) = 255;
  }
  void put_rectangle(int x0, int y0, int x1, int y1, float z) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) put(x, y, z);
  }
  void put_ball(const Eigen::Vector3d& centre, double radius_m) {
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        const Eigen::Vector3d ray = back_project(kKinect, x, y, 1.0);
        const double b = ray.dot(centre), a = ray.squaredNorm();
        const double root = b * b - a * (centre.squaredNorm() - radius_m * radius_m);
        if (root <= 0.0) continue;
        const auto z = static_cast<float>((b - std::sqrt(root)) / a);
        if (z < depth_m.at(x, y)) put(x, y, z);
      }
    }
  }
  void add_noise(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (float& z : depth_m.pixels) z += depth_sigma_m(DepthNoise{}, z) * normal(random);
  }
};

DynamicSurface meshed(const Scene& scene, const DynamicSurfaceConfig& config = {},
                      std::span<const FineRegion> regions = {}) {
  DynamicSurfaceScratch scratch;
  DynamicSurface surface;
  mesh_dynamic({{scene.depth_m, kKinect, scene.T_world_camera}, scene.mask, scene.expected_m}, regions,
               config, scratch, surface);
  return surface;
}

Mesh in_full(const Scene& scene) {
  DepthMeshConfig config;
  config.stride_px = 1;
  DepthMeshScratch scratch;
  Mesh mesh;
  const DepthImage depth_m = test::masked_depth(scene.depth_m, scene.mask);
  mesh_whole({depth_m, kKinect, scene.T_world_camera}, SurfacePolicy::kHoles, config, scratch, mesh);
  return mesh;
}

DepthImage seen_depth(const DynamicSurface& surface, const Scene& scene) {
  return rasterise(surface.seen_world, kKinect, scene.T_world_camera);
}

/// Depth of the back, which faces away from the camera; side walls run along its rays and cover no pixels.
DepthImage back_depth(const DynamicSurface& surface, const Scene& scene) {
  return rasterise(surface.inferred_world, kKinect, scene.T_world_camera);
}

/// Counts edges of both meshes that do not have equally many triangles on either side; vertices at the same
/// position are one vertex.
std::size_t open_edges(const DynamicSurface& surface) {
  using Place = std::tuple<float, float, float>;
  std::map<std::pair<Place, Place>, int> edges;
  const auto add = [&](const Mesh& mesh) {
    const auto place = [&](std::uint32_t i) {
      const Eigen::Vector3f& p = mesh.vertices[i];
      return Place(p.x(), p.y(), p.z());
    };
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Place a = place(t[k]), b = place(t[(k + 1) % 3]);
        if (a < b) {
          ++edges[{a, b}];
        } else {
          --edges[{b, a}];
        }
      }
    }
  };
  add(surface.seen_world);
  add(surface.inferred_world);
  std::size_t open = 0;
  for (const auto& [edge, balance] : edges) open += balance != 0 ? 1U : 0U;
  return open;
}

double volume_m3(const DynamicSurface& surface) {
  double six = 0.0;
  for (const Mesh* mesh : {&surface.seen_world, &surface.inferred_world}) {
    for (const Triangle& t : mesh->triangles) {
      const auto p = [&](std::size_t k) -> Eigen::Vector3d { return mesh->vertices[t[k]].cast<double>(); };
      six += p(0).dot(p(1).cross(p(2)));
    }
  }
  return six / 6.0;
}

void expect_sound(const DynamicSurface& surface, const Scene& scene) {
  const Mesh& seen = surface.seen_world;
  ASSERT_EQ(seen.normals.size(), seen.vertices.size());
  EXPECT_EQ(seen.origin, scene.T_world_camera.translation());
  for (const Triangle& t : seen.triangles) {
    for (const std::uint32_t i : t) ASSERT_LT(i, seen.vertices.size());
    const Eigen::Vector3f& p = seen.vertices[t[0]];
    const Eigen::Vector3f normal = (seen.vertices[t[1]] - p).cross(seen.vertices[t[2]] - p);
    ASSERT_LT(normal.dot(p), 0.0F) << "faces away from the camera";
  }
  for (const Eigen::Vector3f& normal : seen.normals) ASSERT_NEAR(normal.norm(), 1.0F, 1e-5F);
  for (const Triangle& t : surface.inferred_world.triangles)
    for (const std::uint32_t i : t) ASSERT_LT(i, surface.inferred_world.vertices.size());
  EXPECT_EQ(open_edges(surface), 0U);
}

/// Counts mask pixels without surface within one pixel.
std::size_t pixels_lost(const DynamicSurface& surface, const Scene& scene) {
  const DepthImage seen = seen_depth(surface, scene);
  std::size_t lost = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (scene.mask.at(x, y) == 0 || !(scene.depth_m.at(x, y) > 0.0F)) continue;
      bool is_near = false;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
          is_near = is_near || (seen.contains(x + dx, y + dy) && seen.at(x + dx, y + dy) > 0.0F);
      lost += is_near ? 0U : 1U;
    }
  }
  return lost;
}

TEST(DynamicSurface, NothingMovedGivesNothing) {
  const DynamicSurface surface = meshed({});
  EXPECT_TRUE(surface.seen_world.vertices.empty());
  EXPECT_TRUE(surface.inferred_world.vertices.empty());
  EXPECT_TRUE(meshed({.depth_m{640, 480, 0.0F}, .mask{640, 480, 255}}).seen_world.triangles.empty());
}

TEST(DynamicSurface, AHandOverTheLensIsAFewTriangles) {
  Scene scene;
  scene.put_rectangle(0, 0, 640, 480, 0.4F);
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_LT(surface.seen_world.triangles.size(), 4000U);  // 612,162 with a vertex per pixel
  const DepthImage seen = seen_depth(surface, scene);
  std::size_t covered = 0;
  for (const float z : seen.pixels) {
    covered += z > 0.0F ? 1U : 0U;
    if (z > 0.0F) {
      ASSERT_NEAR(z, 0.4F, 1e-5F);
    }
  }
  EXPECT_GE(covered, 640U * 480U - 12U);  // the image's corners are cut
}

TEST(DynamicSurface, WorksAtFortyCentimetresAndAtEightMetres) {
  for (const float z : {0.4F, 8.0F}) {
    Scene scene;
    scene.expected_m = DepthImage(640, 480, 9.5F);
    scene.put_rectangle(250, 180, 391, 301, z);
    scene.add_noise(3);
    const DynamicSurface surface = meshed(scene);
    expect_sound(surface, scene);
    EXPECT_EQ(pixels_lost(surface, scene), 0U);
    EXPECT_LT(surface.seen_world.triangles.size(), in_full(scene).triangles.size() / 10) << z;
    const DepthImage seen = seen_depth(surface, scene);
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
      if (!(seen.pixels[i] > 0.0F)) continue;
      squares += std::pow((seen.pixels[i] - z) / depth_sigma_m(DepthNoise{}, z), 2);
      ++count;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 1.0) << z;
  }
}

TEST(DynamicSurface, ABallIsATenthOfTheTrianglesWithinASigma) {
  Scene scene;
  scene.put_ball({0.05, -0.03, 0.9}, 0.12);
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  const std::size_t full = in_full(scene).triangles.size();
  EXPECT_LT(surface.seen_world.triangles.size(), full / 20) << full;
  const DepthImage seen = seen_depth(surface, scene);
  std::vector<float> sigmas;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (!(seen.at(x, y) > 0.0F) || scene.mask.at(x, y) == 0) continue;
      const Eigen::Vector3d p = back_project(kKinect, x, y, scene.depth_m.at(x, y));
      const double cosine = -(p - Eigen::Vector3d(0.05, -0.03, 0.9)).normalized().dot(p.normalized());
      const float sigma =
          depth_sigma_m(DepthNoise{}, scene.depth_m.at(x, y), static_cast<float>(std::acos(cosine)));
      sigmas.push_back(std::abs(seen.at(x, y) - scene.depth_m.at(x, y)) / sigma);
    }
  }
  std::sort(sigmas.begin(), sigmas.end());
  EXPECT_LT(sigmas[sigmas.size() * 95 / 100], 1.0F);
  EXPECT_LT(sigmas.back(), 2.0F);
}

TEST(DynamicSurface, NoiseOnATiltedPlaneIsNoShape) {
  Scene scene;
  for (int y = 100; y < 400; ++y)
    for (int x = 150; x < 500; ++x)
      scene.put(x, y, 1.2F / (1.0F - 1.0F * (static_cast<float>(x) - 320.0F) / 585.0F));  // 45 degrees
  scene.add_noise(11);
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_EQ(pixels_lost(surface, scene), 0U);
  EXPECT_LT(surface.seen_world.triangles.size(), in_full(scene).triangles.size() / 40);
}

TEST(DynamicSurface, WhereEveryPixelIsAVertexTheNoiseIsAveragedAway) {
  const Eigen::Vector3d centre(0.05, -0.02, 1.2);
  constexpr double kRadius_m = 0.12;
  Scene scene;
  scene.put_ball(centre, kRadius_m);
  const double sigma_m = depth_sigma_m(DepthNoise{}, 1.1F);
  scene.add_noise(5);
  const FineRegion everywhere[] = {{scene.T_world_camera * centre, 0.3}};
  const DynamicSurface surface = meshed(scene, {}, everywhere);
  expect_sound(surface, scene);
  const Eigen::Isometry3d T_camera_world = scene.T_world_camera.inverse();
  double squares_m2 = 0.0, off_m = 0.0;
  int count = 0;
  for (const Eigen::Vector3f& vertex : surface.seen_world.vertices) {
    const Eigen::Vector3d p = T_camera_world * (surface.seen_world.origin + vertex.cast<double>());
    const Eigen::Vector3d from_centre = p - centre;
    if (from_centre.head<2>().norm() > 0.7 * kRadius_m) continue;  // away from the outline
    const double error_m = from_centre.norm() - kRadius_m;
    squares_m2 += error_m * error_m;
    off_m += error_m;
    ++count;
  }
  EXPECT_GT(count, 4000);
  EXPECT_LT(std::sqrt(squares_m2 / count), 0.4 * sigma_m);  // a single pixel: 0.9, along the normal
  EXPECT_LT(std::abs(off_m / count), 0.05 * sigma_m);       // and the ball keeps its size
}

TEST(DynamicSurface, NothingSpansAHugeJumpInTheMask) {
  Scene scene;
  scene.put_rectangle(150, 100, 450, 400, 1.6F);   // a body
  scene.put_rectangle(251, 183, 343, 262, 0.61F);  // a hand in front of it
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_EQ(pixels_lost(surface, scene), 0U);
  const Eigen::Isometry3d T_camera_world = scene.T_world_camera.inverse();
  for (const Triangle& t : surface.seen_world.triangles) {
    float least = 1e9F, most = 0.0F;
    for (const std::uint32_t i : t) {
      const Eigen::Vector3d p =
          T_camera_world * (surface.seen_world.origin + surface.seen_world.vertices[i].cast<double>());
      least = std::min(least, static_cast<float>(p.z()));
      most = std::max(most, static_cast<float>(p.z()));
    }
    ASSERT_LT(most - least, 0.01F);
  }
  EXPECT_LT(surface.seen_world.triangles.size(), in_full(scene).triangles.size() / 20);
}

TEST(DynamicSurface, ThePixelsOfTheRimAreThere) {
  Scene scene;  // a slanted strip: no side of it is on the grid
  for (int y = 60; y < 420; ++y)
    for (int x = 0; x < 640; ++x)
      if (std::abs(0.8 * (x - 320) - 0.6 * (y - 240)) < 25.3) scene.put(x, y, 0.7F);
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  const DepthImage seen = seen_depth(surface, scene),
                   full = rasterise(in_full(scene), kKinect, scene.T_world_camera);
  std::size_t missing = 0, all = 0;
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    all += full.pixels[i] > 0.0F ? 1U : 0U;
    missing += full.pixels[i] > 0.0F && !(seen.pixels[i] > 0.0F) ? 1U : 0U;
  }
  EXPECT_EQ(pixels_lost(surface, scene), 0U);
  EXPECT_LT(static_cast<double>(missing), 0.02 * static_cast<double>(all));
}

TEST(DynamicSurface, AHoleInAHandStaysOpenAndSpecksAreClosed) {
  Scene scene;
  scene.put_rectangle(250, 180, 390, 300, 0.7F);
  const std::size_t without = meshed(scene).seen_world.triangles.size();
  for (int y = 230; y < 250; ++y)
    for (int x = 310; x < 330; ++x) scene.depth_m.at(x, y) = 0.0F;
  scene.depth_m.at(270, 200) = scene.depth_m.at(271, 200) = 0.0F;
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_GT(surface.seen_world.triangles.size(), without);
  const DepthImage seen = seen_depth(surface, scene), back = back_depth(surface, scene);
  EXPECT_EQ(seen.at(320, 240), 0.0F);
  EXPECT_EQ(back.at(320, 240), 0.0F);
  EXPECT_NEAR(seen.at(270, 200), 0.7F, 1e-5F);
}

TEST(DynamicSurface, AHandFullOfNarrowGapsIsOneSurface) {
  Scene scene;
  scene.put_rectangle(200, 150, 320, 260, 1.0F);
  const auto covered_px = [&] {
    const DepthImage seen = seen_depth(meshed(scene), scene);
    return std::count_if(seen.pixels.begin(), seen.pixels.end(), [](float z) { return z > 0.0F; });
  };
  const auto whole = static_cast<double>(covered_px());
  std::mt19937 random(7);
  for (int y = 150; y < 260; y += 2)
    for (int x = 200; x < 320; x += 2)
      if (random() % 10 < 4)
        for (const auto& [u, v] : {std::pair{x, y}, {x + 1, y}, {x, y + 1}, {x + 1, y + 1}})
          scene.depth_m.at(u, v) = 0.0F;
  EXPECT_GT(static_cast<double>(covered_px()), 0.97 * whole);
}

TEST(DynamicSurface, WhatTheImageCutsOffIsThickThere) {
  Scene scene;
  scene.put_rectangle(0, 200, 120, 280, 0.7F);  // an arm that enters from the left
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  const DepthImage back = back_depth(surface, scene);
  const float at_border_m = back.at(1, 240) - 0.7F, inside_m = back.at(60, 240) - 0.7F;
  EXPECT_GT(at_border_m, 0.02F);  // twice 0.3 of 40 pixels
  EXPECT_NEAR(at_border_m, inside_m, 0.005F);
}

TEST(DynamicSurface, ALineOnePixelWideIsASlab) {
  Scene scene;
  for (int k = 0; k < 100; ++k) {
    scene.put(300, 100 + k, 1.0F);
    scene.put(350 + k, 321, 1.0F);
    scene.put(400 + k, 100 + k, 1.0F);
  }
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_TRUE(in_full(scene).triangles.empty());
  const DepthImage seen = seen_depth(surface, scene), back = back_depth(surface, scene);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      ASSERT_EQ(seen.at(x, y) > 0.0F, scene.mask.at(x, y) != 0) << x << " " << y;
      if (scene.mask.at(x, y) != 0) {
        ASSERT_NEAR(seen.at(x, y), 1.0F, 1e-5F);
        ASSERT_NEAR(back.at(x, y), 1.005F, 1e-3F);
      }
    }
  }
}

TEST(DynamicSurface, ABallIsAsThickAsItIsWide) {
  Scene scene;
  scene.put_ball({0.0, 0.0, 1.0}, 0.1);
  const DynamicSurface surface = meshed(scene);
  EXPECT_NEAR(back_depth(surface, scene).at(320, 240), 1.1F, 0.03F);
  const double ball_m3 = 4.0 / 3.0 * M_PI * 1e-3;
  EXPECT_GT(volume_m3(surface), 0.4 * ball_m3);
  EXPECT_LT(volume_m3(surface), 1.2 * ball_m3);
}

TEST(DynamicSurface, TheBackClosesWhereTheModelHasAHole) {
  Scene scene;
  scene.expected_m = DepthImage(640, 480, 0.0F);
  scene.put_ball({0.0, 0.0, 1.0}, 0.1);
  const DynamicSurface surface = meshed(scene);
  expect_sound(surface, scene);
  EXPECT_NEAR(back_depth(surface, scene).at(320, 240), 1.1F, 0.03F);
}

TEST(DynamicSurface, TheBackStaysBeforeWhatTheThingLiesOn) {
  for (const float gap_m : {0.03F, 0.01F, 0.003F}) {
    Scene scene;
    for (int y = 0; y < 480; ++y) {  // a table seen at 50 degrees, and a hand along it
      for (int x = 0; x < 640; ++x) {
        const float z = 0.9F / (1.0F + 1.2F * (static_cast<float>(y) - 240.0F) / 585.0F);
        scene.expected_m.at(x, y) = scene.depth_m.at(x, y) = z;
        if (std::hypot(x - 300, (y - 250) * 1.4) < 110.0) scene.put(x, y, z - gap_m);
      }
    }
    const DynamicSurface surface = meshed(scene);
    expect_sound(surface, scene);
    const DepthImage back = back_depth(surface, scene);
    for (std::size_t i = 0; i < back.pixels.size(); ++i) {
      if (back.pixels[i] > 0.0F) {
        ASSERT_LT(back.pixels[i], scene.expected_m.pixels[i]) << gap_m;
      }
    }
  }
}

TEST(DynamicSurface, RegionsAreAsFineAsTheImage) {
  Scene scene;
  scene.put_ball({0.0, 0.0, 0.9}, 0.12);
  const FineRegion region{scene.T_world_camera * Eigen::Vector3d(0.03, 0.0, 0.8), 0.05};
  const DynamicSurface surface = meshed(scene, {}, {&region, 1});
  expect_sound(surface, scene);
  const DepthImage seen = seen_depth(surface, scene);
  std::size_t inside = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      if (scene.mask.at(x, y) == 0) continue;
      const Eigen::Vector3d p = back_project(kKinect, x, y, scene.depth_m.at(x, y));
      if ((p - Eigen::Vector3d(0.03, 0.0, 0.8)).norm() > 0.05) continue;
      ++inside;
      ASSERT_NEAR(seen.at(x, y), scene.depth_m.at(x, y),
                  0.3F * depth_sigma_m(DepthNoise{}, scene.depth_m.at(x, y)));
    }
  }
  EXPECT_GT(inside, 1000U);
  EXPECT_GT(surface.seen_world.triangles.size(), inside);
  EXPECT_LT(surface.seen_world.triangles.size(), in_full(scene).triangles.size() / 2);
  const FineRegion nowhere[] = {{Eigen::Vector3d::Constant(std::nan("")), 1.0},
                                {Eigen::Vector3d::Zero(), INFINITY}};
  EXPECT_EQ(meshed(scene, {}, nowhere).seen_world.triangles, meshed(scene).seen_world.triangles);
}

// For any mask and depth the mesh is closed, faces the camera, and is close to every pixel of the mask.
TEST(DynamicSurface, IsClosedAndLosesNothingWhateverMoved) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> across(0, 639), down(0, 479), size(1, 120);
  std::uniform_real_distribution<float> depth(0.4F, 4.0F), unit(0.0F, 1.0F);
  for (int round = 0; round < 12; ++round) {
    Scene scene;
    for (int blob = 0; blob < 8; ++blob) {
      const int cx = across(random), cy = down(random), rx = size(random), ry = size(random);
      const float z = depth(random), slope = 4.0F * (unit(random) - 0.5F);
      for (int y = std::max(cy - ry, 0); y < std::min(cy + ry, 480); ++y) {
        for (int x = std::max(cx - rx, 0); x < std::min(cx + rx, 640); ++x) {
          const float u = static_cast<float>(x - cx) / static_cast<float>(rx);
          const float v = static_cast<float>(y - cy) / static_cast<float>(ry);
          if (u * u + v * v < 1.0F) scene.put(x, y, z / (1.0F + 0.1F * slope * u));
        }
      }
    }
    if (round % 2 == 0) scene.add_noise(static_cast<unsigned>(round));
    if (round % 3 == 0) {
      for (std::size_t i = 0; i < scene.mask.pixels.size(); ++i) {
        if (unit(random) < 0.05F) scene.depth_m.pixels[i] = 0.0F;
        if (unit(random) < 0.05F) scene.mask.pixels[i] ^= 255;
      }
    }
    const FineRegion region{scene.T_world_camera * Eigen::Vector3d(0.0, 0.0, depth(random)), 0.3};
    const DynamicSurface surface = meshed(scene, {}, {&region, 1});
    expect_sound(surface, scene);
    EXPECT_GT(volume_m3(surface), 0.0);
    EXPECT_LE(pixels_lost(surface, scene), 20U) << round;  // specks of two depths in one cell
  }
}

TEST(DynamicSurface, ImagesOfAnySizeAreMeshed) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 2}, {5, 3}, {33, 65}, {641, 479}}) {
    const Intrinsics camera{width, height, 585.0, 585.0, 0.5 * width, 0.5 * height};
    DynamicSurfaceScratch scratch;
    DynamicSurface surface;
    mesh_dynamic({{DepthImage(width, height, 1.0F), camera, somewhere()},
                  MaskImage(width, height, 255),
                  DepthImage(width, height, 0.0F)},
                 {}, {}, scratch, surface);
    EXPECT_EQ(open_edges(surface), 0U);
    EXPECT_FALSE(surface.seen_world.triangles.empty()) << width << " x " << height;
  }
}

TEST(DynamicSurface, NoFrameAfterTheFirstAllocates) {
  Scene nothing, ball, all;
  ball.put_ball({0.0, 0.0, 0.9}, 0.2);
  ball.put(5, 5, 1.0F);
  all.put_rectangle(0, 0, 640, 480, 0.5F);
  all.add_noise(1);
  const FineRegion regions[] = {{all.T_world_camera * Eigen::Vector3d(0.0, 0.0, 0.5), 0.5}};
  DynamicSurfaceScratch scratch;
  DynamicSurface surface;
  const auto mesh = [&](const Scene& scene, std::span<const FineRegion> fine) {
    mesh_dynamic({{scene.depth_m, kKinect, scene.T_world_camera}, scene.mask, scene.expected_m}, fine, {},
                 scratch, surface);
  };
  mesh(nothing, regions);
  const std::size_t before = allocations;
  mesh(ball, {});
  mesh(all, regions);
  mesh(ball, regions);
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_FALSE(surface.seen_world.triangles.empty());
}

TEST(DynamicSurface, WithoutABackThereIsNone) {
  Scene scene;
  scene.put_ball({0.0, 0.0, 1.0}, 0.1);
  DynamicSurfaceConfig config;
  config.has_back = false;
  const DynamicSurface surface = meshed(scene, config);
  EXPECT_TRUE(surface.inferred_world.triangles.empty());
  EXPECT_EQ(surface.seen_world.triangles, meshed(scene).seen_world.triangles);
}

TEST(DynamicSurface, ImpossibleSettingsAreNamed) {
  DynamicSurfaceConfig config;
  EXPECT_NO_THROW(require_valid(config));
  config.most_thickness_m = 0.001F;
  try {
    require_valid(config);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("dynamic_surface.most_thickness_m = 0.001"), std::string::npos)
        << error.what();
  }
  config = {};
  config.deviation_sigmas = 0.0F;
  EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::test::dynamic_surface_test
