// scan_parts.cpp: parts of a scan as submaps, their joins, and the poses that result.
#include "mapping/scan_parts.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "mapping/building/building_graph.hpp"
#include "mapping/building/submap.hpp"
#include "mapping/building/submap_join.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kMinFrames = 10;  // shorter parts are not worth naming

/// One part as a submap, with its number.
struct NumberedSubmap {
  int part = 0;
  Submap submap;
};

/// Returns the parts with a keyframe as submaps, those with the most frames first.
std::vector<NumberedSubmap> submaps_of(const std::vector<TrackedFrame>& frames,
                                       const KeyframeDatabase& keyframe_database) {
  std::map<int, NumberedSubmap> by_part;
  std::map<std::int64_t, int> part_of_frame;
  for (const TrackedFrame& frame : frames) {
    part_of_frame[frame.frame_index] = frame.part;
    NumberedSubmap& to = by_part[frame.part];
    to.part = frame.part;
    if (frame.trusted)
      to.submap.trajectory.push_back({frame.frame_index, frame.stamp_s, frame.T_world_camera});
  }
  for (const MapKeyframe& keyframe : keyframe_database.keyframes)
    by_part[part_of_frame[keyframe.frame_index]].submap.keyframes.keyframes.push_back(keyframe);
  std::vector<NumberedSubmap> submaps;
  for (auto& [part, submap] : by_part) {
    if (submap.submap.keyframes.keyframes.empty() || submap.submap.trajectory.empty()) continue;
    submaps.push_back(std::move(submap));
  }
  std::stable_sort(submaps.begin(), submaps.end(), [](const NumberedSubmap& a, const NumberedSubmap& b) {
    return a.submap.trajectory.size() > b.submap.trajectory.size();
  });
  return submaps;
}

/// Returns pairs of keyframes that look alike: for each keyframe of b, the most similar ones of a.
std::vector<std::pair<std::size_t, std::size_t>> alike_pairs(const Submap& a, const Submap& b) {
  constexpr std::size_t kCandidates = 4;
  constexpr int kMinMatches = 15;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 0; j < b.keyframes.keyframes.size(); ++j) {
    for (const std::size_t i : most_alike(b.keyframes.keyframes[j], a.keyframes, kCandidates, kMinMatches))
      pairs.emplace_back(i, j);
  }
  return pairs;
}

std::vector<GraphJoin> joins_of(std::vector<NumberedSubmap>& submaps) {
  std::vector<GraphJoin> joins;
  for (NumberedSubmap& submap : submaps) update_index(submap.submap.keyframes);
  for (std::size_t a = 0; a < submaps.size(); ++a) {
    for (std::size_t b = a + 1; b < submaps.size(); ++b) {
      const auto pairs = alike_pairs(submaps[a].submap, submaps[b].submap);
      if (pairs.empty()) continue;
      for (SubmapJoin& join : join_submaps(submaps[a].submap, submaps[b].submap, pairs))
        if (join.status == JoinStatus::kJoined) joins.push_back({a, b, std::move(join)});
    }
  }
  return joins;
}

}  // namespace

std::vector<ScanPart> join_parts(std::vector<TrackedFrame>& frames, KeyframeDatabase& keyframe_database,
                                 bool is_in_known_map, int& main_part) {
  main_part = 0;
  std::vector<NumberedSubmap> submaps = submaps_of(frames, keyframe_database);
  std::set<int> joined;
  if (submaps.size() == 1) {
    main_part = submaps.front().part;
    joined.insert(main_part);
  } else if (submaps.size() > 1) {
    if (is_in_known_map)  // the part whose poses are in the earlier map's world comes first
      std::stable_sort(submaps.begin(), submaps.end(), [](const NumberedSubmap& a, const NumberedSubmap& b) {
        return (a.part == 0) > (b.part == 0);
      });
    std::vector<GraphSubmap> graph;
    for (const NumberedSubmap& submap : submaps) {
      graph.emplace_back();
      for (const MapKeyframe& keyframe : submap.submap.keyframes.keyframes)
        graph.back().T_submap_keyframe.push_back(keyframe.T_world_camera);
    }
    const std::vector<GraphJoin> joins = joins_of(submaps);
    const BuildingGraph solved = solve_building(graph, joins);
    std::map<std::size_t, std::size_t> frames_of;  // per connected component
    for (std::size_t i = 0; i < submaps.size(); ++i)
      frames_of[solved.submaps[i].part] += submaps[i].submap.trajectory.size();
    const std::size_t chosen =
        is_in_known_map
            ? solved.submaps.front().part
            : std::max_element(frames_of.begin(), frames_of.end(), [](const auto& a, const auto& b) {
                return a.second < b.second;
              })->first;
    std::map<std::int64_t, Eigen::Isometry3d> T_world_camera, T_world_keyframe;
    bool is_first = true;
    const bool moves = !joins.empty();
    for (std::size_t i = 0; i < submaps.size(); ++i) {
      if (solved.submaps[i].part != chosen) continue;
      if (std::exchange(is_first, false)) main_part = submaps[i].part;
      joined.insert(submaps[i].part);
      if (!moves) continue;
      const std::vector<Eigen::Isometry3d>& T_building_keyframe = solved.submaps[i].T_building_keyframe;
      for (const TimedPose& pose : corrected_trajectory(submaps[i].submap, T_building_keyframe))
        T_world_camera[pose.frame_index] = pose.T_world_camera;
      for (std::size_t k = 0; k < T_building_keyframe.size(); ++k)
        T_world_keyframe[submaps[i].submap.keyframes.keyframes[k].frame_index] = T_building_keyframe[k];
    }
    for (TrackedFrame& frame : frames) {
      if (const auto moved = T_world_camera.find(frame.frame_index); moved != T_world_camera.end())
        frame.T_world_camera = moved->second;
    }
    std::map<std::int64_t, int> part_of_frame;
    for (const TrackedFrame& frame : frames) part_of_frame[frame.frame_index] = frame.part;
    std::erase_if(keyframe_database.keyframes, [&](const MapKeyframe& keyframe) {
      return !joined.contains(part_of_frame[keyframe.frame_index]);
    });
    for (MapKeyframe& keyframe : keyframe_database.keyframes) {
      if (const auto moved = T_world_keyframe.find(keyframe.frame_index); moved != T_world_keyframe.end())
        keyframe.T_world_camera = moved->second;
    }
    keyframe_database.index = {};
  }
  std::map<int, ScanPart> parts;
  for (TrackedFrame& frame : frames) {
    if (!frame.trusted) continue;
    const bool is_joined = joined.contains(frame.part);
    ScanPart& part =
        parts.try_emplace(frame.part, ScanPart{frame.frame_index, 0, 0, is_joined}).first->second;
    part.last = frame.frame_index;
    ++part.frames;
    frame.trusted = is_joined;
  }
  std::vector<ScanPart> named;
  for (const auto& [number, part] : parts)
    if (part.frames >= kMinFrames || part.is_joined) named.push_back(part);
  std::stable_sort(named.begin(), named.end(),
                   [](const ScanPart& a, const ScanPart& b) { return a.first < b.first; });
  return named;
}

}  // namespace roomradar
