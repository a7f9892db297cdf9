// session_runner.cpp: calls the session on its thread, and checks that no array shares an image whose size
// changes.
#include "app/python/session_runner.hpp"

#include "app/session/apply_quality.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::python {
namespace {

/// Returns a value as a word of set_field().
struct WordOf {
  std::string operator()(const std::string& word) const { return word; }
  std::string operator()(bool is_on) const { return is_on ? "on" : "off"; }
  std::string operator()(double number) const { return format_number(number); }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
};

}  // namespace

RunQuality quality_with(RunQuality quality, const QualityValues& values) {
  for (const auto& [name, value] : values) set_field(quality, name, std::visit(WordOf{}, value));
  require_valid(quality);
  return quality;
}

SessionRunner::SessionRunner(std::shared_ptr<Map> map, const SessionSettings& settings)
    : map_(std::move(map)), quality_(settings.quality) {
  SessionConfig config;
  config.poses = settings.poses;
  config.scene.surfaces = settings.surfaces;
  apply(settings.quality, config);
  config.make_picture = settings.make_picture;
  config.measure_penetration = settings.measure_penetration;
  thread_.run([&] {
    session_ = std::make_unique<Session>(map_->saved, config);
    if (settings.unknown_is_solid && settings.surfaces == SurfacePolicy::kMap)
      session_->make_unknown_solid(times_);
  });
}

SessionRunner::~SessionRunner() {
  thread_.run([&] { session_.reset(); });
}

FrameResult SessionRunner::step(const Frame& frame) {
  return run([&](Session& session) {
    require_sizes_kept(frame);
    if (fault_of(frame).empty()) sizes_ = sizes_of(frame);
    ++frames_;
    return session.step(frame, times_);
  });
}

void SessionRunner::set_quality(const QualityValues& values) {
  run([&](Session& session) {
    const RunQuality quality = quality_with(quality_, values);
    if (quality.depth_stride != quality_.depth_stride) require_no_views();
    session.set_quality(quality);
    quality_ = quality;
  });
}

Contact SessionRunner::query(const TriangleTree& object, RadarQuery of) {
  return run([&](Session& session) {
    of.object.tree = &object;
    const std::vector<SceneTree> scene = session.scene_without(nullptr);
    return radar_.query(of, {scene, {}, nullptr});
  });
}

std::map<std::string, double> SessionRunner::newest_ms() {
  return run([&](Session&) {
    std::map<std::string, double> newest;
    times_.visit_newest(
        [&](const std::string& stage, std::size_t /*count*/, float ms) { newest[stage] = ms; });
    return newest;
  });
}

FrameFingerprint SessionRunner::fingerprint() {
  return run([&](Session& session) { return fingerprint_of(frames_ - 1, session); });
}

void SessionRunner::close() {
  run([&](Session&) {
    require_no_views();
    session_.reset();
  });
}

void SessionRunner::leave() {
  thread_.run([&] {
    if (views == 0) session_.reset();
  });
}

Session& SessionRunner::opened() {
  if (!session_) throw Error("the session is closed; make another one");
  return *session_;
}

void SessionRunner::require_no_views() const {
  if (views > 0)
    throw Error(
        "arrays of the session's images are still in use, and would lose their memory; delete them first");
}

/// Images are reallocated for a frame of another size. The picture of a frame without colour may have the
/// size of the depth image.
void SessionRunner::require_sizes_kept(const Frame& frame) const {
  const bool may_grow =
      frame.colour.empty() && frame.depth_m.pixels.size() > session_->picture().pixels.size();
  if (sizes_ && (may_grow || !(*sizes_ == sizes_of(frame)))) require_no_views();
}

SessionRunner::ImageSizes SessionRunner::sizes_of(const Frame& frame) {
  return {frame.depth_m.width, frame.depth_m.height, frame.colour.width, frame.colour.height};
}

}  // namespace roomradar::python
