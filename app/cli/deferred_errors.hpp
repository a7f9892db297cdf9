// faults.hpp: what goes wrong while results are put away: the rest of them are put away all the same.
#pragma once
#include <cstdio>
#include <exception>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {

/// The first fault is thrown at the end, once; the others are said on stderr when they come.
class DeferredErrors {
 public:
  template <typename Act>
  void attempt(const Act& act) {
    try {
      act();
    } catch (const std::exception& error) {
      add(error.what());
    }
  }
  void add(const std::string& fault) {
    if (first_.empty())
      first_ = fault;
    else
      std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  }
  /// Empty: none.
  [[nodiscard]] const std::string& first() const { return first_; }
  /// Throws Error with the first of them, if there is one.
  void throw_first() const {
    if (!first_.empty()) throw Error(first_);
  }

 private:
  std::string first_;
};

}  // namespace roomradar
