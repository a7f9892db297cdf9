// frames.cpp: value classes of a frame; a frame's images are shared with NumPy.
#include <cstdint>
#include <memory>
#include <string>

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::python {
namespace {

std::string repr(const Intrinsics& camera) {
  return "Intrinsics(width_px=" + std::to_string(camera.width_px) +
         ", height_px=" + std::to_string(camera.height_px) + ", fx_px=" + format_number(camera.fx_px) +
         ", fy_px=" + format_number(camera.fy_px) + ", cx_px=" + format_number(camera.cx_px) +
         ", cy_px=" + format_number(camera.cy_px) + ")";
}

std::string repr(const Frame& frame) {
  const auto size = [](int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
  };
  return "<roomradar.Frame " + std::to_string(frame.index) + " at " + format_number(frame.stamp_s) +
         " s: depth " + size(frame.depth_m.width, frame.depth_m.height) +
         (frame.colour.empty() ? ", no colour"
                               : ", colour " + size(frame.colour.width, frame.colour.height)) +
         (frame.T_world_camera ? ", with a pose>" : ">");
}

Eigen::Matrix3d matrix_of(const Intrinsics& camera) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 0) = camera.fx_px;
  matrix(1, 1) = camera.fy_px;
  matrix(0, 2) = camera.cx_px;
  matrix(1, 2) = camera.cy_px;
  return matrix;
}

Eigen::Vector3d down_of(py::handle value) {
  const Eigen::Vector3d down_camera = vector_of(value, "down_camera");
  const double length = down_camera.norm();
  if (!(length > 1e-6)) throw py::value_error("down_camera: must be a direction, not zero");
  return down_camera / length;
}

DepthNoise noise_of(const DepthNoise& noise) {
  if (!is_valid(noise))
    throw py::value_error("DepthNoise: must give a finite deviation above 0 at every depth");
  return noise;
}

std::shared_ptr<Frame> make_frame(const py::object& depth_m, const Intrinsics& depth_camera,
                                  const py::object& colour, const std::optional<Intrinsics>& colour_camera,
                                  std::int64_t index, double stamp_s, const py::object& T_colour_depth,
                                  const py::object& T_world_camera, const py::object& down_camera,
                                  double colour_after_depth_s, const DepthNoise& depth_noise,
                                  const SensorTiming& timing) {
  auto frame = std::make_shared<Frame>();
  frame->index = index;
  frame->stamp_s = finite(stamp_s, "stamp_s");
  frame->depth_m = depth_of(depth_m, "depth_m");
  frame->depth_camera = depth_camera;
  frame->depth_noise = noise_of(depth_noise);
  if (!colour.is_none()) {
    if (!colour_camera) throw py::value_error("colour_camera: is missing; colour needs its camera");
    frame->colour = colour_of(colour, "colour");
    frame->colour_camera = *colour_camera;
  }
  frame->colour_after_depth_s = finite(colour_after_depth_s, "colour_after_depth_s");
  if (const auto T = optional_pose_of(T_colour_depth, "T_colour_depth")) frame->T_colour_depth = *T;
  frame->timing = timing;
  frame->T_world_camera = optional_pose_of(T_world_camera, "T_world_camera");
  if (!down_camera.is_none()) frame->down_camera = down_of(down_camera);
  if (const std::string_view fault = fault_of(*frame); !fault.empty())
    throw py::value_error("Frame: " + std::string(fault));
  return frame;
}

void bind_cameras(py::module_& module) {
  py::class_<Intrinsics>(
      module, "Intrinsics",
      "Pinhole camera without distortion: u = fx_px * x / z + cx_px. The centre of pixel (0, 0) is at\n"
      "image coordinates (0, 0).")
      .def(py::init([](int width_px, int height_px, double fx_px, double fy_px, double cx_px, double cy_px) {
             const Intrinsics camera{width_px, height_px, fx_px, fy_px, cx_px, cy_px};
             require_valid(camera, "Intrinsics");
             return camera;
           }),
           py::arg("width_px"), py::arg("height_px"), py::arg("fx_px"), py::arg("fy_px"), py::arg("cx_px"),
           py::arg("cy_px"))
      .def_readonly("width_px", &Intrinsics::width_px)
      .def_readonly("height_px", &Intrinsics::height_px)
      .def_readonly("fx_px", &Intrinsics::fx_px)
      .def_readonly("fy_px", &Intrinsics::fy_px)
      .def_readonly("cx_px", &Intrinsics::cx_px)
      .def_readonly("cy_px", &Intrinsics::cy_px)
      .def_property_readonly(
          "matrix", [](const Intrinsics& camera) { return array_of(matrix_of(camera)); },
          "The camera matrix, (3, 3) float64.")
      .def(
          "__eq__", [](const Intrinsics& a, const Intrinsics& b) { return a == b; }, py::is_operator())
      .def("__repr__", [](const Intrinsics& camera) { return repr(camera); });

  py::class_<DepthNoise>(
      module, "DepthNoise",
      "Standard deviation of depth: base_m + linear * z + quadratic_per_m * max(z - from_m, 0)**2.\n"
      "The defaults are those of a Kinect v1.")
      .def(py::init([](float base_m, float linear, float quadratic_per_m, float from_m, float grazing) {
             return noise_of({base_m, linear, quadratic_per_m, from_m, grazing});
           }),
           py::kw_only(), py::arg("base_m") = DepthNoise{}.base_m, py::arg("linear") = DepthNoise{}.linear,
           py::arg("quadratic_per_m") = DepthNoise{}.quadratic_per_m, py::arg("from_m") = DepthNoise{}.from_m,
           py::arg("grazing") = DepthNoise{}.grazing)
      .def_readonly("base_m", &DepthNoise::base_m)
      .def_readonly("linear", &DepthNoise::linear)
      .def_readonly("quadratic_per_m", &DepthNoise::quadratic_per_m)
      .def_readonly("from_m", &DepthNoise::from_m)
      .def_readonly("grazing", &DepthNoise::grazing)
      .def(
          "sigma_m",
          [](const DepthNoise& noise, double depth_m) {
            return depth_sigma_m(noise, static_cast<float>(finite(depth_m, "depth_m")));
          },
          py::arg("depth_m"), "Returns the standard deviation at a depth, m.");

  py::class_<SensorTiming>(module, "SensorTiming",
                           "Times at which a sensor reads its images, s. A readout of 0 is a global shutter.")
      .def(py::init([](double depth_readout_s, double colour_readout_s, double colour_delay_s) {
             return SensorTiming{finite(depth_readout_s, "depth_readout_s"),
                                 finite(colour_readout_s, "colour_readout_s"),
                                 finite(colour_delay_s, "colour_delay_s")};
           }),
           py::kw_only(), py::arg("depth_readout_s") = 0.0, py::arg("colour_readout_s") = 0.0,
           py::arg("colour_delay_s") = 0.0)
      .def_readonly("depth_readout_s", &SensorTiming::depth_readout_s)
      .def_readonly("colour_readout_s", &SensorTiming::colour_readout_s)
      .def_readonly("colour_delay_s", &SensorTiming::colour_delay_s);
}

}  // namespace

void bind_frames(py::module_& module) {
  bind_cameras(module);
  py::class_<Frame, std::shared_ptr<Frame>>(module, "Frame",
                                            "Depth, colour, cameras and pose that a sensor delivers at one "
                                            "instant. Immutable. The arrays of images are\n"
                                            "read-only and share the frame's memory.")
      .def(
          py::init(&make_frame), py::arg("depth_m"), py::arg("depth_camera"), py::kw_only(),
          py::arg("colour") = py::none(), py::arg("colour_camera") = py::none(), py::arg("index") = 0,
          py::arg("stamp_s") = 0.0, py::arg("T_colour_depth") = py::none(),
          py::arg("T_world_camera") = py::none(), py::arg("down_camera") = py::none(),
          py::arg("colour_after_depth_s") = 0.0, py::arg("depth_noise") = DepthNoise{},
          py::arg("timing") = SensorTiming{},
          "Copies the images: depth_m (H, W) float32, m along the optical axis, 0 where nothing was "
          "measured; colour\n"
          "(H, W, 3) uint8, RGB. Poses are (4, 4) float64. Raises ValueError or TypeError for anything else.")
      .def_readonly("index", &Frame::index, "Number of the frame in its recording.")
      .def_readonly("stamp_s", &Frame::stamp_s, "The sensor's time, s.")
      .def_property_readonly(
          "depth_m", [](const py::object& self) { return view_of(self.cast<const Frame&>().depth_m, self); },
          "(H, W) float32, m; 0 where nothing was measured. A view.")
      .def_property_readonly(
          "colour",
          [](const py::object& self) -> py::object {
            const auto& frame = self.cast<const Frame&>();
            return frame.colour.empty() ? py::object(py::none()) : view_of(frame.colour, self);
          },
          "(H, W, 3) uint8, RGB, or None. A view.")
      .def_readonly("depth_camera", &Frame::depth_camera)
      .def_property_readonly(
          "colour_camera",
          [](const Frame& frame) {
            return frame.colour.empty() ? std::nullopt : std::optional(frame.colour_camera);
          },
          "Intrinsics, or None without colour.")
      .def_readonly("depth_noise", &Frame::depth_noise)
      .def_readonly("timing", &Frame::timing)
      .def_readonly("colour_after_depth_s", &Frame::colour_after_depth_s)
      .def_property_readonly(
          "T_colour_depth", [](const Frame& frame) { return array_of(frame.T_colour_depth); },
          "Maps points of the depth camera to the colour camera, (4, 4) float64.")
      .def_property_readonly(
          "T_world_camera", [](const Frame& frame) { return array_or_none(frame.T_world_camera); },
          "The depth camera's pose in the recording's world, (4, 4) float64, or None.")
      .def_property_readonly(
          "down_camera", [](const Frame& frame) { return array_or_none(frame.down_camera); },
          "Unit direction of gravity in the camera frame, (3,) float64, or None.")
      .def("__repr__", [](const Frame& frame) { return repr(frame); });
}

}  // namespace roomradar::python
