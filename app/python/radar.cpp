// radar.cpp: queries with poses and directions from NumPy.
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"
#include "radar/batch/passes_radar.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gl_thread.hpp"

namespace roomradar::python {
namespace {

/// The surfaces of queries. Shares ownership of trees and frames. Rejects changes while another call reads
/// the scene.
class Scene {
 public:
  std::size_t add_tree(std::shared_ptr<TriangleTree> tree, const Eigen::Isometry3d& T_world_mesh,
                       SurfaceKind kind);
  void add_depth(std::shared_ptr<Frame> frame, SceneDepth depth);
  void set_pose(std::size_t index, const Eigen::Isometry3d& T_world_mesh);
  [[nodiscard]] std::size_t size() const { return trees_.size(); }
  [[nodiscard]] RadarScene radar_scene() const { return {trees_, depths_, nullptr}; }

  /// Guard that marks the scene as being read, for calls without the interpreter's lock.
  class Reading {
   public:
    explicit Reading(Scene& scene) : readers_(scene.readers_) { ++readers_; }
    ~Reading() { --readers_; }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;

   private:
    std::atomic<int>& readers_;
  };

 private:
  std::vector<SceneTree> trees_;
  std::vector<SceneDepth> depths_;
  std::vector<std::shared_ptr<TriangleTree>> kept_trees_;
  std::vector<std::shared_ptr<Frame>> kept_frames_;
  std::atomic<int> readers_ = 0;

  void require_unread() const;
};

std::size_t Scene::add_tree(std::shared_ptr<TriangleTree> tree, const Eigen::Isometry3d& T_world_mesh,
                            SurfaceKind kind) {
  require_unread();
  trees_.push_back({{tree.get(), T_world_mesh}, kind});
  kept_trees_.push_back(std::move(tree));
  return trees_.size() - 1;
}

void Scene::add_depth(std::shared_ptr<Frame> frame, SceneDepth depth) {
  require_unread();
  depth.depth_m = &frame->depth_m;
  depth.camera = frame->depth_camera;
  depths_.push_back(depth);
  kept_frames_.push_back(std::move(frame));
}

void Scene::set_pose(std::size_t index, const Eigen::Isometry3d& T_world_mesh) {
  require_unread();
  if (index >= trees_.size())
    throw py::index_error("tree " + std::to_string(index) + " of " + std::to_string(trees_.size()));
  trees_[index].instance.T_world_mesh = T_world_mesh;
}

void Scene::require_unread() const {
  if (readers_ > 0) throw Error("the scene is in use by another thread; wait for that call, or use two");
}

/// A radar, used by one call at a time. That of RadarMode::kPasses has a thread for its OpenGL context.
class PythonRadar {
 public:
  explicit PythonRadar(const RadarConfig& config) {
    if (config.mode != RadarMode::kPasses) {
      radar_ = std::make_unique<CyberRadar>(config);
      return;
    }
    thread_ = std::make_unique<GlThread>();
    thread_->run([&] {
      context_ = std::make_unique<GlContext>();
      radar_ = roomradar::make_radar(config, *context_);
    });
  }
  ~PythonRadar() {
    if (!thread_) return;
    thread_->run([&] {
      radar_.reset();
      context_.reset();
    });
  }
  PythonRadar(const PythonRadar&) = delete;
  PythonRadar& operator=(const PythonRadar&) = delete;

  Contact query(const RadarQuery& query, const RadarScene& scene) {
    if (!thread_) return radar_->query(query, scene);
    Contact contact;
    thread_->run([&] { contact = radar_->query(query, scene); });
    return contact;
  }
  UseFlag use;

 private:
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<GlContext> context_;
  std::unique_ptr<Radar> radar_;
};

std::unique_ptr<PythonRadar> make_radar(const std::string& mode, int resolution_px) {
  RadarConfig config;
  config.resolution_px = resolution_px;
  const std::optional<RadarMode> known = radar_mode_of(mode);
  if (!known)
    throw py::value_error("mode: is \"" + required_text(mode, "mode") +
                          "\"; must be exact, sampled or passes");
  config.mode = *known;
  require_valid(config);
  return without_gil([&] { return std::make_unique<PythonRadar>(config); });
}

std::shared_ptr<TriangleTree> make_tree(const Mesh& mesh) {
  auto tree = without_gil([&] {
    auto built = std::make_shared<TriangleTree>();
    built->build_by_place(mesh);
    return built;
  });
  if (tree->empty()) throw py::value_error("mesh: has no valid triangle");
  return tree;
}

Contact require_answer(const Contact& contact) {
  if (contact.status == ContactStatus::kInvalidInput)
    throw py::value_error(
        "the radar rejects the query: direction_world must not be zero, distance_m must be finite and > 0, "
        "margin_m "
        "must be finite and >= 0");
  return contact;
}

std::size_t own_index(const std::optional<std::size_t>& own_tree, const Scene& scene) {
  if (!own_tree) return RadarQuery::kNotInScene;
  if (*own_tree >= scene.size())
    throw py::index_error("own_tree: tree " + std::to_string(*own_tree) + " of " +
                          std::to_string(scene.size()));
  return *own_tree;
}

Contact query(PythonRadar& radar, const TriangleTree& object, const py::object& T_world_object,
              const py::object& direction_world, double distance_m, const Scene& scene, double margin_m,
              const std::optional<std::size_t>& own_tree) {
  const UseFlag::Lock lock(radar.use, "the radar");
  const RadarQuery of{{&object, pose_of(T_world_object, "T_world_object")},
                      vector_of(direction_world, "direction_world"),
                      distance_m,
                      margin_m,
                      own_index(own_tree, scene)};
  return require_answer(radar.query(of, scene.radar_scene()));
}

/// Results of many queries, an array per field of Contact.
struct Contacts {
  py::array_t<std::uint8_t> status, touched;
  py::array_t<double> contact_distance_m, lower_m, upper_m, point_world, normal_world;

  explicit Contacts(py::ssize_t count)
      : status(count),
        touched(count),
        contact_distance_m(count),
        lower_m(count),
        upper_m(count),
        point_world({count, py::ssize_t{3}}),
        normal_world({count, py::ssize_t{3}}) {}
};

/// Memory of Contacts, written without the interpreter's lock.
struct ContactRows {
  std::uint8_t *status, *touched;
  double *contact_distance_m, *lower_m, *upper_m, *point_world, *normal_world;

  explicit ContactRows(Contacts& of)
      : status(of.status.mutable_data()),
        touched(of.touched.mutable_data()),
        contact_distance_m(of.contact_distance_m.mutable_data()),
        lower_m(of.lower_m.mutable_data()),
        upper_m(of.upper_m.mutable_data()),
        point_world(of.point_world.mutable_data()),
        normal_world(of.normal_world.mutable_data()) {}

  void set(std::size_t i, const Contact& contact) const {
    status[i] = static_cast<std::uint8_t>(contact.status);
    touched[i] = static_cast<std::uint8_t>(contact.touched);
    contact_distance_m[i] = contact.contact_distance_m;
    lower_m[i] = contact.lower_m;
    upper_m[i] = contact.upper_m;
    Eigen::Map<Eigen::Vector3d>(point_world + 3 * i) = contact.point_world;
    Eigen::Map<Eigen::Vector3d>(normal_world + 3 * i) = contact.normal_world;
  }
};

/// Returns row i of poses (N, 4, 4); throws ValueError naming the row.
Eigen::Isometry3d pose_at(const double* poses, std::size_t i) {
  Eigen::Isometry3d T;
  T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(poses + 16 * i);
  if (T.matrix().row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0) || !is_rigid(T, 1e-6))
    throw py::value_error("T_world_object: row " + std::to_string(i) + " is not a finite rigid transform");
  return T;
}

Contacts query_many(PythonRadar& radar, const TriangleTree& object, const py::object& T_world_object,
                    const py::object& direction_world, double distance_m, Scene& scene, double margin_m,
                    const std::optional<std::size_t>& own_tree) {
  const UseFlag::Lock lock(radar.use, "the radar");
  const py::array poses = required_array<double>(T_world_object, "T_world_object", {{-1, 4, 4}, "(N, 4, 4)"});
  const py::ssize_t count = poses.shape(0);
  const std::string rows = "(" + std::to_string(count) + ", 3), a row per pose";
  const py::array directions =
      required_array<double>(direction_world, "direction_world", {{count, 3}, rows.c_str()});
  const auto* T = static_cast<const double*>(poses.data());
  const auto* u = static_cast<const double*>(directions.data());
  const std::size_t own = own_index(own_tree, scene);
  Contacts contacts(count);
  const ContactRows to(contacts);
  const Scene::Reading reading(scene);
  without_gil([&] {
    RadarQuery of{{&object, {}}, {}, distance_m, margin_m, own};
    const RadarScene surfaces = scene.radar_scene();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      of.object.T_world_mesh = pose_at(T, i);
      of.direction_world = Eigen::Map<const Eigen::Vector3d>(u + 3 * i);
      const Contact contact = radar.query(of, surfaces);
      if (contact.status == ContactStatus::kInvalidInput)
        throw py::value_error("row " + std::to_string(i) +
                              ": the radar rejects the query: direction_world must be finite and not zero, "
                              "distance_m finite and "
                              "> 0, margin_m finite and >= 0");
      to.set(i, contact);
    }
  });
  return contacts;
}

void add_frame(Scene& scene, const std::shared_ptr<Frame>& frame, const py::object& T_world_camera,
               int stride_px, float max_jump_m, float max_jump_slope, SurfaceKind kind) {
  std::optional<Eigen::Isometry3d> T = optional_pose_of(T_world_camera, "T_world_camera");
  if (!T) T = frame->T_world_camera;
  if (!T) throw py::value_error("T_world_camera: is missing, and the frame has no pose");
  if (stride_px < 1) throw py::value_error("stride_px: must be 1 or more");
  if (!(max_jump_m >= 0.0F) || !(max_jump_slope >= 0.0F))
    throw py::value_error("max_jump_m and max_jump_slope: must be 0 or more");
  SceneDepth depth;
  depth.T_world_camera = *T;
  depth.stride_px = stride_px;
  depth.max_jump_m = max_jump_m;
  depth.max_jump_slope = max_jump_slope;
  depth.kind = kind;
  scene.add_depth(frame, depth);
}

std::string repr(const Contact& contact) {
  const auto name_of = [](auto value) { return std::string(py::str(py::cast(value).attr("name"))); };
  if (!contact) return "<roomradar.Contact " + name_of(contact.status) + ">";
  return "<roomradar.Contact " + name_of(contact.status) + " after " +
         format_readable(contact.contact_distance_m, 4) + " m, with " + name_of(contact.touched) + ">";
}

void bind_contacts(py::module_& module) {
  py::enum_<SurfaceKind>(module, "SurfaceKind", py::arithmetic(), "Kind of a surface that can be touched.")
      .value("NOTHING", SurfaceKind::kNothing)
      .value("STATIC", SurfaceKind::kStatic, "the prescanned room")
      .value("DYNAMIC", SurfaceKind::kDynamic, "a surface that is not in the map")
      .value("OBJECT", SurfaceKind::kObject, "a virtual object")
      .value("UNKNOWN_FRONTIER", SurfaceKind::kUnknownFrontier, "frontier of unknown space")
      .value("INFERRED_BACK", SurfaceKind::kInferredBack, "assumed back of a dynamic surface");
  py::enum_<ContactStatus>(module, "ContactStatus", py::arithmetic(), "Outcome of a radar query.")
      .value("NO_ANSWER", ContactStatus::kNoAnswer)
      .value("NO_TARGET", ContactStatus::kNoTarget, "no contact within the distance")
      .value("CONTACT", ContactStatus::kContact)
      .value("OVERLAP", ContactStatus::kOverlap, "the object already overlaps a surface");

  py::class_<Contact>(module, "Contact", "First contact of a moving object. True for CONTACT and OVERLAP.")
      .def_readonly("status", &Contact::status)
      .def_readonly("contact_distance_m", &Contact::contact_distance_m,
                    "Distance to contact, m. OVERLAP: negative, the way back until the object is clear.")
      .def_readonly("lower_m", &Contact::lower_m, "Lower bound of the true distance, m.")
      .def_readonly("upper_m", &Contact::upper_m, "Upper bound of the true distance, m.")
      .def_property_readonly(
          "point_world", [](const Contact& contact) { return array_of(contact.point_world); },
          "Contact point on the scene, (3,) float64, m.")
      .def_property_readonly(
          "normal_world", [](const Contact& contact) { return array_of(contact.normal_world); },
          "Unit normal there, towards the object, (3,) float64.")
      .def_readonly("touched", &Contact::touched, "Kind of the surface touched.")
      .def("__bool__", [](const Contact& contact) { return static_cast<bool>(contact); })
      .def("__repr__", [](const Contact& contact) { return repr(contact); });

  py::class_<Contacts>(module, "Contacts", "Results of many queries: an array per field of Contact.")
      .def_readonly("status", &Contacts::status, "(N,) uint8: values of ContactStatus.")
      .def_readonly("contact_distance_m", &Contacts::contact_distance_m, "(N,) float64.")
      .def_readonly("lower_m", &Contacts::lower_m, "(N,) float64.")
      .def_readonly("upper_m", &Contacts::upper_m, "(N,) float64.")
      .def_readonly("point_world", &Contacts::point_world, "(N, 3) float64.")
      .def_readonly("normal_world", &Contacts::normal_world, "(N, 3) float64.")
      .def_readonly("touched", &Contacts::touched, "(N,) uint8: values of SurfaceKind.")
      .def("__len__", [](const Contacts& contacts) { return contacts.status.shape(0); });
}

}  // namespace

void bind_radar(py::module_& module) {
  bind_contacts(module);
  py::class_<TriangleTree, std::shared_ptr<TriangleTree>>(
      module, "TriangleTree", "A rigid mesh with a bounding volume hierarchy, for radar queries.")
      .def(py::init(&make_tree), py::arg("mesh"))
      .def_property_readonly("triangle_count", method(&TriangleTree::triangle_count))
      .def_property_readonly("dropped_triangles", method(&TriangleTree::dropped_triangles))
      .def_property_readonly("is_closed", method(&TriangleTree::is_closed),
                             "True if the mesh encloses a volume, whose inside then counts as solid.");

  py::class_<Scene, std::shared_ptr<Scene>>(module, "RadarScene", "The surfaces of radar queries.")
      .def(py::init<>())
      .def(
          "add",
          [](Scene& scene, std::shared_ptr<TriangleTree> tree, const py::object& T_world_mesh,
             SurfaceKind kind) {
            if (!tree) throw py::type_error("tree: must be a TriangleTree");
            return scene.add_tree(
                std::move(tree),
                optional_pose_of(T_world_mesh, "T_world_mesh").value_or(Eigen::Isometry3d::Identity()), kind);
          },
          py::arg("tree"), py::arg("T_world_mesh") = py::none(), py::kw_only(),
          py::arg("kind") = SurfaceKind::kStatic,
          "Adds a tree at a pose (4, 4) float64, None: identity. Returns its index.")
      .def("add_frame", &add_frame, py::arg("frame").none(false), py::arg("T_world_camera") = py::none(),
           py::kw_only(), py::arg("stride_px") = 1, py::arg("max_jump_m") = SceneDepth{}.max_jump_m,
           py::arg("max_jump_slope") = SceneDepth{}.max_jump_slope, py::arg("kind") = SurfaceKind::kDynamic,
           "Adds the surface of a frame's depth image. The pose is the frame's own unless given. "
           "Neighbouring pixels\n"
           "are connected where their depths differ by at most max_jump_m + max_jump_slope * depth.")
      .def(
          "set_pose",
          [](Scene& scene, std::size_t index, const py::object& T_world_mesh) {
            scene.set_pose(index, pose_of(T_world_mesh, "T_world_mesh"));
          },
          py::arg("index"), py::arg("T_world_mesh"))
      .def("__len__", method(&Scene::size));

  py::class_<PythonRadar>(
      module, "CyberRadar",
      "How far an object can move along a line before it touches something. Use one per thread.")
      .def(py::init(&make_radar), py::kw_only(), py::arg("mode") = "exact",
           py::arg("resolution_px") = RadarConfig{}.resolution_px,
           "mode: exact; sampled: faster, lower_m and upper_m may differ by the depth within a pixel; or "
           "passes: as\n"
           "sampled, by two depth passes rendered with OpenGL")
      .def("query", &query, py::arg("object"), py::arg("T_world_object"), py::arg("direction_world"),
           py::arg("distance_m"), py::arg("scene"), py::kw_only(), py::arg("margin_m") = 0.0,
           py::arg("own_tree") = py::none(),
           "Returns the Contact of an object that moves from a pose (4, 4) float64 along a direction (3,) "
           "float64 by at\n"
           "most distance_m.\n\n"
           "margin_m: inflates the object; only lower_m is then meaningful\n"
           "own_tree: index of the object's own tree in the scene, which is skipped")
      .def("query_many", &query_many, py::arg("object"), py::arg("T_world_object"),
           py::arg("direction_world"), py::arg("distance_m"), py::arg("scene"), py::kw_only(),
           py::arg("margin_m") = 0.0, py::arg("own_tree") = py::none(),
           "Returns the Contacts of queries from poses (N, 4, 4) along directions (N, 3), float64.");
}

}  // namespace roomradar::python
