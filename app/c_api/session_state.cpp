// session_state.cpp: destruction of sessions and locators, and updates of a session's messages and versions.
#include "app/c_api/session_state.hpp"

#include "app/c_api/conversions.hpp"

namespace roomradar::c_api {

SessionState::~SessionState() {
  if (session) thread.run([this] { session.reset(); });
}

const VirtualObject& SessionState::object(const char* name) const {
  const VirtualObject* found = find_object(session->objects(), name_of(name));
  if (found == nullptr) refuse("there is no object named " + name_of(name));
  return *found;
}

void SessionState::keep(const std::vector<ObjectNotice>& sentences) {
  constexpr std::size_t kMost = 1000;
  for (const ObjectNotice& sentence : sentences) notices.push_back(sentence.name + sentence.text);
  if (notices.size() > kMost) notices.erase(notices.begin(), notices.end() - kMost);
}

void SessionState::look_for_new_room() {
  const std::uint64_t revision = session->room().touched.revision();
  if (room_revision != 0 && revision != room_revision) ++room_version;
  room_revision = revision;
}

LocatorState::Rendered::Rendered(const Mesh& mesh) : room(context), scene(context, room, {}) {
  room.set(mesh, MeshUsage::kStatic);
}

LocatorState::~LocatorState() {
  if (rendered) thread.run([this] { rendered.reset(); });
}

}  // namespace roomradar::c_api
