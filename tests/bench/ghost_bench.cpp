// ghost_bench.cpp: remains of people and hands in the map after a simulated prescan.
//
// usage: ghost_bench [--resolution M] [--poses recorded|tracked] [--frames N] [--width PX] [--seed N]
//                    [--keep-ghosts] [--json FILE] [CASE...]    CASE: one of those below; default: all
// Each case is scanned twice, with and without the moving person; camera and noise are the same. An occupied
// leaf is counted as hers under three conditions. The scan without her has no occupied leaf in it or beside
// it. It is farther from the room's true surface than noise explains (half a leaf's diagonal plus four
// standard deviations of the depth at the range from which she was seen there). It is within two leaves of
// the space that she moved through while the camera looked. Lost parts of the room: leaves of the scan
// without her, on the true surface, without a leaf of the scan with her within two leaves. Settings are the
// defaults of PrescanConfig: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <vector>

#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/movers.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/voxel_key.hpp"
#include "tests/bench/bench_program.hpp"

namespace roomradar {
namespace {

struct Settings {
  double resolution_m = 0.02;
  PoseOrigin poses = PoseOrigin::kRecorded;
  std::int64_t frames = 300;
  int width_px = 320;
  int seed = 1;  // seed of the camera path, her walk and the noise
  bool keep_ghosts = false;
  std::string json;
  std::vector<std::string> cases;
};

struct Case {
  const char* name;
  const char* options;  // options of the simulation
  bool glass;           // the wall behind her gives no depth
};
constexpr std::array<Case, 7> kCases = {{
    {"walks", "sim:table?moving=person", false},
    {"slow", "sim:table?moving=person&pace=slow", false},
    {"waits", "sim:table?moving=person&pace=waits", false},
    {"leaves", "sim:table?moving=person&pace=leaves", false},
    {"glass", "sim:table?moving=person", true},
    {"glass-leaves", "sim:table?moving=person&pace=leaves", true},
    {"hand", "sim:table?moving=hand&path=view", false},
}};

/// Frames of a simulated Kinect, rendered once; the wall behind the person may be a pane of glass.
class RenderedFrames final : public FrameSource {
 public:
  RenderedFrames(const SimOptions& options, bool glass) : source_(options) {
    Frame frame;
    while (source_.next(frame).status == ReadStatus::kFrame) {
      if (glass) see_through_wall(frame);
      frames_.push_back(frame);
    }
  }
  ReadResult next(Frame& frame) override {
    if (next_ >= frames_.size()) return {ReadStatus::kEnd, {}};
    frame = frames_[next_++];
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override { return seek(0); }
  bool seek(std::int64_t index) override {
    next_ = static_cast<std::size_t>(index);
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(frames_.size());
  }
  [[nodiscard]] std::string name() const override { return source_.name(); }

 private:
  void see_through_wall(Frame& frame) const {
    const SimTruth& truth = source_.truth();
    const double pane_m = source_.room().interior_max_world.y() - 0.45;
    for (int y = 0; y < frame.depth_m.height; ++y)
      for (int x = 0; x < frame.depth_m.width; ++x) {
        const double depth_m = frame.depth_m.at(x, y);
        if (depth_m <= 0.0 || truth.moved.at(x, y) != 0) continue;
        const Eigen::Vector3d p_room = truth.T_world_camera * back_project(frame.depth_camera, x, y, depth_m);
        if (p_room.y() > pane_m && p_room.z() > 0.1) frame.depth_m.at(x, y) = 0.0F;
      }
  }

  SimulatedSource source_;
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

struct Leaf {
  VoxelIndex voxel;
  Eigen::Vector3d centre_room;
};

struct Scan {
  std::vector<Leaf> occupied;
  std::unordered_set<std::uint64_t> codes;  // voxel keys in the room's own grid
  PrescanCounts counts;
  double ghosts_s = 0.0;

  // Returns true if a leaf within `reach` leaves is occupied.
  [[nodiscard]] bool has_near(const VoxelIndex& voxel, int reach) const {
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x)
          if (codes.contains(voxel_key(voxel + VoxelIndex(x, y, z)))) return true;
    return false;
  }
};

Scan scan(const SimOptions& options, bool glass, const Settings& settings) {
  RenderedFrames source(options, glass);
  PrescanConfig config;
  config.resolution_m = settings.resolution_m;
  config.poses = settings.poses;
  config.remove_ghosts = !settings.keep_ghosts;
  StageTimes times;
  const PrescanResult result = prescan(source, config, times);
  Scan scan;
  scan.counts = result.counts;
  const auto summaries = times.summaries();
  if (const auto found = summaries.find("ghosts"); found != summaries.end())
    scan.ghosts_s = found->second.median_ms * static_cast<double>(found->second.count) / 1e3;
  const Eigen::Isometry3d T_room_map = result.map.info.T_world_recorded.inverse();
  result.map.octree.load().visit_leaves([&](const MapLeaf& leaf) {
    if (!(leaf.log_odds > 0.0F)) return;
    const int edge = leaf.edge_voxels;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const VoxelIndex own = leaf.lowest_voxel + VoxelIndex(i % edge, i / edge % edge, i / (edge * edge));
      const Eigen::Vector3d centre_room =
          T_room_map * ((own.cast<double>().array() + 0.5) * settings.resolution_m).matrix();
      const VoxelIndex voxel = (centre_room / settings.resolution_m).array().floor().cast<int>();
      scan.occupied.push_back({voxel, centre_room});
      scan.codes.insert(voxel_key(voxel));
    }
  });
  return scan;
}

/// The space that she moved through, as seen by the camera.
class Passage {
 public:
  explicit Passage(const SimOptions& options) : camera_(options.depth_camera) {
    const Room room = make_room(options.room);
    const double duration_s = static_cast<double>(options.frames) / options.rate_hz;
    const CameraPath path = plan_camera_path(room, options.path, options.seed, duration_s);
    const Eigen::Vector3d viewer_world =
        plan_camera_path(room, CameraPathKind::kView, options.seed, duration_s).centre_world;
    for (std::int64_t i = 0; i < options.frames; ++i) {
      const double t_s = static_cast<double>(i) / options.rate_hz;
      Moment moment;
      moment.T_camera_world = T_world_camera_at(path, t_s).inverse();
      for (const MoverKind kind : options.movers)
        append_solids(plan_mover(kind, room, viewer_world, options.seed, options.pace, duration_s), t_s,
                      moment.solids);
      for (const Solid& solid : moment.solids) {
        const double radius_m = bounds_half_m(solid).norm();
        moment.bounds.extend(
            Eigen::Vector3d(solid.T_world_solid.translation() - Eigen::Vector3d::Constant(radius_m)));
        moment.bounds.extend(
            Eigen::Vector3d(solid.T_world_solid.translation() + Eigen::Vector3d::Constant(radius_m)));
      }
      moments_.push_back(std::move(moment));
    }
  }

  /// Returns the least depth at which she was seen within margin_m of a point; infinite if never.
  [[nodiscard]] double seen_from_m(const Eigen::Vector3d& p_room, double margin_m) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Moment& moment : moments_) {
      if (moment.bounds.squaredExteriorDistance(p_room) > margin_m * margin_m) continue;
      const Eigen::Vector3d p_camera = moment.T_camera_world * p_room;
      if (p_camera.z() < 0.3 || p_camera.z() >= nearest_m) continue;
      const Eigen::Vector2d pixel = project(camera_, p_camera);
      if (pixel.x() < -5 || pixel.y() < -5 || pixel.x() > camera_.width_px + 5 ||
          pixel.y() > camera_.height_px + 5)
        continue;
      for (const Solid& solid : moment.solids)
        if (signed_distance_m(solid, p_room) < margin_m) {
          nearest_m = p_camera.z();
          break;
        }
    }
    return nearest_m;
  }

 private:
  struct Moment {
    Eigen::Isometry3d T_camera_world;
    std::vector<Solid> solids;
    Eigen::AlignedBox3d bounds;
  };
  Intrinsics camera_;
  std::vector<Moment> moments_;
};

nlohmann::json bench(const Case& chosen, const Settings& settings) {
  SimOptions options =
      parse_sim_spec(std::string(chosen.options) + "&frames=" + std::to_string(settings.frames) + "&width=" +
                     std::to_string(settings.width_px) + "&seed=" + std::to_string(settings.seed));
  const Scan with_her = scan(options, chosen.glass, settings);
  const Passage passage(options);
  const Room room = make_room(options.room);
  options.movers.clear();
  const Scan without = scan(options, chosen.glass, settings);

  const double leaf_m = settings.resolution_m;
  std::array<std::int64_t, 3> hers{};  // all, more than 6 cm off, more than 10 cm off
  for (const Leaf& leaf : with_her.occupied) {
    const double off_m = std::abs(signed_distance_m(room, leaf.centre_room));
    if (off_m < 0.87 * leaf_m || without.has_near(leaf.voxel, 1)) continue;
    const double seen_from_m = passage.seen_from_m(leaf.centre_room, 2.0 * leaf_m);
    if (!std::isfinite(seen_from_m)) continue;
    if (off_m < 0.87 * leaf_m + 4.0 * depth_sigma_m(DepthNoise{}, static_cast<float>(seen_from_m))) continue;
    ++hers[0];
    hers[1] += off_m > 0.06 ? 1 : 0;
    hers[2] += off_m > 0.10 ? 1 : 0;
  }
  std::int64_t lost = 0;
  for (const Leaf& leaf : without.occupied)
    lost += std::abs(signed_distance_m(room, leaf.centre_room)) < 1.5 * leaf_m &&
                    !with_her.has_near(leaf.voxel, 2)
                ? 1
                : 0;

  const auto share = [](std::int64_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
  };
  const nlohmann::json row = {{"case", chosen.name},
                              {"poses", to_string(settings.poses)},
                              {"seed", settings.seed},
                              {"resolution_m", leaf_m},
                              {"frames_fused", with_her.counts.frames_fused},
                              {"occupied_leaves", with_her.occupied.size()},
                              {"hers", hers[0]},
                              {"hers_share", share(hers[0], with_her.occupied.size())},
                              {"hers_beyond_6_cm", hers[1]},
                              {"hers_beyond_10_cm", hers[2]},
                              {"lost_share", share(lost, without.occupied.size())},
                              {"ghost_voxels", with_her.counts.ghost_voxels},
                              {"ghost_voxels_without_her", without.counts.ghost_voxels},
                              {"ghosts_s", with_her.ghosts_s}};
  std::printf("%-12s %5.3f m %6lld %9zu %7lld %7.3f %% %7lld %7lld %8.3f %% %8lld %8lld %7.1f\n", chosen.name,
              leaf_m, static_cast<long long>(with_her.counts.frames_fused), with_her.occupied.size(),
              static_cast<long long>(hers[0]), 100.0 * share(hers[0], with_her.occupied.size()),
              static_cast<long long>(hers[1]), static_cast<long long>(hers[2]),
              100.0 * share(lost, without.occupied.size()),
              static_cast<long long>(with_her.counts.ghost_voxels),
              static_cast<long long>(without.counts.ghost_voxels), with_her.ghosts_s);
  std::fflush(stdout);
  return row;
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) throw Error(option + ": needs a value");
      return argv[++i];
    };
    if (option == "--resolution") {
      settings.resolution_m = std::stod(value());
    } else if (option == "--poses") {
      settings.poses = value() == "tracked" ? PoseOrigin::kTracked : PoseOrigin::kRecorded;
    } else if (option == "--frames") {
      settings.frames = std::stoll(value());
    } else if (option == "--width") {
      settings.width_px = std::stoi(value());
    } else if (option == "--seed") {
      settings.seed = std::stoi(value());
    } else if (option == "--keep-ghosts") {
      settings.keep_ghosts = true;
    } else if (option == "--json") {
      settings.json = value();
    } else {
      settings.cases.push_back(option);
    }
  }
  for (const std::string& name : settings.cases)
    if (std::none_of(kCases.begin(), kCases.end(), [&](const Case& one) { return name == one.name; }))
      throw Error("no case is called '" + name + "'; see the head of ghost_bench.cpp");
  return settings;
}

int run(int argc, char** argv) {
  const Settings settings = parse(argc, argv);
  std::printf("poses %s, %d px wide, gcc or clang %s\n", std::string(to_string(settings.poses)).c_str(),
              settings.width_px, __VERSION__);
  std::printf(
      "case         leaf    frames  occupied    hers    share    >6 cm  >10 cm   lost      removed, without"
      " her  time, s\n");
  nlohmann::json rows = nlohmann::json::array();
  for (const Case& one : kCases)
    if (settings.cases.empty() ||
        std::find(settings.cases.begin(), settings.cases.end(), one.name) != settings.cases.end())
      rows.push_back(bench(one, settings));
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("ghost_bench", [&] { return roomradar::run(argc, argv); });
}
