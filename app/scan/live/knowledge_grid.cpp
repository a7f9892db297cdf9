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

/// Place of a cell: key of its block, and index in the block.
struct CellPlace {
  std::uint64_t block = 0;
  std::size_t index = 0;
};

CellPlace place_of(const Eigen::Vector3d& p) {
  constexpr int kSide = KnowledgeGrid::kBlockSide;
  const Eigen::Vector3i cell = (p / KnowledgeGrid::kCell_m).array().floor().cast<int>();
  const Eigen::Vector3i block = cell.unaryExpr([](int i) { return floor_div(i, kSide); });
  const Eigen::Vector3i inside = cell - kSide * block;
  return {voxel_key(block), static_cast<std::size_t>((inside.z() * kSide + inside.y()) * kSide + inside.x())};
}

Eigen::Vector3d centre_of(std::uint64_t block, std::size_t index) {
  constexpr int kSide = KnowledgeGrid::kBlockSide;
  const int i = static_cast<int>(index);
  const Eigen::Vector3i cell =
      kSide * voxel_of(block) + Eigen::Vector3i(i % kSide, i / kSide % kSide, i / (kSide * kSide));
  return KnowledgeGrid::kCell_m * (cell.cast<double>().array() + 0.5).matrix();
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

void KnowledgeGrid::add_weight(Blocks& blocks, const Eigen::Vector3d& p, float weight) {
  const auto [block, cell] = place_of(p);
  blocks[block][cell] += weight;
}

void KnowledgeGrid::add(const Frame& frame, std::size_t anchor, const Eigen::Isometry3d& T_anchor_camera,
                        const Eigen::Isometry3d& T_world_anchor) {
  if (anchor >= in_anchor_.size()) in_anchor_.resize(anchor + 1);
  Blocks& own = in_anchor_[anchor];
  visit_samples(frame, T_anchor_camera, [&](int, int, float depth_m, const Eigen::Vector3d& p_anchor) {
    const float weight = weight_of(frame, depth_m);
    add_weight(own, p_anchor, weight);
    add_weight(in_world_, T_world_anchor * p_anchor, weight);
  });
}

void KnowledgeGrid::move(const AnchorPoses& T_world_anchor) {
  in_world_.clear();
  for (std::size_t i = 0; i < in_anchor_.size() && i < T_world_anchor.size(); ++i) {
    if (!T_world_anchor[i]) continue;
    for (const auto& [block, weights] : in_anchor_[i])
      for (std::size_t cell = 0; cell < weights.size(); ++cell)
        if (weights[cell] > 0.0F)
          add_weight(in_world_, *T_world_anchor[i] * centre_of(block, cell), weights[cell]);
  }
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
  const auto [block, cell] = place_of(p_world);
  const auto found = in_world_.find(block);
  const float weight = found == in_world_.end() ? 0.0F : found->second[cell];
  return weight < least ? Knowledge::kNew : weight < kWellKnown * least ? Knowledge::kThin : Knowledge::kWell;
}

double KnowledgeGrid::well_known_fraction() const {
  const float least = SurfaceConfig{}.min_weight;
  std::size_t known = 0, well = 0;
  for (const auto& [block, weights] : in_world_) {
    for (const float weight : weights) {
      known += weight >= least ? 1 : 0;
      well += weight >= kWellKnown * least ? 1 : 0;
    }
  }
  return known > 0 ? static_cast<double>(well) / static_cast<double>(known) : 0.0;
}

}  // namespace roomradar
