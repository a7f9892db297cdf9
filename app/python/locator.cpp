// locator.cpp: localisation with the map's expected depth, rendered on a thread of its own.
#include <memory>
#include <optional>
#include <string>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/python/long_calls.hpp"
#include "app/python/maps.hpp"
#include "app/session/frame_scene.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"
#include "radar/gl/gl_thread.hpp"

namespace roomradar::python {
namespace {

/// The room as a GPU mesh, for expected depth.
struct RenderedRoom {
  GlContext context;
  Shape shape;
  FrameScene scene;

  explicit RenderedRoom(const Mesh& mesh) : shape(context), scene(context, shape, {}) {
    shape.set(mesh, MeshUsage::kStatic);
  }
};

/// Finds the camera in one map, frame by frame.
class MapLocator {
 public:
  explicit MapLocator(std::shared_ptr<Map> map) : map_(std::move(map)) {
    thread_.run([&] { room_ = std::make_unique<RenderedRoom>(map_->saved.mesh); });
  }
  ~MapLocator() {
    thread_.run([&] { room_.reset(); });
  }
  MapLocator(const MapLocator&) = delete;
  MapLocator& operator=(const MapLocator&) = delete;

  Tracking locate(const Frame& frame, const MaskImage& dynamic_mask) {
    Tracking tracking;
    thread_.run([&] {
      const auto expected_depth = [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
        return room_->scene.render_expected(frame.depth_camera, T_world_camera).depth_m;
      };
      tracking = roomradar::locate(locator_, frame, map_->saved.keyframe_database.load(), dynamic_mask,
                                   expected_depth);
    });
    return tracking;
  }
  /// Sets the pose of the previous frame; unset: the next frame is searched in the whole map.
  void set_pose(const std::optional<Eigen::Isometry3d>& T_world_camera) {
    thread_.run([&] {
      Locator fresh;
      fresh.index = std::move(locator_.index);
      fresh.T_world_camera = T_world_camera;
      locator_ = std::move(fresh);
    });
  }
  DepthImage expected_depth(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) {
    DepthImage depth_m;
    thread_.run([&] { depth_m = room_->scene.render_expected(camera, T_world_camera).depth_m; });
    return depth_m;
  }

 private:
  std::shared_ptr<Map> map_;
  Locator locator_;
  std::unique_ptr<RenderedRoom> room_;  ///< made and destroyed on thread_
  GlThread thread_;
};

Tracking locate_frame(MapLocator& locator, const Frame& frame, const py::object& moved_mask) {
  const MaskImage mask = moved_mask.is_none() ? MaskImage{} : mask_of(moved_mask, "moved_mask");
  if (!mask.empty() && (mask.width != frame.depth_m.width || mask.height != frame.depth_m.height))
    throw py::value_error("moved_mask: must have the size of the frame's depth image");
  return without_gil([&] { return locator.locate(frame, mask); });
}

py::object pose_or_none(const Tracking& tracking) {
  const bool is_located =
      tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
  return is_located ? py::object(array_of(tracking.T_world_camera)) : py::none();
}

/// Returns a copy of the expected depth as an array that owns it.
py::array expected_depth(MapLocator& locator, const Intrinsics& camera, const py::object& T_world_camera) {
  const Eigen::Isometry3d T = pose_of(T_world_camera, "T_world_camera");
  auto depth_m = std::make_unique<DepthImage>(without_gil([&] { return locator.expected_depth(camera, T); }));
  const DepthImage& image = *depth_m;
  const py::capsule owner(depth_m.release(), [](void* held) { delete static_cast<DepthImage*>(held); });
  return view_of(image, owner);
}

}  // namespace

void bind_locator(py::module_& module) {
  py::class_<Tracking>(module, "Tracking",
                       "Result of a localisation. True if all degrees of freedom are constrained.")
      .def_property_readonly(
          "status", [](const Tracking& tracking) { return std::string(to_string(tracking.status)); },
          "\"tracked\", \"degenerate\" (unconstrained directions keep the prediction), \"too few points\" "
          "or\n"
          "\"diverged\".")
      .def_property_readonly("T_world_camera", &pose_or_none,
                             "(4, 4) float64 if tracked or degenerate, else None: the camera is lost.")
      .def_readonly("rms_m", &Tracking::rms_m, "RMS distance of the inliers, m; < 0: no result.")
      .def_readonly("inlier_fraction", &Tracking::inlier_fraction)
      .def_readonly("overlap", &Tracking::overlap)
      .def_readonly("unconstrained_dofs", &Tracking::unconstrained_dofs)
      .def("__bool__", [](const Tracking& tracking) { return static_cast<bool>(tracking); })
      .def("__repr__", [](const Tracking& tracking) {
        const std::string said = "<roomradar.Tracking " + std::string(to_string(tracking.status));
        return said + (tracking.rms_m < 0.0 ? ">" : ": RMS " + format_readable(tracking.rms_m, 3) + " m>");
      });

  py::class_<MapLocator>(module, "Locator",
                         "Finds the camera in a saved map: at first anywhere, then from frame to frame.")
      .def(py::init([](std::shared_ptr<Map> map) {
             return without_gil([&] { return std::make_unique<MapLocator>(std::move(map)); });
           }),
           py::arg("map").none(false))
      .def("locate", &locate_frame, py::arg("frame"), py::kw_only(), py::arg("moved_mask") = py::none(),
           "Returns the Tracking of a frame. moved_mask (H, W) uint8: pixels that are not 0 are ignored.")
      .def(
          "set_pose",
          [](MapLocator& locator, const py::object& T_world_camera) {
            const auto T = optional_pose_of(T_world_camera, "T_world_camera");
            without_gil([&] { locator.set_pose(T); });
          },
          py::arg("T_world_camera"),
          "Sets the previous frame's pose; None: the next frame is searched in the whole map.")
      .def("expected_depth", &expected_depth, py::arg("camera"), py::arg("T_world_camera"),
           "Returns the depth of the map's surface at a pose, (H, W) float32, m; 0: none.");
}

}  // namespace roomradar::python
