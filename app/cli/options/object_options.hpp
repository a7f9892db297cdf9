// object_options.hpp: --object, --object-size and --object-up.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/physics/body_material.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// A virtual object of a run without a script.
struct ObjectOption {
  std::string text{};  ///< text as given, such as "chair.glb,size=0.9,up=y,at=0.4,-0.1,0.75"
  ObjectSource source{};
  BodyMaterial material{};
  /// Point above which the object is dropped. Unset: the object is dropped above a surface in view.
  std::optional<Eigen::Vector3d> at_world{};
};

/// Values of the options as given, before objects_of() combines them.
struct ObjectOptions {
  std::vector<std::string> texts;  ///< values of --object
  std::optional<double> size_m;    ///< value of --object-size
  std::optional<std::string> up;   ///< value of --object-up
};

/// Adds --object, --object-size and --object-up to the command.
/// @param options  receives the values; must outlive the parsing
void add_object_options(CLI::App& command, ObjectOptions& options);

/// Returns the objects, or a teapot if no object is given. --object-size and --object-up apply to the objects
/// for which --object gives no size or up axis. Throws CLI::ValidationError if a value is wrong.
std::vector<ObjectOption> objects_of(const ObjectOptions& options);

}  // namespace roomradar
