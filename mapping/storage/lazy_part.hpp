// lazy_part.hpp: a value that is read from disk when it is first used.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace roomradar {

/// Holds a value, or a function that makes the value at its first use. Converts to a reference to the value,
/// like std::reference_wrapper. Concurrent const calls are thread safe. A use rethrows what the function
/// throws, and the next use calls the function again. A moved-from part can only be assigned or destroyed.
template <typename Part>
class LazyPart {
 public:
  /// Holds this value from the start.
  LazyPart(Part part) : state_(std::make_unique<State>()) { state_->part.emplace(std::move(part)); }
  /// @param make  returns the value; called at most once successfully
  explicit LazyPart(std::function<Part()> make) : state_(std::make_unique<State>()) {
    state_->make = std::move(make);
  }

  [[nodiscard]] Part& operator*() { return state_->used(); }
  [[nodiscard]] const Part& operator*() const { return state_->used(); }
  [[nodiscard]] Part* operator->() { return &state_->used(); }
  [[nodiscard]] const Part* operator->() const { return &state_->used(); }
  operator Part&() { return state_->used(); }
  operator const Part&() const { return state_->used(); }

 private:
  struct State {
    std::mutex mutex;
    std::function<Part()> make;
    std::optional<Part> part;

    Part& used() {
      const std::lock_guard lock(mutex);
      if (!part) {
        part.emplace(make());
        make = nullptr;
      }
      return *part;
    }
  };
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
