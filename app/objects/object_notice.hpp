// object_notice.hpp: a message to the user about a virtual object.
#pragma once
#include <string>

namespace roomradar {

/// A sentence about an event that the user did not request: the object was moved out of a surface, is stuck,
/// or cannot be dropped.
struct ObjectNotice {
  std::string name;  ///< name of the object
  std::string text;  ///< the rest of the sentence after the name, without a full stop
};

}  // namespace roomradar
