// passes_radar_test.cpp: the rendered passes on scenes of triangle trees, against the exact radar.
#include "radar/batch/passes_radar.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/radar/shapes.hpp"

namespace roomradar::passes_radar_test {
namespace {

const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TriangleTree tree_of(const Mesh& mesh) {
  TriangleTree tree;
  tree.build_by_place(mesh);
  return tree;
}

class PassesRadarTest : public testing::Test {
 protected:
  GlContext context;
  PassesRadar passes{context, 64};
  CyberRadar exact;
  const TriangleTree cube = tree_of(shapes::box({0.2F, 0.2F, 0.2F}));
  const TriangleTree floor = tree_of(shapes::floor(3.0F, 0.0F));
};

TEST_F(PassesRadarTest, BoundsHoldTheExactDistanceAmongBoxesOnAFloor) {
  const TriangleTree box = tree_of(shapes::box_of_cells({0.3F, 0.5F, 0.4F}, 4));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> side(-1.0, 1.0);
  int contacts = 0, free = 0;
  for (int i = 0; i < 300; ++i) {
    const std::array<SceneTree, 4> scene = {
        SceneTree{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic},
        SceneTree{{&box, at(side(random), side(random), 0.2)}, SurfaceKind::kObject},
        SceneTree{{&box, at(side(random), side(random), 0.2) *
                             Eigen::AngleAxisd(side(random), Eigen::Vector3d::UnitZ())},
                  SurfaceKind::kDynamic},
        SceneTree{{&cube, at(0, 0, 0.7)}, SurfaceKind::kObject}};
    Eigen::Isometry3d T = at(side(random), side(random), 0.8 + 0.2 * side(random));
    T.rotate(
        Eigen::AngleAxisd(3.0 * side(random), Eigen::Vector3d(side(random), side(random), 1.0).normalized()));
    const Eigen::Vector3d direction(side(random), side(random), -0.6);
    RadarQuery query{{&cube, T}, direction, 0.7};
    query.own_tree = 3;  // the object's own tree, wherever it stands
    const Contact truth = exact.query(query, {scene, {}});
    if (truth.status == ContactStatus::kOverlap) continue;
    const Contact rendered = passes.query(query, {scene, {}});
    ASSERT_TRUE(rendered.status == ContactStatus::kContact || rendered.status == ContactStatus::kNoTarget)
        << i;
    if (truth) {
      ++contacts;
      EXPECT_LE(rendered.lower_m, truth.contact_distance_m + 1e-5) << i;
      EXPECT_GE(rendered.upper_m, truth.contact_distance_m - 1e-5) << i;
    } else {
      ++free;
      EXPECT_FALSE(rendered) << i << ": touches nothing";
    }
  }
  EXPECT_GT(contacts, 50);
  EXPECT_GT(free, 20);
}

TEST_F(PassesRadarTest, AFloorBelowACubeIsMetAtItsClearance) {
  const SceneTree scene{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  const Contact contact = passes.query({{&cube, at(0.1, 0.2, 0.6)}, kDown, 2.0}, {{&scene, 1}, {}});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, 0.5, 1e-5);
  EXPECT_NEAR(contact.lower_m, 0.5, 1e-3);
  EXPECT_EQ(contact.touched, SurfaceKind::kStatic);
}

TEST_F(PassesRadarTest, AOneSidedSurfaceBlocksFromOutsideOnly) {
  const SceneTree frontier{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kUnknownFrontier};
  EXPECT_NEAR(passes.query({{&cube, at(0, 0, 0.6)}, kDown, 2.0}, {{&frontier, 1}, {}}).contact_distance_m,
              0.5, 1e-5);
  EXPECT_FALSE(passes.query({{&cube, at(0, 0, -0.6)}, -kDown, 2.0}, {{&frontier, 1}, {}}));
  // Beside a surface that the passes see, the nearer one counts.
  const TriangleTree shelf = tree_of(shapes::floor(3.0F, 0.0F));
  const std::array<SceneTree, 2> both = {frontier, SceneTree{{&shelf, at(0, 0, -0.2)}, SurfaceKind::kStatic}};
  const Contact contact = passes.query({{&cube, at(0, 0, 0.6)}, kDown, 2.0}, {both, {}});
  EXPECT_NEAR(contact.contact_distance_m, 0.5, 1e-5);
  EXPECT_EQ(contact.touched, SurfaceKind::kUnknownFrontier);
}

TEST_F(PassesRadarTest, UploadsATreeOncePerBuild) {
  TriangleTree live;
  Mesh mesh = shapes::floor(3.0F, 0.0F);
  live.build_in_order(mesh);
  const SceneTree scene{{&live, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic};
  const RadarQuery query{{&cube, at(0, 0, 0.6)}, kDown, 2.0};
  (void)passes.query(query, {{&scene, 1}, {}});
  const std::uint64_t uploaded = passes.uploaded_triangles();
  (void)passes.query(query, {{&scene, 1}, {}});
  EXPECT_EQ(passes.uploaded_triangles(), uploaded);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += 0.1F;
  live.build_in_order(mesh);
  EXPECT_NEAR(passes.query(query, {{&scene, 1}, {}}).contact_distance_m, 0.4, 1e-5);
  EXPECT_EQ(passes.uploaded_triangles(), uploaded + live.triangle_count());
  // A frame's surface is replaced at each frame; the buffers of old ones are used again.
  for (int frame = 0; frame < 600; ++frame) {
    live.build_in_order(mesh);
    ASSERT_TRUE(passes.query(query, {{&scene, 1}, {}})) << frame;
  }
}

TEST_F(PassesRadarTest, AQueryWithAMarginOrADepthImageIsExact) {
  const SceneTree scene{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  RadarQuery query{{&cube, at(0, 0, 0.6)}, kDown, 2.0};
  query.margin_m = 0.05;
  EXPECT_EQ(passes.query(query, {{&scene, 1}, {}}).lower_m, exact.query(query, {{&scene, 1}, {}}).lower_m);
  query.margin_m = 0.0;
  const DepthImage depth_m(64, 48, 2.0F);
  SceneDepth depth{.depth_m = &depth_m, .camera = {64, 48, 60, 60, 31.5, 23.5}};
  depth.T_world_camera = at(0, 0, 1.0) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());  // looks down
  const Contact contact = passes.query(query, {{}, {&depth, 1}});
  EXPECT_NEAR(contact.contact_distance_m, 1.5, 1e-6);
  EXPECT_EQ(passes.query({{&cube, at(0, 0, 0.6)}, Eigen::Vector3d::Zero(), 2.0}, {{&scene, 1}, {}}).status,
            ContactStatus::kInvalidInput);
}

TEST_F(PassesRadarTest, TheModeNamesTheRadar) {
  const SceneTree scene{{&floor, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled, RadarMode::kPasses}) {
    const auto radar = make_radar({.mode = mode}, context);
    EXPECT_EQ(dynamic_cast<PassesRadar*>(radar.get()) != nullptr, mode == RadarMode::kPasses);
    EXPECT_NEAR(radar->query({{&cube, at(0, 0, 0.6)}, kDown, 2.0}, {{&scene, 1}, {}}).contact_distance_m, 0.5,
                1e-5);
  }
}

}  // namespace
}  // namespace roomradar::passes_radar_test
