// handles.hpp: tables of the library's objects by handle. Handle numbers are never reused, so that closed
// handles are recognised.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "app/c_api/boundary.hpp"
#include "app/c_api/room_blocks.hpp"
#include "mapping/map/map_folder.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar::c_api {

/// Base of all objects behind handles.
struct Handled {
  std::mutex in_use;  ///< locked during a call, which serialises calls with the same handle
  HandleError error;
};

struct ShapeState : Handled {
  static constexpr const char* kKind = "shape";
  TriangleTree tree;  ///< immutable once the handle exists
};

struct MapState : Handled {
  static constexpr const char* kKind = "map";
  std::string folder;
  SavedMap map;  ///< immutable
  std::optional<RoomBlocks> blocks;
  std::shared_ptr<ShapeState> shape;  ///< null until the first request
};

/// Returns a new handle number, unique among handles of all kinds.
std::uintptr_t next_handle_number();

/// Objects of one kind by their handles. Thread safe.
template <typename State>
class HandleTable {
 public:
  /// Returns the process's table. It is never destroyed: threads may use it while the process exits.
  static HandleTable& get() {
    static HandleTable& table = *new HandleTable;
    return table;
  }
  template <typename Handle>
  Handle* add(std::shared_ptr<State> state) {
    const std::uintptr_t number = next_handle_number();
    const std::lock_guard lock(mutex_);
    states_.emplace(number, std::move(state));
    return reinterpret_cast<Handle*>(number);
  }
  /// Returns null for a closed, null or foreign handle.
  [[nodiscard]] std::shared_ptr<State> find(const void* handle) {
    const std::shared_lock lock(mutex_);
    const auto found = states_.find(reinterpret_cast<std::uintptr_t>(handle));
    return found == states_.end() ? nullptr : found->second;
  }
  /// Closes the handle and returns its object. Returns null for a closed, null or foreign handle.
  std::shared_ptr<State> take(const void* handle) {
    const std::lock_guard lock(mutex_);
    const auto node = states_.extract(reinterpret_cast<std::uintptr_t>(handle));
    return node.empty() ? nullptr : std::move(node.mapped());
  }

 private:
  std::shared_mutex mutex_;
  std::unordered_map<std::uintptr_t, std::shared_ptr<State>> states_;

  HandleTable() = default;
};

/// Throws Refusal for a handle without an object.
[[noreturn]] void refuse_handle(const char* kind);

template <typename State>
std::shared_ptr<State> object_of(const void* handle) {
  std::shared_ptr<State> state = HandleTable<State>::get().find(handle);
  if (!state) refuse_handle(State::kKind);
  return state;
}

/// Calls work(State&) with exclusive use of the handle's object. Returns work()'s status, or that of its
/// exception.
template <typename State, typename Work>
roomradar_status with(const char* call, const void* handle, const Work& work) noexcept {
  std::shared_ptr<State> state;
  const roomradar_status found = guarded(call, nullptr, [&] { state = object_of<State>(handle); });
  if (found != ROOMRADAR_OK) return found;
  return guarded(call, &state->error, [&] {
    const std::lock_guard lock(state->in_use);
    return work(*state);
  });
}

/// Closes a handle. Its object is freed once no call uses it.
template <typename State>
roomradar_status close(const char* call, const void* handle) noexcept {
  return guarded(call, nullptr, [&] {
    if (!HandleTable<State>::get().take(handle)) refuse_handle(State::kKind);
  });
}

/// Returns the error message of a handle's last failed call.
template <typename State>
const char* error_of(const void* handle) noexcept {
  const std::shared_ptr<State> state = HandleTable<State>::get().find(handle);
  return state ? sentence_of(state->error) : "the handle is closed, null or of another kind";
}

}  // namespace roomradar::c_api
