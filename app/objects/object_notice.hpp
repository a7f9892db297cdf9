// object_notice.hpp: news of a virtual object for the user.
#pragma once
#include <string>

namespace roomradar {

/// A sentence about an object that its user did not ask for: it was lifted out of a surface, is stuck, or
/// cannot be dropped.
struct ObjectNotice {
  std::string name;  ///< the object's
  std::string text;  ///< the rest of the sentence after the name, without a full stop
};

}  // namespace roomradar
