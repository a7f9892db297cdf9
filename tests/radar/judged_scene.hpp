// judged_scene.hpp: a scene for the radar (trees and depth images) and for the exact reference (meshes).
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar {

/// Returns the triangles that a SceneDepth represents, as its documentation defines them.
inline Mesh mesh_of(const SceneDepth& depth) {
  Mesh mesh;
  const DepthImage& image = *depth.depth_m;
  const int columns = (image.width - 1) / depth.stride_px + 1,
            rows = (image.height - 1) / depth.stride_px + 1;
  std::vector<float> depths_m;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int u = i * depth.stride_px, v = j * depth.stride_px;
      float depth_m = image.at(u, v);
      if (!std::isfinite(depth_m) || (depth.mask != nullptr && depth.mask->at(u, v) == 0)) depth_m = 0.0F;
      depths_m.push_back(depth_m);
      mesh.vertices.push_back(back_project(depth.camera, u, v, depth_m).cast<float>());
    }
  }
  const auto add = [&](int a, int b, int c) {
    const std::array<float, 3> d = {depths_m[static_cast<std::size_t>(a)],
                                    depths_m[static_cast<std::size_t>(b)],
                                    depths_m[static_cast<std::size_t>(c)]};
    const auto [low, high] = std::minmax({d[0], d[1], d[2]});
    if (!(low > 0.0F) || high - low > depth.max_jump_m + depth.max_jump_slope * low) return;
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;
      add(a, a + columns, a + columns + 1);
      add(a, a + columns + 1, a + 1);
    }
  }
  return mesh;
}

/// A mesh with its pose and its tree.
struct JudgedMesh {
  Mesh mesh;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
  TriangleTree tree;

  explicit JudgedMesh(Mesh m, const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity())
      : mesh(std::move(m)), T_world_mesh(T) {
    tree.build_by_place(mesh);
  }
};

class JudgedScene {
 public:
  void add(Mesh mesh, const Eigen::Isometry3d& T_world_mesh = Eigen::Isometry3d::Identity(),
           SurfaceKind kind = SurfaceKind::kStatic) {
    meshes_.emplace_back(std::move(mesh), T_world_mesh);
    kinds_.push_back(kind);
    has_tree_.push_back(true);
  }
  /// The image must outlive this.
  void add(const SceneDepth& depth) {
    depths_.push_back(depth);
    meshes_.emplace_back(mesh_of(depth), depth.T_world_camera);
    kinds_.push_back(depth.kind);
    has_tree_.push_back(false);
  }
  /// Moves everything by T, for the radar and the reference.
  void move(const Eigen::Isometry3d& T) {
    for (JudgedMesh& mesh : meshes_) mesh.T_world_mesh = T * mesh.T_world_mesh;
    for (SceneDepth& depth : depths_) depth.T_world_camera = T * depth.T_world_camera;
  }
  [[nodiscard]] Contact query(CyberRadar& radar, const JudgedMesh& object, const Eigen::Vector3d& direction,
                              double distance_m, double margin_m = 0.0) const {
    std::vector<SceneTree> trees;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      if (has_tree_[i]) trees.push_back({{&meshes_[i].tree, meshes_[i].T_world_mesh}, kinds_[i]});
    }
    return radar.query({.object = {&object.tree, object.T_world_mesh},
                        .direction_world = direction,
                        .distance_m = distance_m,
                        .margin_m = margin_m},
                       {trees, depths_});
  }
  [[nodiscard]] std::optional<double> contact_distance_m(const JudgedMesh& object,
                                                         const Eigen::Vector3d& direction,
                                                         double distance_m) const {
    std::optional<double> least_m;
    for (const JudgedMesh& mesh : meshes_) {
      const auto travel =
          exact_travel(object.mesh, object.T_world_mesh, direction, distance_m, mesh.mesh, mesh.T_world_mesh);
      if (travel && (!least_m || *travel < *least_m)) least_m = travel;
    }
    return least_m;
  }
  [[nodiscard]] const std::deque<JudgedMesh>& meshes() const { return meshes_; }

 private:
  std::deque<JudgedMesh> meshes_;
  std::vector<SceneDepth> depths_;
  std::vector<SurfaceKind> kinds_;
  std::vector<bool> has_tree_;
};

/// Describes a query and its result completely enough to repeat it.
inline std::string describe(const JudgedMesh& object, const Eigen::Vector3d& direction, double distance_m,
                            const Contact& got, const std::optional<double>& truth_m) {
  std::ostringstream text;
  text.precision(17);
  text << "status " << static_cast<int>(got.status) << " travel " << got.contact_distance_m << " lower "
       << got.lower_m << " upper " << got.upper_m << " pixel " << got.pixel_m << ", truth ";
  if (truth_m) {
    text << *truth_m;
  } else {
    text << "none";
  }
  text << " within " << distance_m << " m along " << direction.transpose() << "; object at\n"
       << object.T_world_mesh.matrix();
  return text.str();
}

constexpr double kExactError_m = 1e-6;
constexpr double kBoundRounding_m = 1e-9;  ///< rounding error when double results are compared

/// For a free pose in exact mode: lower = upper = truth.
inline testing::AssertionResult is_exact(const Contact& got, const std::optional<double>& truth_m,
                                         double distance_m) {
  if (truth_m) {
    // At the very end of the distance, both contact and none are accepted.
    if (distance_m - *truth_m < kExactError_m) return testing::AssertionSuccess();
    if (got.status != ContactStatus::kContact) return testing::AssertionFailure() << "no contact";
    if (!(std::abs(got.contact_distance_m - *truth_m) <= kExactError_m)) {
      return testing::AssertionFailure() << "off by " << got.contact_distance_m - *truth_m;
    }
    if (!(got.upper_m - got.lower_m <= 2.0 * kExactError_m)) return testing::AssertionFailure() << "wide";
  } else {
    if (got.status != ContactStatus::kNoTarget) return testing::AssertionFailure() << "invented";
    if (!(got.lower_m >= distance_m - kExactError_m)) return testing::AssertionFailure() << "timid";
  }
  return testing::AssertionSuccess();
}

/// For a free pose in any mode: lower <= truth <= upper, and travel between them.
inline testing::AssertionResult holds(const Contact& got, const std::optional<double>& truth_m,
                                      double distance_m) {
  if (got.status != ContactStatus::kContact && got.status != ContactStatus::kNoTarget) {
    return testing::AssertionFailure() << "wrong status";
  }
  const double rounding_m = kBoundRounding_m;
  if (!(got.lower_m <= (truth_m ? *truth_m : distance_m) + rounding_m)) {
    return testing::AssertionFailure() << "lower bound above the truth";
  }
  if (!(got.upper_m >= (truth_m ? *truth_m : distance_m) - rounding_m)) {
    return testing::AssertionFailure() << "upper bound under the truth";
  }
  if (got.status == ContactStatus::kContact && !(got.contact_distance_m >= got.lower_m - rounding_m)) {
    return testing::AssertionFailure() << "travel under its lower bound";
  }
  if (got.status == ContactStatus::kContact && !(got.contact_distance_m <= got.upper_m + rounding_m)) {
    return testing::AssertionFailure() << "travel over its upper bound";
  }
  return testing::AssertionSuccess();
}

}  // namespace roomradar
