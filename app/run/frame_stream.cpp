// frame_stream.cpp: JSON of one frame: camera, objects, contacts, dynamic surfaces, times.
#include "app/run/frame_stream.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "app/cli/report.hpp"
#include "mapping/mesh/components.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kLeastTriangles = 8;  // smaller components of the dynamic mesh have no box

nlohmann::json pose(const Eigen::Isometry3d& T) {
  return {{"position_m", to_json(T.translation())},
          {"orientation_xyzw", to_json(Eigen::Quaterniond(T.linear()))}};
}

nlohmann::json json_of(const ObjectContact& contact) {
  return {{"with", to_string(contact.closest.kind)},
          {"object", contact.other != nullptr ? nlohmann::json(contact.other->name) : nullptr},
          {"point_m", to_json(contact.closest.point_world)},
          {"normal", to_json(contact.closest.normal_world)},
          {"gap_m", contact.closest.gap_m}};
}

nlohmann::json json_of(const VirtualObject& object) {
  nlohmann::json json = {{"name", object.body.name}, {"state", state_word(object)}};
  if (!object.in_room) return json;
  json.update(pose(object.body.T_world_object));
  json["velocity_mps"] = to_json(object.body.velocity_world_mps);
  json["angular_velocity_rad_s"] = to_json(object.body.angular_velocity_world_rad_s);
  json["rests_on"] = object.body.asleep ? nlohmann::json(to_string(object.body.rests_on)) : nullptr;
  nlohmann::json& contacts = json["contacts"] = nlohmann::json::array();
  for (const ObjectContact& contact : object.contacts) contacts.push_back(json_of(contact));
  return json;
}

std::string_view located_word(FrameStatus status) {
  switch (status) {
    case FrameStatus::kDone:
      return "located";
    case FrameStatus::kUncertain:
      return "uncertain";
    case FrameStatus::kNotLocated:
    case FrameStatus::kBadFrame:
      break;
  }
  return "lost";
}

/// Infinite standard deviations become null.
nlohmann::json json_of(const PoseSigma& sigma) {
  const auto numbers = [](const Eigen::Vector3d& v) {
    nlohmann::json json = nlohmann::json::array();
    for (const double x : {v.x(), v.y(), v.z()})
      json.push_back(std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr));
    return json;
  };
  return {{"position_m", numbers(sigma.position_m)},
          {"rotation_rad", numbers(sigma.rotation_rad)},
          {"least_certain", sigma.least_certain_world.isZero() ? nlohmann::json(nullptr)
                                                               : numbers(sigma.least_certain_world)}};
}

/// Returns JSON in one line. Names that are not UTF-8 get replacement characters.
std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::vector<Eigen::AlignedBox3d> component_boxes(const Mesh& mesh, std::size_t min_triangles) {
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  DisjointSets<std::uint32_t> components = components_of(mesh);
  struct Component {
    Eigen::AlignedBox3f box;
    std::size_t triangles = 0;
  };
  std::vector<Component> found;
  std::vector<std::uint32_t> index_of(count, count);
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& index = index_of[components.find(t[0])];
    if (index == count) index = static_cast<std::uint32_t>(found.size()), found.emplace_back();
    for (const std::uint32_t vertex : t) found[index].box.extend(mesh.vertices[vertex]);
    ++found[index].triangles;
  }
  std::erase_if(found, [&](const Component& component) { return component.triangles < min_triangles; });
  std::stable_sort(found.begin(), found.end(),
                   [](const Component& a, const Component& b) { return a.triangles > b.triangles; });
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Component& component : found) {
    Eigen::AlignedBox3d box = component.box.cast<double>();
    boxes.push_back(box.translate(mesh.origin));
  }
  return boxes;
}

std::vector<std::uint32_t> runs_of(const MaskImage& mask) {
  std::vector<std::uint32_t> runs;
  const auto begin = mask.pixels.begin(), end = mask.pixels.end();
  const auto is_set = [](std::uint8_t pixel) { return pixel != 0; };
  for (auto first = std::find_if(begin, end, is_set); first != end;) {
    const auto last = std::find_if_not(first, end, is_set);
    runs.push_back(static_cast<std::uint32_t>(first - begin));
    runs.push_back(static_cast<std::uint32_t>(last - first));
    first = std::find_if(last, end, is_set);
  }
  return runs;
}

FrameStream::FrameStream(const std::filesystem::path& path, const std::string& source, const std::string& map)
    : lines_(path) {
  lines_.offer(text_of({{"type", "start"},
                        {"schema", kFrameStreamVersion},
                        {"version", kVersion},
                        {"source", source},
                        {"map", map}}));
}

void FrameStream::write(std::int64_t run_frame, double time_s, const Frame& frame, const FrameResult& result,
                        const Session& session, const StageTimes& times) {
  const bool is_located = result.status == FrameStatus::kDone;
  const bool has_pose = is_located || result.status == FrameStatus::kUncertain;
  nlohmann::json stages = nlohmann::json::object();
  times.visit_newest([&](const std::string& stage, std::size_t count, float newest_ms) {
    if (timed_[stage] != count) stages[stage] = std::round(1e3 * static_cast<double>(newest_ms)) / 1e3;
    timed_[stage] = count;
  });
  nlohmann::json objects = nlohmann::json::array();
  for (const auto& object : session.objects()) objects.push_back(json_of(*object));
  nlohmann::json moved = nlohmann::json::array();
  if (is_located && session.config().scene.surfaces == SurfacePolicy::kMap)
    for (const Eigen::AlignedBox3d& box :
         component_boxes(session.scene().dynamic_world().seen_world, kLeastTriangles))
      moved.push_back({{"least_m", to_json(box.min())}, {"greatest_m", to_json(box.max())}});
  nlohmann::json mask;
  if (is_located && session.config().scene.surfaces == SurfacePolicy::kMap) {
    const MaskImage& dynamic_mask = session.scene().foreground().dynamic_mask;
    mask = {{"width_px", dynamic_mask.width},
            {"height_px", dynamic_mask.height},
            {"runs", runs_of(dynamic_mask)}};
  }
  nlohmann::json notices = nlohmann::json::array();
  for (const ObjectNotice& notice : result.notices) notices.push_back(notice.name + notice.text);
  nlohmann::json line = {{"type", "frame"},
                         {"frame", run_frame},
                         {"source_frame", frame.index},
                         {"stamp_s", frame.stamp_s},
                         {"time_s", time_s},
                         {"tracking", to_string(result.tracking)},
                         {"located", located_word(result.status)},
                         {"camera", has_pose ? pose(result.T_world_camera) : nlohmann::json(nullptr)},
                         {"sigma", has_pose ? json_of(result.sigma) : nlohmann::json(nullptr)},
                         {"objects", objects},
                         {"moved", moved},
                         {"moved_mask", mask},
                         {"notices", notices},
                         {"stages_ms", stages},
                         {"lines_dropped", lines_.dropped()}};
  lines_.offer([line = std::move(line)] { return text_of(line); });
  ++frames_;
}

void FrameStream::close() {
  lines_.offer(text_of({{"type", "end"}, {"frames", frames_}, {"lines_dropped", lines_.dropped()}}));
  lines_.close();
}

}  // namespace roomradar
