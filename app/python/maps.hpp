// maps.hpp: a saved map for Python.
#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "app/python/octree.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar::python {

/// An immutable map in memory.
struct Map : std::enable_shared_from_this<Map> {
  SavedMap saved;
  std::string folder;  ///< empty: the map was neither loaded nor saved

  Map(SavedMap map, std::string its_folder) : saved(std::move(map)), folder(std::move(its_folder)) {}
};

/// Returns the map's octree, which shares ownership of the map. The octree is read from disk at its first
/// use.
std::shared_ptr<Octree> octree_of(Map& map);

}  // namespace roomradar::python
