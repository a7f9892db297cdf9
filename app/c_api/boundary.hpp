// boundary.hpp: boundary between C++ and C, which converts exceptions to a status and an error message.
// Elsewhere in app/c_api, exceptions are not caught.
#pragma once
#include <mutex>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "app/c_api/roomradar_types.h"

namespace roomradar::c_api {

/// Exception for an invalid call, with the status to return. Exceptions of type Error become FAILED. Other
/// exceptions become OUT_OF_MEMORY or INTERNAL.
class Refusal : public std::runtime_error {
 public:
  Refusal(roomradar_status of, const std::string& sentence) : std::runtime_error(sentence), status(of) {}
  roomradar_status status;
};

/// Error message of a handle's last failed call.
struct HandleError {
  std::mutex mutex;
  std::string sentence;
};

/// Returns the status of the exception that is being handled. Stores the error message "CALL: MESSAGE" for
/// the thread and, if `error` is not null, for the handle. If memory is exhausted, the stored messages may be
/// empty.
roomradar_status status_of_exception(const char* call, HandleError* error) noexcept;

/// Returns work()'s status, or OK if it returns none. If work() throws, returns status_of_exception().
template <typename Work>
roomradar_status guarded(const char* call, HandleError* error, const Work& work) noexcept {
  try {
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      return ROOMRADAR_OK;
    } else {
      return work();
    }
  } catch (...) {
    return status_of_exception(call, error);
  }
}

/// Returns the error message of this thread's last failed call.
const char* last_error() noexcept;
/// Returns a copy of a handle's error message. The copy is valid until the calling thread calls sentence_of()
/// again.
const char* sentence_of(HandleError& error) noexcept;

}  // namespace roomradar::c_api
