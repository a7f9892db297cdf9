// object_notice.hpp: a message to the user about a virtual object.
#pragma once
#include <string>

namespace roomradar {

/// A sentence about an event that the user did not request. Examples: an object was moved out of a surface,
/// is stuck, or cannot be dropped.
struct ObjectNotice {
  std::string name;  ///< object's name, the start of the sentence; empty: `text` is the whole sentence
  std::string text;  ///< rest of the sentence, without a full stop
};

}  // namespace roomradar
