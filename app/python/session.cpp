// session.cpp: a session on a thread of its own, whose images are shared with NumPy.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/objects/object_model.hpp"
#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "app/python/maps.hpp"
#include "app/python/session_runner.hpp"
#include "app/python/session_values.hpp"

namespace roomradar::python {
namespace {

using RunnerPointer = std::shared_ptr<SessionRunner>;

template <typename Work>
auto on(SessionRunner& runner, const Work& work) {
  return without_gil([&] { return runner.run(work); });
}

/// Returns an array that shares memory with an image of the session, and keeps the session alive; None if the
/// image is empty.
template <typename Choose>
py::object view_of_image(SessionRunner& runner, const Choose& choose) {
  auto kept = std::make_unique<RunnerPointer>(runner.shared_from_this());
  const py::capsule owner(kept.get(), [](void* held) {
    const std::unique_ptr<RunnerPointer> released(static_cast<RunnerPointer*>(held));
    --(*released)->views;
  });
  ++(*kept.release())->views;  // first: from now on the image keeps its memory
  const auto* image = on(runner, [&](Session& session) { return &choose(session); });
  return image->empty() ? py::object(py::none()) : view_of(*image, owner);
}

/// Copies the picture into an array of the caller.
void read_picture(SessionRunner& runner, const py::object& out) {
  const auto [height, width] = on(
      runner, [](Session& session) { return std::pair(session.picture().height, session.picture().width); });
  const std::string shape = "(" + std::to_string(height) + ", " + std::to_string(width) + ", 3)";
  const py::array array = required_output<std::uint8_t>(out, "out", {{height, width, 3}, shape.c_str()});
  void* const to = const_cast<void*>(array.data());
  on(runner, [&, h = height, w = width](Session& session) {
    const ColourImage& picture = session.picture();
    if (picture.height != h || picture.width != w)
      throw Error("the picture changed its size meanwhile; read it again");
    if (!picture.empty()) std::memcpy(to, picture.pixels.data(), picture.pixels.size() * sizeof(Rgb));
  });
}

SurfacePolicy policy_of(const std::string& name) {
  for (const SurfacePolicy policy :
       {SurfacePolicy::kHoles, SurfacePolicy::kSkirt, SurfacePolicy::kBorder, SurfacePolicy::kMap})
    if (to_string(policy) == name) return policy;
  throw py::value_error("surfaces: is \"" + required_text(name, "surfaces") +
                        "\"; must be map, border, skirt or holes");
}

bool is_solid(const std::string& unknown) {
  if (unknown != "solid" && unknown != "free")
    throw py::value_error("unknown: is \"" + required_text(unknown, "unknown") + "\"; must be solid or free");
  return unknown == "solid";
}

RunnerPointer make_session(std::shared_ptr<Map> map, const std::string& poses, const std::string& surfaces,
                           const std::string& unknown, bool make_picture, bool measure_penetration,
                           const QualityValues& quality) {
  SessionSettings settings;
  if (poses != "auto" && poses != "tracked" && poses != "recorded")
    throw py::value_error("poses: is \"" + required_text(poses, "poses") +
                          "\"; must be auto, tracked or recorded");
  if (poses == "tracked") settings.poses = PoseOrigin::kTracked;
  if (poses == "recorded") {
    settings.poses = PoseOrigin::kRecorded;
    if (!knows_recorded_world(map->saved.info))
      throw Error(
          "poses: the map was scanned without recorded poses, so those of frames have no meaning in it");
  }
  settings.surfaces = policy_of(surfaces);
  settings.unknown_is_solid = is_solid(unknown);
  settings.make_picture = make_picture;
  settings.measure_penetration = measure_penetration;
  settings.quality = quality_with({}, quality);
  return without_gil([&] { return std::make_shared<SessionRunner>(std::move(map), settings); });
}

BodyMaterial material_of(std::optional<double> mass_kg, std::optional<double> density_kg_m3,
                         std::optional<double> friction, std::optional<double> restitution) {
  BodyMaterial material{mass_kg, density_kg_m3, friction, restitution};
  require_valid(material);
  return material;
}

void add(SessionRunner& runner, const std::string& name,
         const std::variant<std::filesystem::path, std::shared_ptr<Mesh>>& model,
         std::optional<double> size_m, const std::optional<std::string>& up, std::optional<double> mass_kg,
         std::optional<double> density_kg_m3, std::optional<double> friction,
         std::optional<double> restitution) {
  static_cast<void>(required_text(name, "name"));
  const BodyMaterial material = material_of(mass_kg, density_kg_m3, friction, restitution);
  if (const auto* mesh = std::get_if<std::shared_ptr<Mesh>>(&model)) {
    if (*mesh == nullptr) throw py::type_error("model: must be a Mesh or the name of a model");
    if (size_m || up) throw py::value_error("size_m and up: are for files; a Mesh is taken as it is");
    without_gil([&] {
      ObjectParts parts = object_parts(name, **mesh);
      runner.run([&](Session& session) { session.add_object(name, std::move(parts), material); });
    });
    return;
  }
  ObjectSource source{.mesh = std::get<std::filesystem::path>(model).string(), .size_m = size_m};
  if (size_m && !(*size_m > 0.0 && std::isfinite(*size_m))) throw py::value_error("size_m: must be > 0");
  if (up) {
    source.up = up_axis_of(required_text(*up, "up"));
    if (!source.up) throw py::value_error("up: is \"" + *up + "\"; must be " + std::string(kUpAxisWords));
  }
  without_gil([&] {
    ObjectParts parts = object_parts(name, object_model(source));
    runner.run([&](Session& session) {
      require_sensible_size(parts.source, source, {session.room_extent_m(), "size_m="});
      session.add_object(name, std::move(parts), material);
    });
  });
}

void place(SessionRunner& runner, const std::string& name, const py::object& position_world,
           const py::object& R_world_object, const py::object& velocity_world_mps,
           const py::object& angular_velocity_world_rad_s) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const ObjectState state{
      vector_of(position_world, "position_world"), optional_rotation_of(R_world_object, "R_world_object"),
      optional_vector_of(velocity_world_mps, "velocity_world_mps").value_or(zero),
      optional_vector_of(angular_velocity_world_rad_s, "angular_velocity_world_rad_s").value_or(zero)};
  on(runner, [&](Session& session) { session.place(name, state); });
}

void drop(SessionRunner& runner, const std::string& name, const py::object& position_world,
          const py::object& near_world, double height_m, const py::object& R_world_object) {
  const DropRequest request{name, optional_vector_of(position_world, "position_world"),
                            optional_vector_of(near_world, "near_world"), finite(height_m, "height_m"),
                            optional_rotation_of(R_world_object, "R_world_object")};
  on(runner, [&](Session& session) { session.drop(request); });
}

void set_material(SessionRunner& runner, const std::string& name, std::optional<double> mass_kg,
                  std::optional<double> density_kg_m3, std::optional<double> friction,
                  std::optional<double> restitution) {
  const BodyMaterial material = material_of(mass_kg, density_kg_m3, friction, restitution);
  on(runner, [&](Session& session) { session.set_material(name, material); });
}

/// Binds a call of the session with a name and a vector.
template <void (Session::*call)(const std::string&, const Eigen::Vector3d&)>
auto named_vector(const char* argument) {
  return [argument](SessionRunner& runner, const std::string& name, const py::object& value) {
    const Eigen::Vector3d vector = vector_of(value, argument);
    on(runner, [&](Session& session) { (session.*call)(name, vector); });
  };
}

std::vector<ObjectSnapshot> objects_of(SessionRunner& runner) {
  return on(runner, [](Session& session) {
    std::vector<ObjectSnapshot> objects;
    for (const auto& object : session.objects()) objects.push_back(snapshot_of(*object));
    return objects;
  });
}

Contact query_scene(SessionRunner& runner, const TriangleTree& object, const py::object& T_world_object,
                    const py::object& direction_world, double distance_m, double margin_m) {
  const RadarQuery of{{nullptr, pose_of(T_world_object, "T_world_object")},
                      vector_of(direction_world, "direction_world"),
                      distance_m,
                      margin_m};
  const Contact contact = without_gil([&] { return runner.query(object, of); });
  if (contact.status == ContactStatus::kInvalidInput)
    throw py::value_error(
        "the radar rejects the query: direction_world must not be zero, distance_m must be > 0");
  return contact;
}

void set_unknown(SessionRunner& runner, const std::string& unknown) {
  const bool solid = is_solid(unknown);
  on(runner, [&](Session& session) {
    StageTimes unreported;
    if (solid)
      session.make_unknown_solid(unreported);
    else
      session.make_unknown_free();
  });
}

void bind_object_calls(py::class_<SessionRunner, RunnerPointer>& bound) {
  bound
      .def("add", &add, py::arg("name"), py::arg("model") = "teapot", py::kw_only(),
           py::arg("size_m") = py::none(), py::arg("up") = py::none(), py::arg("mass_kg") = py::none(),
           py::arg("density_kg_m3") = py::none(), py::arg("friction") = py::none(),
           py::arg("restitution") = py::none(),
           "Adds an object, outside the room until it is placed, thrown or dropped.\n\n"
           "model: \"teapot\", a .glb .gltf .obj .ply .stl or .dae file, or a Mesh in metres\n"
           "size_m: longest side of a file's model after scaling; None: not scaled\n"
           "up: axis of the file that points up: x, y, z, -x, -y or -z; None: that of its format")
      .def("place", &place, py::arg("name"), py::arg("position_world"), py::kw_only(),
           py::arg("R_world_object") = py::none(), py::arg("velocity_world_mps") = py::none(),
           py::arg("angular_velocity_world_rad_s") = py::none(),
           "Puts the object's origin at a position (3,). Moves it out of surfaces by at most 10 cm; raises "
           "PlaceRefused\n"
           "if that is not enough. R_world_object (3, 3); None: keeps its orientation.")
      .def(
          "throw",
          [](SessionRunner& runner, const std::string& name, const py::object& position_world,
             const py::object& velocity_world_mps, const py::object& R_world_object,
             const py::object& angular_velocity_world_rad_s) {
            place(runner, name, position_world, R_world_object, velocity_world_mps,
                  angular_velocity_world_rad_s);
          },
          py::arg("name"), py::arg("position_world"), py::arg("velocity_world_mps"), py::kw_only(),
          py::arg("R_world_object") = py::none(), py::arg("angular_velocity_world_rad_s") = py::none(),
          "Puts the object at a position with a velocity, m/s.")
      .def("drop", &drop, py::arg("name"), py::kw_only(), py::arg("position_world") = py::none(),
           py::arg("near_world") = py::none(), py::arg("height_m") = DropRequest{}.height_m,
           py::arg("R_world_object") = py::none(),
           "Drops the object from height_m above a position, or above a level surface in view: the nearest "
           "one to\n"
           "near_world, or to the image's centre. Without a position it waits for a frame with such a "
           "surface.")
      .def("carry", named_vector<&Session::carry>("position_world"), py::arg("name"),
           py::arg("position_world"),
           "Moves the object towards a position and holds it there until release(). Obstacles stop it.")
      .def("release", named_vector<&Session::release>("velocity_world_mps"), py::arg("name"),
           py::arg("velocity_world_mps") = py::make_tuple(0.0, 0.0, 0.0), "Lets go of a carried object.")
      .def("turn", named_vector<&Session::turn>("turn_world_deg"), py::arg("name"), py::arg("turn_world_deg"),
           "Rotates the object about its centre until the first contact, by a rotation vector in degrees.")
      .def("set_material", &set_material, py::arg("name"), py::kw_only(), py::arg("mass_kg") = py::none(),
           py::arg("density_kg_m3") = py::none(), py::arg("friction") = py::none(),
           py::arg("restitution") = py::none(), "Changes the values that are given.")
      .def(
          "remove",
          [](SessionRunner& runner, const std::string& name) {
            on(runner, [&](Session& session) { session.remove(name); });
          },
          py::arg("name"), "Takes the object out of the room; its name stays in use.")
      .def_property_readonly("objects", &objects_of, "ObjectState of all objects.");
}

/// The images and the dynamic surfaces of the last frame.
void bind_frame_results(py::class_<SessionRunner, RunnerPointer>& bound) {
  bound
      .def_property_readonly(
          "picture",
          [](SessionRunner& runner) {
            return view_of_image(runner, [](Session& s) -> const ColourImage& { return s.picture(); });
          },
          "The composed picture, (H, W, 3) uint8, or None. A view that the next step() overwrites; copy it "
          "to keep it.")
      .def("read_picture", &read_picture, py::arg("out"), "Copies the picture into an array (H, W, 3) uint8.")
      .def_property_readonly(
          "moved_mask",
          [](SessionRunner& runner) {
            return view_of_image(
                runner, [](Session& s) -> const MaskImage& { return s.scene().foreground().dynamic_mask; });
          },
          "(H, W) uint8: 255 at dynamic pixels, which show a surface that is not in the map, or None. A "
          "view, "
          "as picture.")
      .def_property_readonly(
          "expected_depth_m",
          [](SessionRunner& runner) {
            return view_of_image(
                runner, [](Session& s) -> const DepthImage& { return s.scene().expected().depth_m; });
          },
          "(H, W) float32, m: the map's surface from the camera's pose, or None. A view, as picture.")
      .def(
          "moved_mesh",
          [](SessionRunner& runner) {
            return on(runner, [](Session& s) {
              return std::make_shared<Mesh>(s.scene().dynamic_world().seen_world);
            });
          },
          "Returns the dynamic surfaces, in the world. A copy.");
}

void bind_settings(py::class_<SessionRunner, RunnerPointer>& bound) {
  bound
      .def(
          "set_quality",
          [](SessionRunner& runner, const QualityValues& quality) {
            without_gil([&] { runner.set_quality(quality); });
          },
          py::arg("quality"), "Changes the given fields from the next frame on.")
      .def("set_unknown", &set_unknown, py::arg("unknown"), "solid or free, see Session().")
      .def(
          "set_surfaces",
          [](SessionRunner& runner, const std::string& surfaces) {
            const SurfacePolicy policy = policy_of(surfaces);
            on(runner, [&](Session& s) { s.set_surfaces(policy); });
          },
          py::arg("surfaces"), "map, border, skirt or holes, see Session().");
}

}  // namespace

void bind_session(py::module_& module) {
  py::class_<SessionRunner, RunnerPointer> bound(
      module, "Session",
      "Augmented reality in a saved map, which does not change. May be called from any thread; calls wait\n"
      "for each other. A call that raises an exception changes nothing.");
  bind_object_calls(bound);
  bound
      .def(py::init(&make_session), py::arg("map").none(false), py::kw_only(), py::arg("poses") = "auto",
           py::arg("surfaces") = "map", py::arg("unknown") = "solid", py::arg("make_picture") = true,
           py::arg("measure_penetration") = false, py::arg("quality") = QualityValues{},
           "poses: auto (localised in the map, with those of frames as a prior), tracked (localised) or "
           "recorded\n"
           "surfaces: what objects can touch: map, or this frame's depth alone: border, skirt or holes\n"
           "unknown: solid: objects cannot enter space that the scan has not observed; free: they can\n"
           "quality: fields of a run's quality, such as {\"depth_stride\": 2, \"radar\": \"sampled\"}; see "
           "`roomradar run\n"
           "--help`")
      .def(
          "step",
          [](SessionRunner& runner, const Frame& frame) {
            return without_gil([&] { return runner.step(frame); });
          },
          py::arg("frame"),
          "Processes one frame: locates the camera, finds dynamic pixels, moves the objects, composes "
          "the picture.\n"
          "Overwrites the arrays of picture, moved_mask and expected_depth_m.");
  bind_frame_results(bound);
  bound.def("query", &query_scene, py::arg("object").none(false), py::arg("T_world_object"),
            py::arg("direction_world"), py::arg("distance_m"), py::kw_only(), py::arg("margin_m") = 0.0,
            "Returns the Contact of a TriangleTree with everything in the room: map, dynamic surfaces, and "
            "the session's objects.");
  bind_settings(bound);
  bound
      .def(
          "fingerprint",
          [](SessionRunner& runner) {
            const FrameFingerprint of = without_gil([&] { return runner.fingerprint(); });
            return py::make_tuple(of.objects, of.picture);
          },
          "Returns hashes of the objects' poses and of the picture, as in results of `run --record-session`.")
      .def_property_readonly(
          "stage_ms", [](SessionRunner& runner) { return without_gil([&] { return runner.newest_ms(); }); },
          "Wall-clock time of each stage of the last frame, ms.")
      .def_property_readonly(
          "renderer",
          [](SessionRunner& runner) { return on(runner, [](Session& s) { return s.renderer(); }); })
      .def(
          "close", [](SessionRunner& runner) { without_gil([&] { runner.close(); }); },
          "Frees the session. Raises Error while arrays of its images are in use.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](SessionRunner& runner, const py::args&) { without_gil([&] { runner.leave(); }); });
}

}  // namespace roomradar::python
