// odometry_checkpoint.cpp: saves an odometry to disk and restores it.
//
// All numbers are little-endian; each file has a magic word, a version (u32), a body, and a checksum (u64).
#include "mapping/odometry/odometry_checkpoint.hpp"

#include <optional>
#include <string>
#include <utility>

#include "mapping/alignment/packed_view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/checkpoints.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStateMagic = "RRODOMET", kViewMagic = "RRKEYFRM";
constexpr std::uint32_t kVersion = 7;
constexpr const char* kStateFile = "state.bin";
constexpr int kMaxSide_px = 8192;

fs::path view_name(std::size_t number, std::uint32_t revision) {
  return "keyframe-" + std::to_string(number) + "-" + std::to_string(revision) + ".bin";
}

fs::path place_name(std::size_t number) { return "place-" + std::to_string(number) + ".bin"; }

template <typename Archive>
void serialize_pose(Archive& archive, Ref<Archive, Eigen::Isometry3d> T, const char* what) {
  archive(T.matrix());
  if constexpr (Archive::kReads)
    if (!is_rigid(T, 1e-6)) archive.fail(std::string(what) + " is not a rotation and a shift");
}

/// An unset pose is in the file as the identity.
template <typename Archive>
void serialize_optional_pose(Archive& archive, Ref<Archive, std::optional<Eigen::Isometry3d>> T,
                             const char* what) {
  bool is_set = T.has_value();
  Eigen::Isometry3d pose = T.value_or(Eigen::Isometry3d::Identity());
  serialize_as<std::uint32_t>(archive, is_set);
  serialize_pose(archive, pose, what);
  if constexpr (Archive::kReads) T = is_set ? std::optional(pose) : std::nullopt;
}

template <typename Archive>
void serialize_times(Archive& archive, Ref<Archive, SensorTiming> times) {
  serialize_finite(archive, "a time of the sensor", times.depth_readout_s, times.colour_readout_s,
                   times.colour_delay_s);
}

/// @param image  an Image; its number of pixels follows from its size and is not in the file
template <typename Archive, typename Picture>
void serialize_image(Archive& archive, Picture& image, const char* what) {
  archive(image.width, image.height);
  if constexpr (Archive::kReads) {
    const int width = image.width, height = image.height;
    if (width < 0 || height < 0 || width > kMaxSide_px || height > kMaxSide_px)
      archive.fail(std::string(what) + " of " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels");
    archive.require(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
                    sizeof(image.pixels[0]));
    image.resize(width, height);
  }
  archive.raw(image.pixels.data(), image.pixels.size() * sizeof(image.pixels[0]));
}

constexpr std::size_t kPose_bytes = 16 * sizeof(double), kInformation_bytes = 36 * sizeof(double);

}  // namespace

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, StoredView> view) {
  auto& camera = view.camera;
  serialize_finite(archive, "camera", camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  auto& noise = view.noise;
  for (auto* const number :
       {&noise.base_m, &noise.linear, &noise.quadratic_per_m, &noise.from_m, &noise.grazing})
    serialize_as<double>(archive, *number);
  if constexpr (Archive::kReads)
    if (!is_valid(noise)) archive.fail("its noise model is not valid");
  serialize_image(archive, view.inverse_depth, "depth");
  serialize_image(archive, view.intensity, "intensity");
  serialize_image(archive, view.measured, "counts");
  if constexpr (Archive::kReads) {
    camera.width_px = view.inverse_depth.width;
    camera.height_px = view.inverse_depth.height;
    require_valid(camera, (archive.where() + ": the camera").c_str());
    const auto fits = [&](const auto& image) {
      return image.width == camera.width_px && image.height == camera.height_px;
    };
    if (!fits(view.measured) || !(view.intensity.empty() || fits(view.intensity)))
      archive.fail("its images differ in size");
  }
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, CameraVelocity> velocity) {
  serialize_finite(archive, "velocity", velocity.linear_mps, velocity.angular_radps);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, MotionPrior> prior) {
  serialize_optional_pose(archive, prior.T_world_recorded, "the recorded world's pose");
  serialize_finite(archive, "a deviation of recorded poses", prior.sigma_m, prior.mean_difference_m,
                   prior.jitter_m);
  for (auto& pose : prior.recorded) {
    double stamp_s = pose ? pose->stamp_s : 0.0;
    auto T = pose ? std::optional(pose->T_recorded_camera) : std::nullopt;
    serialize_finite(archive, "stamp of a recorded pose", stamp_s);
    serialize_optional_pose(archive, T, "a recorded pose");
    if constexpr (Archive::kReads)
      if (T) pose = RecordedPose{stamp_s, *T};
  }
  for (auto& distance_m : prior.excess_m)
    serialize_finite(archive, "distance of a recorded pose", distance_m);
  archive(prior.excesses, prior.stretch, prior.used, prior.contradicted, prior.contradicted_in_a_row);
  if constexpr (Archive::kReads) {
    if (prior.excesses < 0) archive.fail("the number of distances of recorded poses is negative");
    if (!(prior.sigma_m > 0.0)) archive.fail("the standard deviation of recorded poses is not positive");
  }
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, TimingEstimate> timing) {
  serialize_times(archive, timing.stated);
  serialize_times(archive, timing.current);
  serialize_finite(archive, "evidence", timing.sum.H, timing.sum.b);
  archive(timing.frames);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, OdometryCounts> c) {
  archive(c.frames, c.tracked, c.degenerate, c.lost, c.relocalised, c.keyframes, c.anchored);
}

/// All but the view.
template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, Keyframe> keyframe) {
  archive(keyframe.frame_index);
  serialize_pose(archive, keyframe.T_world_camera, "a keyframe's pose");
  archive(keyframe.revision);
  serialize_finite(archive, "path length", keyframe.path_length_m);
  archive(keyframe.velocity, keyframe.steady_velocity);
  serialize_times(archive, keyframe.timing);
  serialize_optional_pose(archive, keyframe.T_recorded_camera, "a keyframe's recorded pose");
  archive(keyframe.stretch, keyframe.part);
  serialize_as<std::uint32_t>(archive, keyframe.is_by_flow);
  if constexpr (Archive::kReads)
    if (keyframe.part < 0) archive.fail("a keyframe's part is negative");
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, PoseConstraint> c) {
  archive(c.a, c.b);
  serialize_pose(archive, c.T_a_b, "a constraint's pose");
  serialize_finite(archive, "information", c.information);
  serialize_as<std::uint32_t>(archive, c.robust);
  serialize_as<std::uint32_t>(archive, c.recorded);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, PoseAnchor> anchor) {
  archive(anchor.pose);
  serialize_pose(archive, anchor.T_world_camera, "an anchor's pose");
  serialize_finite(archive, "information", anchor.information);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeyframeGraph> graph) {
  serialize_size(archive, graph.keyframes, kPose_bytes);
  for (auto& keyframe : graph.keyframes) archive(keyframe);
  serialize_size(archive, graph.constraints, kPose_bytes + kInformation_bytes);
  for (auto& constraint : graph.constraints) archive(constraint);
  serialize_size(archive, graph.anchors, kPose_bytes + kInformation_bytes);
  for (auto& anchor : graph.anchors) archive(anchor);
  if constexpr (Archive::kReads) {
    const std::size_t keyframes = graph.keyframes.size();
    for (const PoseConstraint& c : graph.constraints)
      if (c.a >= keyframes || c.b >= keyframes) archive.fail("a constraint's keyframe is not there");
    for (const PoseAnchor& anchor : graph.anchors)
      if (anchor.pose >= keyframes) archive.fail("an anchor's keyframe is not there");
  }
  archive(graph.loops_found, graph.loops_rejected);
  serialize_finite(archive, "standard deviation of recorded poses", graph.recorded_sigma_m);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeptFrame> frame) {
  archive(frame.frame_index);
  serialize_finite(archive, "stamp", frame.stamp_s);
  auto keyframe = frame.keyframe ? static_cast<std::int64_t>(*frame.keyframe) : std::int64_t{-1};
  archive(keyframe);
  if constexpr (Archive::kReads)
    if (keyframe >= 0) frame.keyframe = static_cast<std::size_t>(keyframe);
  serialize_pose(archive, frame.T_keyframe_camera, "a frame's pose");
  serialize(archive, frame.status, TrackStatus::kDiverged);
  serialize_as<std::uint32_t>(archive, frame.trusted);
}

/// All but the views of the keyframes and, but for their poses, the entries of the keyframe database.
template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, OdometrySnapshot> kept) {
  archive(kept.counts, kept.graph);
  auto& places = kept.keyframe_database.keyframes;
  serialize_size(archive, places, kPose_bytes);
  for (auto& place : places) serialize_pose(archive, place.T_world_camera, "a database entry's pose");
  serialize_size(archive, kept.frames, kPose_bytes);
  for (auto& frame : kept.frames) archive(frame);
  archive(kept.current, kept.final_keyframes, kept.improved);
  serialize_pose(archive, kept.T_world_last, "the last pose");
  serialize_pose(archive, kept.T_last_next, "the last motion");
  serialize_finite(archive, "path length", kept.path_length_m);
  serialize_image(archive, kept.last_moved_grey, "picture");
  serialize(archive, kept.last_moved.status, TrackStatus::kDiverged);
  serialize_pose(archive, kept.last_moved.T_world_camera, "the pose when the camera last moved");
  serialize_as<std::uint32_t>(archive, kept.located);
  archive(kept.timing);
  serialize_as<std::uint32_t>(archive, kept.is_stationary);
  archive(kept.parts);
  bool is_lost = kept.lost.has_value();
  LostPlace lost = kept.lost.value_or(LostPlace{});
  serialize_as<std::uint32_t>(archive, is_lost);
  archive(lost.keyframe);
  serialize_pose(archive, lost.T_keyframe_camera, "the pose of a loss");
  serialize_finite(archive, "the time of a loss", lost.stamp_s);
  archive(kept.prior);
  if constexpr (Archive::kReads) {
    const std::size_t keyframes = kept.graph.keyframes.size();
    if (keyframes > 0 && places.size() != keyframes)
      archive.fail("keyframes and database entries differ in number");
    for (const KeptFrame& frame : kept.frames)
      if (frame.keyframe && *frame.keyframe >= keyframes) archive.fail("a frame's keyframe is not there");
    if (keyframes > 0 && kept.current >= keyframes) archive.fail("the current keyframe is not there");
    if (keyframes == 0) kept.current = 0;
    if (kept.final_keyframes > keyframes) archive.fail("more keyframes are final than there are");
    if (is_lost && lost.keyframe >= keyframes) archive.fail("the keyframe of a loss is not there");
    if (is_lost) kept.lost = lost;
  }
}

void save_odometry(const Odometry& odometry, const fs::path& into, const fs::path& previous) {
  const OdometrySnapshot kept = odometry.snapshot();
  const auto is_carried_over = [&](const fs::path& name) {
    return !previous.empty() && carry_over(previous / name, into / name);
  };
  for (std::size_t i = 0; i < kept.graph.keyframes.size(); ++i) {
    const fs::path name = view_name(i, kept.graph.keyframes[i].revision);
    if (!is_carried_over(name))
      save_binary(into / name, kViewMagic, kVersion, unpacked(*kept.graph.keyframes[i].view));
  }
  for (std::size_t i = 0; i < kept.keyframe_database.keyframes.size(); ++i) {
    const fs::path name = place_name(i);
    if (!is_carried_over(name))
      write_keyframe_database({{kept.keyframe_database.keyframes[i]}, {}}, into / name);
  }
  save_binary(into / kStateFile, kStateMagic, kVersion, kept);
}

Odometry load_odometry(const fs::path& folder, const OdometryConfig& config) {
  OdometrySnapshot kept;
  load_binary(folder / kStateFile, kStateMagic, kVersion, kept);
  for (std::size_t i = 0; i < kept.graph.keyframes.size(); ++i) {
    Keyframe& keyframe = kept.graph.keyframes[i];
    StoredView view;
    load_binary(folder / view_name(i, keyframe.revision), kViewMagic, kVersion, view);
    keyframe.view = std::make_shared<const PackedView>(packed(view));
  }
  for (std::size_t i = 0; i < kept.keyframe_database.keyframes.size(); ++i) {
    const fs::path path = folder / place_name(i);
    KeyframeDatabase one = read_keyframe_database(path);
    if (one.keyframes.size() != 1) throw Error(path.string() + ": does not contain one database entry");
    MapKeyframe& place = kept.keyframe_database.keyframes[i];
    one.keyframes.front().T_world_camera = place.T_world_camera;
    place = std::move(one.keyframes.front());
  }
  return Odometry(config, std::move(kept));
}

}  // namespace roomradar
