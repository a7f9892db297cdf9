// odometry_checkpoint.cpp: saves an odometry to disk and restores it.
//
// All numbers are little-endian; each file has a magic word, a version (u32), a body, and a checksum (u64).
#include "mapping/odometry/odometry_checkpoint.hpp"

#include <optional>
#include <string>
#include <utility>

#include "mapping/alignment/packed_view.hpp"
#include "mapping/localization/keyframe_database_file.hpp"
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
constexpr int kMaxSide_px = 8192;

fs::path view_name(std::size_t number, std::uint32_t revision) {
  return "keyframe-" + std::to_string(number) + "-" + std::to_string(revision) + ".bin";
}

fs::path place_name(std::size_t number) { return "place-" + std::to_string(number) + ".bin"; }

void put_pose(std::string& out, const Eigen::Isometry3d& T) { put(out, T.matrix().data(), 16); }

Eigen::Isometry3d take_pose(BinaryReader& in, const char* what) {
  Eigen::Isometry3d T;
  for (Eigen::Index i = 0; i < 16; ++i) T.matrix().data()[i] = in.take_finite(what);
  if (!is_rigid(T, 1e-6)) in.fail(std::string(what) + " is not a rotation and a shift");
  return T;
}

void put_optional_pose(std::string& out, const std::optional<Eigen::Isometry3d>& T) {
  put(out, std::uint32_t{T ? 1U : 0U});
  put_pose(out, T.value_or(Eigen::Isometry3d::Identity()));
}

std::optional<Eigen::Isometry3d> take_optional_pose(BinaryReader& in, const char* what) {
  const bool is_set = in.take<std::uint32_t>(what) != 0;
  const Eigen::Isometry3d T = take_pose(in, what);
  return is_set ? std::optional(T) : std::nullopt;
}

void put_prior(std::string& out, const MotionPrior& prior) {
  put_optional_pose(out, prior.T_world_recorded);
  put(out, prior.sigma_m);
  put(out, prior.mean_difference_m);
  put(out, prior.jitter_m);
  for (const std::optional<RecordedPose>& pose : prior.recorded) {
    put(out, pose ? pose->stamp_s : 0.0);
    put_optional_pose(out, pose ? std::optional(pose->T_recorded_camera) : std::nullopt);
  }
  put(out, prior.excess_m.data(), prior.excess_m.size());
  put(out, prior.excesses);
  for (const std::int64_t count :
       {prior.stretch, prior.used, prior.contradicted, prior.contradicted_in_a_row})
    put(out, count);
}

MotionPrior take_prior(BinaryReader& in) {
  MotionPrior prior;
  prior.T_world_recorded = take_optional_pose(in, "the recorded world's pose");
  prior.sigma_m = in.take_finite("standard deviation of recorded poses");
  prior.mean_difference_m = in.take_finite("mean difference of recorded poses");
  prior.jitter_m = in.take_finite("jitter of recorded poses");
  for (std::optional<RecordedPose>& pose : prior.recorded) {
    const double stamp_s = in.take_finite("stamp of a recorded pose");
    if (const auto T = take_optional_pose(in, "a recorded pose")) pose = RecordedPose{stamp_s, *T};
  }
  for (double& distance_m : prior.excess_m) distance_m = in.take_finite("distance of a recorded pose");
  prior.excesses = in.take<std::int64_t>("number of distances of recorded poses");
  if (prior.excesses < 0) in.fail("the number of distances of recorded poses is negative");
  if (!(prior.sigma_m > 0.0)) in.fail("the standard deviation of recorded poses is not positive");
  for (std::int64_t* count : {&prior.stretch, &prior.used, &prior.contradicted, &prior.contradicted_in_a_row})
    *count = in.take<std::int64_t>("counts of recorded poses");
  return prior;
}

void put_velocity(std::string& out, const CameraVelocity& velocity) {
  put(out, velocity.linear_mps.data(), 3);
  put(out, velocity.angular_radps.data(), 3);
}

CameraVelocity take_velocity(BinaryReader& in) {
  CameraVelocity velocity;
  for (Eigen::Index i = 0; i < 3; ++i) velocity.linear_mps[i] = in.take_finite("velocity");
  for (Eigen::Index i = 0; i < 3; ++i) velocity.angular_radps[i] = in.take_finite("velocity");
  return velocity;
}

void put_times(std::string& out, const SensorTiming& times) {
  for (const double s : {times.depth_readout_s, times.colour_readout_s, times.colour_delay_s}) put(out, s);
}

SensorTiming take_times(BinaryReader& in) {
  SensorTiming times;
  for (double* s : {&times.depth_readout_s, &times.colour_readout_s, &times.colour_delay_s})
    *s = in.take_finite("a time of the sensor");
  return times;
}

void put_timing(std::string& out, const TimingEstimate& timing) {
  put_times(out, timing.stated);
  put_times(out, timing.current);
  put(out, timing.sum.H.data(), static_cast<std::size_t>(timing.sum.H.size()));
  put(out, timing.sum.b.data(), static_cast<std::size_t>(timing.sum.b.size()));
  put(out, timing.frames);
}

TimingEstimate take_timing(BinaryReader& in) {
  TimingEstimate timing;
  timing.stated = take_times(in);
  timing.current = take_times(in);
  for (Eigen::Index i = 0; i < timing.sum.H.size(); ++i) timing.sum.H.data()[i] = in.take_finite("evidence");
  for (Eigen::Index i = 0; i < timing.sum.b.size(); ++i) timing.sum.b.data()[i] = in.take_finite("evidence");
  timing.frames = in.take<int>("frames of evidence");
  return timing;
}

void put_information(std::string& out, const Matrix6d& information) { put(out, information.data(), 36); }

Matrix6d take_information(BinaryReader& in) {
  Matrix6d information;
  for (Eigen::Index i = 0; i < 36; ++i) information.data()[i] = in.take_finite("information");
  return information;
}

template <typename Pixel>
void put_image(std::string& out, const Image<Pixel>& image) {
  put(out, image.width);
  put(out, image.height);
  put(out, image.pixels.data(), image.pixels.size());
}

template <typename Pixel>
Image<Pixel> take_image(BinaryReader& in, const char* what) {
  const int width = in.take<int>(what), height = in.take<int>(what);
  if (width < 0 || height < 0 || width > kMaxSide_px || height > kMaxSide_px) {
    in.fail(std::string(what) + " of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  in.require(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), sizeof(Pixel), what);
  Image<Pixel> image(width, height);
  in.take(image.pixels.data(), image.pixels.size(), what);
  return image;
}

void write_view(const StoredView& view, const fs::path& path) {
  std::string out;
  for (const double number : {view.camera.fx_px, view.camera.fy_px, view.camera.cx_px, view.camera.cy_px}) {
    put(out, number);
  }
  const DepthNoise& noise = view.noise;
  for (const float number : {noise.base_m, noise.linear, noise.quadratic_per_m, noise.from_m, noise.grazing})
    put(out, static_cast<double>(number));
  put_image(out, view.inverse_depth);
  put_image(out, view.intensity);
  put_image(out, view.measured);
  write_binary(path, kViewMagic, kVersion, out);
}

StoredView read_view(const fs::path& path) {
  const std::string bytes = read_binary(path, kViewMagic, kVersion);
  BinaryReader in(bytes, path);
  StoredView view;
  for (double* number : {&view.camera.fx_px, &view.camera.fy_px, &view.camera.cx_px, &view.camera.cy_px}) {
    *number = in.take_finite("camera");
  }
  DepthNoise& noise = view.noise;
  for (float* number : {&noise.base_m, &noise.linear, &noise.quadratic_per_m, &noise.from_m, &noise.grazing})
    *number = static_cast<float>(in.take_finite("noise"));
  if (!is_valid(noise)) in.fail("its noise model is not valid");
  view.inverse_depth = take_image<std::uint16_t>(in, "depth");
  view.intensity = take_image<std::uint8_t>(in, "intensity");
  view.measured = take_image<std::uint8_t>(in, "counts");
  view.camera.width_px = view.inverse_depth.width;
  view.camera.height_px = view.inverse_depth.height;
  require_valid(view.camera, (path.string() + ": the camera").c_str());
  const auto fits = [&](int width, int height) {
    return width == view.camera.width_px && height == view.camera.height_px;
  };
  if (!fits(view.measured.width, view.measured.height) ||
      !(view.intensity.empty() || fits(view.intensity.width, view.intensity.height)) || in.left() != 0) {
    in.fail("its images differ in size");
  }
  return view;
}

TrackStatus take_status(BinaryReader& in) {
  const auto status = in.take<std::uint32_t>("status");
  if (status > static_cast<std::uint32_t>(TrackStatus::kDiverged)) in.fail("a frame's status is invalid");
  return static_cast<TrackStatus>(status);
}

std::size_t take_index(BinaryReader& in, std::size_t count, const char* what) {
  const auto index = in.take<std::uint64_t>(what);
  if (index >= count) in.fail(std::string(what) + " " + std::to_string(index) + " is not there");
  return static_cast<std::size_t>(index);
}

std::size_t take_count(BinaryReader& in, std::size_t item_bytes, const char* what) {
  const auto count = in.take<std::uint64_t>(what);
  in.require(static_cast<std::size_t>(count), item_bytes, what);
  return static_cast<std::size_t>(count);
}

constexpr std::size_t kPose_bytes = 16 * sizeof(double), kInformation_bytes = 36 * sizeof(double);

void put_counts(std::string& out, const OdometryCounts& c) {
  for (const std::int64_t count :
       {c.frames, c.tracked, c.degenerate, c.lost, c.relocalised, c.keyframes, c.anchored}) {
    put(out, count);
  }
}

void take_counts(BinaryReader& in, OdometryCounts& c) {
  for (std::int64_t* count :
       {&c.frames, &c.tracked, &c.degenerate, &c.lost, &c.relocalised, &c.keyframes, &c.anchored}) {
    *count = in.take<std::int64_t>("counts");
  }
}

void put_graph(std::string& out, const KeyframeGraph& graph) {
  put(out, std::uint64_t{graph.keyframes.size()});
  for (const Keyframe& keyframe : graph.keyframes) {
    put(out, keyframe.frame_index);
    put_pose(out, keyframe.T_world_camera);
    put(out, keyframe.revision);
    put(out, keyframe.path_length_m);
    put_velocity(out, keyframe.velocity);
    put_velocity(out, keyframe.steady_velocity);
    put_times(out, keyframe.timing);
    put_optional_pose(out, keyframe.T_recorded_camera);
    put(out, keyframe.stretch);
    put(out, keyframe.part);
    put(out, std::uint32_t{keyframe.is_by_flow ? 1U : 0U});
  }
  put(out, std::uint64_t{graph.constraints.size()});
  for (const PoseConstraint& c : graph.constraints) {
    put(out, std::uint64_t{c.a});
    put(out, std::uint64_t{c.b});
    put_pose(out, c.T_a_b);
    put_information(out, c.information);
    put(out, std::uint32_t{c.robust ? 1U : 0U});
    put(out, std::uint32_t{c.recorded ? 1U : 0U});
  }
  put(out, std::uint64_t{graph.anchors.size()});
  for (const PoseAnchor& anchor : graph.anchors) {
    put(out, std::uint64_t{anchor.pose});
    put_pose(out, anchor.T_world_camera);
    put_information(out, anchor.information);
  }
  put(out, graph.loops_found);
  put(out, graph.loops_rejected);
  put(out, graph.recorded_sigma_m);
}

KeyframeGraph take_graph(BinaryReader& in, const fs::path& folder) {
  KeyframeGraph graph;
  graph.keyframes.resize(take_count(in, kPose_bytes, "keyframes"));
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    Keyframe& keyframe = graph.keyframes[i];
    keyframe.frame_index = in.take<std::int64_t>("frame index");
    keyframe.T_world_camera = take_pose(in, "a keyframe's pose");
    keyframe.revision = in.take<std::uint32_t>("revision");
    keyframe.path_length_m = in.take_finite("path length");
    keyframe.velocity = take_velocity(in);
    keyframe.steady_velocity = take_velocity(in);
    keyframe.timing = take_times(in);
    keyframe.T_recorded_camera = take_optional_pose(in, "a keyframe's recorded pose");
    keyframe.stretch = in.take<std::int64_t>("stretch");
    keyframe.part = in.take<int>("part");
    keyframe.is_by_flow = in.take<std::uint32_t>("keyframe") != 0;
    if (keyframe.part < 0) in.fail("a keyframe's part is negative");
    keyframe.view =
        std::make_shared<const PackedView>(packed(read_view(folder / view_name(i, keyframe.revision))));
  }
  graph.constraints.resize(take_count(in, kPose_bytes + kInformation_bytes, "constraints"));
  for (PoseConstraint& c : graph.constraints) {
    c.a = take_index(in, graph.keyframes.size(), "keyframe");
    c.b = take_index(in, graph.keyframes.size(), "keyframe");
    c.T_a_b = take_pose(in, "a constraint's pose");
    c.information = take_information(in);
    c.robust = in.take<std::uint32_t>("constraint") != 0;
    c.recorded = in.take<std::uint32_t>("constraint") != 0;
  }
  graph.anchors.resize(take_count(in, kPose_bytes + kInformation_bytes, "anchors"));
  for (PoseAnchor& anchor : graph.anchors) {
    anchor.pose = take_index(in, graph.keyframes.size(), "keyframe");
    anchor.T_world_camera = take_pose(in, "an anchor's pose");
    anchor.information = take_information(in);
  }
  graph.loops_found = in.take<std::int64_t>("loops");
  graph.loops_rejected = in.take<std::int64_t>("loops");
  graph.recorded_sigma_m = in.take_finite("standard deviation of recorded poses");
  return graph;
}

KeyframeDatabase take_keyframe_database(BinaryReader& in, const fs::path& folder) {
  KeyframeDatabase keyframe_database;
  keyframe_database.keyframes.resize(take_count(in, kPose_bytes, "database entries"));
  for (std::size_t i = 0; i < keyframe_database.keyframes.size(); ++i) {
    KeyframeDatabase one = read_keyframe_database(folder / place_name(i));
    if (one.keyframes.size() != 1) in.fail(place_name(i).string() + " does not contain one database entry");
    keyframe_database.keyframes[i] = std::move(one.keyframes.front());
    keyframe_database.keyframes[i].T_world_camera = take_pose(in, "a database entry's pose");
  }
  return keyframe_database;
}

void put_frames(std::string& out, const std::vector<KeptFrame>& frames) {
  put(out, std::uint64_t{frames.size()});
  for (const KeptFrame& frame : frames) {
    put(out, frame.frame_index);
    put(out, frame.stamp_s);
    put(out, frame.keyframe ? static_cast<std::int64_t>(*frame.keyframe) : std::int64_t{-1});
    put_pose(out, frame.T_keyframe_camera);
    put(out, static_cast<std::uint32_t>(frame.status));
    put(out, std::uint32_t{frame.trusted ? 1U : 0U});
  }
}

std::vector<KeptFrame> take_frames(BinaryReader& in, std::size_t keyframes) {
  std::vector<KeptFrame> frames(take_count(in, kPose_bytes, "frames"));
  for (KeptFrame& frame : frames) {
    frame.frame_index = in.take<std::int64_t>("frame index");
    frame.stamp_s = in.take_finite("stamp");
    const auto keyframe = in.take<std::int64_t>("keyframe");
    if (keyframe >= static_cast<std::int64_t>(keyframes)) in.fail("a frame's keyframe is not there");
    if (keyframe >= 0) frame.keyframe = static_cast<std::size_t>(keyframe);
    frame.T_keyframe_camera = take_pose(in, "a frame's pose");
    frame.status = take_status(in);
    frame.trusted = in.take<std::uint32_t>("frame") != 0;
  }
  return frames;
}

}  // namespace

void save_odometry(const Odometry& odometry, const fs::path& into, const fs::path& previous) {
  const OdometrySnapshot kept = odometry.snapshot();
  const auto is_carried_over = [&](const fs::path& name) {
    return !previous.empty() && carry_over(previous / name, into / name);
  };
  for (std::size_t i = 0; i < kept.graph.keyframes.size(); ++i) {
    const fs::path name = view_name(i, kept.graph.keyframes[i].revision);
    if (!is_carried_over(name)) write_view(unpacked(*kept.graph.keyframes[i].view), into / name);
  }
  for (std::size_t i = 0; i < kept.keyframe_database.keyframes.size(); ++i) {
    const fs::path name = place_name(i);
    if (!is_carried_over(name))
      write_keyframe_database({{kept.keyframe_database.keyframes[i]}, {}}, into / name);
  }
  std::string out;
  put_counts(out, kept.counts);
  put_graph(out, kept.graph);
  put(out, std::uint64_t{kept.keyframe_database.keyframes.size()});
  for (const MapKeyframe& place : kept.keyframe_database.keyframes) put_pose(out, place.T_world_camera);
  put_frames(out, kept.frames);
  put(out, std::uint64_t{kept.current});
  put(out, std::uint64_t{kept.final_keyframes});
  put(out, kept.improved);
  put_pose(out, kept.T_world_last);
  put_pose(out, kept.T_last_next);
  put(out, kept.path_length_m);
  put_image(out, kept.last_moved_grey);
  put(out, static_cast<std::uint32_t>(kept.last_moved.status));
  put_pose(out, kept.last_moved.T_world_camera);
  put(out, std::uint32_t{kept.located ? 1U : 0U});
  put_timing(out, kept.timing);
  put(out, std::uint32_t{kept.is_stationary ? 1U : 0U});
  put(out, kept.parts);
  put(out, std::uint32_t{kept.lost ? 1U : 0U});
  const LostPlace lost = kept.lost.value_or(LostPlace{});
  put(out, std::uint64_t{lost.keyframe});
  put_pose(out, lost.T_keyframe_camera);
  put(out, lost.stamp_s);
  put_prior(out, kept.prior);
  write_binary(into / "state.bin", kStateMagic, kVersion, out);
}

Odometry load_odometry(const fs::path& folder, const OdometryConfig& config) {
  const fs::path path = folder / "state.bin";
  const std::string bytes = read_binary(path, kStateMagic, kVersion);
  BinaryReader in(bytes, path);
  OdometrySnapshot kept;
  take_counts(in, kept.counts);
  kept.graph = take_graph(in, folder);
  const std::size_t keyframes = kept.graph.keyframes.size();
  kept.keyframe_database = take_keyframe_database(in, folder);
  if (keyframes > 0 && kept.keyframe_database.keyframes.size() != keyframes)
    in.fail("keyframes and database entries differ in number");
  kept.frames = take_frames(in, keyframes);
  const auto current = in.take<std::uint64_t>("keyframe");
  if (keyframes > 0 && current >= keyframes) in.fail("the current keyframe is not there");
  kept.current = keyframes > 0 ? static_cast<std::size_t>(current) : 0;
  const auto final_keyframes = in.take<std::uint64_t>("final keyframes");
  if (final_keyframes > keyframes) in.fail("more keyframes are final than there are");
  kept.final_keyframes = static_cast<std::size_t>(final_keyframes);
  kept.improved = in.take<int>("views");
  kept.T_world_last = take_pose(in, "the last pose");
  kept.T_last_next = take_pose(in, "the last motion");
  kept.path_length_m = in.take_finite("path length");
  kept.last_moved_grey = take_image<float>(in, "picture");
  kept.last_moved.status = take_status(in);
  kept.last_moved.T_world_camera = take_pose(in, "the pose when the camera last moved");
  kept.located = in.take<std::uint32_t>("located") != 0;
  kept.timing = take_timing(in);
  kept.is_stationary = in.take<std::uint32_t>("stationary") != 0;
  kept.parts = in.take<int>("parts");
  const bool is_lost = in.take<std::uint32_t>("the place of a loss") != 0;
  LostPlace lost;
  lost.keyframe = static_cast<std::size_t>(in.take<std::uint64_t>("the keyframe of a loss"));
  lost.T_keyframe_camera = take_pose(in, "the pose of a loss");
  lost.stamp_s = in.take_finite("the time of a loss");
  if (is_lost && lost.keyframe >= keyframes) in.fail("the keyframe of a loss is not there");
  if (is_lost) kept.lost = lost;
  kept.prior = take_prior(in);
  if (in.left() != 0) in.fail(std::to_string(in.left()) + " bytes more than expected");
  return Odometry(config, std::move(kept));
}

}  // namespace roomradar
