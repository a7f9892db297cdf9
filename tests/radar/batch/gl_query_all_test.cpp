// gl_query_all_test.cpp: a batch of queries gives the same results as single queries, wherever the minimum is
// computed.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "radar/batch/gl_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::gl_query_all_test {
namespace {

const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

void expect_same(const Contact& a, const Contact& b, std::size_t i) {
  EXPECT_EQ(a.status, b.status) << i;
  EXPECT_EQ(a.contact_distance_m, b.contact_distance_m) << i;
  EXPECT_EQ(a.lower_m, b.lower_m) << i;
  EXPECT_EQ(a.upper_m, b.upper_m) << i;
  EXPECT_EQ(a.touched, b.touched) << i;
  EXPECT_EQ(a.point_world, b.point_world) << i;
  EXPECT_EQ(a.normal_world, b.normal_world) << i;
  EXPECT_EQ(a.pixel_m, b.pixel_m) << i;
}

/// Objects of three shapes in the air above the ground, each moving in its own direction.
class GlQueryAll : public testing::Test {
 protected:
  GlQueryAll() {
    std::mt19937 random(1);
    const Mesh shapes[] = {shapes::box({0.1F, 0.08F, 0.06F}), shapes::torus(24, 12, 0.05F, 0.02F, 0.005F),
                           shapes::cup(0.04F, 0.1F, 0.004F, 16)};
    for (const Mesh& shape : shapes) upload(shape);
    for (std::size_t i = 0; i < 60; ++i) {
      Eigen::Isometry3d T(shapes::random_rotation(random));
      T.pretranslate(Eigen::Vector3d(0, 0, 0.6) +
                     Eigen::Vector3d(0.5, 0.5, 0.3).cwiseProduct(shapes::random_point(random)));
      scene.push_back({{meshes[i % 3].get(), T}, SurfaceKind::kObject});
      queries.push_back(
          {scene.back().instance, kDown + 0.8 * shapes::random_point(random), 0.2 + 0.01 * double(i), i});
    }
    upload(shapes::bumpy_ground(60));
    scene.push_back({{meshes.back().get(), Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic});
  }
  void upload(const Mesh& mesh) {
    trees.push_back(std::make_unique<TriangleTree>());
    trees.back()->build_by_place(mesh);
    meshes.push_back(std::make_unique<GpuMesh>(context));
    meshes.back()->upload(mesh, MeshUsage::kStatic, *trees.back());
  }
  std::vector<Contact> ask_all(GlRadar& radar) const {
    std::vector<Contact> contacts(queries.size());
    radar.query_all(queries, scene, contacts);
    return contacts;
  }

  GlContext context;
  std::vector<std::unique_ptr<TriangleTree>> trees;
  std::vector<std::unique_ptr<GpuMesh>> meshes;
  std::vector<GpuSceneMesh> scene;
  std::vector<GlQuery> queries;
};

TEST_F(GlQueryAll, ObjectsAreSceneForEachOtherAndNotForThemselves) {
  GlRadar radar(context);
  const GpuSceneMesh pile[] = {{{meshes[0].get(), at(0, 0, 1.00)}, SurfaceKind::kObject},
                               {{meshes[0].get(), at(0, 0, 1.26)}, SurfaceKind::kObject}};
  const GlQuery both[] = {{pile[0].instance, kDown, 0.5, 0}, {pile[1].instance, kDown, 0.5, 1}};
  std::vector<Contact> contacts(2);
  radar.query_all(both, pile, contacts);
  EXPECT_EQ(contacts[0].status, ContactStatus::kNoTarget);
  ASSERT_EQ(contacts[1].status, ContactStatus::kContact);
  EXPECT_NEAR(contacts[1].contact_distance_m, 0.2, 1e-6);
  EXPECT_EQ(contacts[1].touched, SurfaceKind::kObject);
}

TEST_F(GlQueryAll, AnswersAsEachAlone) {
  for (const int atlas_px : {32, 100, 2048}) {  // one tile, nine, all
    GlRadar radar(context, {.resolution_px = 32, .atlas_px = atlas_px});
    const std::vector<Contact> together = ask_all(radar);
    GlRadar alone(context, {.resolution_px = 32});
    int contacts = 0, overlaps = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      std::vector<GpuSceneMesh> others = scene;
      others[i].instance.mesh = nullptr;
      const Contact contact =
          alone.query(queries[i].object, queries[i].direction_world, queries[i].distance_m, others);
      expect_same(together[i], contact, i);
      contacts += contact.status == ContactStatus::kContact ? 1 : 0;
      overlaps += contact.status == ContactStatus::kOverlap ? 1 : 0;
    }
    EXPECT_GT(contacts, 20);
    EXPECT_GT(overlaps, 3);
    EXPECT_LT(contacts + overlaps, 60);
  }
}

TEST_F(GlQueryAll, MinimumIsTheSameOnTheRendererAndReadBack) {
  for (const int resolution_px : {1, 9, 64}) {
    GlRadar here(context, {.resolution_px = resolution_px, .minimum = GlMinimum::kReadBack});
    GlRadar there(context, {.resolution_px = resolution_px,
                            .atlas_px = 3 * resolution_px,  // nine queries at a time
                            .minimum = GlMinimum::kOnRenderer});
    const std::vector<Contact> a = ask_all(here), b = ask_all(there);
    for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i], i);
  }
}

TEST_F(GlQueryAll, KeptMasksAnswerAsNewOnes) {
  GlRadar kept(context, {.resolution_px = 32, .atlas_px = 128});  // sixteen masks for sixty objects
  ask_all(kept);
  for (int step = 0; step < 3; ++step) {
    // All move, every other one also rotates, and one changes its shape.
    for (std::size_t i = 0; i < queries.size(); ++i) {
      Eigen::Isometry3d& T = scene[i].instance.T_world_mesh;
      T.pretranslate(Eigen::Vector3d(0.01, 0, 0.005));
      if (i % 2 == 0) T.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
      queries[i].object = scene[i].instance;
    }
    const Mesh another = shapes::box({0.02F * static_cast<float>(step + 1), 0.05F, 0.05F});
    trees[0]->build_by_place(another);
    meshes[0]->upload(another, MeshUsage::kStatic, *trees[0]);
    GlRadar fresh(context, {.resolution_px = 32});
    const std::vector<Contact> a = ask_all(kept), b = ask_all(fresh);
    for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i], i);
  }
}

TEST_F(GlQueryAll, InvalidOnesAreSaidAndTheOthersAnswered) {
  GlRadar radar(context);
  const GpuSceneMesh floor = scene.back();
  const GlQuery mixed[] = {{{meshes[0].get(), at(0, 0, 0.5)}, {0, 0, 0}, 1.0},
                           {{meshes[0].get(), at(0, 0, 0.5)}, kDown, 1.0},
                           {{nullptr, at(0, 0, 0.5)}, kDown, 1.0}};
  std::vector<Contact> contacts(3);
  radar.query_all(mixed, {&floor, 1}, contacts);
  EXPECT_EQ(contacts[0].status, ContactStatus::kInvalidInput);
  EXPECT_EQ(contacts[1].status, ContactStatus::kContact);
  EXPECT_EQ(contacts[2].status, ContactStatus::kInvalidInput);
  radar.query_all({}, {&floor, 1}, {});
}

TEST_F(GlQueryAll, WhatThePassesCannotTellIsSettledExactly) {
  // A peg inside the cup, behind the front wall as the cup moves sideways: the rear wall hits it.
  const Mesh cup = shapes::cup(0.04F, 0.1F, 0.004F, 16), peg = shapes::box({0.01F, 0.01F, 0.04F});
  upload(peg);
  const GpuSceneMesh target{{meshes.back().get(), at(0, 0, 0.06)}, SurfaceKind::kDynamic};
  GlRadar radar(context), unsettled(context, {.exact_fallback = false});
  const MeshInstance object{meshes[2].get(), at(0, 0, 0)};
  const Eigen::Vector3d sideways(1, 0.1, 0);
  const auto truth_m = exact_travel(cup, at(0, 0, 0), sideways, 0.2, peg, at(0, 0, 0.06));
  ASSERT_TRUE(truth_m);
  const Contact contact = radar.query(object, sideways, 0.2, {&target, 1});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_NEAR(contact.contact_distance_m, *truth_m, 1e-9);
  EXPECT_LT(contact.upper_m - contact.lower_m, 1e-9);
  EXPECT_EQ(contact.touched, SurfaceKind::kDynamic);
  const Contact wide = unsettled.query(object, sideways, 0.2, {&target, 1});
  EXPECT_EQ(wide.status, ContactStatus::kNoTarget);
  EXPECT_EQ(wide.lower_m, 0.0) << "holds, but says little";
}

}  // namespace
}  // namespace roomradar::gl_query_all_test
