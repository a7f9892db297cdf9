// foreign_recording.cpp: the list of kinds.
#include "app/sources/datasets/foreign_recording.hpp"

#include <array>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/datasets/azure_recording.hpp"
#include "app/sources/datasets/record3d.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

struct Kind {
  const char* name;
  bool (*is_kind)(const fs::path&);
  IndexedRecording (*index)(const fs::path&);
};

constexpr std::array kKinds = {
    Kind{"Record3D export", is_record3d, index_record3d},
    Kind{"Azure Kinect recording", is_matroska, index_azure_recording},
};

const Kind* kind_of(const fs::path& path) {
  for (const Kind& kind : kKinds)
    if (kind.is_kind(path)) return &kind;
  return nullptr;
}

}  // namespace

std::string foreign_kind(const fs::path& path) {
  const Kind* kind = kind_of(path);
  return kind ? kind->name : "";
}

std::optional<IndexedRecording> index_foreign(const fs::path& path) {
  const Kind* kind = kind_of(path);
  if (!kind) return std::nullopt;
  try {
    return kind->index(path);
  } catch (const fs::filesystem_error& error) {
    throw Error(path.string() + ": cannot be listed: " + error.code().message());
  }
}

}  // namespace roomradar
