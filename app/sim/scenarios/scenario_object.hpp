// scenario_object.hpp: objects to drop and push, from a needle to a table. They consist of solids. Their
// distance to contact can thus be computed exactly.
#pragma once
#include <string_view>
#include <vector>

#include "app/sim/solids/solid.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

enum class ObjectShape {
  /// Ball, 4 to 30 cm in size.
  kBall,
  /// Box, 4 to 30 cm in size.
  kBox,
  /// Cylinder, 4 to 30 cm in size.
  kCylinder,
  /// Needle, 2 mm thick, 5 to 40 cm long.
  kNeedle,
  /// Sheet, 2 mm thick, 8 to 60 cm wide.
  kSheet,
  /// Cup, open at the top, 6 to 14 cm high.
  kCup,
  /// Torus, 8 to 40 cm in diameter.
  kTorus,
  /// Chair with seat, back and legs, 0.5 to 1 m high.
  kChair,
  /// Table with a board and four legs, 0.5 to 1.3 m wide.
  kTable,
};
std::string_view to_string(ObjectShape shape);

/// An object in its own frame. The origin is the centre of its bounding box.
struct ScenarioObject {
  ObjectShape shape = ObjectShape::kBall;
  /// Convex solids whose union is the object, which may be concave.
  std::vector<Solid> parts;
  /// Radius of a bounding sphere about the origin.
  double reach_m = 0.0;
};

/// Makes an object of this shape with random size and proportions.
ScenarioObject draw_object(ObjectShape shape, CounterRandom& random);

/// Returns a mesh of all parts. Each part's surface is closed. It is at most kMeshDeviation_m inside the
/// part's true surface.
Mesh object_mesh(const ScenarioObject& object);

}  // namespace roomradar
