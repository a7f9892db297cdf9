// scenario_object.hpp: objects to drop and push, from a needle to a table, made of solids whose travel is
// exact.
#pragma once
#include <string_view>
#include <vector>

#include "app/sim/solids/counter_random.hpp"
#include "app/sim/solids/solid.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class ObjectShape {
  kBall,  ///< these three 4 to 30 cm
  kBox,
  kCylinder,
  kNeedle,  ///< 2 mm thick, 5 to 40 cm long
  kSheet,   ///< 2 mm thick, 8 to 60 cm wide
  kCup,     ///< open at the top, 6 to 14 cm
  kTorus,   ///< 8 to 40 cm across
  kChair,   ///< seat, back and legs, 0.5 to 1 m high
  kTable,   ///< board and four legs, 0.5 to 1.3 m wide
};
std::string_view to_string(ObjectShape shape);

/// In its own frame, whose origin is the middle of its bounds.
struct ScenarioObject {
  ObjectShape shape = ObjectShape::kBall;
  std::vector<Solid> parts;  ///< convex; their union is the object, also where it is concave
  double reach_m = 0.0;      ///< no point of it is farther from the origin
};

/// One of a shape, its size and proportions drawn.
ScenarioObject draw_object(ObjectShape shape, CounterRandom& random);

/// All parts, each closed, no farther than kMeshDeviation_m inside of them.
Mesh object_mesh(const ScenarioObject& object);

}  // namespace roomradar
