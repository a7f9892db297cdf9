// simulated_source.cpp: renders a frame of the simulated Kinect.
#include "app/sim/sensor/simulated_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <future>
#include <iterator>
#include <span>
#include <vector>

#include "app/sim/building/building.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/room/room_parts.hpp"
#include "app/sim/room/surface_appearance.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "app/sim/sensor/movers.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

/// Shadows of one frame's moving solids in the light of the room's first and strongest lamp.
class MoverShadow {
 public:
  void prepare(std::span<const Solid> movers);

  /// Returns the brightness factor of a point on the room's surface. It is about 0.75 if a moving solid
  /// blocks the lamp, and 1 if the lamp lights the point or the room itself shadows it.
  [[nodiscard]] float factor(const Room& room, const Eigen::Vector3d& p_world,
                             const Eigen::Vector3d& normal_world) const;

 private:
  std::vector<Solid> movers_;
  SolidTree tree_;
};

void MoverShadow::prepare(std::span<const Solid> movers) {
  movers_.assign(movers.begin(), movers.end());
  tree_ = SolidTree(movers_);
}

float MoverShadow::factor(const Room& room, const Eigen::Vector3d& p_world,
                          const Eigen::Vector3d& normal_world) const {
  constexpr double kLampPoints[4][2] = {{0.6, 0.2}, {-0.2, 0.6}, {-0.6, -0.2}, {0.2, -0.6}};
  constexpr float kDarkest = 0.26F;
  constexpr double kSkin_m = 0.001;
  if (room.lamps.empty()) return 1.0F;
  const Lamp& lamp = room.lamps.front();
  if (normal_world.dot(lamp.position_world - p_world) <= 0.0) return 1.0F;
  const Eigen::Vector3d start_world = p_world + kSkin_m * normal_world;
  int blocked = 0;
  for (const auto& [x, y] : kLampPoints)
    blocked += tree_.is_blocked(movers_, start_world,
                                lamp.position_world + lamp.radius_m * Eigen::Vector3d(x, y, 0.0));
  if (blocked == 0 || room.tree.is_blocked(room.solids, start_world, lamp.position_world)) return 1.0F;
  return 1.0F - kDarkest * static_cast<float>(blocked) / static_cast<float>(std::size(kLampPoints));
}

namespace {

/// Mean of the added pictures, which must have the same size.
class MeanPicture {
 public:
  MeanPicture(int width_px, int height_px) : sums_(width_px, height_px) {}

  void add(const ColourImage& picture) {
    ++count_;
    for (std::size_t i = 0; i < sums_.pixels.size(); ++i) {
      const Rgb& pixel = picture.pixels[i];
      std::array<int, 3>& sum = sums_.pixels[i];
      sum = {sum[0] + pixel.r, sum[1] + pixel.g, sum[2] + pixel.b};
    }
  }

  /// Writes the mean of at least one picture.
  void write(ColourImage& picture) const {
    const auto mean = [this](int sum) { return static_cast<std::uint8_t>((sum + count_ / 2) / count_); };
    std::transform(sums_.pixels.begin(), sums_.pixels.end(), picture.pixels.begin(),
                   [&](const std::array<int, 3>& sum) {
                     return Rgb{mean(sum[0]), mean(sum[1]), mean(sum[2])};
                   });
  }

 private:
  Image<std::array<int, 3>> sums_;
  int count_ = 0;
};

/// Returns the colour with each channel multiplied by the factor, <= 1.
Rgb dimmed(Rgb colour, float factor) {
  const auto dim = [factor](std::uint8_t of) {
    return static_cast<std::uint8_t>(static_cast<float>(of) * factor);
  };
  return factor < 1.0F ? Rgb{dim(colour.r), dim(colour.g), dim(colour.b)} : colour;
}

/// Makes the room that the options describe.
Room room_of(const SimOptions& options) {
  const bool crate = options.crate == CrateKind::kStays;
  if (options.room != kBuildingRoom) return make_room(options.room, crate, options.seed, options.moved);
  return make_building(plan_building(options.seed, options.building), options.walk, crate);
}

/// Returns the number of frames: SimOptions::frames, but at most those of an open walk. SimOptions::frames =
/// 0 means the whole walk, or the default number without a walk.
std::int64_t frames_of(const SimOptions& options, const Room& room) {
  if (options.path != CameraPathKind::kScan || room.walk_step_s == 0.0)
    return options.frames == 0 ? SimOptions{}.frames : options.frames;
  const double walk_s = static_cast<double>(room.walk.size() - 1) * room.walk_step_s;
  const auto whole = static_cast<std::int64_t>(std::floor(walk_s * options.rate_hz)) + 1;
  return options.frames == 0 ? whole : std::min(options.frames, whole);
}

/// Returns the seed of the camera's sway, the moving objects and the noise. It differs between the walks of a
/// building.
std::uint64_t path_seed(const SimOptions& options) {
  if (options.moved > 0.0) return hash_of(options.seed, 0x6d6f7665);
  if (options.room != kBuildingRoom) return options.seed;
  return hash_of(options.seed, 0x77616c6b, static_cast<std::uint64_t>(options.walk));
}

/// Selects all solids of a single room. In a building, selects the solids of the parts that may be visible
/// from eye_world.
/// @param solids    out: these solids
/// @param infrared  out: Material::infrared of each
/// @return their indices in Room::solids, ascending
std::vector<std::size_t> visible_solids(const Room& room, const Eigen::Vector3d& eye_world,
                                        std::vector<Solid>& solids, std::vector<float>& infrared) {
  std::vector<std::size_t> indices;
  solids.clear();
  infrared.clear();
  const auto add_range = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      solids.push_back(room.solids[i]);
      infrared.push_back(room.materials[i].infrared);
      indices.push_back(i);
    }
  };
  if (room.parts.empty()) add_range(0, room.solids.size());
  for (const int part : visible_parts(room, eye_world)) {
    const RoomPart& seen = room.parts[static_cast<std::size_t>(part)];
    add_range(seen.solids_begin, seen.solids_end);
  }
  return indices;
}

using Eigen::Vector3d;

/// The Kinect's colour camera is 2.5 cm along the depth camera's +x and has a slightly wider field of view.
constexpr double kColourOffset_m = 0.025;
constexpr double kColourFocal = 525.0 / 585.0;
/// An absent crate is moved this far below the floor, where it is invisible.
constexpr double kAway_m = 100.0;

using PoseAt = std::function<Eigen::Isometry3d(double)>;  // s after the middle of the depth image

}  // namespace

struct SimulatedSource::State {
  explicit State(const SimOptions& chosen)
      : options(chosen),
        noise_seed(path_seed(chosen)),
        room(room_of(chosen)),
        room_look(room, finest_texel_m(chosen)) {
    options.frames = frames_of(options, room);
    const double duration_s = static_cast<double>(options.frames) / options.rate_hz;
    path = plan_camera_path(room, options.path, noise_seed, duration_s);
    add_turns(path, options.turn_dps);
    const Vector3d viewer_world =
        plan_camera_path(room, CameraPathKind::kView, noise_seed, duration_s).centre_world;
    std::vector<Material> materials;
    for (std::size_t i = 0; i < options.movers.size(); ++i) {
      moving.movers.push_back(
          plan_mover(options.movers[i], room, viewer_world, noise_seed, options.pace, duration_s));
      append_solids(moving.movers.back(), 0.0, solids);
      materials.insert(materials.end(), moving.movers.back().materials.begin(),
                       moving.movers.back().materials.end());
      moving.mover_of_solid.resize(solids.size(), static_cast<std::uint8_t>(i + 1));
    }
    if (crate_changes()) {
      moving.crate = crate_in(room);
      solids.push_back(moving.crate);
      materials.push_back(crate_material());
      moving.mover_of_solid.push_back(static_cast<std::uint8_t>(options.movers.size() + 1));
    }
    moving.look.emplace(room, solids, materials, finest_texel_m(options));
    for (const Material& material : materials) moving.infrared.push_back(material.infrared);

    colour.camera = options.depth_camera;
    if (!options.registered_colour) {
      colour.camera.fx_px *= kColourFocal;
      colour.camera.fy_px *= kColourFocal;
      colour.T_colour_depth.translation().x() = -kColourOffset_m;
    }
    colour.T_colour_depth_true = colour.T_colour_depth;
    if (options.faults) add_faults();
  }

  void add_faults() {
    const Intrinsics& depth_camera = options.depth_camera;
    const SensorFaults faults = sensor_faults(depth_camera, colour.camera, colour.T_colour_depth);
    colour.T_colour_depth_true = faults.T_colour_depth;
    depth_faults.rays = pixel_rays(faults.depth_camera, faults.depth_lens, depth_camera);
    colour.rays = pixel_rays(faults.colour_camera, faults.colour_lens, colour.camera);
    depth_faults.inverse_scale = faults.inverse_depth_scale;
    depth_faults.inverse_offset_per_m.resize(depth_camera.width_px, depth_camera.height_px);
    for (int y = 0; y < depth_camera.height_px; ++y)
      for (int x = 0; x < depth_camera.width_px; ++x)
        depth_faults.inverse_offset_per_m.at(x, y) =
            static_cast<float>(inverse_depth_offset_per_m(depth_camera, x, y));
  }

  /// Returns 1.6 pixels' width at 1 m: cameras are hardly ever nearer.
  static double finest_texel_m(const SimOptions& options) { return 1.6 / options.depth_camera.fx_px; }

  void place_solids(std::int64_t index, const Vector3d& eye_world) {
    const double t_s = static_cast<double>(index) / options.rate_hz;
    room_index = visible_solids(room, eye_world, solids, infrared);
    infrared.insert(infrared.end(), moving.infrared.begin(), moving.infrared.end());
    for (const Mover& mover : moving.movers) append_solids(mover, t_s, solids);
    if (crate_changes()) {
      const bool second_half = 2 * index >= options.frames;
      moving.crate_is_there = second_half == (options.crate == CrateKind::kComes);
      solids.push_back(moving.crate);
      if (!moving.crate_is_there) solids.back().T_world_solid.pretranslate(Vector3d(0, 0, -kAway_m));
    }
    moving.shadow.prepare(std::span<const Solid>(solids).subspan(room_index.size()));
  }
  [[nodiscard]] bool crate_changes() const {
    return options.crate == CrateKind::kComes || options.crate == CrateKind::kGoes;
  }
  [[nodiscard]] bool is_colour_own_view() const {
    return !options.registered_colour || options.timing != SimTiming{};
  }
  void render(std::int64_t index, const PoseAt& T_world_camera_at, Frame& frame);
  void describe(std::int64_t index, Frame& frame) const;
  void render_depth_exact(const PoseAt& T_world_camera_at);
  void fill_truth();
  void fill_depth(std::int64_t index, const PoseAt& T_world_camera_at, DepthImage& depth_m);
  void fill_picture(std::int64_t index, const PoseAt& T_world_camera_at, ColourImage& picture);
  void fill_colour(const ViewCaster& view, const ExactView& exact, std::uint64_t key, const RowBand& band,
                   ColourImage& picture);

  /// Rays of the colour camera, and its pose relative to the depth camera.
  struct ColourCamera {
    Intrinsics camera;
    PixelRays rays;
    Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();       ///< as frames declare
    Eigen::Isometry3d T_colour_depth_true = Eigen::Isometry3d::Identity();  ///< true value
  };
  /// The solids besides the room's.
  struct Moving {
    std::vector<Mover> movers;
    std::optional<SurfaceAppearance> look;
    std::vector<std::uint8_t> mover_of_solid;  ///< 1 + mover index, for the solids after the room's
    std::vector<float> infrared;               ///< of their materials
    Solid crate;                               ///< crate that appears or disappears, at its place
    bool crate_is_there = false;
    MoverShadow shadow;
  };
  /// Views of the current frame, and buffers.
  struct Views {
    ViewCaster depth, colour, crate;
    ExactView depth_exact, colour_exact;
    KinectScratch scratch;
  };

  SimOptions options;
  std::uint64_t noise_seed;  ///< of the path, the moving objects and the noise
  Room room;
  SurfaceAppearance room_look;
  CameraPath path;
  Moving moving;
  ColourCamera colour;
  DepthFaults depth_faults;
  std::int64_t next_index = 0;
  std::vector<Solid> solids;    ///< the room's that may be seen, then the movers', at the frame's time
  std::vector<float> infrared;  ///< of the solids' materials
  std::vector<std::size_t> room_index;  ///< of the room's solids in `solids`: their index in Room::solids
  Views views;
  SimTruth truth;
};

void SimulatedSource::State::fill_truth() {
  const int width_px = options.depth_camera.width_px, height_px = options.depth_camera.height_px;
  truth.depth_m.resize(width_px, height_px);
  truth.moved.resize(width_px, height_px);
  truth.mover.resize(width_px, height_px);
  truth.revealed.resize(width_px, height_px);
  const bool crate_went = options.crate == CrateKind::kGoes && !moving.crate_is_there;
  if (crate_went) views.crate.prepare({&moving.crate, 1}, options.depth_camera, truth.T_world_camera);
  for (std::size_t i = 0; i < truth.depth_m.pixels.size(); ++i) {
    const float depth_m = views.depth_exact.depth_m.pixels[i];
    if (depth_m >= static_cast<float>(kKinectNearest_m) && depth_m <= static_cast<float>(kKinectFarthest_m))
      truth.depth_m.pixels[i] = depth_m;
    if (crate_went) {
      const auto x = static_cast<int>(i) % width_px, y = static_cast<int>(i) / width_px;
      const PlanePoint<double> ray = ray_of(depth_faults.rays, x, y);
      const double crate_m = views.crate.depth_of(0, ray.x, ray.y);
      if (crate_m > 0.0 && (depth_m == 0.0F || crate_m < depth_m)) truth.revealed.pixels[i] = 255;
    }
    const auto after_room = views.depth_exact.solid.pixels[i] - static_cast<std::int64_t>(room_index.size());
    if (after_room < 0) continue;
    // A crate that disappears counts as part of the room until then.
    if (options.crate == CrateKind::kGoes &&
        moving.mover_of_solid[static_cast<std::size_t>(after_room)] > moving.movers.size())
      continue;
    truth.moved.pixels[i] = 255;
    truth.mover.pixels[i] = moving.mover_of_solid[static_cast<std::size_t>(after_room)];
  }
}

void SimulatedSource::State::fill_colour(const ViewCaster& view, const ExactView& exact, std::uint64_t key,
                                         const RowBand& band, ColourImage& picture) {
  const auto noise_scale = static_cast<float>(options.noise_scale);
  for (int y = band.begin; y < band.end; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const int seen = exact.solid.at(x, y);
      if (seen < 0) continue;
      const auto index = static_cast<std::size_t>(seen);
      const double depth_m = exact.depth_m.at(x, y);
      const Vector3d p_solid = colour.rays.empty() ? view.local_point(seen, x, y, depth_m)
                                                   : view.local_point(seen, colour.rays.at(x, y).x,
                                                                      colour.rays.at(x, y).y, depth_m);
      const Vector3d normal_solid = normal_local(solids[index], p_solid);
      const double cosine = std::max(exact.cosine.at(x, y), 0.2F);
      const double footprint_m = depth_m / (colour.camera.fx_px * cosine);
      Rgb& pixel = picture.at(x, y);
      const Eigen::Isometry3d& T_world_solid = solids[index].T_world_solid;
      if (index < room_index.size()) {
        pixel = room_look.shade(room_index[index], p_solid, normal_solid, footprint_m, T_world_solid);
        if (solids.size() > room_index.size())
          pixel = dimmed(pixel, moving.shadow.factor(room, T_world_solid * p_solid,
                                                     T_world_solid.linear() * normal_solid));
      } else {
        pixel =
            moving.look->shade(index - room_index.size(), p_solid, normal_solid, footprint_m, T_world_solid);
      }
      if (noise_scale == 0.0F) continue;
      const std::uint64_t pixel_key = mixed(key + picture.index(x, y));
      const float brightness = 1.6F * noise_scale * gaussian(pixel_key);
      const auto noisy = [brightness](std::uint8_t of) {
        return static_cast<std::uint8_t>(
            std::clamp(static_cast<float>(of) + brightness + 0.5F, 0.0F, 255.0F));
      };
      pixel = {noisy(pixel.r), noisy(pixel.g), noisy(pixel.b)};
    }
}

void SimulatedSource::State::render_depth_exact(const PoseAt& T_world_camera_at) {
  clear(options.depth_camera, views.depth_exact);
  for (const RowBand& band : row_bands(options.depth_camera.height_px, options.timing.shutter_s)) {
    views.depth.prepare(solids, options.depth_camera, T_world_camera_at(band.t_s));
    render_exact(solids, views.depth, options.depth_camera, depth_faults.rays, band, views.depth_exact);
  }
}

void SimulatedSource::State::fill_depth(std::int64_t index, const PoseAt& T_world_camera_at,
                                        DepthImage& depth_m) {
  if (options.noise_scale > 0.0) {
    depth_m.resize(options.depth_camera.width_px, options.depth_camera.height_px);
    for (const RowBand& band : row_bands(depth_m.height, options.timing.shutter_s)) {
      const Eigen::Isometry3d T_world_camera = T_world_camera_at(band.t_s);
      if (options.timing.shutter_s > 0.0) views.depth.prepare(solids, options.depth_camera, T_world_camera);
      measure_depth({solids, infrared},
                    {.caster = views.depth,
                     .exact = views.depth_exact,
                     .camera = options.depth_camera,
                     .T_world_camera = T_world_camera},
                    {.faults = depth_faults,
                     .noise_scale = options.noise_scale,
                     .seed = noise_seed,
                     .frame_index = index},
                    band, views.scratch, depth_m);
    }
    return;
  }
  depth_m = truth.depth_m;
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x) {
      float& z_m = depth_m.at(x, y);
      if (z_m > 0.0F) z_m = static_cast<float>(reported_m(depth_faults, x, y, z_m));
    }
}

void SimulatedSource::State::fill_picture(std::int64_t index, const PoseAt& T_world_camera_at,
                                          ColourImage& picture) {
  const std::uint64_t key = hash_of(noise_seed, static_cast<std::uint64_t>(index), 0x636f6c);
  picture.resize(colour.camera.width_px, colour.camera.height_px);
  if (!is_colour_own_view()) {
    fill_colour(views.depth, views.depth_exact, key, {0, picture.height, 0.0}, picture);
    return;
  }
  const auto& [shutter_s, delay_s, exposure_s] = options.timing;
  const Eigen::Isometry3d T_depth_colour = colour.T_colour_depth_true.inverse();
  const int exposures = exposure_s > 0.0 ? 5 : 1;
  MeanPicture mean(picture.width, picture.height);
  for (int i = 0; i < exposures; ++i) {
    const double exposed_s = exposure_s * ((i + 0.5) / exposures - 0.5);
    clear(colour.camera, views.colour_exact);
    std::fill(picture.pixels.begin(), picture.pixels.end(), Rgb{});
    for (const RowBand& band : row_bands(picture.height, shutter_s)) {
      views.colour.prepare(solids, colour.camera,
                           T_world_camera_at(delay_s + exposed_s + band.t_s) * T_depth_colour);
      render_exact(solids, views.colour, colour.camera, colour.rays, band, views.colour_exact);
      fill_colour(views.colour, views.colour_exact, key, band, picture);
    }
    mean.add(picture);
  }
  mean.write(picture);
}

void SimulatedSource::State::render(std::int64_t index, const PoseAt& T_world_camera_at, Frame& frame) {
  place_solids(index, T_world_camera_at(0.0).translation());
  std::future<void> picture;  // rendered beside depth
  const auto take_picture = [&] {
    picture = std::async(std::launch::async, [&] { fill_picture(index, T_world_camera_at, frame.colour); });
  };
  if (options.with_colour && is_colour_own_view()) take_picture();
  render_depth_exact(T_world_camera_at);
  if (options.with_colour && !picture.valid()) take_picture();
  truth.T_world_camera = T_world_camera_at(0.0);
  fill_truth();
  fill_depth(index, T_world_camera_at, frame.depth_m);
  if (picture.valid()) picture.get();
  if (!options.with_colour) frame.colour = {};
}

SimulatedSource::SimulatedSource(const SimOptions& options) {
  require_valid(options);
  state_ = std::make_unique<State>(options);
}

SimulatedSource::~SimulatedSource() = default;

ReadResult SimulatedSource::next(Frame& frame) {
  State& s = *state_;
  if (s.next_index >= s.options.frames) return {ReadStatus::kEnd, {}};
  const std::int64_t index = s.next_index++;
  const double t_s = static_cast<double>(index) / s.options.rate_hz;
  s.render(
      index, [&](double after_s) { return T_world_camera_at(s.path, t_s + after_s); }, frame);
  s.describe(index, frame);
  return {ReadStatus::kFrame, {}};
}

void SimulatedSource::look(std::int64_t index, const Eigen::Isometry3d& T_world_camera, Frame& frame) {
  state_->render(
      index, [&](double) { return T_world_camera; }, frame);
  state_->describe(index, frame);
}

void SimulatedSource::State::describe(std::int64_t index, Frame& frame) const {
  frame.index = index;
  frame.stamp_s = static_cast<double>(index) / options.rate_hz;
  frame.depth_camera = options.depth_camera;
  frame.colour_camera = options.with_colour ? colour.camera : Intrinsics{};
  frame.T_colour_depth = colour.T_colour_depth;
  frame.T_world_camera = truth.T_world_camera;
  frame.down_camera = truth.T_world_camera.linear().transpose() * -Vector3d::UnitZ();
}

bool SimulatedSource::rewind() {
  state_->next_index = 0;
  return true;
}

bool SimulatedSource::seek(std::int64_t index) {
  if (index < 0 || index >= state_->options.frames) return false;
  state_->next_index = index;
  return true;
}

std::optional<std::int64_t> SimulatedSource::frame_count() const { return state_->options.frames; }
std::string SimulatedSource::name() const { return sim_spec(state_->options); }
const SimTruth& SimulatedSource::truth() const { return state_->truth; }
const Room& SimulatedSource::room() const { return state_->room; }

}  // namespace roomradar
