// object_options.hpp: --object, --object-size and --object-up.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/object_file.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// A virtual object of a run without a script.
struct ObjectOption {
  std::string text{};  ///< as given: "chair.glb,size=0.9,up=y,at=0.4,-0.1,0.75"
  ObjectSource source{};
  std::optional<Eigen::Vector3d> at_world{};  ///< point above which it is dropped; unset: a surface in view
};

/// Options as given, before they are joined.
struct ObjectOptions {
  std::vector<std::string> texts;  ///< of --object
  std::optional<double> size_m;    ///< of --object-size
  std::optional<std::string> up;   ///< of --object-up
};

/// Adds the options with their help texts.
/// @param options  receives the values; must outlive the parsing
void add_object_options(CLI::App& command, ObjectOptions& options);

/// Returns the objects; a teapot if none is given. --object-size and --object-up apply to all objects that
/// have no size or up axis of their own. Throws CLI::ValidationError if a value is wrong.
std::vector<ObjectOption> objects_of(const ObjectOptions& options);

}  // namespace roomradar
