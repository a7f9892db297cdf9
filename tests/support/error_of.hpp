// error_of.hpp: the message of the Error that some work is expected to throw.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar::test {

/// The test fails if none is thrown.
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
