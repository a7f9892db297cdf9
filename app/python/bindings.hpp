// bindings.hpp: the functions that bind the Python module's classes and functions, in the order of their
// dependencies.
#pragma once
#include <pybind11/pybind11.h>

namespace roomradar::python {

/// Binds the exceptions, then calls all functions below.
void bind_module(pybind11::module_& module);

/// Cameras, noise, timing and frames.
void bind_frames(pybind11::module_& module);

/// Frame sources, as iterators of frames.
void bind_sources(pybind11::module_& module);

/// Triangle meshes.
void bind_meshes(pybind11::module_& module);

/// The simulated Kinect with its ground truth. Call after bind_sources() and bind_meshes().
void bind_simulator(pybind11::module_& module);

/// The octree of occupancy and signed distance. Call after bind_meshes() and bind_frames().
void bind_octree(pybind11::module_& module);

/// Saved maps. Call after bind_octree() and bind_meshes().
void bind_maps(pybind11::module_& module);

/// The prescan. Call after bind_sources() and bind_maps().
void bind_scan(pybind11::module_& module);

/// Cyber Radar: distance to contact of moving objects. Call after bind_meshes() and bind_frames().
void bind_radar(pybind11::module_& module);

/// Localisation in a saved map. Call after bind_maps().
void bind_locator(pybind11::module_& module);

/// FrameResult and ObjectSnapshot. Call after bind_radar().
void bind_session_values(pybind11::module_& module);

/// Sessions of augmented reality in a saved room. Call after bind_maps(), bind_radar() and
/// bind_session_values().
void bind_session(pybind11::module_& module);

}  // namespace roomradar::python
