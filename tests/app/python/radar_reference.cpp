// radar_reference.cpp: answers and times of radar queries in C++, to compare with those of the Python module.
//
// usage: radar_reference SCENE.ply OBJECT.ply QUERIES ANSWERS
// QUERIES: per query 12 doubles, the pose's rows R | t, and 3, the direction. ANSWERS: per query status,
// touched, distance, lower and upper bound, point and normal as 11 doubles. Prints the time per query, us: of
// single calls (median), and of all in a row.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <vector>

#include "mapping/mesh/mesh_file.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace {

using namespace roomradar;

std::vector<RadarQuery> read_queries(const char* path, const TriangleTree& object) {
  std::ifstream file(path, std::ios::binary);
  std::vector<RadarQuery> queries;
  double numbers[15];
  while (file.read(reinterpret_cast<char*>(numbers), sizeof numbers)) {
    RadarQuery query;
    query.object.tree = &object;
    query.object.T_world_mesh.matrix().topRows<3>() =
        Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers);
    query.direction_world = Eigen::Map<Eigen::Vector3d>(numbers + 12);
    query.distance_m = 2.0;
    queries.push_back(query);
  }
  return queries;
}

double us_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  TriangleTree room, object;
  room.build_by_place(read_mesh(argv[1]));
  object.build_by_place(read_mesh(argv[2]));
  const std::vector<SceneTree> trees = {{{&room, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
  const RadarScene scene{trees, {}, nullptr};
  const std::vector<RadarQuery> queries = read_queries(argv[3], object);
  CyberRadar radar;
  for (const RadarQuery& query : queries) static_cast<void>(radar.query(query, scene));  // warm-up
  std::vector<double> single_us;
  for (const RadarQuery& query : queries) {
    const auto start = std::chrono::steady_clock::now();
    static_cast<void>(radar.query(query, scene));
    single_us.push_back(us_since(start));
  }
  std::vector<Contact> contacts(queries.size());
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < queries.size(); ++i) contacts[i] = radar.query(queries[i], scene);
  const double all_us = us_since(start);
  std::ofstream answers(argv[4], std::ios::binary);
  for (const Contact& contact : contacts) {
    const double row[11] = {static_cast<double>(contact.status),
                            static_cast<double>(contact.touched),
                            contact.contact_distance_m,
                            contact.lower_m,
                            contact.upper_m,
                            contact.point_world.x(),
                            contact.point_world.y(),
                            contact.point_world.z(),
                            contact.normal_world.x(),
                            contact.normal_world.y(),
                            contact.normal_world.z()};
    answers.write(reinterpret_cast<const char*>(row), sizeof row);
  }
  std::nth_element(single_us.begin(), single_us.begin() + static_cast<std::ptrdiff_t>(single_us.size() / 2),
                   single_us.end());
  std::printf("%.4f %.4f\n", single_us[single_us.size() / 2], all_us / static_cast<double>(queries.size()));
}
