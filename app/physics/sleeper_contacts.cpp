// sleeper_contacts.cpp: keeps contacts by body; compares poses bit by bit.
#include "app/physics/sleeper_contacts.hpp"

#include <algorithm>

namespace roomradar {

bool recall_contacts(std::span<const SleeperContacts> known, const Body& body,
                     std::span<const SceneBody> others, std::vector<ClosestPoint>& near) {
  const auto own =
      std::find_if(known.begin(), known.end(), [&](const SleeperContacts& one) { return one.body == &body; });
  if (own == known.end() || own->T_world_object.matrix() != body.T_world_object.matrix()) return false;
  near = own->near;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const SleeperContacts::ContactBody& contact = own->bodies[i];
    const auto other = std::find_if(others.begin(), others.end(),
                                    [&](const SceneBody& one) { return one.body == contact.body; });
    near[i].tree = static_cast<std::uint32_t>(other - others.begin());  // beyond the end: no body
    if (contact.body == nullptr) continue;
    if (other == others.end() || other->body->T_world_object.matrix() != contact.T_world_body.matrix())
      return false;
  }
  return true;
}

void remember_contacts(std::vector<SleeperContacts>& known, const Body& body,
                       std::span<const SceneBody> others, const std::vector<ClosestPoint>& near) {
  auto own =
      std::find_if(known.begin(), known.end(), [&](const SleeperContacts& one) { return one.body == &body; });
  if (own == known.end()) own = known.insert(own, SleeperContacts{});
  own->body = &body;
  own->T_world_object = body.T_world_object;
  own->near = near;
  own->bodies.clear();
  for (const ClosestPoint& p : near) {
    const Body* other = body_of(others, p);
    own->bodies.push_back({other, other != nullptr ? other->T_world_object : Eigen::Isometry3d::Identity()});
  }
}

}  // namespace roomradar
