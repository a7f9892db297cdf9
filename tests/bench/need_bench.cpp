// need_bench.cpp: cost follows need: half as much relevant scene takes half the time. Scenes are fixed:
// changing them breaks the comparison with earlier results. Times are CPU times of all threads.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dynamic/surface/dynamic_surface.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "radar/depth/depth_pass.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar::test {
namespace {

using Rows = nlohmann::json;

constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};

/// CPU time of all threads of this process.
double process_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Measures work at several sizes, alternating between them, so noise of the machine affects all alike.
template <typename Work>
std::vector<double> medians_ms(std::size_t sizes, int repeats, const Work& work) {
  constexpr int kWarmUp = 5;
  std::vector<Times> times(sizes);
  for (int i = 0; i < kWarmUp + repeats; ++i) {
    for (std::size_t size = 0; size < sizes; ++size) {
      const double start_ms = process_ms();
      work(size);
      if (i >= kWarmUp) times[size].samples_ms.push_back(process_ms() - start_ms);
    }
  }
  std::vector<double> medians;
  for (Times& of : times) medians.push_back(of.percentile(0.5));
  return medians;
}

/// A wavy wall over x, y in -half_m .. half_m, at depth z in front of the camera, of 2 n^2 triangles.
Mesh wall(int n, float half_m, float z) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = half_m * (2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F);
      const float y = half_m * (2.0F * static_cast<float>(j) / static_cast<float>(n) - 1.0F);
      mesh.vertices.emplace_back(x, y, z + 0.1F * std::sin(7.0F * x) * std::cos(9.0F * y));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  return mesh;
}

/// The same mesh without triangles that have no vertex for which is_in() returns true.
template <typename IsIn>
Mesh cut(const Mesh& whole, const IsIn& is_in) {
  Mesh part = whole;
  std::erase_if(part.triangles, [&](const Triangle& t) {
    return std::none_of(t.begin(), t.end(), [&](std::uint32_t i) { return is_in(part.vertices[i]); });
  });
  return part;
}

/// Appends one row per size; the others are compared with the first.
template <typename Describe>
void add_rows(const std::string& work, const std::vector<double>& medians, const std::vector<double>& parts,
              const Describe& describe, Rows& rows) {
  for (std::size_t i = 0; i < medians.size(); ++i) {
    nlohmann::json row = {{"work", work},
                          {"relevant_part", parts[i] / parts[0]},
                          {"median_ms", medians[i]},
                          {"time_ratio", medians[i] / medians[0]}};
    row.update(describe(i));
    rows.push_back(row);
  }
}

// A camera in front of a wall of 720,000 triangles that covers all of its image, then half of it, then a
// quarter, as the camera moves past the wall's edge.
void measure_expected_depth(Rows& rows) {
  GlContext context;
  DepthPass pass(context);
  const Mesh whole_mesh = wall(600, 2.0F, 2.5F);
  GpuMesh mesh(context), only_part(context);
  mesh.upload(whole_mesh, MeshUsage::kStatic);
  const MeshInstance instance{&mesh, Eigen::Isometry3d::Identity()};
  const std::vector<double> shares{1.0, 0.5, 0.25, 0.125};
  std::vector<Eigen::Isometry3d> poses;
  const double half_view_m = 0.5 * 2.5 * kCamera.width_px / kCamera.fx_px;
  for (const double share : shares)
    poses.emplace_back(Eigen::Translation3d(2.0 + half_view_m * (1.0 - 2.0 * share), 0.0, 0.0));
  DepthImage depth_m;
  std::vector<std::size_t> drawn(shares.size());
  const auto medians = medians_ms(shares.size(), 40, [&](std::size_t i) {
    drawn[i] = pass.render({&instance, 1}, kCamera, poses[i], depth_m);
  });
  const std::vector<double> parts(drawn.begin(), drawn.end());
  add_rows(
      "expected depth", medians, parts,
      [&](std::size_t i) {
        // The triangles in view alone give the same image: none of the rest was needed.
        const auto least_x = static_cast<float>(poses[i].translation().x() - 1.1 * half_view_m);
        only_part.upload(cut(whole_mesh, [&](const Eigen::Vector3f& p) { return p.x() > least_x; }),
                         MeshUsage::kStatic);
        const MeshInstance part{&only_part, Eigen::Isometry3d::Identity()};
        DepthImage of_part_m;
        pass.render({&instance, 1}, kCamera, poses[i], depth_m);
        pass.render({&part, 1}, kCamera, poses[i], of_part_m);
        float most = 0.0F;
        std::size_t covered = 0;
        for (std::size_t k = 0; k < depth_m.pixels.size(); ++k) {
          most = std::max(most, std::abs(depth_m.pixels[k] - of_part_m.pixels[k]));
          covered += depth_m.pixels[k] > 0.0F ? 1U : 0U;
        }
        return nlohmann::json{{"room_triangles", whole_mesh.triangles.size()},
                              {"drawn", drawn[i]},
                              {"covered_px", covered},
                              {"error_max_m", most}};
      },
      rows);
}

/// A plate of n x n squares, edge_m wide, facing +z.
Mesh plate(int n, float edge_m) {
  Mesh mesh = wall(n, 0.5F * edge_m, 0.0F);
  for (Eigen::Vector3f& p : mesh.vertices) p.z() = 0.0F;
  return mesh;
}

// A plate that moves towards a wall: a plate of half the area, with half as much wall in its way; and the
// whole plate in a room of twice as many triangles.
void measure_radar(Rows& rows) {
  const auto tree_of = [](const Mesh& mesh) {
    TriangleTree tree;
    tree.build_by_place(mesh);
    return tree;
  };
  const Mesh room_mesh = wall(600, 2.0F, 2.5F), twice_mesh = wall(849, 2.83F, 2.5F);
  const TriangleTree room = tree_of(room_mesh), twice = tree_of(twice_mesh);
  struct Case {
    const Mesh* mesh;
    const TriangleTree* room;
    double edge_m;
    TriangleTree plate;
    CyberRadar radar = CyberRadar{};
    std::uint64_t asked = 0;
  };
  std::vector<Case> cases;
  for (const double edge_m : {0.8, 0.5657, 0.4, 0.2828}) cases.push_back({&room_mesh, &room, edge_m, {}});
  cases.push_back({&twice_mesh, &twice, 0.8, {}});
  std::vector<double> parts;
  for (Case& of : cases) {
    of.plate.build_by_place(plate(1, static_cast<float>(of.edge_m)));
    parts.push_back(of.edge_m * of.edge_m);
  }
  const auto contact_distance_m = [](Case& of, const TriangleTree& tree, int turn) {
    const SceneTree scene{{&tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    const Eigen::Isometry3d T_world_object(Eigen::AngleAxisd(0.1 * turn, Eigen::Vector3d::UnitZ()));
    const RadarQuery query{{&of.plate, T_world_object}, Eigen::Vector3d::UnitZ(), 3.0};
    return of.radar.query(query, {{&scene, 1}, {}}).contact_distance_m;
  };
  std::vector<int> turns(cases.size(), 0);
  const auto medians = medians_ms(cases.size(), 400, [&](std::size_t i) {
    const std::uint64_t before = cases[i].radar.static_triangles_tested();
    static_cast<void>(contact_distance_m(cases[i], *cases[i].room, ++turns[i]));
    cases[i].asked = cases[i].radar.static_triangles_tested() - before;
  });
  add_rows(
      "radar", medians, parts,
      [&](std::size_t i) {
        // The triangles in the plate's way alone give the same result.
        Case& of = cases[i];
        const auto reach = static_cast<float>(of.edge_m);
        const Mesh part = cut(*of.mesh, [&](const Eigen::Vector3f& p) { return p.head<2>().norm() < reach; });
        const TriangleTree part_tree = tree_of(part);
        double most_m = 0.0;
        for (int turn = 0; turn < 20; ++turn)
          most_m = std::max(most_m, std::abs(contact_distance_m(of, *of.room, turn) -
                                             contact_distance_m(of, part_tree, turn)));
        return nlohmann::json{
            {"room_triangles", of.room->triangle_count()}, {"asked", of.asked}, {"error_max_m", most_m}};
      },
      rows);
}

// Eight balls in front of a wall, each covering 5 % of the image; then four, two, one; with the sensor's
// noise.
void measure_mesh(Rows& rows) {
  constexpr double kRadius_px = 70.0;
  std::vector<DepthImage> depths;
  std::vector<MaskImage> masks;
  std::vector<double> parts;
  const DepthImage expected_m(kCamera.width_px, kCamera.height_px, 2.5F);
  for (const int balls : {8, 4, 2, 1}) {
    DepthImage depth_m = expected_m;
    MaskImage mask(kCamera.width_px, kCamera.height_px, 0);
    for (int y = 0; y < kCamera.height_px; ++y) {
      for (int x = 0; x < kCamera.width_px; ++x) {
        const int column = x / 160, row = y / 240;
        if (4 * row + column >= balls) continue;
        const double r = std::hypot(x - 160 * column - 80, y - 240 * row - 120) / kRadius_px;
        if (r >= 1.0) continue;
        const auto z = static_cast<float>(1.0 - 0.12 * std::sqrt(1.0 - r * r));
        depth_m.at(x, y) = z + depth_sigma_m(DepthNoise{}, z) * gaussian(hash_of(7, depth_m.index(x, y), 0));
        mask.at(x, y) = 255;
      }
    }
    parts.push_back(static_cast<double>(std::count(mask.pixels.begin(), mask.pixels.end(), 255)));
    depths.push_back(depth_m);
    masks.push_back(mask);
  }
  DynamicSurfaceScratch scratch;
  DynamicSurface surface;
  std::vector<std::size_t> triangles(parts.size());
  const auto medians = medians_ms(parts.size(), 100, [&](std::size_t i) {
    mesh_dynamic({{depths[i], kCamera, Eigen::Isometry3d::Identity()}, masks[i], expected_m}, {}, {}, scratch,
                 surface);
    triangles[i] = surface.seen_world.triangles.size();
  });
  add_rows(
      "mesh of what moved", medians, parts,
      [&](std::size_t i) {
        return nlohmann::json{{"moved_px", parts[i]}, {"triangles", triangles[i]}};
      },
      rows);
}

int run(int argc, char** argv) {
  const bool has_file = argc == 3 && std::strcmp(argv[1], "--json") == 0;
  if (argc != 1 && !has_file) {
    std::cerr << "usage: need_bench [--json FILE]\n";
    return 2;
  }
  Rows rows = Rows::array();
  measure_expected_depth(rows);
  measure_radar(rows);
  measure_mesh(rows);
  for (const auto& row : rows) std::cout << row.dump() << "\n";
  write_rows(has_file ? argv[2] : "", rows);
  return 0;
}

}  // namespace
}  // namespace roomradar::test

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("need_bench", [&] { return roomradar::test::run(argc, argv); });
}
