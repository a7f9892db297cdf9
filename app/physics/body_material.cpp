// body_material.cpp: checks materials, and combines them at contacts.
#include "app/physics/body_material.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

void require_valid(const BodyMaterial& material) {
  const ConfigCheck require{"material"};
  for (const MaterialField& field : kMaterialFields) {
    const std::optional<double>& value = material.*field.value;
    if (value)
      require(*value >= field.least && *value <= field.most, field.name.data(), *value, field.wanted);
  }
  if (material.mass_kg && material.density_kg_m3)
    throw Error("material: give either a mass or a density, not both");
}

void change(BodyMaterial& material, const BodyMaterial& change) {
  if (change.mass_kg) material.density_kg_m3.reset();
  if (change.density_kg_m3) material.mass_kg.reset();
  for (const MaterialField& field : kMaterialFields)
    if (change.*field.value) material.*field.value = change.*field.value;
}

double mass_kg(const BodyMaterial& material, const MassProperties& of_mesh) {
  if (material.mass_kg) return *material.mass_kg;
  if (!material.density_kg_m3) return of_mesh.mass_kg;
  if (!(of_mesh.volume_m3 > 0.0))
    throw Error("the mesh is open, so its volume is unknown: give a mass (kg) instead of a density");
  return *material.density_kg_m3 * of_mesh.volume_m3;
}

Coefficients on_room(const BodyMaterial& material, const PhysicsConfig& config) {
  return {material.friction.value_or(config.friction), material.restitution.value_or(config.restitution)};
}

Coefficients between(const BodyMaterial& one, const BodyMaterial& other, const PhysicsConfig& config) {
  const Coefficients a = on_room(one, config), b = on_room(other, config);
  return {std::sqrt(a.friction * b.friction), std::max(a.restitution, b.restitution)};
}

}  // namespace roomradar
