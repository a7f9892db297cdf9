// error_of.hpp: message of the Error that a piece of work is expected to throw.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar::test {

/// Runs `work` and returns the message of the Error it throws. The test fails if it throws none.
template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

}  // namespace roomradar::test
