// patch_matching.cpp: camera pose hypotheses from matched surface patches.
#include "mapping/localization/patch_matching.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/system/parallel_for.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kMaxPatchDistance_bits = 70;    // of 256; one in 10,000 unrelated patches is this similar
constexpr std::uint64_t kMaxFirst_bits = 24;  // of the first 64; one in 30 unrelated patches passes
constexpr std::size_t kAlike = 3;             // max matches per patch of the frame
constexpr float kSamePlace_m = 0.05F;

struct Alike {
  const SurfacePatch* seen;
  const SurfacePatch* known;
  int distance_bits;
  int seen_index;
};

std::uint64_t first_bits(const Descriptor& bits) {
  std::uint64_t first = 0;
  std::memcpy(&first, bits.data(), sizeof first);
  return first;
}

/// Counts the bits in which each of `count` numbers differs from `seen`; written for automatic vectorisation.
/// Source: Warren, Hacker's Delight, section 5-1.
void count_differing(std::uint64_t seen, const std::uint64_t* known, std::size_t count, std::uint64_t* bits) {
  for (std::size_t k = 0; k < count; ++k) {
    std::uint64_t x = seen ^ known[k];
    x -= (x >> 1) & 0x5555555555555555ULL;
    x = (x & 0x3333333333333333ULL) + ((x >> 2) & 0x3333333333333333ULL);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fULL;
    x += x >> 8;
    x += x >> 16;
    x += x >> 32;
    bits[k] = x & 0x7f;
  }
}

/// Appends the known patches, at distinct places, that look most like this one.
void add_alike(const SurfacePatch& seen, int seen_index, const PatchIndex::OfSize& known,
               std::vector<Alike>& alike) {
  std::array<Alike, kAlike> best;
  std::size_t count = 0;
  const std::uint64_t first = first_bits(seen.bits);
  constexpr std::size_t kBlock = 256;
  std::array<std::uint64_t, kBlock> differing;
  for (std::size_t k = 0; k < known.patches.size(); ++k) {
    if (k % kBlock == 0)
      count_differing(first, known.first_bits.data() + k, std::min(kBlock, known.patches.size() - k),
                      differing.data());
    if (differing[k % kBlock] > kMaxFirst_bits) continue;
    const SurfacePatch& candidate = known.patches[k];
    const int bits = distance_bits(seen.bits, candidate.bits);
    if (bits > kMaxPatchDistance_bits || (count == kAlike && bits >= best[kAlike - 1].distance_bits))
      continue;
    std::size_t at = 0;
    bool is_worse = false;
    for (std::size_t i = 0; i < count; ++i) {  // one per place
      if ((best[i].known->point - candidate.point).squaredNorm() > kSamePlace_m * kSamePlace_m) continue;
      is_worse = best[i].distance_bits <= bits;
      if (!is_worse) {
        std::move(best.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                  best.begin() + static_cast<std::ptrdiff_t>(count),
                  best.begin() + static_cast<std::ptrdiff_t>(i));
        --count;
      }
      break;
    }
    if (is_worse) continue;
    count = std::min(count, kAlike - 1);
    while (at < count && best[at].distance_bits <= bits) ++at;
    std::move_backward(best.begin() + static_cast<std::ptrdiff_t>(at),
                       best.begin() + static_cast<std::ptrdiff_t>(count),
                       best.begin() + static_cast<std::ptrdiff_t>(count) + 1);
    best[at] = {&seen, &candidate, bits, seen_index};
    ++count;
  }
  alike.insert(alike.end(), best.begin(), best.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Returns the pairs of add_alike() for all patches of the frame, in their order.
std::vector<Alike> alike_pairs(std::span<const SurfacePatch> seen, const PatchIndex& known) {
  constexpr std::size_t kPiece = 64;
  std::vector<std::vector<Alike>> pieces((seen.size() + kPiece - 1) / kPiece);
  parallel_ranges(seen.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      add_alike(seen[i], static_cast<int>(i), known.by_size[seen[i].size], pieces[begin / kPiece]);
  });
  std::vector<Alike> alike;
  for (const std::vector<Alike>& piece : pieces) alike.insert(alike.end(), piece.begin(), piece.end());
  return alike;
}

Eigen::Matrix3f axes_of(const SurfacePatch& patch) {
  Eigen::Matrix3f axes;
  axes << patch.along, patch.normal.cross(patch.along), patch.normal;
  return axes;
}

/// Returns the pairs that agree with the pose that one pair implies, within the accuracy of a patch's axes.
std::vector<std::size_t> agreeing_with(std::size_t vote, std::span<const Alike> alike,
                                       std::span<const Eigen::Matrix3f> R_known_seen) {
  constexpr float kMinCosine = 0.9F;                   // 25 degrees between the rotations of two pairs
  constexpr float kGate_m = 0.05F, kGatePer_m = 0.2F;  // a patch's axes are off by about 10 degrees
  const Eigen::Matrix3f& R = R_known_seen[vote];
  const Eigen::Vector3f p = alike[vote].seen->point, q = alike[vote].known->point;
  std::vector<std::size_t> agreeing;
  for (std::size_t i = 0; i < alike.size(); ++i) {
    const Eigen::Vector3f way = alike[i].seen->point - p;
    const float gate_m = kGate_m + kGatePer_m * way.norm();
    if ((R * way - (alike[i].known->point - q)).squaredNorm() > gate_m * gate_m) continue;
    const float cosine = 0.5F * (R.cwiseProduct(R_known_seen[i]).sum() - 1.0F);
    if (cosine > kMinCosine) agreeing.push_back(i);
  }
  return agreeing;
}

/// Max distance between the points of a pair, both measured.
double gate_m(const SurfacePatch& seen) {
  return 0.02 + 3.0 * static_cast<double>(depth_sigma_m(DepthNoise{}, seen.point.z()));
}

/// Counts the distinct patches of the frame among the chosen pairs.
int seen_in(const std::vector<std::size_t>& chosen, std::span<const Alike> alike) {
  int count = 0, last = -1;
  for (const std::size_t i : chosen) {
    count += alike[i].seen_index != last;
    last = alike[i].seen_index;
  }
  return count;
}

/// Pairs that agree with one of them, the vote.
struct Group {
  int seen;  // distinct patches of the frame
  std::size_t vote;
  std::vector<std::size_t> pairs;
};

/// Groups the pairs that agree with the pairs that look most alike; most patches of the frame first.
std::vector<Group> agreeing_groups(const std::vector<Alike>& alike, int min_agreeing) {
  std::vector<Eigen::Matrix3f> R_known_seen;
  R_known_seen.reserve(alike.size());
  for (const Alike& pair : alike)
    R_known_seen.push_back(axes_of(*pair.known) * axes_of(*pair.seen).transpose());

  constexpr std::size_t kVotes = 400;
  std::vector<std::size_t> votes(alike.size());
  std::iota(votes.begin(), votes.end(), std::size_t{0});
  std::stable_sort(votes.begin(), votes.end(), [&](std::size_t a, std::size_t b) {
    return alike[a].distance_bits < alike[b].distance_bits;
  });
  votes.resize(std::min(votes.size(), kVotes));
  std::vector<Group> groups;
  for (const std::size_t vote : votes) {
    std::vector<std::size_t> pairs = agreeing_with(vote, alike, R_known_seen);
    const int count = seen_in(pairs, alike);
    if (count >= min_agreeing) groups.push_back({count, vote, std::move(pairs)});
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.seen > b.seen; });
  return groups;
}

constexpr float kCell_m = 0.05F;

Eigen::Vector3i cell_of(const Eigen::Vector3f& point_world) {
  return (point_world / kCell_m).array().floor().cast<int>();
}

std::size_t hash_of(const PatchIndex::OfSize& known, const Eigen::Vector3i& cell) {
  return (fibonacci_hash(voxel_key(cell)) >> 32U) & (known.last_of_hash.size() - 1);
}

/// Calls visit(patch) for known patches in the cells within half a cell of a point, and for some others,
/// possibly twice: callers compare distances anyway.
template <typename Visit>
void visit_near(const PatchIndex::OfSize& known, const Eigen::Vector3f& point_world, const Visit& visit) {
  if (known.last_of_hash.empty()) return;
  const Eigen::Vector3i low = cell_of(point_world - Eigen::Vector3f::Constant(0.5F * kCell_m));
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3i cell = low + Eigen::Vector3i(k & 1, k >> 1 & 1, k >> 2);
    for (std::uint32_t number = known.last_of_hash[hash_of(known, cell)]; number != 0;
         number = known.before[number - 1])
      visit(known.patches[number - 1]);
  }
}

SurfacePatch moved_by(const Eigen::Isometry3f& T_world_camera, SurfacePatch patch) {
  patch.point = T_world_camera * patch.point;
  patch.normal = T_world_camera.linear() * patch.normal;
  patch.along = T_world_camera.linear() * patch.along;
  return patch;
}

bool is_same_proposal(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d gap = a.inverse() * b;
  return gap.translation().norm() < 0.15 && Eigen::AngleAxisd(gap.linear()).angle() < 0.1;
}

}  // namespace

bool PatchIndex::empty() const {
  return std::all_of(by_size.begin(), by_size.end(), [](const auto& known) { return known.patches.empty(); });
}

PatchIndex build_patch_index(const KeyframeDatabase& keyframe_database) {
  constexpr int kSameLook_bits = 40;
  constexpr float kSame_m = 0.02F;
  PatchIndex known;
  std::array<std::size_t, kPatchSizes> counts{};
  for (const MapKeyframe& place : keyframe_database.keyframes)
    for (const SurfacePatch& patch : place.patches) ++counts[patch.size];
  for (std::size_t size = 0; size < counts.size(); ++size)
    if (counts[size] > 0) known.by_size[size].last_of_hash.assign(std::bit_ceil(counts[size]), 0);
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    const Eigen::Isometry3f T_world_camera = place.T_world_camera.cast<float>();
    for (const SurfacePatch& in_camera : place.patches) {
      const SurfacePatch patch = moved_by(T_world_camera, in_camera);
      // Keyframes overlap; a patch that several saw alike is stored once.
      PatchIndex::OfSize& of_size = known.by_size[patch.size];
      bool is_known = false;
      visit_near(of_size, patch.point, [&](const SurfacePatch& other) {
        is_known = is_known || ((other.point - patch.point).squaredNorm() < kSame_m * kSame_m &&
                                distance_bits(other.bits, patch.bits) <= kSameLook_bits);
      });
      if (is_known) continue;
      of_size.patches.push_back(patch);
      std::uint32_t& last = of_size.last_of_hash[hash_of(of_size, cell_of(patch.point))];
      of_size.before.push_back(last);
      last = static_cast<std::uint32_t>(of_size.patches.size());
      of_size.first_bits.push_back(first_bits(patch.bits));
    }
  }
  return known;
}

PatchAgreement match_patches_at(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                const Eigen::Isometry3d& T_world_camera) {
  constexpr float kReach_m = 0.03F;
  constexpr float kMinCosine = 0.8F;  // between normals, and between directions to the brighter side
  constexpr int kAlike_bits = 80;     // of 256; max for two matching patches at one place
  PatchAgreement proof;
  for (const SurfacePatch& in_camera : seen) {
    const SurfacePatch patch = moved_by(T_world_camera.cast<float>(), in_camera);
    const SurfacePatch* most_alike = nullptr;
    int least_bits = kAlike_bits;
    bool is_compared = false;
    visit_near(known.by_size[patch.size], patch.point, [&](const SurfacePatch& other) {
      if ((other.point - patch.point).squaredNorm() > kReach_m * kReach_m ||
          other.normal.dot(patch.normal) < kMinCosine)
        return;
      is_compared = true;
      const int bits = distance_bits(other.bits, patch.bits);
      if (bits >= least_bits || other.along.dot(patch.along) < kMinCosine) return;
      most_alike = &other;
      least_bits = bits;
    });
    proof.compared += is_compared;
    if (most_alike != nullptr)
      proof.alike.push_back(
          {most_alike->point.cast<double>(), in_camera.point.cast<double>(), gate_m(in_camera)});
  }
  return proof;
}

std::vector<PoseCandidate> propose_poses(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                         std::size_t most, int min_agreeing) {
  constexpr std::size_t kTried = 24;
  const std::vector<Alike> alike = alike_pairs(seen, known);
  const std::vector<Group> groups = agreeing_groups(alike, min_agreeing);

  std::vector<PoseCandidate> candidates;
  std::size_t tried = 0;
  for (const Group& group : groups) {
    if (tried == kTried) break;
    // A vote that a pose already found explains is skipped, which leaves the tries to alternatives.
    const bool is_explained =
        std::any_of(candidates.begin(), candidates.end(), [&](const PoseCandidate& found) {
          return (found.T_world_camera * alike[group.vote].seen->point.cast<double>() -
                  alike[group.vote].known->point.cast<double>())
                     .norm() < 2.0 * gate_m(*alike[group.vote].seen);
        });
    if (is_explained) continue;
    ++tried;
    std::vector<PointPair> pairs;
    for (const std::size_t i : group.pairs)
      pairs.push_back({alike[i].known->point.cast<double>(), alike[i].seen->point.cast<double>(),
                       gate_m(*alike[i].seen)});
    const KeyframeMatch match = motion_of(pairs, 200);
    if (match.inliers < min_agreeing) continue;
    std::erase_if(
        pairs, [&](const PointPair& pair) { return (match.T_a_b * pair.b - pair.a).norm() > pair.gate_m; });
    const auto same = std::find_if(candidates.begin(), candidates.end(), [&](const PoseCandidate& candidate) {
      return is_same_proposal(candidate.T_world_camera, match.T_a_b);
    });
    if (same == candidates.end())
      candidates.push_back({match.T_a_b, match.inliers, std::move(pairs)});
    else if (match.inliers > same->agreeing)
      *same = {match.T_a_b, match.inliers, std::move(pairs)};
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.agreeing > b.agreeing; });
  if (candidates.size() > most) candidates.resize(most);
  return candidates;
}

}  // namespace roomradar
