// registration.cpp: views and shape propose transforms; the surface refines and verifies them.
#include "mapping/map/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/correlative_search.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/map/tsdf_interpolation.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

/// Transform implied by one view of b that matches a view of a.
struct Vote {
  std::size_t view_b = 0;
  int inliers = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
};

bool has_features(const KeyframeDatabase& keyframe_database) {
  return std::any_of(keyframe_database.keyframes.begin(), keyframe_database.keyframes.end(),
                     [](const MapKeyframe& place) { return !place.descriptors.empty(); });
}

std::vector<Vote> collect_votes(const KeyframeDatabase& a, const KeyframeDatabase& b,
                                const RegistrationConfig& config) {
  constexpr int kMinMatches = 15;
  const auto most = static_cast<std::size_t>(std::max(config.views, 1));
  const std::size_t stride = 1 + (b.keyframes.size() - 1) / most;
  std::vector<Vote> votes;
  for (std::size_t j = 0; j < b.keyframes.size(); j += stride) {
    const MapKeyframe& view = b.keyframes[j];
    const auto candidates = static_cast<std::size_t>(std::max(config.candidates, 1));
    for (const std::size_t i : most_alike(view, a, candidates, kMinMatches)) {
      const KeyframeMatch match = match_keyframes(a.keyframes[i], view);
      if (match.inliers < config.min_inliers) continue;
      votes.push_back(
          {j, match.inliers, a.keyframes[i].T_world_camera * match.T_a_b * view.T_world_camera.inverse()});
    }
  }
  return votes;
}

/// Returns true if two transforms give a view of b nearly the same pose in a.
bool agree(const Vote& vote, const Eigen::Isometry3d& T_a_b, const MapKeyframe& view) {
  constexpr double kNear_m = 0.15, kNear_rad = 0.1;
  return is_near(vote.T_a_b * view.T_world_camera, T_a_b * view.T_world_camera, kNear_m, kNear_rad);
}

/// Counts the views of b that agree with a transform, each view once.
int count_agreeing(const std::vector<Vote>& votes, const Eigen::Isometry3d& T_a_b,
                   const KeyframeDatabase& b) {
  int agreeing = 0;
  std::size_t last = b.keyframes.size();
  for (const Vote& vote : votes) {
    if (vote.view_b == last || !agree(vote, T_a_b, b.keyframes[vote.view_b])) continue;
    ++agreeing;
    last = vote.view_b;
  }
  return agreeing;
}

/// Transform on which views of b agree.
struct Hypothesis {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  int agreeing_views = 0;
};

/// Returns at most `most` transforms on which most views agree, best first, none near another. Features break
/// ties.
std::vector<Hypothesis> find_by_views(std::vector<Vote> votes, const KeyframeDatabase& b, int most) {
  std::vector<Hypothesis> hypotheses;
  while (!votes.empty() && std::ssize(hypotheses) < most) {
    Hypothesis best;
    int inliers = 0;
    for (const Vote& vote : votes) {
      const int agreeing = count_agreeing(votes, vote.T_a_b, b);
      if (std::pair(agreeing, vote.inliers) <= std::pair(best.agreeing_views, inliers)) continue;
      best = {vote.T_a_b, agreeing};
      inliers = vote.inliers;
    }
    hypotheses.push_back(best);
    std::erase_if(votes, [&](const Vote& vote) { return agree(vote, best.T_a_b, b.keyframes[vote.view_b]); });
  }
  return hypotheses;
}

/// Returns at most `most` transforms that bring b's surface near a's, best first.
std::vector<Eigen::Isometry3d> find_by_shape(const KeyframeDatabase& a, const KeyframeDatabase& b,
                                             std::span<const Eigen::Vector3d> surface_b,
                                             const Eigen::Vector3d& up_b, std::size_t most) {
  const Eigen::Vector3d camera_b = b.keyframes[b.keyframes.size() / 2].T_world_camera.translation();
  std::vector<Eigen::Vector3f> points;  // relative to a camera, which is inside a's grid if the rooms overlap
  points.reserve(surface_b.size());
  for (const Eigen::Vector3d& p : surface_b) points.emplace_back((p - camera_b).cast<float>());
  std::vector<Eigen::Isometry3d> found;
  for (const ShapeCandidate& candidate : search_by_shape(points, -up_b, shape_index(a), most))
    found.push_back(candidate.T_world_camera * Eigen::Translation3d(-camera_b));
  return found;
}

/// Returns true if enough of b's patches that coincide with patches of a look like them.
bool is_supported_by_patches(const KeyframeDatabase& b, const PatchIndex& patches_a,
                             const Eigen::Isometry3d& T_a_b) {
  // Of simulated rooms with moved furniture 34 % are alike; of other rooms at most 18 %.
  constexpr double kMinAlike = 0.25;
  constexpr std::size_t kMinCompared = 200;
  std::size_t compared = 0, alike = 0;
  for (const MapKeyframe& view : b.keyframes) {
    const PatchAgreement agreement = match_patches_at(view.patches, patches_a, T_a_b * view.T_world_camera);
    compared += static_cast<std::size_t>(agreement.compared);
    alike += agreement.alike.size();
  }
  return compared >= kMinCompared && static_cast<double>(alike) > kMinAlike * static_cast<double>(compared);
}

/// Result of testing b's points against a's surface and free space.
struct Judgement {
  std::size_t on_surface = 0;
  std::size_t in_free_space = 0;
  double residual_m = 0.0;
};

/// Max distance that noise and drift cause between two measurements of one surface.
constexpr double kGate_m = 0.05;

Judgement judge(const StaticMap& a, std::span<const Eigen::Vector3d> surface_b,
                const Eigen::Isometry3d& T_a_b) {
  Judgement judgement;
  std::vector<double> distances_m;
  for (const Eigen::Vector3d& p_b : surface_b) {
    const Eigen::Vector3d p_a = T_a_b * p_b;
    if (const auto at = distance_at(a, p_a)) {
      const double distance_m = at->distance_m / std::max(at->gradient.norm(), 0.3);
      if (std::abs(distance_m) < kGate_m)
        distances_m.push_back(std::abs(distance_m));
      else if (distance_m > 0.0)
        ++judgement.in_free_space;
    } else if (a.occupancy_at(p_a) == Occupancy::kFree && !a.sample_at(p_a)) {
      ++judgement.in_free_space;
    }
  }
  judgement.on_surface = distances_m.size();
  if (!distances_m.empty()) {
    const auto middle = distances_m.begin() + static_cast<std::ptrdiff_t>(distances_m.size() / 2);
    std::nth_element(distances_m.begin(), middle, distances_m.end());
    judgement.residual_m = *middle;
  }
  return judgement;
}

/// Minimises the distances of b's points to a's surface by Gauss-Newton, robust to moved objects. Directions
/// in which the surface is uniform stay unchanged.
Eigen::Isometry3d align_surface(const StaticMap& a, std::span<const Eigen::Vector3d> surface_b,
                                const Eigen::Isometry3d& T_a_b_start) {
  constexpr int kIterations = 15;
  constexpr double kSoft_m = 0.015;         // distance at which a point's weight is 1/4
  constexpr double kMinConstraint = 0.005;  // mean squared cosine, lever arms in units of their spread
  Eigen::Vector3d centre_b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : surface_b) centre_b += p / static_cast<double>(surface_b.size());
  double spread_m = 0.0;
  for (const Eigen::Vector3d& p : surface_b)
    spread_m += (p - centre_b).norm() / static_cast<double>(surface_b.size());
  spread_m = std::max(spread_m, 0.1);

  Eigen::Isometry3d T_a_b = T_a_b_start;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    double weights = 0.0;
    const Eigen::Vector3d centre_a = T_a_b * centre_b;
    for (const Eigen::Vector3d& p_b : surface_b) {
      const Eigen::Vector3d p_a = T_a_b * p_b;
      const auto at = distance_at(a, p_a);
      if (!at) continue;
      const double slope = at->gradient.norm();
      if (slope < 0.3) continue;
      const double distance_m = at->distance_m / slope;
      if (std::abs(distance_m) > 2.0 * kGate_m) continue;
      const Eigen::Vector3d normal = at->gradient / slope;
      const double ratio = distance_m / kSoft_m;
      const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));  // Geman-McClure
      Vector6d row;
      row << normal, (p_a - centre_a).cross(normal) / spread_m;
      H += weight * row * row.transpose();
      g += weight * distance_m * row;
      weights += weight;
    }
    if (weights < 50.0) break;
    const SymmetricEigen<6> axes = symmetric_eigen(Matrix6d(H / weights));
    Vector6d step = Vector6d::Zero();
    for (int i = 0; i < 6; ++i) {
      const double constraint = axes.values[i];
      if (constraint < kMinConstraint) continue;
      const Vector6d axis = axes.vectors.col(i);
      step -= axis * (axis.dot(g) / weights / constraint);
    }
    const Eigen::Vector3d turn = step.tail<3>() / spread_m;
    Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0.0) change.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
    change.translation() = centre_a + step.head<3>() - change.linear() * centre_a;
    T_a_b = change * T_a_b;
    if (step.norm() < 1e-5) break;
  }
  T_a_b.linear() = Eigen::Quaterniond(T_a_b.linear()).normalized().toRotationMatrix();
  return T_a_b;
}

Registration aligned(const StaticMap& a, std::span<const Eigen::Vector3d> surface_b,
                     const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config) {
  return verify_registration(a, surface_b, align_surface(a, surface_b, T_a_b), config);
}

/// Fraction of b's surface that is on a's.
double explained(const Registration& registration) {
  return registration ? registration.agreement * registration.overlap : 0.0;
}

/// Returns the registration that the room's shape proposes and patches support, if it explains clearly more
/// than the one by views and than all others by shape.
Registration best_by_shape(const StaticMap& octree_a, const KeyframeDatabase& a, const KeyframeDatabase& b,
                           std::span<const Eigen::Vector3d> surface_b, const Registration& by_views,
                           const RegistrationConfig& config) {
  constexpr std::size_t kCandidates = 6;
  constexpr std::size_t kEvery = 8;  // points, to compare candidates
  constexpr double kMinLead = 1.1;
  constexpr double kNear_m = 0.3, kNear_rad = 0.1;  // the same transform, of a and b
  std::vector<Eigen::Vector3d> few;
  for (std::size_t i = 0; i < surface_b.size(); i += kEvery) few.push_back(surface_b[i]);
  const PatchIndex patches_a = build_patch_index(a);
  Registration best, other;
  for (const Eigen::Isometry3d& T_a_b : find_by_shape(a, b, surface_b, config.up_b, kCandidates)) {
    if (by_views && is_near(by_views.T_a_b, T_a_b, kNear_m, kNear_rad)) continue;
    const Registration candidate = aligned(octree_a, few, T_a_b, config);
    if (explained(candidate) <= explained(other)) continue;
    if (!is_supported_by_patches(b, patches_a, candidate.T_a_b)) continue;
    const bool is_same = is_near(best.T_a_b, candidate.T_a_b, kNear_m, kNear_rad);
    if (explained(candidate) <= explained(best)) {
      if (!is_same) other = candidate;
      continue;
    }
    if (!is_same) other = best;
    best = candidate;
  }
  if (!(explained(best) > kMinLead * std::max(explained(other), explained(by_views)))) return {};
  return aligned(octree_a, surface_b, best.T_a_b, config);
}

}  // namespace

Registration register_to(const StaticMap& octree_a, const KeyframeDatabase& database_a,
                         const KeyframeDatabase& database_b, std::span<const Eigen::Vector3d> surface_b,
                         const RegistrationConfig& config) {
  Registration best;
  if (surface_b.empty()) {
    best.status = RegistrationStatus::kNoOverlap;
    return best;
  }
  const bool comparable = has_features(database_a) && has_features(database_b);
  const std::vector<Vote> votes =
      comparable ? collect_votes(database_a, database_b, config) : std::vector<Vote>{};

  const std::vector<Hypothesis> by_views = find_by_views(votes, database_b, config.hypotheses);
  if (by_views.empty() || by_views.front().agreeing_views < config.min_agreeing) {
    best.status = comparable ? RegistrationStatus::kNotRecognised : RegistrationStatus::kNoFeatures;
    if (!by_views.empty()) best.agreeing_views = by_views.front().agreeing_views;
    return best;
  }
  best.agreement = -1.0;
  for (const Hypothesis& hypothesis : by_views) {
    if (hypothesis.agreeing_views < config.min_agreeing) break;
    Registration registration = aligned(octree_a, surface_b, hypothesis.T_a_b, config);
    registration.agreeing_views = count_agreeing(votes, registration.T_a_b, database_b);
    if (registration.agreeing_views < config.min_agreeing)
      registration.status = RegistrationStatus::kNotRecognised;
    if (std::pair(bool(registration), registration.agreement) > std::pair(bool(best), best.agreement))
      best = registration;
  }
  // All views that are recognised may show furniture that was moved.
  Registration by_shape = best_by_shape(octree_a, database_a, database_b, surface_b, best, config);
  if (!by_shape) return best;
  by_shape.agreeing_views = count_agreeing(votes, by_shape.T_a_b, database_b);
  return by_shape;
}

Registration refine_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                 const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config) {
  const Registration before = verify_registration(octree_a, surface_b, T_a_b, config);
  if (surface_b.empty()) return before;
  const Registration refined = aligned(octree_a, surface_b, T_a_b, config);
  return std::pair(bool(refined), refined.agreement) >= std::pair(bool(before), before.agreement) ? refined
                                                                                                  : before;
}

Registration verify_registration(const StaticMap& octree_a, std::span<const Eigen::Vector3d> surface_b,
                                 const Eigen::Isometry3d& T_a_b, const RegistrationConfig& config) {
  Registration judged;
  judged.status = RegistrationStatus::kNoOverlap;
  judged.T_a_b = T_a_b;
  if (surface_b.empty()) return judged;
  const Judgement judgement = judge(octree_a, surface_b, T_a_b);
  const auto known = static_cast<double>(judgement.on_surface + judgement.in_free_space);
  judged.overlap = known / static_cast<double>(surface_b.size());
  judged.agreement = known > 0.0 ? static_cast<double>(judgement.on_surface) / known : 0.0;
  judged.residual_m = judgement.residual_m;
  if (judged.overlap >= config.min_overlap)
    judged.status = judged.agreement >= config.min_agreement ? RegistrationStatus::kRegistered
                                                             : RegistrationStatus::kContradicted;
  return judged;
}

std::string describe(const Registration& registration) {
  std::array<char, 200> text{};
  switch (registration.status) {
    case RegistrationStatus::kRegistered:
      format_classic(
          text.data(), text.size(),
          "%d views agree; %.0f %% of the surface is known to both, %.0f %% of that agrees, %.1f mm apart",
          registration.agreeing_views, 100.0 * registration.overlap, 100.0 * registration.agreement,
          1e3 * registration.residual_m);
      break;
    case RegistrationStatus::kNoFeatures:
      return "one of them has no views with colour, so nothing can be recognised";
    case RegistrationStatus::kNotRecognised:
      format_classic(text.data(), text.size(), "only %d views agree on the relative pose; more are needed",
                     registration.agreeing_views);
      break;
    case RegistrationStatus::kNoOverlap:
      format_classic(text.data(), text.size(), "only %.0f %% of the surface is known to both",
                     100.0 * registration.overlap);
      break;
    case RegistrationStatus::kContradicted:
      if (registration.agreeing_views > 0)
        format_classic(text.data(), text.size(),
                       "%d views look alike, but only %.0f %% of the surface agrees; is it another room?",
                       registration.agreeing_views, 100.0 * registration.agreement);
      else
        format_classic(text.data(), text.size(),
                       "only %.0f %% of the surface agrees; was the room rearranged?",
                       100.0 * registration.agreement);
      break;
  }
  return text.data();
}

}  // namespace roomradar
