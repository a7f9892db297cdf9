// handles.cpp: assigns numbers to handles.
#include "app/c_api/handles.hpp"

#include <atomic>

namespace roomradar::c_api {

std::uintptr_t next_handle_number() {
  static std::atomic<std::uintptr_t> next{0x1001};  // odd: no address of an object
  return next.fetch_add(2);
}

void refuse_handle(const char* kind) {
  throw Refusal(ROOMRADAR_CLOSED_HANDLE, std::string("this is not an open ") + kind +
                                             ": the handle is closed, null or of another kind");
}

}  // namespace roomradar::c_api
