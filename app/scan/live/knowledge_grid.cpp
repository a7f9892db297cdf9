// knowledge_grid.cpp: weights by cell, kept per anchor and summed in the world.
#include "app/scan/live/knowledge_grid.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr float kFarthest_m = 5.0F;
constexpr float kWellKnown = 5.0F;  ///< times SurfaceConfig::min_weight

std::uint64_t key_of(const Eigen::Vector3d& p) {
  return voxel_key((p / KnowledgeGrid::kCell_m).array().floor().cast<int>().matrix().eval());
}

Eigen::Vector3d centre_of(std::uint64_t cell) {
  return KnowledgeGrid::kCell_m * (voxel_of(cell).cast<double>().array() + 0.5).matrix();
}

/// Calls visit(column, row, point) for every kStep_px-th pixel with depth.
template <typename Visit>
void visit_samples(const Frame& frame, const Eigen::Isometry3d& T_to_camera, const Visit& visit) {
  constexpr int kStep_px = KnowledgeGrid::kStep_px;
  for (int y = kStep_px / 2; y < frame.depth_m.height; y += kStep_px)
    for (int x = kStep_px / 2; x < frame.depth_m.width; x += kStep_px) {
      const float depth_m = frame.depth_m.at(x, y);
      if (depth_m > 0.0F && depth_m <= kFarthest_m)
        visit(x / kStep_px, y / kStep_px, depth_m,
              T_to_camera * back_project(frame.depth_camera, x, y, static_cast<double>(depth_m)));
    }
}

/// Weight of a frame's sample in a cell: the frame's weight, shared by the samples that meet the cell.
float weight_of(const Frame& frame, float depth_m) {
  const float sigma = kUnitWeightSigma_m / depth_sigma_m(frame.depth_noise, depth_m);
  const float spacing_m = static_cast<float>(KnowledgeGrid::kStep_px / frame.depth_camera.fx_px) * depth_m;
  const float share = std::min(spacing_m / static_cast<float>(KnowledgeGrid::kCell_m), 1.0F);
  return sigma * sigma * share * share;
}

}  // namespace

void KnowledgeGrid::add(const Frame& frame, std::size_t anchor, const Eigen::Isometry3d& T_anchor_camera,
                        const Eigen::Isometry3d& T_world_anchor) {
  if (anchor >= in_anchor_.size()) in_anchor_.resize(anchor + 1);
  Weights& own = in_anchor_[anchor];
  visit_samples(frame, T_anchor_camera, [&](int, int, float depth_m, const Eigen::Vector3d& p_anchor) {
    const float weight = weight_of(frame, depth_m);
    own[key_of(p_anchor)] += weight;
    in_world_[key_of(T_world_anchor * p_anchor)] += weight;
  });
}

void KnowledgeGrid::move(const AnchorPoses& T_world_anchor) {
  in_world_.clear();
  for (std::size_t i = 0; i < in_anchor_.size() && i < T_world_anchor.size(); ++i)
    for (const auto& [cell, weight] : in_anchor_[i])
      if (T_world_anchor[i]) in_world_[key_of(*T_world_anchor[i] * centre_of(cell))] += weight;
}

Image<Knowledge> KnowledgeGrid::knowledge_of(const Frame& frame,
                                             const Eigen::Isometry3d& T_world_camera) const {
  const auto samples = [](int pixels) { return (pixels + kStep_px - 1 - kStep_px / 2) / kStep_px; };
  Image<Knowledge> knowledge(samples(frame.depth_m.width), samples(frame.depth_m.height), Knowledge::kNone);
  visit_samples(frame, T_world_camera, [&](int x, int y, float, const Eigen::Vector3d& p_world) {
    knowledge.at(x, y) = at(p_world);
  });
  return knowledge;
}

Knowledge KnowledgeGrid::at(const Eigen::Vector3d& p_world) const {
  const float least = SurfaceConfig{}.min_weight;
  const auto found = in_world_.find(key_of(p_world));
  const float weight = found == in_world_.end() ? 0.0F : found->second;
  return weight < least ? Knowledge::kNew : weight < kWellKnown * least ? Knowledge::kThin : Knowledge::kWell;
}

double KnowledgeGrid::well_known_fraction() const {
  const float least = SurfaceConfig{}.min_weight;
  std::size_t known = 0, well = 0;
  for (const auto& [cell, weight] : in_world_) {
    known += weight >= least ? 1 : 0;
    well += weight >= kWellKnown * least ? 1 : 0;
  }
  return known > 0 ? static_cast<double>(well) / static_cast<double>(known) : 0.0;
}

}  // namespace roomradar
