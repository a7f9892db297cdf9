// change_tracker.cpp: projects the points into each frame, and confirms, contradicts or drops them.
#include "dynamic/foreground/change_tracker.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/disjoint_sets.hpp"
#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNoCell = ~std::uint32_t{0};
constexpr int kAllRound = 7;  // neighbours of an interior cell, of eight in a flat surface

/// Returns the slot of a cell in the hash table, or the empty slot where it belongs.
std::uint32_t find_cell(const ChangeClusters& clusters, std::uint64_t code) {
  const std::size_t mask = clusters.table.size() - 1;
  for (std::size_t at = fibonacci_hash(code) >> 32U & mask;; at = (at + 1) & mask)
    if (clusters.table[at] == kNoCell || clusters.cells[clusters.table[at]].code == code)
      return static_cast<std::uint32_t>(at);
}

/// Returns the root cell of a cell's object.
std::uint32_t object_of(std::vector<ChangeCell>& cells, std::uint32_t cell) {
  return find_root(cell, [&](std::uint32_t of) -> std::uint32_t& { return cells[of].joined_to; });
}

}  // namespace

void require_valid(const ChangeTrackerConfig& config) {
  const ConfigCheck require{"change_tracker"};
  const auto part = [](float value) { return value >= 0.0F && value <= 1.0F; };
  require(config.spacing_m >= 0.002F && config.spacing_m <= 1.0F, "spacing_m", config.spacing_m,
          "in 0.002..1");
  require(config.agree_sigmas > 0.0F && config.agree_sigmas < 1e3F, "agree_sigmas", config.agree_sigmas,
          "in 0..1000");
  require(config.pose_sigma_m >= 0.0F && config.pose_sigma_m < 1.0F, "pose_sigma_m", config.pose_sigma_m,
          "in 0..1");
  require(config.pose_sigma_per_m >= 0.0F && config.pose_sigma_per_m < 1.0F, "pose_sigma_per_m",
          config.pose_sigma_per_m, "in 0..1");
  require(config.own_reach_m >= 0.0F && std::isfinite(config.own_reach_m), "own_reach_m", config.own_reach_m,
          ">= 0");
  require(config.link_m >= config.spacing_m && config.link_m <= 1.0F, "link_m", config.link_m,
          "at least spacing_m, and at most 1");
  require(config.min_cells >= 1, "min_cells", config.min_cells, ">= 1");
  require(part(config.min_steady_fraction), "min_steady_fraction", config.min_steady_fraction, "in 0..1");
  require(part(config.min_core_fraction), "min_core_fraction", config.min_core_fraction, "in 0..1");
  require(part(config.min_seen_fraction), "min_seen_fraction", config.min_seen_fraction, "in 0..1");
  require(part(config.min_known_fraction), "min_known_fraction", config.min_known_fraction, "in 0..1");
  require(config.forget_after_s > 0.0F, "forget_after_s", config.forget_after_s, "> 0");
  require(config.max_points >= 1 && config.max_points <= 10'000'000, "max_points",
          static_cast<double>(config.max_points), "in 1..10000000");
}

std::string_view to_string(LastingKind kind) { return kind == LastingKind::kCame ? "came" : "went"; }

Eigen::AlignedBox3d LastingChange::box_world() const {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points_world) box.extend(p);
  return box;
}

void reserve(std::size_t max_points, ChangeClusters& clusters) {
  clusters.cell_of.reserve(max_points);
  clusters.cells.reserve(max_points);
  clusters.objects.reserve(max_points);
  clusters.table.reserve(4 * max_points);
}

void sort_into_cells(std::span<const ChangePoint> points, LastingKind kind, float seconds, float link_m,
                     ChangeClusters& clusters) {
  std::size_t places = 64;
  while (places < 2 * points.size()) places *= 2;
  clusters.table.assign(places, kNoCell);
  clusters.cells.clear();
  clusters.cell_of.assign(points.size(), kNoCell);
  const auto index_of = [&](float x) { return static_cast<std::int64_t>(std::floor(x / link_m)); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ChangePoint& point = points[i];
    if (point.kind != kind) continue;
    const std::uint64_t code =
        voxel_key(index_of(point.position.x()), index_of(point.position.y()), index_of(point.position.z()));
    const std::uint32_t at = find_cell(clusters, code);
    if (clusters.table[at] == kNoCell) {
      clusters.table[at] = static_cast<std::uint32_t>(clusters.cells.size());
      clusters.cells.push_back({.code = code, .joined_to = clusters.table[at], .steady = false});
    }
    clusters.cell_of[i] = clusters.table[at];
    clusters.cells[clusters.table[at]].steady |= point.steady_s >= seconds;
  }
  const std::uint64_t zero = voxel_key(0, 0, 0);
  for (std::uint32_t cell = 0; cell < clusters.cells.size(); ++cell) {
    for (int n = 0; n < kCellsRound / 2; ++n) {  // the neighbour's own loop covers the other half
      const std::uint32_t beside =
          clusters
              .table[find_cell(clusters, clusters.cells[cell].code + voxel_key(neighbour_offset(n)) - zero)];
      if (beside == kNoCell) continue;
      ++clusters.cells[cell].neighbours;
      ++clusters.cells[beside].neighbours;
      const std::uint32_t a = object_of(clusters.cells, cell), b = object_of(clusters.cells, beside);
      clusters.cells[std::max(a, b)].joined_to = std::min(a, b);
    }
  }
}

void add_objects(std::span<const ChangePoint> points, LastingKind kind, const Eigen::Vector3d& origin_world,
                 const ChangeTrackerConfig& config, ChangeClusters& clusters,
                 std::vector<LastingChange>& changes) {
  clusters.objects.assign(clusters.cells.size(), {});
  for (std::uint32_t cell = 0; cell < clusters.cells.size(); ++cell) {
    ChangeObject& object = clusters.objects[object_of(clusters.cells, cell)];
    ++object.cells;
    object.steady_cells += clusters.cells[cell].steady ? 1 : 0;
    object.core_cells += clusters.cells[cell].neighbours >= kAllRound ? 1 : 0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clusters.cell_of[i] == kNoCell) continue;
    ChangeObject& object = clusters.objects[object_of(clusters.cells, clusters.cell_of[i])];
    ++object.points;
    object.seen_points += points[i].as_it_was ? 1 : 0;
    object.known_points += points[i].before_map ? 1 : 0;
  }
  const float min_core = kind == LastingKind::kWent ? config.min_core_fraction : 0.0F;
  const float min_known = kind == LastingKind::kCame ? config.min_known_fraction : 0.0F;
  for (ChangeObject& object : clusters.objects) {
    if (object.cells < config.min_cells ||
        static_cast<float>(object.core_cells) < min_core * static_cast<float>(object.cells) ||
        static_cast<float>(object.steady_cells) <
            config.min_steady_fraction * static_cast<float>(object.cells) ||
        static_cast<float>(object.seen_points) <
            config.min_seen_fraction * static_cast<float>(object.points) ||
        static_cast<float>(object.known_points) < min_known * static_cast<float>(object.points))
      continue;
    changes.push_back({.kind = kind, .points_world = {}, .ids = {}});
    object.change = changes.size();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clusters.cell_of[i] == kNoCell) continue;
    const std::size_t change = clusters.objects[object_of(clusters.cells, clusters.cell_of[i])].change;
    if (change == 0) continue;
    changes[change - 1].points_world.emplace_back(origin_world + points[i].position.cast<double>());
    changes[change - 1].ids.push_back(points[i].id);
  }
}

namespace {

constexpr float kNearest_m = 0.2F;  // no sensor measures nearer
constexpr double kLongestStep_s = 0.5;
// A contradicting sighting weighs as much as two confirming ones. At the rim of an object that stays, the
// pixel may show the background: one frame in four misses the object there.
constexpr int kContradiction = 2, kConfirmation = 1, kMaxContradiction = 7;
constexpr float kFarApart_m = 4.0F;  // depth at which pixels of the sampling grid are spacing_m apart
constexpr float kNothing_m = std::numeric_limits<float>::quiet_NaN();

std::uint8_t bit_of(LastingKind kind) { return static_cast<std::uint8_t>(1U << static_cast<unsigned>(kind)); }

}  // namespace

struct ChangeTracker::View {
  const DepthImage& depth_m;
  const DepthImage& expected_m;
  const LabelImage& labels;
  float fx, fy, cx, cy;
  Eigen::Matrix3f R_camera_world;
  Eigen::Vector3f t_camera_world;  // for points relative to the tracker's origin
  int stride_px;                   // stride of the sampling grid
  int grid_width;

  [[nodiscard]] Eigen::Vector3f to_camera(const Eigen::Vector3f& p) const {
    return R_camera_world * p + t_camera_world;
  }
  [[nodiscard]] Eigen::Vector3f from_camera(const Eigen::Vector3f& p_camera) const {
    return R_camera_world.transpose() * (p_camera - t_camera_world);
  }
  [[nodiscard]] Eigen::Vector3f back_projected(int x, int y, float z) const {
    return {(static_cast<float>(x) - cx) / fx * z, (static_cast<float>(y) - cy) / fy * z, z};
  }
};

namespace {

// Returns how much farther than z the image is at (x, y), or at the adjacent pixel that agrees best, since a
// point between two pixels or on an edge appears in one of them. NaN if nothing is measured.
float beyond(const DepthImage& depth_m, int x, int y, float z) {
  float best = kNothing_m;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height - 1); ++v) {
    const float* row = depth_m.row(v);
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width - 1); ++u)
      if (row[u] > 0.0F && !(std::abs(row[u] - z) >= std::abs(best))) best = row[u] - z;
  }
  return best;
}

// Returns true if (x, y) or an adjacent pixel has this label.
bool is_labelled(const LabelImage& labels, int x, int y, PixelLabel label) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, labels.height - 1); ++v) {
    const PixelLabel* row = labels.row(v);
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, labels.width - 1); ++u)
      if (row[u] == label) return true;
  }
  return false;
}

float tolerance_m(const ChangeTrackerConfig& config, float z) {
  const float sensor = depth_sigma_m(config.noise, z);
  const float pose = config.pose_sigma_m + config.pose_sigma_per_m * z;
  return config.agree_sigmas * std::sqrt(sensor * sensor + pose * pose);
}

}  // namespace

ChangeTracker::ChangeTracker(const ChangeTrackerConfig& config) : config_(config) {
  require_valid(config);
  points_.reserve(config.max_points);
  reserve(config.max_points, clusters_);
}

void ChangeTracker::update(const DepthImage& depth_m, const DepthImage& expected_depth_m,
                           const LabelImage& labels, const Intrinsics& camera,
                           const Eigen::Isometry3d& T_world_camera, double stamp_s) {
  assert(depth_m.width == expected_depth_m.width && depth_m.height == expected_depth_m.height);
  assert(depth_m.width == labels.width && depth_m.height == labels.height);
  if (!has_origin_) {
    origin_world_ = T_world_camera.translation();
    if (std::isfinite(stamp_s)) last_stamp_s_ = stamp_s;
    has_origin_ = true;
  }
  const double passed_s = stamp_s - last_stamp_s_;
  const double dt_s = passed_s > 0.0 ? std::min(passed_s, kLongestStep_s) : 0.0;  // 0 for NaN
  if (std::isfinite(stamp_s)) last_stamp_s_ = stamp_s;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  const double focal_px = std::min(camera.fx_px, camera.fy_px);
  const int stride_px = std::max(static_cast<int>(focal_px * config_.spacing_m / kFarApart_m), 1);
  const View view{depth_m,
                  expected_depth_m,
                  labels,
                  static_cast<float>(camera.fx_px),
                  static_cast<float>(camera.fy_px),
                  static_cast<float>(camera.cx_px),
                  static_cast<float>(camera.cy_px),
                  T_camera_world.linear().cast<float>(),
                  (T_camera_world * origin_world_).cast<float>(),
                  stride_px,
                  (depth_m.width + stride_px - 1) / stride_px};
  const int grid_height = (depth_m.height + stride_px - 1) / stride_px;
  covered_.assign(static_cast<std::size_t>(view.grid_width) * static_cast<std::size_t>(grid_height), 0);
  std::erase_if(points_, [&](ChangePoint& point) { return !review(view, static_cast<float>(dt_s), point); });
  add_points(view);
}

bool ChangeTracker::review(const View& view, float dt_s, ChangePoint& point) {
  const Eigen::Vector3f p_camera = view.to_camera(point.position);
  const float z = p_camera.z();
  point.as_it_was = false;
  point.unseen_s += dt_s;
  const bool may_stay_unseen = point.unseen_s < config_.forget_after_s;
  if (!(z > kNearest_m)) return may_stay_unseen;
  const float u_px = view.fx * p_camera.x() / z + view.cx;
  const float v_px = view.fy * p_camera.y() / z + view.cy;
  const auto right = static_cast<float>(view.depth_m.width) - 0.5F;
  const auto bottom = static_cast<float>(view.depth_m.height) - 0.5F;
  if (!(u_px > -0.5F && v_px > -0.5F && u_px < right && v_px < bottom)) return may_stay_unseen;
  const int x = static_cast<int>(u_px + 0.5F);
  const int y = static_cast<int>(v_px + 0.5F);
  const float tolerance = tolerance_m(config_, z);
  const bool came = point.kind == LastingKind::kCame;

  const float live_here = view.depth_m.at(x, y);
  const float live = came ? beyond(view.depth_m, x, y, z) : live_here > 0.0F ? live_here - z : kNothing_m;
  // Not measured (NaN), or occluded by another surface; a kWent point is occluded by any surface.
  if (!(live >= (came ? -config_.own_reach_m : -tolerance))) return may_stay_unseen;
  const float model = beyond(view.expected_m, x, y, z);
  const bool in_model = std::abs(model) <= tolerance;
  const bool in_sight = std::abs(live) <= tolerance;

  // A kCame point must be visible and not in the model yet; a kWent point must be invisible and still in the
  // model. The foreground knows more about edges and noise: pixels that it labels static are static.
  bool holds = came ? in_sight && !in_model : !in_sight && in_model;
  if (!came && model < -tolerance) return may_stay_unseen;  // the model has a surface in front of the point
  if (holds && !is_labelled(view.labels, x, y, came ? PixelLabel::kMoved : PixelLabel::kRevealed)) {
    const PixelLabel label = view.labels.at(x, y);
    if (label == PixelLabel::kNotKnown || label == PixelLabel::kUnmapped) return may_stay_unseen;
    holds = false;
  }
  point.unseen_s = 0.0F;
  if (!holds) {
    point.contradiction = static_cast<std::uint8_t>(point.contradiction + kContradiction);
    return point.contradiction <= kMaxContradiction;
  }
  point.as_it_was = true;
  point.before_map |= model > tolerance;  // false for NaN
  point.steady_s += dt_s;
  point.contradiction = static_cast<std::uint8_t>(std::max(point.contradiction - kConfirmation, 0));
  if (came && std::abs(live_here - z) <= tolerance && live_here > 0.0F) {
    // Mean of all sightings, along the rays.
    if (point.sightings < std::numeric_limits<std::uint16_t>::max()) ++point.sightings;
    const float share = (live_here - z) / (z * static_cast<float>(point.sightings));
    point.position = view.from_camera(p_camera * (1.0F + share));
  }
  cover(view, point.kind, u_px, v_px, z);
  return true;
}

void ChangeTracker::cover(const View& view, LastingKind kind, float u_px, float v_px, float depth_m) {
  const auto stride = static_cast<float>(view.stride_px);
  const float reach_px = 0.5F * config_.spacing_m * view.fx / depth_m;
  const int last_column = view.grid_width - 1;
  const int last_row = static_cast<int>(covered_.size()) / view.grid_width - 1;
  // Grid points within reach_px of the point, along rows and columns.
  const int left = std::max(static_cast<int>(std::ceil((u_px - reach_px) / stride)), 0);
  const int right = std::min(static_cast<int>(std::floor((u_px + reach_px) / stride)), last_column);
  const int top = std::max(static_cast<int>(std::ceil((v_px - reach_px) / stride)), 0);
  const int bottom = std::min(static_cast<int>(std::floor((v_px + reach_px) / stride)), last_row);
  for (int row = top; row <= bottom; ++row) {
    std::uint8_t* covered =
        covered_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(view.grid_width);
    for (int column = left; column <= right; ++column) covered[column] |= bit_of(kind);
  }
}

void ChangeTracker::add_points(const View& view) {
  std::size_t place = 0;
  for (int y = 0; y < view.depth_m.height; y += view.stride_px) {
    const PixelLabel* labels = view.labels.row(y);
    for (int x = 0; x < view.depth_m.width; x += view.stride_px, ++place) {
      if (labels[x] != PixelLabel::kMoved && labels[x] != PixelLabel::kRevealed) continue;
      const LastingKind kind = labels[x] == PixelLabel::kMoved ? LastingKind::kCame : LastingKind::kWent;
      if ((covered_[place] & bit_of(kind)) != 0) continue;
      const float z = kind == LastingKind::kCame ? view.depth_m.at(x, y) : view.expected_m.at(x, y);
      if (!(z > kNearest_m)) continue;
      if (points_.size() >= config_.max_points) return;
      ChangePoint point;
      point.position = view.from_camera(view.back_projected(x, y, z));
      point.id = next_id_++;
      point.kind = kind;
      points_.push_back(point);
      cover(view, kind, static_cast<float>(x), static_cast<float>(y), z);
    }
  }
}

std::vector<LastingChange> ChangeTracker::lasting_changes(double seconds) {
  std::vector<LastingChange> changes;
  const auto least_s = static_cast<float>(seconds);
  for (const LastingKind kind : {LastingKind::kCame, LastingKind::kWent}) {
    const auto steady = std::count_if(points_.begin(), points_.end(), [&](const ChangePoint& point) {
      return point.kind == kind && point.steady_s >= least_s;
    });
    if (steady < config_.min_cells) continue;
    sort_into_cells(points_, kind, least_s, config_.link_m, clusters_);
    add_objects(points_, kind, origin_world_, config_, clusters_, changes);
  }
  return changes;
}

double ChangeTracker::still_true(const LastingChange& change) const {
  std::size_t found = 0;
  auto point = points_.begin();
  for (const std::uint32_t id : change.ids) {
    while (point != points_.end() && point->id < id) ++point;
    found += point != points_.end() && point->id == id ? 1 : 0;
  }
  return change.ids.empty() ? 0.0 : static_cast<double>(found) / static_cast<double>(change.ids.size());
}

double ChangeTracker::seen_now(const LastingChange& change) const {
  std::size_t found = 0;
  auto point = points_.begin();
  for (const std::uint32_t id : change.ids) {
    while (point != points_.end() && point->id < id) ++point;
    found += point != points_.end() && point->id == id && point->as_it_was ? 1 : 0;
  }
  return change.ids.empty() ? 0.0 : static_cast<double>(found) / static_cast<double>(change.ids.size());
}

void ChangeTracker::forget(const LastingChange& change) {
  auto id = change.ids.begin();
  std::erase_if(points_, [&](const ChangePoint& point) {
    while (id != change.ids.end() && *id < point.id) ++id;
    return id != change.ids.end() && *id == point.id;
  });
}

}  // namespace roomradar
