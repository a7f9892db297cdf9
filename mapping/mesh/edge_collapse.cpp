// edge_collapse.cpp: candidate queue by quadric error (a weighted sum of squared distances from a point to a
// set of planes), and the tests that accept or reject a collapse.
#include "mapping/mesh/edge_collapse.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mapping/mesh/triangle_distance.hpp"

namespace roomradar {

/// Quadric error p^T A p + 2 b . p + c. Source: Garland and Heckbert, Surface Simplification Using Quadric
/// Error Metrics, SIGGRAPH 1997, section 5.
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0.0;
  double weight = 0.0;  ///< sum of the planes' weights

  /// Adds the plane through `point` with this unit normal.
  void add_plane(const Eigen::Vector3d& unit_normal, const Eigen::Vector3d& point, double plane_weight) {
    const double offset = -unit_normal.dot(point);
    A += plane_weight * unit_normal * unit_normal.transpose();
    b += plane_weight * offset * unit_normal;
    c += plane_weight * offset * offset;
    weight += plane_weight;
  }
  Quadric& operator+=(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    weight += other.weight;
    return *this;
  }
  /// Returns the weighted sum of squared distances from p to the planes, >= 0.
  [[nodiscard]] double at(const Eigen::Vector3d& p) const {
    const double sum = p.dot(A * p) + 2.0 * b.dot(p) + c;
    return sum > 0.0 ? sum : 0.0;
  }
  /// Returns the least-squares intersection of all planes. Along poorly constrained directions, the result
  /// stays near `guess`.
  [[nodiscard]] Eigen::Vector3d nearest_to_all(const Eigen::Vector3d& guess) const {
    // Regularisation relative to trace(A); large enough that noise on a flat wall does not constrain the
    // point along the wall.
    constexpr double kHardly = 5e-3;
    const double trace = A.trace();
    if (!(trace > 0.0)) return guess;
    const Eigen::Matrix3d held = A + kHardly * trace * Eigen::Matrix3d::Identity();
    return guess - held.inverse() * (A * guess + b);
  }
};

namespace {

/// Index that stands for "no vertex", "no triangle" or "no corner of a triangle".
constexpr std::uint32_t kNoIndex = ~std::uint32_t{0};

struct MergedVertex {
  Quadric quadric;
  Eigen::Vector3f normal_sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f colour_sum = Eigen::Vector3f::Zero();
  std::uint32_t count = 0;
  std::uint32_t version = 0;  ///< incremented by every collapse; kNoIndex: vertex removed
  float tolerance_m = 0.0F;   ///< minimum over the merged vertices; 0: constrained
  bool on_border = false;

  /// Merges another vertex into this one.
  /// @param both  sum of both quadrics
  void absorb(MergedVertex& from, const Quadric& both) {
    quadric = both;
    normal_sum += from.normal_sum;
    colour_sum += from.colour_sum;
    count += from.count;
    on_border |= from.on_border;
    ++version;
    from.version = kNoIndex;
    tolerance_m = std::min(tolerance_m, from.tolerance_m);
  }
};

/// Singly linked lists of indices. An index is in at most one list.
struct IndexLists {
  IndexLists(std::size_t lists, std::size_t indices) : first(lists, kNoIndex), next(indices, kNoIndex) {}
  void push_front(std::uint32_t list, std::uint32_t index) {
    next[index] = first[list];
    first[list] = index;
  }
  std::vector<std::uint32_t> first;  ///< per list; kNoIndex: empty
  std::vector<std::uint32_t> next;   ///< per index; kNoIndex: last of its list
};

/// An edge to collapse, with the versions of its vertices at the time the cost was computed.
struct Candidate {
  float cost = 0.0F;
  std::uint32_t kept = 0;
  std::uint32_t gone = 0;
  std::uint32_t kept_version = 0;
  std::uint32_t gone_version = 0;
};

/// Bucket queue. Pops candidates in order of cost, rounded to four steps per factor of two. Candidates of
/// equal rounded cost are popped first in, first out, so flat areas thin out evenly. A heap would take longer
/// than all other work of the simplification.
class CandidateQueue {
 public:
  void push(const Candidate& candidate) {
    const std::size_t bucket = std::bit_cast<std::uint32_t>(candidate.cost) >> 21U;  // cost >= 0
    buckets_[bucket].waiting.push_back(candidate);
    cheapest_ = std::min(cheapest_, bucket);
  }
  bool pop(Candidate& candidate) {
    for (; cheapest_ < buckets_.size(); ++cheapest_) {
      Bucket& bucket = buckets_[cheapest_];
      if (bucket.taken < bucket.waiting.size()) {
        candidate = bucket.waiting[bucket.taken++];
        return true;
      }
      bucket = Bucket{};
    }
    return false;
  }

 private:
  struct Bucket {
    std::vector<Candidate> waiting;
    std::size_t taken = 0;
  };
  std::array<Bucket, 1024> buckets_;
  std::size_t cheapest_ = 0;
};

constexpr float kThinnest_m = 1e-4F;  // min height of a new triangle
constexpr float kLarge = 12.0F;       // a triangle with a side above this many tolerances counts as large
constexpr float kMostTurn = 0.3F;     // min cosine between a triangle's normals before and after a collapse
// Weight of the planes across an open border that constrain it, relative to triangle planes.
constexpr double kBorderWeight = 2.0;

class EdgeCollapser {
 public:
  EdgeCollapser(const Mesh& full, const MeshDistanceQuery& full_surface,
                const std::vector<float>& tolerance_m)
      : full_(full),
        full_surface_(full_surface),
        tolerance_m_(tolerance_m),
        mesh_(full),
        merged_(full.vertices.size()),
        corners_(full.vertices.size(), 3 * full.triangles.size()),
        points_(full.triangles.size(), full.vertices.size()),
        mark_(full.vertices.size(), 0) {
    link();
    find_borders();
    add_planes();
    for (std::uint32_t t = 0; t < full_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = full_.triangles[t][k];
        const std::uint32_t b = full_.triangles[t][(k + 1) % 3];
        if (a < b || merged_[a].on_border) push(a, b);
      }
  }

  void run() {
    Candidate next;
    while (queue_.pop(next)) {
      if (merged_[next.kept].version != next.kept_version || merged_[next.gone].version != next.gone_version)
        continue;
      if (collapse(next.kept, next.gone)) push_around(next.kept);
    }
  }

  Mesh take() {
    for (std::size_t v = 0; v < merged_.size(); ++v) {
      const MergedVertex& merged = merged_[v];
      if (merged.count == 0) continue;
      if (!mesh_.normals.empty() && !merged.normal_sum.isZero())
        mesh_.normals[v] = merged.normal_sum.normalized();
      if (mesh_.colours.empty()) continue;
      const Eigen::Vector3f mean = merged.colour_sum / static_cast<float>(merged.count);
      const auto channel = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
      mesh_.colours[v] = {channel(mean.x()), channel(mean.y()), channel(mean.z())};
    }
    std::erase_if(mesh_.triangles, [](const Triangle& t) { return t[0] == kNoIndex; });
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] bool is_alive(std::uint32_t triangle) const {
    return mesh_.triangles[triangle][0] != kNoIndex;
  }
  [[nodiscard]] const Eigen::Vector3f& position(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }

  // Builds the list of corners per vertex, and assigns each vertex as a point to one of its triangles.
  void link() {
    for (std::uint32_t t = 0; t < full_.triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = full_.triangles[t][k];
        if (corners_.first[v] == kNoIndex) points_.push_front(t, v);
        corners_.push_front(v, 3 * t + k);
      }
  }

  // Collects the live triangles around a vertex and unlinks the removed ones.
  void star_of(std::uint32_t vertex, std::vector<std::uint32_t>& star) {
    star.clear();
    std::uint32_t* link = &corners_.first[vertex];
    while (*link != kNoIndex) {
      if (is_alive(*link / 3)) {
        star.push_back(*link / 3);
        link = &corners_.next[*link];
      } else {
        *link = corners_.next[*link];
      }
    }
  }

  [[nodiscard]] bool has_corner(std::uint32_t triangle, std::uint32_t vertex) const {
    const Triangle& t = mesh_.triangles[triangle];
    return t[0] == vertex || t[1] == vertex || t[2] == vertex;
  }

  template <typename Visit>
  void for_each_edge(const Visit& visit) {
    for (std::uint32_t t = 0; t < full_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) visit(t, full_.triangles[t][k], full_.triangles[t][(k + 1) % 3]);
  }

  void find_borders() {
    for_each_edge([&](std::uint32_t, std::uint32_t a, std::uint32_t b) {
      if (triangles_at(a, b) != 2) merged_[a].on_border = merged_[b].on_border = true;
    });
  }
  std::size_t triangles_at(std::uint32_t a, std::uint32_t b) {
    star_of(a, star_kept_);
    return static_cast<std::size_t>(std::count_if(star_kept_.begin(), star_kept_.end(),
                                                  [&](std::uint32_t t) { return has_corner(t, b); }));
  }

  void add_planes() {
    for (std::uint32_t v = 0; v < merged_.size(); ++v) {
      MergedVertex& merged = merged_[v];
      merged.count = 1;
      merged.tolerance_m = tolerance_m_[v];
      if (!full_.normals.empty()) merged.normal_sum = full_.normals[v];
      if (!full_.colours.empty())
        merged.colour_sum = Eigen::Vector3f(full_.colours[v].r, full_.colours[v].g, full_.colours[v].b);
    }
    for (const Triangle& t : full_.triangles) {
      const Eigen::Vector3d a = full_.vertices[t[0]].cast<double>();
      const Eigen::Vector3d normal =
          (full_.vertices[t[1]].cast<double>() - a).cross(full_.vertices[t[2]].cast<double>() - a);
      const double doubled_area = normal.norm();
      if (!(doubled_area > 0.0)) continue;
      for (const std::uint32_t v : t)
        merged_[v].quadric.add_plane(normal / doubled_area, a, doubled_area / 2);
    }
    for_each_edge([&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
      if (!merged_[a].on_border || !merged_[b].on_border || triangles_at(a, b) == 2) return;
      const Eigen::Vector3d start = full_.vertices[a].cast<double>();
      const Eigen::Vector3d along = full_.vertices[b].cast<double>() - start;
      const Eigen::Vector3d across = along.cross(normal_of(mesh_, t).cast<double>());
      if (across.isZero()) return;
      for (const std::uint32_t v : {a, b})
        merged_[v].quadric.add_plane(across.normalized(), start, kBorderWeight * along.squaredNorm());
    });
  }

  static Eigen::Vector3f normal_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  }

  // Computes the position of the merged vertex; a constrained vertex stays in place, as does a border vertex
  // merged with an inner one. Returns false if the edge may not be collapsed.
  bool place(std::uint32_t kept, std::uint32_t gone, const Quadric& both, Eigen::Vector3f& p) const {
    const bool hold_kept =
        merged_[kept].tolerance_m == 0.0F || (merged_[kept].on_border && !merged_[gone].on_border);
    const bool hold_gone =
        merged_[gone].tolerance_m == 0.0F || (merged_[gone].on_border && !merged_[kept].on_border);
    if (hold_kept && hold_gone) return false;
    if (hold_kept || hold_gone) {
      p = position(hold_kept ? kept : gone);
      return true;
    }
    const Eigen::Vector3d middle = 0.5 * (position(kept) + position(gone)).cast<double>();
    const Eigen::Vector3d best = both.nearest_to_all(middle);
    const double reach = (position(kept) - position(gone)).cast<double>().norm();
    p = ((best - middle).norm() <= reach ? best : middle).cast<float>();
    return true;
  }

  void push(std::uint32_t kept, std::uint32_t gone) {
    if (merged_[gone].tolerance_m == 0.0F) std::swap(kept, gone);  // a constrained vertex keeps its index
    Quadric both = merged_[kept].quadric;
    both += merged_[gone].quadric;
    Eigen::Vector3f p;
    if (!place(kept, gone, both, p)) return;
    const double error = both.at(p.cast<double>());
    const float tolerance_m = std::max(merged_[kept].tolerance_m, merged_[gone].tolerance_m);
    if (error > tolerance_m * tolerance_m * both.weight) return;
    // Among equal errors short edges come first, which keeps the triangles of flat areas well shaped.
    const double shortness =
        1e-5 * both.weight * (position(kept) - position(gone)).cast<double>().squaredNorm();
    queue_.push(
        {static_cast<float>(error + shortness), kept, gone, merged_[kept].version, merged_[gone].version});
  }

  void push_around(std::uint32_t vertex) {
    star_of(vertex, star_kept_);
    ++stamp_;
    for (const std::uint32_t t : star_kept_)
      for (const std::uint32_t other : mesh_.triangles[t]) {
        if (other == vertex || mark_[other] == stamp_) continue;
        mark_[other] = stamp_;
        push(vertex, other);
      }
  }

  // Link condition, preserves topology: the edge's ends share no neighbours except the apexes of its
  // triangles, and two borders are not merged across a strip of surface.
  bool keeps_kind(std::uint32_t kept, std::uint32_t gone) {
    const auto shared = static_cast<std::size_t>(std::count_if(
        star_kept_.begin(), star_kept_.end(), [&](std::uint32_t t) { return has_corner(t, gone); }));
    if (shared != 1 && shared != 2) return false;
    if (shared == 2 && merged_[kept].on_border && merged_[gone].on_border) return false;
    if (star_kept_.size() == shared || star_gone_.size() == shared)
      return false;  // no triangle of that star would remain
    if (shared == 2 && star_kept_.size() == 3 && star_gone_.size() == 3) return false;
    const std::uint32_t beside_kept = ++stamp_;
    const std::uint32_t beside_gone = ++stamp_;
    for (const std::uint32_t t : star_kept_)
      for (const std::uint32_t v : mesh_.triangles[t]) mark_[v] = beside_kept;
    std::size_t common = 0;
    for (const std::uint32_t t : star_gone_)
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (v == kept || v == gone || mark_[v] == beside_gone) continue;
        if (mark_[v] == beside_kept) ++common;
        // A neighbouring block may share both constrained vertices and connect them, too.
        else if (merged_[kept].tolerance_m == 0.0F && merged_[v].tolerance_m == 0.0F)
          return false;
        mark_[v] = beside_gone;
      }
    return common == shared;
  }

  // Builds the triangles after the collapse in made_; returns false if one would flip or become too thin.
  bool make_new_triangles(std::uint32_t kept, std::uint32_t gone, const Eigen::Vector3f& p) {
    made_.clear();
    for (const auto* star : {&star_kept_, &star_gone_})
      for (const std::uint32_t t : *star) {
        if (has_corner(t, kept) && has_corner(t, gone)) continue;
        Made made{t, {}};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v = mesh_.triangles[t][k];
          made.corners[k] = v == kept || v == gone ? p : position(v);
        }
        const auto& [a, b, c] = made.corners;
        const Eigen::Vector3f normal = (b - a).cross(c - a);
        const Eigen::Vector3f before = normal_of(mesh_, t);
        if (normal.dot(before) < kMostTurn * normal.norm() * before.norm()) return false;
        const float longest =
            std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
        if (normal.norm() < kThinnest_m * longest) return false;
        made_.push_back(made);
      }
    return true;
  }

  // Assigns every original vertex on a changing triangle to a new triangle within its tolerance. Returns
  // false if a vertex has none.
  bool rehome_points() {
    homes_.clear();
    for (const auto* star : {&star_kept_, &star_gone_})
      for (const std::uint32_t t : *star) {
        const auto own = static_cast<std::size_t>(
            std::find_if(made_.begin(), made_.end(), [&](const Made& m) { return m.triangle == t; }) -
            made_.begin());
        for (std::uint32_t v = points_.first[t]; v != kNoIndex; v = points_.next[v]) {
          if (mark_[v] == stamp_) continue;  // already done: its triangle is in both stars
          mark_[v] = stamp_;
          const float limit_m2 = tolerance_m_[v] * tolerance_m_[v];
          const auto is_near = [&](const Made& m) {
            const auto& [a, b, c] = m.corners;
            return squared_distance_to_triangle(full_.vertices[v], a, b, c) <= limit_m2;
          };
          std::size_t home = own;
          if (home == made_.size() || !is_near(made_[home]))
            home =
                static_cast<std::size_t>(std::find_if(made_.begin(), made_.end(), is_near) - made_.begin());
          if (home == made_.size()) return false;
          homes_.push_back({v, made_[home].triangle});
        }
      }
    return true;
  }

  // Returns true if the new vertex or the centroid of a large new triangle is farther than tolerance_m from
  // the full surface. Planes may intersect outside a rounded edge; a large triangle may span a notch.
  [[nodiscard]] bool bulges(const Eigen::Vector3f& p, float tolerance_m) const {
    std::uint32_t near = MeshDistanceQuery::kNoGuess;
    const auto is_far = [&](const Eigen::Vector3f& q) {
      return full_surface_.distance_m(q, tolerance_m, near) > tolerance_m;
    };
    return is_far(p) || std::any_of(made_.begin(), made_.end(), [&](const Made& made) {
             const auto& [a, b, c] = made.corners;
             const float longest_m2 =
                 std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
             return longest_m2 > kLarge * kLarge * tolerance_m * tolerance_m && is_far((a + b + c) / 3.0F);
           });
  }

  bool collapse(std::uint32_t kept, std::uint32_t gone) {
    star_of(kept, star_kept_);
    star_of(gone, star_gone_);
    if (!keeps_kind(kept, gone)) return false;
    Quadric both = merged_[kept].quadric;
    both += merged_[gone].quadric;
    Eigen::Vector3f p;
    if (!place(kept, gone, both, p) || !make_new_triangles(kept, gone, p)) return false;
    ++stamp_;
    if (!rehome_points()) return false;
    if (bulges(p, std::max(merged_[kept].tolerance_m, merged_[gone].tolerance_m))) return false;

    for (const auto* star : {&star_kept_, &star_gone_})
      for (const std::uint32_t t : *star) points_.first[t] = kNoIndex;
    for (const auto& [point, triangle] : homes_) points_.push_front(triangle, point);
    for (const std::uint32_t t : star_gone_) {
      Triangle& triangle = mesh_.triangles[t];
      if (has_corner(t, kept)) {
        triangle.fill(kNoIndex);
        continue;
      }
      const auto k =
          static_cast<std::uint32_t>(std::find(triangle.begin(), triangle.end(), gone) - triangle.begin());
      triangle[k] = kept;
      corners_.push_front(kept, 3 * t + k);
    }
    corners_.first[gone] = kNoIndex;
    mesh_.vertices[kept] = p;
    merged_[kept].absorb(merged_[gone], both);
    return true;
  }

  struct Made {
    std::uint32_t triangle;
    std::array<Eigen::Vector3f, 3> corners;
  };
  struct Home {
    std::uint32_t point;
    std::uint32_t triangle;
  };

  const Mesh& full_;
  const MeshDistanceQuery& full_surface_;
  const std::vector<float>& tolerance_m_;
  Mesh mesh_;  // removed triangles have corners kNoIndex
  std::vector<MergedVertex> merged_;
  IndexLists corners_;  // per vertex: corners 3 t + k
  IndexLists points_;   // per triangle: original vertices
  std::vector<std::uint32_t> mark_;
  std::uint32_t stamp_ = 0;
  CandidateQueue queue_;
  std::vector<std::uint32_t> star_kept_, star_gone_;
  std::vector<Made> made_;
  std::vector<Home> homes_;
};

}  // namespace

Mesh collapsed(const Mesh& full, const MeshDistanceQuery& full_surface,
               const std::vector<float>& tolerance_m) {
  EdgeCollapser collapser(full, full_surface, tolerance_m);
  collapser.run();
  return collapser.take();
}

}  // namespace roomradar
