// boundary.cpp: converts exceptions to statuses.
#include "app/c_api/boundary.hpp"

#include <new>

#include "mapping/types/system/error.hpp"

namespace roomradar::c_api {
namespace {

struct ThreadSentences {
  std::string last;    ///< of last_error()
  std::string handle;  ///< of sentence_of()
};
thread_local ThreadSentences thread_sentences;

void keep(const char* call, const char* kind, const char* what, HandleError* error) noexcept {
  thread_sentences.last.clear();
  try {
    std::unique_lock<std::mutex> lock;
    if (error != nullptr) {
      lock = std::unique_lock(error->mutex);
      error->sentence.clear();
    }
    thread_sentences.last = std::string(call) + ": " + kind + what;
    if (error != nullptr) error->sentence = thread_sentences.last;
  } catch (...) {  // out of memory: the sentence is missing
  }
}

}  // namespace

roomradar_status status_of_exception(const char* call, HandleError* error) noexcept {
  try {
    throw;
  } catch (const Refusal& refusal) {
    keep(call, "", refusal.what(), error);
    return refusal.status;
  } catch (const Error& failure) {
    keep(call, "", failure.what(), error);
    return ROOMRADAR_FAILED;
  } catch (const std::bad_alloc&) {
    keep(call, "", "memory is short", error);
    return ROOMRADAR_OUT_OF_MEMORY;
  } catch (const std::length_error&) {
    keep(call, "", "memory is short: a size is beyond what can be addressed", error);
    return ROOMRADAR_OUT_OF_MEMORY;
  } catch (const std::exception& fault) {
    keep(call, "a fault of the library: ", fault.what(), error);
    return ROOMRADAR_INTERNAL;
  } catch (...) {
    keep(call, "", "a fault of the library", error);
    return ROOMRADAR_INTERNAL;
  }
}

const char* last_error() noexcept { return thread_sentences.last.c_str(); }

const char* sentence_of(HandleError& error) noexcept {
  try {
    const std::lock_guard lock(error.mutex);
    thread_sentences.handle = error.sentence;
    return thread_sentences.handle.c_str();
  } catch (...) {
    return "";
  }
}

}  // namespace roomradar::c_api
