// object_file.hpp: loads the models that users name, in the right size.
#pragma once
#include <optional>
#include <string>

#include "app/models/model_file.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A virtual object as a user names it.
struct ObjectSource {
  std::string mesh{};  ///< `teapot`, the built-in one, 0.15 m high, or a file that read_model() reads
  std::optional<double> size_m{};  ///< longest side after scaling, > 0; unset: not scaled
  std::optional<UpAxis> up{};      ///< as in read_model()
  ModelOrigin origin = ModelOrigin::kNear;
};

/// Loads a model and scales it. Throws Error naming the file and the fault.
Model object_model(const ObjectSource& source);
/// Returns the mesh of object_model().
Mesh object_mesh(const std::string& name_or_path, double size_m = 0.0);

/// The room into which an object comes, and how its user gives it a size.
struct SizeCheck {
  double room_m = 0.0;  ///< longest side of the known room; 0: not known
  std::string option;   ///< text that precedes a size in metres: "--object-size "
};

/// Throws Error if no size was given and the longest side of the model is less than 5 mm, more than 5 m or
/// more than half of the room's. The sentence ends with the option that makes it fit, to be pasted: in
/// millimetres or centimetres if the model has a plausible size in these, else 0.3 m.
void require_sensible_size(const Model& model, const ObjectSource& source, const SizeCheck& check);

}  // namespace roomradar
