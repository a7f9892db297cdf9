// object_file.hpp: loads the model of a virtual object and scales it to the requested size.
#pragma once
#include <optional>
#include <string>

#include "app/models/model_file.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Model file and scaling that a user gave for a virtual object.
struct ObjectSource {
  /// `teapot` (built in, 0.15 m high), or a file in a format of read_model().
  std::string mesh{};
  std::optional<double> size_m{};  ///< longest side of the bounding box after scaling, > 0; unset: not scaled
  /// Axis of the file that points up; unset: the format's default, see read_model().
  std::optional<UpAxis> up{};
  ModelOrigin origin = ModelOrigin::kNear;
  friend bool operator==(const ObjectSource&, const ObjectSource&) = default;
};

/// Throws Error with the file's name and the fault.
Model object_model(const ObjectSource& source);
/// Returns the mesh of object_model().
/// @param size_m  longest side after scaling; 0: not scaled
Mesh object_mesh(const std::string& name_or_path, double size_m = 0.0);

/// Limits for the size of an object without a given size, and the option named in the error message.
struct SizeCheck {
  double room_m = 0.0;  ///< longest side of the room's mapped space; 0: unknown
  std::string option;   ///< command-line text before a size in metres, such as "--object-size "
};

/// Throws Error for a model without a given size whose longest side is below 5 mm, above 5 m or above half of
/// room_m. The message ends with an option that the user can paste. The option's size assumes that the file
/// is in millimetres or centimetres if the model is then 2 cm to 2 m long and not too large for the room.
/// Otherwise the size is 0.3 m, or half of room_m if that is less.
void require_sensible_size(const Model& model, const ObjectSource& source, const SizeCheck& check);

}  // namespace roomradar
