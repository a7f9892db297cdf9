/* roomradar_source.h: frames of a recording on disk. Live cameras are the caller's: it fills roomradar_frame.
 */
#ifndef ROOMRADAR_SOURCE_H
#define ROOMRADAR_SOURCE_H

#include "roomradar_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Opens a recording, a folder or a file of one of the kinds in app/sources/README.md. */
ROOMRADAR_API roomradar_status roomradar_source_open(const char* path, roomradar_source** source);
ROOMRADAR_API roomradar_status roomradar_source_close(roomradar_source* source);
/* Returns the sentence of the last failed call with this handle; see roomradar_map_error(). */
ROOMRADAR_API const char* roomradar_source_error(const roomradar_source* source);
/* Returns what was decided about the recording so far, such as its unit, cameras and times, as a JSON array of
 * objects with topic, sentence, count, option and advice. Valid until the next call of this function with this
 * source. Null if the handle is closed or of another kind. */
ROOMRADAR_API const char* roomradar_source_input(const roomradar_source* source);
/* Reads the next frame. Its images belong to the library and are valid until the next call with this source.
 * Returns ROOMRADAR_END after the last frame, and ROOMRADAR_SKIPPED for an unreadable one. */
ROOMRADAR_API roomradar_status roomradar_source_next(roomradar_source* source, roomradar_frame* frame);
/* Goes back to the first frame. */
ROOMRADAR_API roomradar_status roomradar_source_rewind(roomradar_source* source);

#ifdef __cplusplus
}
#endif
#endif
