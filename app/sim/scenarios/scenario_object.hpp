// scenario_object.hpp: objects to drop and push, from a needle to a table, built of solids with exact travel.
#pragma once
#include <string_view>
#include <vector>

#include "app/sim/solids/counter_random.hpp"
#include "app/sim/solids/solid.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class ObjectShape {
  kBall,  ///< ball, box and cylinder are 4 to 30 cm in size
  kBox,
  kCylinder,
  kNeedle,  ///< 2 mm thick, 5 to 40 cm long
  kSheet,   ///< 2 mm thick, 8 to 60 cm wide
  kCup,     ///< open at the top, 6 to 14 cm high
  kTorus,   ///< 8 to 40 cm across
  kChair,   ///< seat, back and legs, 0.5 to 1 m high
  kTable,   ///< board and four legs, 0.5 to 1.3 m wide
};
std::string_view to_string(ObjectShape shape);

/// An object in its own frame, whose origin is the centre of its bounds.
struct ScenarioObject {
  ObjectShape shape = ObjectShape::kBall;
  std::vector<Solid> parts;  ///< convex; the object, which may be concave, is their union
  double reach_m = 0.0;      ///< radius of a bounding sphere about the origin
};

/// Draws an object of this shape with random size and proportions.
ScenarioObject draw_object(ObjectShape shape, CounterRandom& random);

/// Meshes all parts, each closed, at most kMeshDeviation_m inside the true surface.
Mesh object_mesh(const ScenarioObject& object);

}  // namespace roomradar
