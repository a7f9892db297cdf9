// session_state.cpp: life and small changes of sessions and locators.
#include "app/c_api/session_state.hpp"

#include <utility>

#include "app/c_api/conversions.hpp"

namespace roomradar::c_api {

SessionThread::SessionThread() : thread_([this] { serve(); }) {}

SessionThread::~SessionThread() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SessionThread::run_and_wait(Call call, const void* task) {
  std::unique_lock lock(mutex_);
  call_ = call;
  task_ = task;
  is_done_ = false;
  changed_.notify_all();
  changed_.wait(lock, [this] { return is_done_; });
  if (const std::exception_ptr fault = std::exchange(fault_, nullptr)) std::rethrow_exception(fault);
}

void SessionThread::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stops_ || call_ != nullptr; });
    if (call_ == nullptr) return;
    const Call work = std::exchange(call_, nullptr);
    lock.unlock();
    std::exception_ptr fault;
    try {
      work(task_);
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    fault_ = fault;
    is_done_ = true;
    changed_.notify_all();
  }
}

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
