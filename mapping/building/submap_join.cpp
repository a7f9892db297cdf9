// submap_join.cpp: keyframes vote for a relative pose; depth and features of those around test it. Joins are
// stored as one binary file, with a checksum.
#include "mapping/building/submap_join.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string_view>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/building/submap_overlap.hpp"
#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

/// Relative pose implied by a pair of keyframes that match.
struct Vote {
  std::size_t a = 0, b = 0;  ///< keyframes
  int inliers = 0;
  Eigen::Isometry3d T_camera_a_camera_b, T_a_b;
};

double angle_rad(const Eigen::Isometry3d& T) { return Eigen::AngleAxisd(T.linear()).angle(); }

std::vector<Vote> collect_votes(const Submap& a, const Submap& b,
                                std::span<const std::pair<std::size_t, std::size_t>> keyframes,
                                const JoinConfig& config) {
  std::vector<Vote> votes;
  for (const auto& [i, j] : keyframes) {
    const MapKeyframe& from = a.keyframes.keyframes.at(i);
    const MapKeyframe& to = b.keyframes.keyframes.at(j);
    const KeyframeMatch match = match_keyframes(from, to);
    if (match.inliers < config.min_inliers) continue;
    votes.push_back(
        {i, j, match.inliers, match.T_a_b, from.T_world_camera * match.T_a_b * to.T_world_camera.inverse()});
  }
  return votes;
}

/// Returns whether two votes give the view of one of them nearly the same pose. Drift of both submaps between
/// the votes is allowed for.
bool agree(const Vote& vote, const Vote& other, const Submap& b) {
  constexpr double kNear_m = 0.15, kNear_rad = 0.1, kDrift = 0.03;
  const Eigen::Isometry3d& T_b_camera = b.keyframes.keyframes[vote.b].T_world_camera;
  const double apart_m =
      (T_b_camera.translation() - b.keyframes.keyframes[other.b].T_world_camera.translation()).norm();
  return is_near(vote.T_a_b * T_b_camera, other.T_a_b * T_b_camera, kNear_m + kDrift * apart_m, kNear_rad);
}

/// Returns the votes that agree with one of them; of each keyframe of b, only the vote with most inliers.
std::vector<Vote> agreeing_with(const Vote& middle, const std::vector<Vote>& votes, const Submap& b) {
  std::map<std::size_t, Vote> best;  // by keyframe of b
  for (const Vote& vote : votes) {
    if (!agree(vote, middle, b)) continue;
    const auto [at, is_new] = best.emplace(vote.b, vote);
    if (!is_new && vote.inliers > at->second.inliers) at->second = vote;
  }
  std::vector<Vote> agreeing;
  for (const auto& [keyframe, vote] : best) agreeing.push_back(vote);
  return agreeing;
}

/// Tests a relative pose with all keyframes of b that are near the votes for it.
PlacementTest test_votes(const Submap& a, const Submap& b, const std::vector<Vote>& votes, double near_m) {
  constexpr double kDrift = 0.02;
  std::vector<Eigen::Isometry3d> T_a_keyframe;
  for (const MapKeyframe& keyframe : a.keyframes.keyframes) T_a_keyframe.push_back(keyframe.T_world_camera);
  std::vector<PredictedPair> pairs;
  for (std::size_t k = 0; k < b.keyframes.keyframes.size(); ++k) {
    const Eigen::Isometry3d& T_b_view = b.keyframes.keyframes[k].T_world_camera;
    const Vote* nearest = nullptr;
    double nearest_m = near_m;
    for (const Vote& vote : votes) {
      const Eigen::Vector3d& p = b.keyframes.keyframes[vote.b].T_world_camera.translation();
      const double distance_m = (p - T_b_view.translation()).norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      nearest = &vote;
    }
    if (nearest) predict_pairs(T_a_keyframe, nearest->T_a_b * T_b_view, k, kDrift * nearest_m, pairs);
  }
  return test_placement(a, b, pairs);
}

/// A keyframe's preview, prepared for alignment.
struct AlignedPreview {
  TargetView target;
  SourcePoints source;
};

AlignedPreview prepared(const MapKeyframe& keyframe) {
  ViewConfig config;
  config.finest_width_px = std::max(keyframe.preview_camera.width_px, 1);
  config.levels = 2;
  config.normal_reach_px = 2;
  DepthImage depth_m;
  depth_m.resize(keyframe.preview_depth_mm.width, keyframe.preview_depth_mm.height);
  std::transform(keyframe.preview_depth_mm.pixels.begin(), keyframe.preview_depth_mm.pixels.end(),
                 depth_m.pixels.begin(), [](std::uint16_t mm) { return 1e-3F * static_cast<float>(mm); });
  ViewPyramid pyramid;
  make_pyramid(depth_m, keyframe.preview_camera, config, pyramid);
  AlignedPreview preview;
  make_target_view(pyramid, Eigen::Isometry3d::Identity(), config, preview.target);
  make_source_points(pyramid, preview.source, {}, 1);
  return preview;
}

/// Aligns the depth of a vote's keyframes in both directions. Adds two links if both results agree.
void add_links(const Submap& a, const Submap& b, const Vote& vote, std::vector<KeyframeLink>& links) {
  constexpr double kMaxGap_m = 0.03, kMaxGap_rad = 0.03, kMinInliers = 0.5;
  AlignConfig config;
  config.coarsest_level = 1;
  config.max_correction_m = 0.15F;
  config.max_correction_rad = 0.15F;
  const AlignedPreview view_a = prepared(a.keyframes.keyframes[vote.a]),
                       view_b = prepared(b.keyframes.keyframes[vote.b]);
  const Tracking b_in_a = align(view_b.source, view_a.target, vote.T_camera_a_camera_b, config);
  const Tracking a_in_b = align(view_a.source, view_b.target, vote.T_camera_a_camera_b.inverse(), config);
  const Eigen::Isometry3d gap = b_in_a.T_world_camera * a_in_b.T_world_camera;
  if (!has_pose(b_in_a) || !has_pose(a_in_b) || gap.translation().norm() > kMaxGap_m ||
      angle_rad(gap) > kMaxGap_rad || std::min(b_in_a.inlier_fraction, a_in_b.inlier_fraction) < kMinInliers)
    return;
  // The mean of both directions, with the features' information where depth does not constrain it.
  const Eigen::Isometry3d T_a_b = pose_between(b_in_a.T_world_camera, a_in_b.T_world_camera.inverse(), 0.5);
  // Half of the links of a simulated building are within 1.5 mm and 0.8 mrad, nine of ten within 6 mm.
  constexpr double kSigma_m = 0.003, kSigma_rad = 0.001;
  Vector6d information;
  information << Eigen::Vector3d::Constant(1.0 / (kSigma_m * kSigma_m)),
      Eigen::Vector3d::Constant(1.0 / (kSigma_rad * kSigma_rad));
  links.push_back({vote.a, vote.b, T_a_b, information.asDiagonal()});
}

/// Returns whether two submaps look the same around votes that are refused because they differ elsewhere.
bool look_alike_near(const Submap& a, const Submap& b, const std::vector<Vote>& votes) {
  constexpr double kNear_m = 1.5, kMinRecognised = 0.7, kMinAgreement = 0.92;
  const PlacementTest test = test_votes(a, b, votes, kNear_m);
  return test.recognised > 0 && test.recognised >= kMinRecognised * test.expected &&
         test.agreement() >= kMinAgreement;
}

SubmapJoin judged(const Submap& a, const Submap& b, const std::vector<Vote>& agreeing, const Vote& middle,
                  const JoinConfig& config) {
  constexpr std::size_t kLinksOfRefused = 12;
  SubmapJoin join;
  join.T_a_b = middle.T_a_b;
  join.agreeing = static_cast<int>(agreeing.size());
  const PlacementTest test = test_votes(a, b, agreeing, config.near_m);
  join.expected = test.expected;
  join.recognised = test.recognised;
  join.agreement = test.agreement();
  if (test.same + test.through == 0) {
    join.status =
        JoinStatus::kNotRecognised;  // no keyframes have nearly the same view: nothing to prove it by
  } else if (join.agreement < config.min_agreement) {
    join.status = JoinStatus::kContradicted;
  } else if (test.expected - test.recognised > std::max(1.0, config.max_different * test.expected)) {
    join.status = JoinStatus::kLooksDifferent;
  } else {
    for (const Vote& vote : spread_evenly(agreeing, config.max_links)) add_links(a, b, vote, join.links);
    join.status = join.links.size() >= 2 ? JoinStatus::kJoined : JoinStatus::kNotRecognised;
    if (join.status != JoinStatus::kJoined) join.links.clear();
  }
  const bool is_refused =
      join.status == JoinStatus::kContradicted || join.status == JoinStatus::kLooksDifferent;
  if (is_refused && look_alike_near(a, b, agreeing))
    for (const Vote& vote : spread_evenly(agreeing, kLinksOfRefused))
      join.links.push_back({vote.a, vote.b, vote.T_camera_a_camera_b});
  return join;
}

constexpr std::string_view kJoinsMagic = "RRJOINED";
constexpr std::uint32_t kJoinsVersion = 1;

}  // namespace

std::string describe(const SubmapJoin& join) {
  std::array<char, 200> text{};
  const char* outcome = join.status == JoinStatus::kJoined          ? "joined"
                        : join.status == JoinStatus::kNotRecognised ? "not recognised"
                        : join.status == JoinStatus::kContradicted
                            ? "refused, since surfaces contradict"
                            : "refused, since other parts look different";
  format_classic(text.data(), text.size(),
                 "%s: %d keyframes agree, %d of %d others are recognised, %.0f %% of the surface agrees",
                 outcome, join.agreeing, join.recognised, join.expected, 100.0 * join.agreement);
  return text.data();
}

std::vector<SubmapJoin> join_submaps(const Submap& a, const Submap& b,
                                     std::span<const std::pair<std::size_t, std::size_t>> keyframes,
                                     const JoinConfig& config) {
  std::vector<Vote> votes = collect_votes(a, b, keyframes, config);
  std::vector<SubmapJoin> joins;
  while (!votes.empty()) {
    // The vote that most others agree with; features break ties.
    std::vector<Vote> agreeing;
    const Vote* middle = nullptr;
    for (const Vote& vote : votes) {
      std::vector<Vote> found = agreeing_with(vote, votes, b);
      if (middle && std::pair(found.size(), vote.inliers) <= std::pair(agreeing.size(), middle->inliers))
        continue;
      middle = &vote;
      agreeing = std::move(found);
    }
    if (static_cast<int>(agreeing.size()) < config.min_agreeing) {
      if (joins.empty()) joins.emplace_back().agreeing = static_cast<int>(agreeing.size());
      break;
    }
    const Vote chosen = *middle;
    joins.push_back(judged(a, b, agreeing, chosen, config));
    std::erase_if(votes, [&](const Vote& vote) { return agree(vote, chosen, b); });
  }
  if (joins.empty()) joins.emplace_back();
  return joins;
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeyframeLink> link) {
  static_assert(sizeof link.a == sizeof(std::uint64_t));
  archive(link.a, link.b, link.T_a_b);
  serialize_finite(archive, "is damaged: a link's information", link.information);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, SubmapJoin> join) {
  serialize(archive, join.status, JoinStatus::kLooksDifferent);
  archive(join.links, join.T_a_b, join.agreeing, join.expected, join.recognised, join.agreement);
}

void save_joins(const std::vector<SubmapJoin>& joins, const std::filesystem::path& path) {
  save_binary(path, kJoinsMagic, kJoinsVersion, joins);
}

std::vector<SubmapJoin> load_joins(const std::filesystem::path& path) {
  std::vector<SubmapJoin> joins;
  load_binary(path, kJoinsMagic, kJoinsVersion, joins);
  return joins;
}

}  // namespace roomradar
