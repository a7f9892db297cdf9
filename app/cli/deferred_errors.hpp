// deferred_errors.hpp: collects errors while results are saved, so that one failure does not prevent saving
// other results.
#pragma once
#include <cstdio>
#include <exception>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Stores the first error, which callers can throw at the end. Prints later errors to stderr immediately.
class DeferredErrors {
 public:
  /// Calls act(). If act() throws, adds the exception's message.
  template <typename Act>
  void attempt(const Act& act) {
    try {
      act();
    } catch (const std::exception& error) {
      add(error.what());
    }
  }
  /// Adds an error message.
  void add(const std::string& fault) {
    if (first_.empty())
      first_ = fault;
    else
      std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  }
  /// Returns the first error's message; empty if there was none.
  [[nodiscard]] const std::string& first() const { return first_; }
  /// Throws Error with the first error's message, if there is one.
  void throw_first() const {
    if (!first_.empty()) throw Error(first_);
  }

 private:
  std::string first_;
};

}  // namespace roomradar
