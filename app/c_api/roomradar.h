/* roomradar.h: the C API of roomradar, for engines and other languages. Includes all of it.
 *
 * Handles. Each object of the library is a pointer to a type that is never defined. It is a number, not an
 * address: do not dereference it. A closed, null or foreign handle is recognised, and the call returns
 * ROOMRADAR_CLOSED_HANDLE. Numbers are never used twice.
 *
 * Errors. A function that can fail returns a roomradar_status. If it is not ROOMRADAR_OK, nothing has changed
 * except needed counts and, after ROOMRADAR_SKIPPED, a source's position. roomradar_last_error() then has a
 * sentence that says what is wrong, where, and what to do. The sentence is also kept with the handle. No
 * exception leaves the library.
 *
 * Structs. A struct that begins with struct_size may grow in later versions: set struct_size to sizeof of the
 * struct, and all other fields to zero or to a value. Zero is the default of each field unless its comment
 * says otherwise. Structs without struct_size never change while the library is libroomradar.so.0.
 *
 * Buffers. The caller owns all memory that it passes, and the library keeps no pointer into it. Functions
 * that return arrays take a buffer, its capacity, and a pointer to the needed count. If handle and arguments
 * are valid, they set the needed count. If the capacity is less, they return ROOMRADAR_BUFFER_TOO_SMALL and
 * do not write to the buffer. A null buffer with capacity 0 asks for the count. Only sentences and a frame of
 * roomradar_source_next() point into the library.
 *
 * Threads. Every function may be called from any thread. Calls with the same handle run one after the other;
 * calls with different handles run at the same time. A thread that shares a handle sees the state after
 * another thread's complete call, never half of one. Results that belong together (step, picture, mask) are
 * one frame's only if one thread asks for all of them, or the threads take turns. Closing a handle that
 * another thread is using waits for nothing: that call ends first, then the object is freed. A session and a
 * locator draw on a thread of their own: the caller's OpenGL context is never touched. Do not use the library
 * in a child of fork() that does not call exec.
 *
 * Frames and units. Lengths are metres, times seconds. World: right-handed, +z up, z = 0 on the floor.
 * Camera: x right, y down, z forward; pixel (0, 0) is centred at image coordinates (0, 0). T_a_b maps
 * coordinates in b to coordinates in a. roomradar_axes.h converts to the axes and units of engines. Texts are
 * UTF-8. Numbers in texts have a point, whatever the locale. */
#ifndef ROOMRADAR_H
#define ROOMRADAR_H

#include "roomradar_axes.h"
#include "roomradar_locator.h"
#include "roomradar_map.h"
#include "roomradar_objects.h"
#include "roomradar_radar.h"
#include "roomradar_scene.h"
#include "roomradar_session.h"
#include "roomradar_source.h"
#include "roomradar_types.h"

#endif
