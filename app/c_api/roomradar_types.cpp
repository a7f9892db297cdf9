// roomradar_types.cpp: version, names of statuses, the thread's error.
#include "app/c_api/roomradar_types.h"

#include "app/c_api/boundary.hpp"
#include "mapping/types/system/version.hpp"

const char* roomradar_version(void) { return roomradar::kVersion; }

const char* roomradar_status_name(int32_t status) {
  switch (status) {
    case ROOMRADAR_OK:
      return "ok";
    case ROOMRADAR_INVALID_ARGUMENT:
      return "invalid argument";
    case ROOMRADAR_CLOSED_HANDLE:
      return "closed handle";
    case ROOMRADAR_WRONG_STRUCT_SIZE:
      return "wrong struct_size";
    case ROOMRADAR_BUFFER_TOO_SMALL:
      return "buffer too small";
    case ROOMRADAR_FAILED:
      return "failed";
    case ROOMRADAR_OUT_OF_MEMORY:
      return "out of memory";
    case ROOMRADAR_END:
      return "end";
    case ROOMRADAR_SKIPPED:
      return "skipped";
    case ROOMRADAR_INTERNAL:
      return "internal fault";
    default:
      return "unknown status";
  }
}

const char* roomradar_last_error(void) { return roomradar::c_api::last_error(); }
