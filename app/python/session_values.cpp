// session_values.cpp: copies of the session's state, which remain valid during later frames.
#include "app/python/session_values.hpp"

#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"
#include "app/session/frame_result.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar::python {
namespace {

py::dict foreground_of(const FrameResult& result) {
  py::dict counts;
  counts["valid"] = result.foreground.valid;
  counts["moved"] = result.foreground.moved;
  counts["revealed"] = result.foreground.revealed;
  counts["not_known"] = result.foreground.not_known;
  return counts;
}

py::list sentences_of(const FrameResult& result) {
  py::list sentences;
  for (const ObjectNotice& notice : result.notices) sentences.append(text_of(notice.name + notice.text));
  return sentences;
}

py::list departures_of(const FrameResult& result) {
  py::list departures;
  for (const Departure& departure : result.departures)
    departures.append(py::make_tuple(departure.name, departure.is_back));
  return departures;
}

const char* status_of(const FrameResult& result) {
  return result.status == FrameStatus::kDone         ? "done"
         : result.status == FrameStatus::kUncertain  ? "uncertain"
         : result.status == FrameStatus::kNotLocated ? "not located"
                                                     : "bad frame";
}

std::string repr(const FrameResult& result) {
  const std::string said = std::string("<roomradar.FrameResult ") + status_of(result);
  if (result.status == FrameStatus::kBadFrame) return said + ": " + std::string(result.fault) + ">";
  return said + ": " + std::to_string(result.dynamic_triangles) + " dynamic triangles, " +
         std::to_string(result.contacts) + " contacts>";
}

void bind_objects(py::module_& module) {
  py::class_<TouchPoint>(module, "TouchPoint", "A point where an object touches a surface or another object.")
      .def_property_readonly(
          "point_world", [](const TouchPoint& touch) { return array_of(touch.point_world); },
          "(3,) float64, m, on what is touched.")
      .def_property_readonly(
          "normal_world", [](const TouchPoint& touch) { return array_of(touch.normal_world); },
          "(3,) float64, unit, towards the object.")
      .def_readonly("gap_m", &TouchPoint::gap_m, "Distance of the two meshes there.")
      .def_readonly("kind", &TouchPoint::kind)
      .def_property_readonly(
          "other",
          [](const TouchPoint& touch) {
            return touch.other.empty() ? std::nullopt : std::optional(touch.other);
          },
          "Name of the other object, or None.");
  py::class_<ObjectSnapshot>(module, "ObjectState", "State of a virtual object after a frame. A copy.")
      .def_readonly("name", &ObjectSnapshot::name)
      .def_readonly("state", &ObjectSnapshot::state,
                    "\"outside\", \"carried\", \"stuck\", \"at rest\" or \"moving\".")
      .def_property_readonly(
          "T_world_object", [](const ObjectSnapshot& object) { return array_of(object.T_world_object); },
          "(4, 4) float64.")
      .def_property_readonly(
          "velocity_world_mps",
          [](const ObjectSnapshot& object) { return array_of(object.velocity_world_mps); },
          "(3,) float64, of the centre of mass.")
      .def_property_readonly(
          "angular_velocity_world_rad_s",
          [](const ObjectSnapshot& object) { return array_of(object.angular_velocity_world_rad_s); },
          "(3,) float64.")
      .def_readonly("rests_on", &ObjectSnapshot::rests_on,
                    "Kind of the surface below an object at rest, else None.")
      .def_readonly("mass_kg", &ObjectSnapshot::mass_kg)
      .def_readonly("contacts", &ObjectSnapshot::contacts)
      .def("__repr__", [](const ObjectSnapshot& object) {
        return text_of("<roomradar.ObjectState " + object.name + ": " + object.state + " at " +
                       text_of_point(object.T_world_object.translation()) + ">");
      });
}

}  // namespace

ObjectSnapshot snapshot_of(const VirtualObject& object) {
  const Body& body = object.body;
  ObjectSnapshot snapshot{body.name,
                          std::string(state_word(object)),
                          body.T_world_object,
                          body.velocity_world_mps,
                          body.angular_velocity_world_rad_s,
                          {},
                          body.mass.mass_kg,
                          {}};
  if (!object.in_room) return snapshot;
  if (body.asleep) snapshot.rests_on = body.rests_on;
  for (const ObjectContact& contact : object.contacts)
    snapshot.contacts.push_back({contact.closest.point_world, contact.closest.normal_world,
                                 contact.closest.gap_m, contact.closest.kind,
                                 contact.other != nullptr ? contact.other->name : ""});
  return snapshot;
}

void bind_session_values(py::module_& module) {
  bind_objects(module);
  py::class_<FrameResult>(module, "FrameResult", "Result of Session.step(). True if the frame was processed.")
      .def_property_readonly(
          "status", &status_of,
          "\"done\", \"uncertain\" (the pose is a guess; objects did not move), \"not located\" (no pose;\n"
          "objects did not move) or \"bad frame\" (see fault).")
      .def_property_readonly("fault", [](const FrameResult& result) { return std::string(result.fault); })
      .def_property_readonly(
          "tracking", [](const FrameResult& result) { return std::string(to_string(result.tracking)); })
      .def_property_readonly(
          "T_world_camera",
          [](const FrameResult& result) -> py::object {
            const bool has_pose =
                result.status == FrameStatus::kDone || result.status == FrameStatus::kUncertain;
            return has_pose ? py::object(array_of(result.T_world_camera)) : py::none();
          },
          "The depth camera's pose, (4, 4) float64, a guess if uncertain, or None.")
      .def_property_readonly(
          "sigma_m", [](const FrameResult& result) { return array_of(result.sigma.position_m); },
          "Standard deviations of the camera's position along the world's axes, (3,); inf: not known.")
      .def_property_readonly(
          "sigma_rad", [](const FrameResult& result) { return array_of(result.sigma.rotation_rad); },
          "Standard deviations of the camera's rotation about the world's axes, (3,); inf: not known.")
      .def_property_readonly("foreground", &foreground_of,
                             "Numbers of pixels: valid, moved, revealed, not_known.")
      .def_readonly("dynamic_triangles", &FrameResult::dynamic_triangles)
      .def_readonly("contacts", &FrameResult::contacts, "Number of impacts in this frame.")
      .def_readonly("deepest_penetration_m", &FrameResult::deepest_penetration_m)
      .def_readonly("picture_is_new", &FrameResult::picture_is_new)
      .def_property_readonly("notices", &sentences_of, "Sentences for the user.")
      .def_property_readonly("departures", &departures_of,
                             "Name of each object that fell out of the map, and whether it was set back.")
      .def("__bool__", [](const FrameResult& result) { return result.status == FrameStatus::kDone; })
      .def("__repr__", [](const FrameResult& result) { return text_of(repr(result)); });
}

}  // namespace roomradar::python
