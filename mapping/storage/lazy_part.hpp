// lazy_part.hpp: a value that is read from disk when it is first used.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace roomradar {

/// Holds a value, or a function that makes the value at its first use. Concurrent calls of load() are thread
/// safe. A moved-from part can only be assigned or destroyed.
template <typename Part>
class LazyPart {
 public:
  /// Holds this value from the start.
  LazyPart(Part part) : state_(std::make_unique<State>()) { state_->part.emplace(std::move(part)); }
  /// @param make  returns the value; called at most once successfully
  explicit LazyPart(std::function<Part()> make) : state_(std::make_unique<State>()) {
    state_->make = std::move(make);
  }

  /// Returns the value. The first call makes it: reads the part's files, and may throw Error. The call after
  /// one that threw reads the files again.
  Part& load() { return state_->load(); }
  const Part& load() const { return state_->load(); }

 private:
  struct State {
    std::mutex mutex;
    std::function<Part()> make;
    std::optional<Part> part;

    Part& load() {
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
