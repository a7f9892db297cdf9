// body_material.hpp: mass, friction and restitution of a body, as a user gives them.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "app/physics/mass_properties.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Material of a body. Unset values are those of mass_properties() and PhysicsConfig.
struct BodyMaterial {
  std::optional<double> mass_kg{};
  std::optional<double> density_kg_m3{};  ///< alternative to mass_kg, for bodies with a closed mesh
  std::optional<double> friction{};       ///< Coulomb's coefficient on the room's surfaces
  std::optional<double> restitution{};    ///< coefficient of restitution on the room's surfaces
  friend bool operator==(const BodyMaterial&, const BodyMaterial&) = default;
};

/// A value of BodyMaterial: its name in scripts and options, and the values that are allowed.
struct MaterialField {
  std::string_view name;
  const char* wanted;  ///< text for error messages
  std::optional<double> BodyMaterial::*value;
  double least, most;
};
inline constexpr std::array<MaterialField, 4> kMaterialFields = {{
    {"mass", "a mass (kg), 0.0001..10000", &BodyMaterial::mass_kg, 1e-4, 1e4},
    {"density", "a density (kg/m3), 1..30000", &BodyMaterial::density_kg_m3, 1.0, 3e4},
    {"friction", "a coefficient of friction, 0..10", &BodyMaterial::friction, 0.0, 10.0},
    {"restitution", "a coefficient of restitution, 0..1", &BodyMaterial::restitution, 0.0, 1.0},
}};

/// Throws Error such as "material.friction = 11: must be a coefficient of friction, 0..10" for a value that
/// is out of range or not finite, and for a mass together with a density.
void require_valid(const BodyMaterial& material);

/// Overwrites the values of `material` that `change` sets. A mass replaces a density, and a density a mass.
void change(BodyMaterial& material, const BodyMaterial& change);

/// Returns the mass of a body, kg: the material's mass; else its density times the mesh's volume; else that
/// of mass_properties(). Throws Error for a density if the mesh is open.
double mass_kg(const BodyMaterial& material, const MassProperties& of_mesh);

/// Coefficients of a contact.
struct Coefficients {
  double friction = 0.0;
  double restitution = 0.0;
};
/// Returns the coefficients of a body on the room's surfaces.
Coefficients on_room(const BodyMaterial& material, const PhysicsConfig& config);
/// Returns the coefficients between two bodies: the geometric mean of their coefficients of friction, and the
/// larger coefficient of restitution.
Coefficients between(const BodyMaterial& one, const BodyMaterial& other, const PhysicsConfig& config);

}  // namespace roomradar
