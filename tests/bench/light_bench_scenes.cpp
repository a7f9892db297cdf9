// light_bench_scenes.cpp: relights simulated rooms and renders them from any view.
#include "light_bench_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr double kTexel_m = 1.6 / 585.0;
constexpr double kMiddle_m = 0.13;  // height of the object's middle above its foot

Lamp side_lamp(const Room& room, const Vector3d& focus_room) {
  Lamp lamp;
  lamp.position_world = {0.8 * room.interior_max_world.x(), -0.3 * room.interior_max_world.y(), 1.7};
  const double away_m = (lamp.position_world - focus_room).norm();
  lamp.power = static_cast<float>(1.2 * away_m * away_m);
  lamp.radius_m = 0.25;
  return lamp;
}

}  // namespace

std::vector<Solid> object_solids() {
  return {box({0, 0, 0.045}, {0.16, 0.16, 0.09}), cylinder({0, 0, 0.09}, 0.055, 0.08),
          sphere({0, 0, 0.22}, 0.05)};
}

std::vector<Material> object_materials() {
  const auto plain = [](Rgb colour) { return Material{Pattern::kPortable, colour, colour, 5, 0.6F}; };
  return {plain({190, 120, 90}), plain({90, 140, 160}), plain({200, 200, 190})};
}

Mesh object_of_solids() {
  Mesh mesh;
  const std::vector<Solid> solids = object_solids();
  const std::vector<Material> materials = object_materials();
  for (std::size_t i = 0; i < solids.size(); ++i)
    append_mesh(solids[i], materials[i].first, kMeshDeviation_m, mesh);
  return mesh;
}

std::unique_ptr<LitRoom> lit_room(const std::string& name, const LampSet& lamps,
                                  const std::optional<Vector3d>& foot_room) {
  auto lit = std::make_unique<LitRoom>();
  lit->room = make_room(name, false, 2);
  if (lamps.from_the_side) {
    lit->room.lamps = {side_lamp(lit->room, lit->room.focus_world)};
    lit->tint = {1.0F, 0.84F, 0.66F};
  }
  lit->object_begin = lit->room.solids.size();
  if (foot_room) {
    const std::vector<Solid> solids = object_solids();
    const std::vector<Material> materials = object_materials();
    const Eigen::Isometry3d T_room_object = standing_at(foot_room->x(), foot_room->y(), foot_room->z());
    for (std::size_t i = 0; i < solids.size(); ++i) add(lit->room, T_room_object, solids[i], materials[i]);
    lit->room.tree = SolidTree(lit->room.solids);
  }
  lit->look = std::make_unique<SurfaceAppearance>(lit->room, kTexel_m);
  return lit;
}

std::optional<Vector3d> true_light(const LitRoom& lit, const Vector3d& p_room) {
  Vector3d sum = Vector3d::Zero();
  double all = 0.0;
  for (const Lamp& lamp : lit.room.lamps) {
    if (lit.room.tree.is_blocked(lit.room.solids, p_room, lamp.position_world)) continue;
    const Vector3d way = lamp.position_world - p_room;
    const double irradiance = static_cast<double>(lamp.power) / way.squaredNorm();
    sum += irradiance * way.normalized();
    all += irradiance;
  }
  constexpr double kDirected = 0.5, kFeeble = 0.2;
  if (!(all > kFeeble) || sum.norm() < kDirected * all) return std::nullopt;
  return sum.normalized();
}

void render_lit(const LitRoom& lit, const Intrinsics& camera, const Eigen::Isometry3d& T_room_camera,
                double noise, std::uint64_t noise_seed, ColourImage& colour, ExactView& exact) {
  ViewCaster view;
  view.prepare(lit.room.solids, camera, T_room_camera);
  render_exact(lit.room.solids, view, camera, {}, exact);
  colour.resize(camera.width_px, camera.height_px);
  const Eigen::Vector3f factor = lit.tint.array().pow(1.0F / 2.2F);
  for (int y = 0; y < colour.height; ++y) {
    for (int x = 0; x < colour.width; ++x) {
      const int seen = exact.solid.at(x, y);
      if (seen < 0) continue;
      const auto index = static_cast<std::size_t>(seen);
      const Solid& solid = lit.room.solids[index];
      const double depth_m = exact.depth_m.at(x, y);
      const Vector3d p_solid = view.local_point(seen, x, y, depth_m);
      const double cosine = std::max(exact.cosine.at(x, y), 0.2F);
      const Rgb shaded = lit.look->shade(index, p_solid, normal_local(solid, p_solid),
                                         depth_m / (camera.fx_px * cosine), solid.T_world_solid);
      const float grain =
          noise > 0.0 ? static_cast<float>(noise) * gaussian(mixed(noise_seed + colour.index(x, y))) : 0.0F;
      const auto seen_as = [&](std::uint8_t of, float by) {
        return static_cast<std::uint8_t>(
            std::clamp(by * static_cast<float>(of) + grain + 0.5F, 0.0F, 255.0F));
      };
      colour.at(x, y) = {seen_as(shaded.r, factor.x()), seen_as(shaded.g, factor.y()),
                         seen_as(shaded.b, factor.z())};
    }
  }
}

std::vector<Eigen::Isometry3d> views_of(const Room& room, const Vector3d& foot_room, std::size_t count,
                                        std::uint64_t seed) {
  CounterRandom random(hash_of(0x6c696768, seed), 0);
  const Vector3d middle = foot_room + Vector3d(0, 0, kMiddle_m);
  std::vector<Eigen::Isometry3d> views;
  for (int draw = 0; draw < 4000 && views.size() < count; ++draw) {
    const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double elevation = random.uniform(0.2, 0.9), away_m = random.uniform(0.7, 1.6);
    const Vector3d eye =
        middle + away_m * Vector3d(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    if (signed_distance_m(room, eye) < 0.15) continue;
    if (((eye - room.interior_min_world).array() < 0.1).any() ||
        ((room.interior_max_world - eye).array() < 0.1).any())
      continue;
    if (room.tree.is_blocked(room.solids, eye, middle) ||
        room.tree.is_blocked(room.solids, eye, foot_room + Vector3d(0, 0, 0.02)))
      continue;
    // The object is not always in the middle of the picture.
    const Vector3d target =
        middle + Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.15));
    Eigen::Isometry3d T_room_camera = Eigen::Isometry3d::Identity();
    const Vector3d z = (target - eye).normalized();
    const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
    T_room_camera.linear() << x, z.cross(x), z;
    T_room_camera.translation() = eye;
    views.push_back(T_room_camera);
  }
  return views;
}

}  // namespace roomradar
