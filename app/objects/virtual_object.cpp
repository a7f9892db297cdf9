// virtual_object.cpp: makes virtual objects from models, and computes their extents and levels of detail.
#include "app/objects/virtual_object.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns null if no object was made from this mesh.
std::shared_ptr<const ObjectModel> model_among(std::span<const std::unique_ptr<VirtualObject>> objects,
                                               const Model& source) {
  const auto same = std::find_if(objects.begin(), objects.end(),
                                 [&](const auto& object) { return is_model_of(*object->model, source); });
  return same == objects.end() ? nullptr : (*same)->model;
}

}  // namespace

std::string_view state_word(const VirtualObject& object) {
  if (!object.in_room) return "outside";
  if (object.carried_to_world) return "carried";
  if (object.placement.stuck) return "stuck";
  return object.body.asleep ? "at rest" : "moving";
}

VirtualObject::VirtualObject(std::string name, std::shared_ptr<const ObjectModel> its_model)
    : model(std::move(its_model)) {
  body.name = std::move(name);
  body.mass = model->mass;
  make_contact_shadow(model->surface, body.T_world_object.linear(), shadow);
}

std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, Model source,
                                         std::span<const std::unique_ptr<VirtualObject>> others) {
  std::shared_ptr<const ObjectModel> model = model_among(others, source);
  if (!model) model = std::make_shared<const ObjectModel>(context, object_parts(name, std::move(source)));
  return std::make_unique<VirtualObject>(name, std::move(model));
}

std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, const Mesh& mesh,
                                         std::span<const std::unique_ptr<VirtualObject>> others) {
  return object_of(context, name, Model{.mesh = mesh}, others);
}

std::unique_ptr<VirtualObject> object_of(GlContext& context, const std::string& name, ObjectParts parts,
                                         std::span<const std::unique_ptr<VirtualObject>> others) {
  std::shared_ptr<const ObjectModel> model = model_among(others, parts.source);
  if (!model) model = std::make_shared<const ObjectModel>(context, std::move(parts));
  return std::make_unique<VirtualObject>(name, std::move(model));
}

void change_material(VirtualObject& object, const BodyMaterial& change) {
  Body& body = object.body;
  BodyMaterial material = body.material;
  roomradar::change(material, change);
  try {
    require_valid(material);
    body.mass.mass_kg = mass_kg(material, object.model->mass);
  } catch (const Error& fault) {
    throw Error(body.name + ": " + fault.what());
  }
  body.material = material;
  body.asleep = false;
  body.sleep_timer_s = 0.0;
}

DrawnObject drawn_object(const VirtualObject& object, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera, double error_px) {
  const ObjectModel& model = *object.model;
  const Eigen::Vector3d middle_camera = T_world_camera.inverse() * middle_world(object);
  const double nearest_m = middle_camera.z() - radius_m(object);
  const double pixel_m = nearest_m / std::max(camera.fx_px, camera.fy_px);
  DrawnObject drawn{.instance = {&model.shape.drawn, object.body.T_world_object},
                    .is_closed = model.shape.touched.is_closed() && model.is_opaque,
                    .parts = model.parts};
  for (const DrawnLevel& level : model.levels()) {
    if (!is_fine_enough(level.deviation_m, pixel_m, error_px)) continue;
    drawn.instance.mesh = level.mesh.get();
    drawn.parts = level.parts;
  }
  return drawn;
}

namespace {

/// Returns the farthest extent of the object from its origin along a direction of its own frame.
double farthest_m(const VirtualObject& object, const Eigen::Vector3d& direction_object) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : object.model->corners)
    farthest = std::max(farthest, direction_object.dot(corner));
  return farthest;
}

}  // namespace

double lowest_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object) {
  return -farthest_m(object, -R_world_object.row(2));
}

VirtualObject* find_object(std::span<const std::unique_ptr<VirtualObject>> objects, const std::string& name) {
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [&](const auto& object) { return object->body.name == name; });
  return found == objects.end() ? nullptr : found->get();
}

double lowest_m(const VirtualObject& object) { return lowest_m(object, object.body.T_world_object.linear()); }

double highest_m(const VirtualObject& object) {
  return farthest_m(object, object.body.T_world_object.linear().row(2));
}

Eigen::Vector3d middle_world(const VirtualObject& object) {
  const Eigen::Isometry3d T_world_object = object.body.T_world_object;
  const Eigen::Vector3d middle = object.model->middle;
  return T_world_object * middle;
}

double radius_m(const VirtualObject& object) {
  return 0.5 * object.model->shape.drawn.bounds().sizes().norm();
}

double footprint_radius_m(const VirtualObject& object, const Eigen::Matrix3d& R_world_object) {
  const Eigen::Matrix<double, 2, 3> R_level_object = R_world_object.topRows<2>();
  double squared_m2 = 0.0;
  for (const Eigen::Vector3d& corner : object.model->corners)
    squared_m2 = std::max(squared_m2, (R_level_object * (corner - object.model->middle)).squaredNorm());
  return std::sqrt(squared_m2);
}

Eigen::Vector3d level_to_middle(const VirtualObject& object, const Eigen::Matrix3d& R_world_object) {
  const Eigen::Vector3d to_middle = R_world_object * object.model->middle;
  return {to_middle.x(), to_middle.y(), 0.0};
}

}  // namespace roomradar
