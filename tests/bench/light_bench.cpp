// light_bench.cpp: a virtual object beside the same object really in a simulated room: colours, shadow,
// direction of light, flicker, and pixels lost along the contact with what it rests on.
//
// usage: light_bench [--views N] [--maps FOLDER] [--only WORD] [--pictures FOLDER] [--json FILE]
//                    [--light fixed|estimated]
//        N: views per room, lamps and place, 9 if not given. FOLDER of --maps: saved scans of simulated
//        rooms, as where_bench and placement_bench keep them; without it, no contact rows. WORD: part of a
//        row's name.
//
//   ROOM-LAMPS-PLACE  the room's true mesh is the map; poses are true; depth exact; colour with noise
//     colour      mean difference of the object's pixels from the real object's, of 255
//     shadow      the same of the pixels outside the object that the real object darkens by 4 or more
//     light_deg   angle between estimated and true direction of light; null where the lamps give none
//     flicker     greatest mean change of the object's tiles of 16 x 16 pixels between frames of a held view,
//                 of 255; the grain averages out
//     noise       standard deviation of brightness within the object, by second differences, of 255; and the
//                 same of the real object in the camera's image (noise_real)
//     light_ms    processor time of the light's estimate, per frame of a held view, of the calling thread
//   ROOM-contact      the map is a scan, depth as measured; the object rests on the highest point under it
//     lost        pixels within 10 mm of the foot that the picture hides though nothing is before them
//     lost_all    the same of all the object's pixels
//     shown       pixels shown though a real surface is 5 cm or more before them
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/picture_file.hpp"
#include "app/session/picture_composer.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "bench_program.hpp"
#include "bench_times.hpp"
#include "light_bench_scenes.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "radar/exact/ray_hit.hpp"
#include "where_bench_rooms.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

struct Settings {
  std::size_t views = 9;
  std::filesystem::path maps, pictures;
  std::string only, json;
  bool fixed = false;
};

/// Returns the sum of the channels' absolute differences.
int difference(const Rgb& a, const Rgb& b) {
  return std::abs(int{a.r} - int{b.r}) + std::abs(int{a.g} - int{b.g}) + std::abs(int{a.b} - int{b.b});
}

/// Returns the indices of pixels whose neighbourhood shows only the object.
std::vector<std::size_t> object_pixels(const ExactView& exact, std::size_t object_begin) {
  std::vector<std::size_t> pixels;
  const auto is_object = [&](int x, int y) { return exact.solid.at(x, y) >= static_cast<int>(object_begin); };
  for (int y = 1; y + 1 < exact.solid.height; ++y)
    for (int x = 1; x + 1 < exact.solid.width; ++x) {
      bool whole = true;
      for (int v = -1; v <= 1 && whole; ++v)
        for (int u = -1; u <= 1 && whole; ++u) whole = is_object(x + u, y + v);
      if (whole) pixels.push_back(exact.solid.index(x, y));
    }
  return pixels;
}

/// Returns the mean difference of two pictures in some pixels, per channel.
double mean_difference(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels) {
  double sum = 0.0;
  for (const std::size_t i : pixels) sum += difference(a.pixels[i], b.pixels[i]);
  return pixels.empty() ? 0.0 : sum / (3.0 * static_cast<double>(pixels.size()));
}

/// Returns the mean absolute change of tiles of 16 x 16 pixels, weighted by the given pixels in them.
double tile_change(const ColourImage& a, const ColourImage& b, const std::vector<std::size_t>& pixels) {
  constexpr std::size_t kTile_px = 16;
  std::map<std::size_t, std::pair<double, double>> tiles;  // sum of changes, number of pixels
  for (const std::size_t i : pixels) {
    const auto width = static_cast<std::size_t>(a.width);
    auto& [sum, count] = tiles[i / width / kTile_px * width + i % width / kTile_px];
    const Rgb &before = a.pixels[i], &after = b.pixels[i];
    sum += (int{after.r} + int{after.g} + int{after.b} - int{before.r} - int{before.g} - int{before.b}) / 3.0;
    count += 1.0;
  }
  double changed = 0.0;
  for (const auto& [tile, of] : tiles) changed += std::abs(of.first);
  return pixels.empty() ? 0.0 : changed / static_cast<double>(pixels.size());
}

/// Returns the standard deviation of the noise in pixels whose neighbourhood is the object's, from the median
/// of second differences.
double noise_in(const ColourImage& picture, const std::vector<std::size_t>& pixels) {
  constexpr double kOfDeviation = 0.6745 * 6.0 * 3.0;
  std::vector<int> rough;
  for (const std::size_t i : pixels) {
    const auto across = [](const Rgb* of) {
      const auto sum = [](const Rgb& pixel) { return int{pixel.r} + int{pixel.g} + int{pixel.b}; };
      return sum(of[-1]) - 2 * sum(of[0]) + sum(of[1]);
    };
    const Rgb* at = picture.pixels.data() + i;
    rough.push_back(std::abs(across(at - picture.width) - 2 * across(at) + across(at + picture.width)));
  }
  if (rough.empty()) return 0.0;
  const auto middle = rough.begin() + static_cast<std::ptrdiff_t>(rough.size() / 2);
  std::nth_element(rough.begin(), middle, rough.end());
  return *middle / kOfDeviation;
}

constexpr double kHeight_m = 0.27;

/// A composer in a room whose map is a mesh, with the object in it.
class Stage {
 public:
  explicit Stage(const Mesh& room_world, bool fixed_light = false)
      : room_(context_), scene_(context_, room_, {}), composer_(context_, scene_, objects_, config_) {
    if (fixed_light) config_.picture.light.samples_per_s = 0;
    room_.set(room_world, MeshUsage::kStatic);
    objects_.push_back(object_of(context_, "pot", object_of_solids(), {}));
    objects_.front()->in_room = objects_.front()->body.asleep = true;
  }
  void put_object(const Eigen::Isometry3d& T_world_object) {
    objects_.front()->body.T_world_object = T_world_object;
  }
  /// Shows a frame that comes dt_s after the previous one.
  const ColourImage& show(Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s) {
    frame.index = ++count_;
    frame.stamp_s = stamp_s_ += dt_s;
    composer_.begin_frame(frame);
    const ExpectedView& expected = scene_.render_expected(frame.depth_camera, T_world_camera);
    const FrameForeground& foreground = scene_.find_dynamic(frame, expected);
    scene_.mesh_surfaces(frame, T_world_camera, expected, foreground);
    const double start_ms = test::thread_ms();
    composer_.keep_colour(frame, T_world_camera, dt_s);
    if (dt_s < kHeld_s) light_ms.push_back(test::thread_ms() - start_ms);
    composer_.compose(frame, T_world_camera, true);
    if (dt_s < kHeld_s) compose_ms.push_back(test::thread_ms() - start_ms);
    composer_.end_frame(T_world_camera);
    return composer_.picture();
  }
  [[nodiscard]] const PictureComposer& composer() const { return composer_; }
  [[nodiscard]] const Shape& room() const { return room_; }

  static constexpr double kHeld_s = 0.1;     ///< frames of held views come sooner
  std::vector<double> compose_ms, light_ms;  ///< of held views

 private:
  GlContext context_;
  Shape room_;
  FrameScene scene_;
  SessionConfig config_;
  std::vector<std::unique_ptr<VirtualObject>> objects_;
  PictureComposer composer_;
  std::int64_t count_ = 0;
  double stamp_s_ = 0.0;
};

void save(const Settings& settings, const std::string& name, const ColourImage& picture) {
  if (settings.pictures.empty()) return;
  std::filesystem::create_directories(settings.pictures);
  write_png(picture, settings.pictures / (name + ".png"));
}

Frame frame_of(const Intrinsics& camera, const ColourImage& colour, const DepthImage& depth_m) {
  Frame frame;
  frame.colour = colour;
  frame.colour_camera = frame.depth_camera = camera;
  frame.depth_m = depth_m;
  for (float& z_m : frame.depth_m.pixels)
    if (z_m < static_cast<float>(kKinectNearest_m) || z_m > static_cast<float>(kKinectFarthest_m)) z_m = 0.0F;
  return frame;
}

struct Measured {
  std::vector<double> colour, shadow, light_deg, noise, noise_real;
  double flicker = 0.0;
};

/// Compares one view; the view is shown for one second first.
void compare_view(Stage& stage, const LitRoom& empty, const LitRoom& real, const Vector3d& middle,
                  const Eigen::Isometry3d& T_room_camera, std::uint64_t seed, const std::string& name,
                  const Settings& settings, Measured& measured) {
  constexpr double kNoise = 1.6;
  const Intrinsics camera = kKinectDepthCamera;
  ColourImage background, truth, clean;
  ExactView room_view, real_view;
  render_lit(empty, camera, T_room_camera, kNoise, hash_of(seed, 1), background, room_view);
  render_lit(empty, camera, T_room_camera, 0.0, 0, clean, room_view);
  render_lit(real, camera, T_room_camera, 0.0, 0, truth, real_view);
  Frame frame = frame_of(camera, background, room_view.depth_m);
  for (int i = 0; i < 4; ++i) static_cast<void>(stage.show(frame, T_room_camera, 0.2));
  ColourImage picture = stage.show(frame, T_room_camera, 0.2);

  const std::vector<std::size_t> pixels = object_pixels(real_view, real.object_begin);
  std::vector<std::size_t> darkened;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    if (real_view.solid.pixels[i] < static_cast<int>(real.object_begin) &&
        difference(truth.pixels[i], clean.pixels[i]) >= 12)
      darkened.push_back(i);
  measured.colour.push_back(mean_difference(picture, truth, pixels));
  measured.shadow.push_back(mean_difference(picture, truth, darkened));
  const std::optional<Vector3d> true_world = true_light(empty, middle);
  std::optional<Vector3d> found_world;
  if (stage.composer().room_light()) found_world = main_light(*stage.composer().room_light()).to_light_world;
  if (true_world)
    measured.light_deg.push_back(found_world
                                     ? std::acos(std::clamp(true_world->dot(*found_world), -1.0, 1.0)) *
                                           180.0 / std::numbers::pi
                                     : 180.0);
  ColourImage as_seen;
  ExactView same;
  render_lit(real, camera, T_room_camera, kNoise, hash_of(seed, 9), as_seen, same);
  measured.noise.push_back(noise_in(picture, pixels));
  measured.noise_real.push_back(noise_in(as_seen, pixels));
  save(settings, name + "-virtual", picture);
  save(settings, name + "-real", truth);
  for (std::uint64_t i = 0; i < 6; ++i) {  // held, at 30 frames per second, with each frame's own noise
    ColourImage noisy = clean;
    for (std::size_t k = 0; k < noisy.pixels.size(); ++k) {
      const float grain = static_cast<float>(kNoise) * gaussian(mixed(hash_of(seed, 2 + i) + k));
      const auto grainy = [&](std::uint8_t of) {
        return static_cast<std::uint8_t>(std::clamp(static_cast<float>(of) + grain + 0.5F, 0.0F, 255.0F));
      };
      Rgb& pixel = noisy.pixels[k];
      pixel = {grainy(pixel.r), grainy(pixel.g), grainy(pixel.b)};
    }
    frame.colour = noisy;
    const ColourImage& next = stage.show(frame, T_room_camera, 1.0 / 30.0);
    measured.flicker = std::max(measured.flicker, tile_change(picture, next, pixels));
    picture = next;
  }
}

nlohmann::json colour_row(const std::string& row, const std::string& room, const LampSet& lamps,
                          const Vector3d& foot, const Settings& settings) {
  const auto empty = lit_room(room, lamps, std::nullopt);
  const auto real = lit_room(room, lamps, foot);
  Stage stage(room_mesh(empty->room), settings.fixed);
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  T_world_object.translation() = foot;
  stage.put_object(T_world_object);
  const Vector3d middle = foot + Vector3d(0, 0, kHeight_m + 0.02);
  Measured measured;
  std::uint64_t view = 0;
  for (const Eigen::Isometry3d& T_room_camera : views_of(empty->room, foot, settings.views, 1)) {
    compare_view(stage, *empty, *real, middle, T_room_camera, view, row + "-" + std::to_string(view),
                 settings, measured);
    ++view;
  }
  std::sort(stage.compose_ms.begin(), stage.compose_ms.end());
  std::sort(stage.light_ms.begin(), stage.light_ms.end());
  const auto& degrees = measured.light_deg;
  return {
      {"row", row},
      {"views", view},
      {"colour", test::Times{measured.colour}.mean()},
      {"colour_max", view > 0 ? *std::max_element(measured.colour.begin(), measured.colour.end()) : 0.0},
      {"shadow", test::Times{measured.shadow}.mean()},
      {"light_deg", degrees.empty() ? nlohmann::json() : nlohmann::json(test::Times{degrees}.mean())},
      {"light_max_deg", degrees.empty() ? nlohmann::json()
                                        : nlohmann::json(*std::max_element(degrees.begin(), degrees.end()))},
      {"flicker", measured.flicker},
      {"noise", test::Times{measured.noise}.mean()},
      {"noise_real", test::Times{measured.noise_real}.mean()},
      {"compose_ms", view > 0 ? stage.compose_ms[stage.compose_ms.size() / 2] : 0.0},
      {"light_ms", view > 0 ? stage.light_ms[stage.light_ms.size() / 2] : 0.0}};
}

/// Returns the height of the map's highest point under the object's foot, in the world.
std::optional<double> support_m(const Shape& room, const Vector3d& foot_world) {
  constexpr double kHalf_m = 0.08, kStep_m = 0.004, kAbove_m = 0.1;
  std::optional<double> highest_m;
  for (double x = -kHalf_m; x <= kHalf_m; x += kStep_m)
    for (double y = -kHalf_m; y <= kHalf_m; y += kStep_m) {
      const Ray down{foot_world + Vector3d(x, y, kAbove_m), -Vector3d::UnitZ()};
      const auto hit = hit_mesh({&room.touched, Eigen::Isometry3d::Identity()}, down, 2.0 * kAbove_m);
      if (hit) highest_m = std::max(highest_m.value_or(hit->point_world.z()), hit->point_world.z());
    }
  return highest_m;
}

struct Lost {
  int foot = 0, lost = 0, lost_all = 0, shown = 0, pixels = 0;
};

/// Counts the pixels of the object that the last picture hides or shows wrongly.
/// @param room_m  exact depth of the room
void count_lost(const PictureComposer& composer, const DepthImage& room_m,
                const Eigen::Isometry3d& T_world_camera, const Intrinsics& camera, double foot_z_m,
                Lost& lost) {
  constexpr float kNothingBefore_m = 0.015F, kBefore_m = 0.05F;
  constexpr double kFoot_m = 0.010;
  const ObjectLayer& layer = composer.layer();
  const Occlusion& occlusion = composer.occlusion();
  for (int y = 0; y < layer.rect.height; ++y)
    for (int x = 0; x < layer.rect.width; ++x) {
      const int n = layer.samples;
      float depth_m = 0.0F;
      bool whole = true;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const float z_m = layer.depth_m.at(x * n + i, y * n + j);
          whole = whole && z_m > 0.0F;
          depth_m += z_m / static_cast<float>(n * n);
        }
      if (!whole) continue;
      const int u = layer.rect.x + x, v = layer.rect.y + y;
      const float hidden = occlusion.hidden.at(u - occlusion.rect.x, v - occlusion.rect.y);
      const double height_m = (T_world_camera * back_project(camera, u, v, depth_m)).z() - foot_z_m;
      ++lost.pixels;
      const bool is_free = room_m.at(u, v) > depth_m - kNothingBefore_m;
      lost.foot += height_m < kFoot_m && is_free;
      lost.lost += height_m < kFoot_m && is_free && hidden > 0.02F;
      lost.lost_all += is_free && hidden > 0.5F;
      lost.shown += room_m.at(u, v) < depth_m - kBefore_m && hidden < 0.5F;
    }
}

nlohmann::json contact_row(const std::string& row, const SimOptions& scan, const Vector3d& foot,
                           const Settings& settings) {
  SimulatedSource source(scan);
  const SavedMap map = map_of(source, PoseOrigin::kTracked, settings.maps / scan.room);
  Stage stage(map.mesh);
  const Eigen::Isometry3d& T_world_room = map.info.T_world_recorded;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  T_world_object.translation() = T_world_room * foot;
  const std::optional<double> z_m = support_m(stage.room(), T_world_object.translation());
  if (!z_m) throw Error(row + ": the map has no surface under the object");
  T_world_object.translation().z() = *z_m;
  stage.put_object(T_world_object);
  Lost lost;
  std::int64_t view = 0;
  for (const Eigen::Isometry3d& T_room_camera : views_of(source.room(), foot, 2 * settings.views, 2)) {
    Frame frame;
    for (int i = 0; i < 3; ++i) {
      source.look(3 * view + i, T_room_camera, frame);
      const ColourImage& picture = stage.show(frame, T_world_room * T_room_camera, 0.1);
      if (i == 2) save(settings, row + "-" + std::to_string(view), picture);
    }
    count_lost(stage.composer(), source.truth().depth_m, T_world_room * T_room_camera, frame.depth_camera,
               *z_m, lost);
    ++view;
  }
  return {{"row", row},         {"views", view},     {"pixels", lost.pixels},
          {"foot", lost.foot},  {"lost", lost.lost}, {"lost_all", lost.lost_all},
          {"shown", lost.shown}};
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i], value = argv[i + 1];
    if (word == "--views") settings.views = static_cast<std::size_t>(std::atoll(value.c_str()));
    if (word == "--maps") settings.maps = value;
    if (word == "--only") settings.only = value;
    if (word == "--pictures") settings.pictures = value;
    if (word == "--json") settings.json = value;
    if (word == "--light") settings.fixed = value == "fixed";
  }
  return settings;
}

int bench(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const nlohmann::json& row) {
    rows.push_back(row);
    std::printf("%s\n", row.dump().c_str());
    std::fflush(stdout);
  };
  const auto is_wanted = [&](const std::string& row) { return row.find(settings.only) != std::string::npos; };
  const struct {
    const char *room, *place;
    Vector3d foot;
  } places[] = {{"table", "top", {0.12, -0.14, 0.75}}, {"table", "under", {0.0, 0.0, 0.008}},
                {"shelf", "top", {0.0, 0.0, 0.46}},    {"shelf", "under", {0.0, 0.1, 0.008}},
                {"wall", "crate", {0.0, 1.2, 0.4}},    {"wall", "under", {2.2, -2.25, 0.0}}};
  for (const auto& place : places)
    for (const LampSet& lamps : {LampSet{"above", false}, LampSet{"side", true}}) {
      const std::string row = std::string(place.room) + "-" + lamps.name + "-" + place.place;
      if (is_wanted(row)) add(colour_row(row, place.room, lamps, place.foot, settings));
    }
  if (!settings.maps.empty()) {
    if (is_wanted("table-contact"))
      add(contact_row("table-contact", scan_of("table", 1), {0.12, -0.14, 0.75}, settings));
    if (is_wanted("shelf-contact"))
      add(contact_row("shelf-contact", scan_of("shelf", 1), {0.0, 0.0, 0.46}, settings));
  }
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("light_bench",
                                     [&] { return roomradar::bench(roomradar::parse(argc, argv)); });
}
