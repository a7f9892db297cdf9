// fusion.cpp: the descent that fuses one depth frame.
#include "mapping/fusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

using HitRange = std::span<const std::uint64_t>;

constexpr float kNearest_m = 0.01F;  // nothing is projected from nearer to the camera's plane
constexpr unsigned kExactDepth = 9;  // above, centres are computed in double: nodes are metres away from zero
constexpr std::uint8_t kMaxColours = 16;  // of a running mean; more would round later ones away

struct Cell {
  unsigned depth = 0;
  Eigen::Array3i key = Eigen::Array3i::Zero();       // of its lowest voxel
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  // m, in the camera frame
};

enum class Verdict {
  kNothing,   // hidden, or out of sight
  kFree,      // seen through as a whole
  kPartFree,  // what is seen of it is seen through; the rest is out of sight or has no depth
  kSplit,     // a surface may be in it
};

// What one leaf gets from the pixel that its centre falls on.
struct Observation {
  bool free = false;     // the centre is seen through
  bool sampled = false;  // the centre is within the truncation of the measured surface
  float distance_m = 0.0F;
  float weight = 0.0F;
  const Rgb* colour = nullptr;

  [[nodiscard]] bool says_nothing() const { return !free && !sampled; }
};

class Descent {
 public:
  Descent(RoomOcTree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
          const FusionConfig& config, const DepthPyramid& pyramid)
      : tree_(tree),
        frame_(frame),
        config_(config),
        pyramid_(pyramid),
        T_camera_world_(T_world_camera.inverse()),
        fx_(static_cast<float>(frame.depth_camera.fx_px)),
        fy_(static_cast<float>(frame.depth_camera.fy_px)),
        cx_(static_cast<float>(frame.depth_camera.cx_px)),
        cy_(static_cast<float>(frame.depth_camera.cy_px)),
        sigma_at_1m_(depth_sigma_m(1.0F)) {
    const Eigen::Matrix3d R_camera_world = T_camera_world_.linear();
    for (unsigned depth = 0; depth <= kLeafDepth; ++depth) {
      const double half_m = tree.getNodeSize(depth) / 2;
      half_extent_[depth] = (R_camera_world.cwiseAbs().rowwise().sum() * half_m).cast<float>();
      for (unsigned i = 0; i < 8; ++i) {
        const Eigen::Vector3d towards(i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0);
        to_child_[depth][i] = (R_camera_world * towards * half_m / 2).cast<float>();
      }
    }
    const ColourImage& colour = frame.colour;
    has_colour_ = !colour.empty() && colour.width == frame.colour_camera.width_px &&
                  colour.height == frame.colour_camera.height_px;
    T_colour_depth_ = frame.T_colour_depth.cast<float>();
    colour_distance_m_ = 2.0F * static_cast<float>(tree.getResolution());
  }

  void run(HitRange hits) {
    RoomNode& root = tree_.ensure_root();
    const Cell whole{0, Eigen::Array3i::Zero(), exact_centre(0, Eigen::Array3i::Zero())};
    split(root, whole, hits);
    if (!holds_anything(root)) tree_.remove_root();
  }

 private:
  // Children of an inner node. The node has a place in the tree already; it may be empty or a merged leaf.
  void split(RoomNode& node, const Cell& cell, HitRange hits) {
    if (cell.depth == kLeafDepth - 1) return update_leaves(node, cell, hits);
    std::array<Cell, 8> cells;
    std::array<HitRange, 8> hits_in;
    std::array<Verdict, 8> verdicts;
    bool nothing = true;
    bool free_only = true;
    const bool settled = is_settled_free(node);
    for (unsigned i = 0; i < 8; ++i) {
      cells[i] = child_cell(cell, i);
      hits_in[i] = take_front(hits, cells[i]);
      verdicts[i] = hits_in[i].empty() ? classify(cells[i]) : Verdict::kSplit;
      if (verdicts[i] == Verdict::kPartFree) {
        const RoomNode* child = tree_.child(node, i);
        verdicts[i] = settled || (child && is_settled_free(*child)) ? Verdict::kNothing : Verdict::kSplit;
      }
      nothing &= verdicts[i] == Verdict::kNothing;
      free_only &= verdicts[i] != Verdict::kSplit;
    }
    if (nothing || (free_only && settled)) return;
    open(node);
    for (unsigned i = 0; i < 8; ++i) {
      if (verdicts[i] == Verdict::kNothing) continue;
      RoomNode& child = tree_.ensure_child(node, i);
      if (verdicts[i] == Verdict::kFree) {
        mark_free(child, weight_of(cells[i].centre.z()));
      } else {
        split(child, cells[i], hits_in[i]);
        if (!holds_anything(child)) tree_.deleteNodeChild(&node, i);
      }
    }
    if (tree_.nodeHasChildren(&node)) {
      tree_.summarise(node);
    } else {
      node.free_empty_child_table();
    }
  }

  void update_leaves(RoomNode& node, const Cell& cell, HitRange hits) {
    unsigned hit_mask = 0;
    for (const std::uint64_t code : hits) hit_mask |= 1U << (code & 7U);
    std::array<Observation, 8> observed;
    bool nothing = hit_mask == 0;
    bool free_only = hit_mask == 0;
    for (unsigned i = 0; i < 8; ++i) {
      observed[i] = observe(cell.centre + to_child_[cell.depth][i]);
      nothing &= observed[i].says_nothing();
      free_only &= !observed[i].sampled;
    }
    if (nothing || (free_only && is_settled_free(node))) return;
    open(node);
    for (unsigned i = 0; i < 8; ++i) {
      const bool hit = (hit_mask >> i & 1U) != 0;
      if (!hit && observed[i].says_nothing()) continue;
      RoomNode& leaf = tree_.ensure_child(node, i);
      if (hit) {
        leaf.setLogOdds(std::min(leaf.getLogOdds() + config_.hit_log_odds, config_.max_log_odds));
      } else if (observed[i].free) {
        miss(leaf);
      }
      if (observed[i].sampled) add_sample(leaf, observed[i]);
    }
    tree_.summarise(node);
  }

  [[nodiscard]] Observation observe(const Eigen::Vector3f& p_camera) const {
    Observation seen;
    const float z = p_camera.z();
    if (!(z > kNearest_m)) return seen;
    const float u = fx_ * p_camera.x() / z + cx_ + 0.5F;
    const float v = fy_ * p_camera.y() / z + cy_ + 0.5F;
    if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(frame_.depth_m.width) &&
          v < static_cast<float>(frame_.depth_m.height)))
      return seen;
    const int x = static_cast<int>(u);
    const int y = static_cast<int>(v);
    const float depth = frame_.depth_m.at(x, y);
    if (!(depth > 0.0F)) return seen;
    if (depth > config_.max_range_m) {
      seen.free = z < config_.max_range_m;
      return seen;
    }
    const DepthBounds& bounds = pyramid_.levels.front().at(x, y);
    seen.free = z < depth;
    seen.sampled = z >= bounds.front_m && z <= bounds.back_m;
    if (!seen.sampled) return seen;
    seen.distance_m = depth - z;
    seen.weight = weight_of(depth);
    if (has_colour_ && std::abs(seen.distance_m) < colour_distance_m_) seen.colour = colour_at(p_camera);
    return seen;
  }

  [[nodiscard]] const Rgb* colour_at(const Eigen::Vector3f& p_camera) const {
    const Eigen::Vector3f p_colour = T_colour_depth_ * p_camera;
    if (!(p_colour.z() > kNearest_m)) return nullptr;
    const Intrinsics& camera = frame_.colour_camera;
    const float u =
        static_cast<float>(camera.fx_px) * p_colour.x() / p_colour.z() + static_cast<float>(camera.cx_px);
    const float v =
        static_cast<float>(camera.fy_px) * p_colour.y() / p_colour.z() + static_cast<float>(camera.cy_px);
    if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(camera.width_px - 1) &&
          v < static_cast<float>(camera.height_px - 1)))
      return nullptr;
    return &frame_.colour.at(static_cast<int>(u + 0.5F), static_cast<int>(v + 0.5F));
  }

  [[nodiscard]] float weight_of(float depth_m) const {
    const float ratio = sigma_at_1m_ / depth_sigma_m(depth_m);
    return std::min(ratio * ratio, 1.0F);
  }

  void miss(RoomNode& leaf) const {
    leaf.setLogOdds(std::max(leaf.getLogOdds() + config_.miss_log_odds, config_.min_log_odds));
  }

  void add_sample(RoomNode& leaf, const Observation& seen) const {
    const float sum = leaf.weight + seen.weight;
    leaf.distance_m += (seen.distance_m - leaf.distance_m) * (seen.weight / sum);
    leaf.weight = std::min(sum, config_.max_weight);
    if (!seen.colour) return;
    const auto blend = [n = leaf.colour_count + 1](std::uint8_t mean, std::uint8_t value) {
      return static_cast<std::uint8_t>((mean * (n - 1) + value + n / 2) / n);
    };
    leaf.colour = {blend(leaf.colour.r, seen.colour->r), blend(leaf.colour.g, seen.colour->g),
                   blend(leaf.colour.b, seen.colour->b)};
    leaf.colour_count = std::min(static_cast<std::uint8_t>(leaf.colour_count + 1), kMaxColours);
  }

  // The leaf lies in a node that is seen through as a whole: its distance is at least the truncation. Once
  // this is settled the sample goes, so that the leaf can merge with the free space around it. A leaf seen
  // through by its own pixel alone keeps its sample: beside an edge, and on surfaces seen obliquely, that is
  // noise more often than change.
  void fade_sample(RoomNode& leaf, float weight) const {
    const float truncation = config_.truncation_voxels * static_cast<float>(tree_.getResolution());
    const float gained = weight * config_.seen_through_gain;
    const float sum = leaf.weight + gained;
    leaf.distance_m += (std::max(truncation, leaf.distance_m) - leaf.distance_m) * (gained / sum);
    leaf.weight = std::min(sum, config_.max_weight);
    if (leaf.getLogOdds() <= config_.min_log_odds && leaf.distance_m > 0.7F * truncation)
      leaf.forget_sample();
  }

  // The whole node is seen through.
  void mark_free(RoomNode& node, float weight) {
    if (!tree_.nodeHasChildren(&node)) {
      miss(node);
      if (node.has_sample()) fade_sample(node, weight);
      return;
    }
    for (unsigned i = 0; i < 8; ++i) mark_free(tree_.ensure_child(node, i), weight);
    tree_.summarise(node);
  }

  // Of a node that no ray ends in, from its box in the camera frame and the image rectangle that the box
  // falls into.
  [[nodiscard]] Verdict classify(const Cell& cell) const {
    const Eigen::Vector3f low = cell.centre - half_extent_[cell.depth];
    const Eigen::Vector3f high = cell.centre + half_extent_[cell.depth];
    const auto width = static_cast<float>(frame_.depth_m.width);
    const auto height = static_cast<float>(frame_.depth_m.height);
    if (high.z() <= kNearest_m) return Verdict::kNothing;
    if (low.z() > config_.max_range_m * 2.0F) return Verdict::kNothing;
    if (low.z() <= kNearest_m) {
      // Straddles the camera's plane: outside only if the image's border planes have it wholly on their far
      // side.
      const bool outside =
          fx_ * low.x() > (width - cx_) * high.z() || fx_ * high.x() < -(cx_ + 1.0F) * high.z() ||
          fy_ * low.y() > (height - cy_) * high.z() || fy_ * high.y() < -(cy_ + 1.0F) * high.z();
      return outside ? Verdict::kNothing : Verdict::kSplit;
    }
    const float far_inverse = 1.0F / high.z();
    const float near_inverse = 1.0F / low.z();
    const float left = fx_ * low.x() * (low.x() > 0.0F ? far_inverse : near_inverse) + cx_;
    const float right = fx_ * high.x() * (high.x() > 0.0F ? near_inverse : far_inverse) + cx_;
    const float top = fy_ * low.y() * (low.y() > 0.0F ? far_inverse : near_inverse) + cy_;
    const float bottom = fy_ * high.y() * (high.y() > 0.0F ? near_inverse : far_inverse) + cy_;
    if (right < -0.5F || bottom < -0.5F || left > width - 0.5F || top > height - 0.5F)
      return Verdict::kNothing;
    const bool whole = left >= -0.5F && top >= -0.5F && right <= width - 0.5F && bottom <= height - 0.5F;
    const auto pixel = [](float coordinate, int size) {
      return static_cast<int>(std::clamp(coordinate + 0.5F, 0.0F, static_cast<float>(size - 1)));
    };
    const DepthBounds bounds =
        bounds_within(pyramid_, pixel(left, frame_.depth_m.width), pixel(top, frame_.depth_m.height),
                      pixel(right, frame_.depth_m.width), pixel(bottom, frame_.depth_m.height));
    if (low.z() > bounds.back_m) return Verdict::kNothing;
    if (whole && high.z() < bounds.front_m) return Verdict::kFree;
    if (high.z() < bounds.nearest_m) return Verdict::kPartFree;
    return Verdict::kSplit;
  }

  [[nodiscard]] Cell child_cell(const Cell& cell, unsigned i) const {
    const int edge = 1 << (kLeafDepth - cell.depth - 1);
    const Eigen::Array3i key =
        cell.key + Eigen::Array3i(i & 1U ? edge : 0, i & 2U ? edge : 0, i & 4U ? edge : 0);
    if (cell.depth < kExactDepth) return {cell.depth + 1, key, exact_centre(cell.depth + 1, key)};
    return {cell.depth + 1, key, cell.centre + to_child_[cell.depth][i]};
  }

  [[nodiscard]] Eigen::Vector3f exact_centre(unsigned depth, const Eigen::Array3i& key) const {
    const double half_edge = 0.5 * (1 << (kLeafDepth - depth));
    const Eigen::Vector3d centre_world =
        (key.cast<double>() - kKeyOrigin + half_edge).matrix() * tree_.getResolution();
    return (T_camera_world_ * centre_world).cast<float>();
  }

  // Splits off the hits that lie in the cell, which come first: cells are visited in Morton order.
  static HitRange take_front(HitRange& hits, const Cell& cell) {
    const unsigned shift = 3 * (kLeafDepth - cell.depth);
    if (hits.empty()) return {};
    const std::uint64_t parent = hits.front() >> (shift + 3);
    const auto digit = [&](int axis) {
      return static_cast<std::uint64_t>(cell.key[axis] >> (kLeafDepth - cell.depth)) & 1U;
    };
    const std::uint64_t own = parent << 3U | digit(0) | digit(1) << 1U | digit(2) << 2U;
    const auto end = std::partition_point(hits.begin(), hits.end(),
                                          [&](std::uint64_t code) { return code >> shift <= own; });
    const HitRange taken = hits.first(static_cast<std::size_t>(end - hits.begin()));
    hits = hits.subspan(taken.size());
    return taken;
  }

  // A merged free leaf that another miss would not change.
  [[nodiscard]] bool is_settled_free(const RoomNode& node) const {
    return node.getLogOdds() <= config_.min_log_odds && !node.has_sample() && !tree_.nodeHasChildren(&node);
  }
  // Gives a merged leaf its eight children back.
  void open(RoomNode& node) {
    if (node.getLogOdds() != 0.0F && !tree_.nodeHasChildren(&node)) tree_.expandNode(&node);
  }
  [[nodiscard]] bool holds_anything(const RoomNode& node) const {
    return node.getLogOdds() != 0.0F || node.has_sample() || tree_.nodeHasChildren(&node);
  }

  RoomOcTree& tree_;
  const Frame& frame_;
  const FusionConfig& config_;
  const DepthPyramid& pyramid_;
  Eigen::Isometry3d T_camera_world_;
  float fx_, fy_, cx_, cy_;
  float sigma_at_1m_;
  std::array<Eigen::Vector3f, kLeafDepth + 1> half_extent_;  // of a node's box along the camera's axes
  // From a node's centre to its children's.
  std::array<std::array<Eigen::Vector3f, 8>, kLeafDepth + 1> to_child_;
  Eigen::Isometry3f T_colour_depth_;
  float colour_distance_m_ = 0.0F;
  bool has_colour_ = false;
};

}  // namespace

void fuse_depth(RoomOcTree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                const FusionConfig& config, FusionScratch& scratch) {
  build_pyramid(frame.depth_m, tree.getResolution(), config, scratch.pyramid);
  Descent(tree, frame, T_world_camera, config, scratch.pyramid).run(scratch.hits);
}

}  // namespace roomradar
