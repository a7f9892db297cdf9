/* roomradar_godot.c: class Roomradar of Godot 3: a saved room, a recording that plays in it, and its objects, in
 * Godot's axes. The methods are described in README.md. */
#include <math.h>
#include <roomradar.h>
#include <stdlib.h>
#include <string.h>

#include "gdnative.h"

/* The symbols that Godot looks for. */
#define GDN_EXPORT __attribute__((visibility("default"))) extern
GDN_EXPORT void godot_gdnative_init(gdn_init_options* options);
GDN_EXPORT void godot_gdnative_terminate(void* options);
GDN_EXPORT void godot_nativescript_init(void* handle);

static const gdn_core* core = NULL;
#define GDN(place, type) ((type)core->functions[place])

/* Object behind an instance of Roomradar. */
typedef struct room {
  roomradar_map* map;
  roomradar_source* source;
  roomradar_session* session;
  roomradar_frame frame; /* the last one read */
  roomradar_frame_result result;
} room;

/* Kinds of pool arrays: how to make, fill and pass one. */
typedef struct pool {
  int make, resize, write, access_ptr, access_end, destroy, variant_of;
} pool;
static const pool kBytes = {GDN_BYTES_NEW,        GDN_BYTES_RESIZE,  GDN_BYTES_WRITE,      GDN_BYTES_ACCESS_PTR,
                            GDN_BYTES_ACCESS_END, GDN_BYTES_DESTROY, GDN_VARIANT_NEW_BYTES};
static const pool kInts = {GDN_INTS_NEW,        GDN_INTS_RESIZE,  GDN_INTS_WRITE,      GDN_INTS_ACCESS_PTR,
                           GDN_INTS_ACCESS_END, GDN_INTS_DESTROY, GDN_VARIANT_NEW_INTS};
static const pool kReals = {GDN_REALS_NEW,        GDN_REALS_RESIZE,  GDN_REALS_WRITE,      GDN_REALS_ACCESS_PTR,
                            GDN_REALS_ACCESS_END, GDN_REALS_DESTROY, GDN_VARIANT_NEW_REALS};
static const pool kVectors = {
    GDN_VECTORS_NEW,        GDN_VECTORS_RESIZE,  GDN_VECTORS_WRITE,      GDN_VECTORS_ACCESS_PTR,
    GDN_VECTORS_ACCESS_END, GDN_VECTORS_DESTROY, GDN_VARIANT_NEW_VECTORS};

static gdn_variant nothing(void) {
  gdn_variant variant;
  GDN(GDN_VARIANT_NEW_NIL, gdn_variant_new_nil)(&variant);
  return variant;
}

static gdn_variant integer(int64_t value) {
  gdn_variant variant;
  GDN(GDN_VARIANT_NEW_INT, gdn_variant_new_int)(&variant, value);
  return variant;
}

static gdn_variant text(const char* utf8) {
  gdn_variant variant;
  gdn_reference string = GDN(GDN_STRING_OF_UTF8, gdn_string_of_utf8)(utf8);
  GDN(GDN_VARIANT_NEW_STRING, gdn_variant_new_of)(&variant, &string);
  GDN(GDN_STRING_DESTROY, gdn_take_reference)(&string);
  return variant;
}

/* Copies an array into a new pool array of `count` elements. */
static gdn_variant pooled(const pool* of, const void* from, size_t count, size_t bytes_per_element) {
  gdn_variant variant;
  gdn_reference array;
  GDN(of->make, gdn_take_reference)(&array);
  GDN(of->resize, gdn_resize)(&array, (int)count);
  if (count > 0) {
    gdn_access* access = GDN(of->write, gdn_write)(&array);
    memcpy(GDN(of->access_ptr, gdn_access_ptr)(access), from, count * bytes_per_element);
    GDN(of->access_end, gdn_access_end)(access);
  }
  GDN(of->variant_of, gdn_variant_new_of)(&variant, &array);
  GDN(of->destroy, gdn_take_reference)(&array);
  return variant;
}

/* Copies an argument's text into a buffer; longer ones are cut. */
static void read_text(const gdn_variant* argument, char* to, size_t capacity) {
  gdn_reference string = GDN(GDN_VARIANT_AS_STRING, gdn_variant_as_string)(argument);
  gdn_reference chars = GDN(GDN_STRING_UTF8, gdn_string_utf8)(&string);
  strncpy(to, GDN(GDN_CHARS_DATA, gdn_chars_data)(&chars), capacity - 1);
  to[capacity - 1] = '\0';
  GDN(GDN_CHARS_DESTROY, gdn_take_reference)(&chars);
  GDN(GDN_STRING_DESTROY, gdn_take_reference)(&string);
}

/* Returns "" for success, else the library's sentence. */
static gdn_variant outcome(roomradar_status status) {
  return text(status == ROOMRADAR_OK ? "" : roomradar_last_error());
}

static void close_all(room* self) {
  roomradar_session_close(self->session);
  roomradar_source_close(self->source);
  roomradar_map_close(self->map);
  memset(self, 0, sizeof *self);
  self->frame.struct_size = sizeof self->frame;
  self->result.struct_size = sizeof self->result;
}

/* open(map, recording, poses) */
static gdn_variant open_room(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  char map[4096], recording[4096];
  roomradar_session_options options;
  roomradar_status status;
  (void)instance, (void)data;
  if (count != 3) return text("open(map, recording, poses) takes three arguments");
  close_all(self);
  read_text(arguments[0], map, sizeof map);
  read_text(arguments[1], recording, sizeof recording);
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.poses = (int32_t)GDN(GDN_VARIANT_AS_INT, gdn_variant_as_int)(arguments[2]);
  options.has_no_picture = 1; /* Godot draws */
  status = roomradar_map_open(map, &self->map);
  if (status == ROOMRADAR_OK) status = roomradar_source_open(recording, &self->source);
  if (status == ROOMRADAR_OK) status = roomradar_session_open(self->map, &options, &self->session);
  return outcome(status);
}

/* add(name, file, size_m) */
static gdn_variant add(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  char name[256], file[4096];
  (void)instance, (void)data;
  if (count != 3) return text("add(name, file, size_m) takes three arguments");
  read_text(arguments[0], name, sizeof name);
  read_text(arguments[1], file, sizeof file);
  return outcome(roomradar_session_add_file(self->session, name, file,
                                            GDN(GDN_VARIANT_AS_REAL, gdn_variant_as_real)(arguments[2]), NULL));
}

/* drop(name, height_m) */
static gdn_variant drop(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  char name[256];
  (void)instance, (void)data;
  if (count != 2) return text("drop(name, height_m) takes two arguments");
  read_text(arguments[0], name, sizeof name);
  return outcome(roomradar_session_drop(self->session, name, NULL,
                                        GDN(GDN_VARIANT_AS_REAL, gdn_variant_as_real)(arguments[1])));
}

/* step(): 1 a frame was processed, 0 the recording has ended, -1 see error() */
static gdn_variant step(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  roomradar_status status;
  (void)instance, (void)data, (void)count, (void)arguments;
  do status = roomradar_source_next(self->source, &self->frame);
  while (status == ROOMRADAR_SKIPPED);
  if (status == ROOMRADAR_END) return integer(0);
  if (status == ROOMRADAR_OK) status = roomradar_session_step(self->session, &self->frame, &self->result);
  return integer(status == ROOMRADAR_OK ? 1 : -1);
}

/* error() */
static gdn_variant error(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  (void)instance, (void)data, (void)self_, (void)count, (void)arguments;
  return text(roomradar_last_error());
}

typedef roomradar_status (*mesh_call)(room* self, const void* which, roomradar_mesh_buffers* mesh);

static roomradar_status block_call(room* self, const void* which, roomradar_mesh_buffers* mesh) {
  return roomradar_session_block_mesh(self->session, *(const uint64_t*)which, mesh);
}
static roomradar_status moved_call(room* self, const void* which, roomradar_mesh_buffers* mesh) {
  (void)which;
  return roomradar_session_moved_mesh(self->session, 0, mesh);
}
static roomradar_status object_call(room* self, const void* which, roomradar_mesh_buffers* mesh) {
  return roomradar_session_object_mesh(self->session, which, mesh);
}

static void append(gdn_reference* array, gdn_variant variant) {
  GDN(GDN_ARRAY_APPEND, gdn_append)(array, &variant);
  GDN(GDN_VARIANT_DESTROY, gdn_variant_destroy)(&variant);
}

/* Returns [vertices, normals, colours, indices, version], or null for an empty mesh or an error. */
static gdn_variant mesh_of(room* self, mesh_call call, const void* which) {
  roomradar_mesh_buffers mesh;
  gdn_variant made;
  size_t i, axis;
  memset(&mesh, 0, sizeof mesh);
  mesh.struct_size = sizeof mesh;
  mesh.axes = ROOMRADAR_AXES_GODOT;
  call(self, which, &mesh);
  if (mesh.vertex_count == 0 || mesh.triangle_count == 0) return nothing();
  mesh.vertex_capacity = mesh.vertex_count;
  mesh.triangle_capacity = mesh.triangle_count;
  mesh.vertices = malloc(mesh.vertex_count * 3 * sizeof(float));
  mesh.normals = malloc(mesh.vertex_count * 3 * sizeof(float));
  mesh.colours_rgb = malloc(mesh.vertex_count * 3);
  mesh.triangles = malloc(mesh.triangle_count * 3 * sizeof(uint32_t));
  made = nothing();
  if (mesh.vertices && mesh.normals && mesh.colours_rgb && mesh.triangles &&
      call(self, which, &mesh) == ROOMRADAR_OK) {
    gdn_reference parts;
    for (i = 0; i < mesh.vertex_count; ++i) /* a room is small enough for float coordinates */
      for (axis = 0; axis < 3; ++axis) mesh.vertices[3 * i + axis] += (float)mesh.origin[axis];
    GDN(GDN_ARRAY_NEW, gdn_take_reference)(&parts);
    append(&parts, pooled(&kVectors, mesh.vertices, mesh.vertex_count, 3 * sizeof(float)));
    append(&parts, pooled(&kVectors, mesh.normals, mesh.vertex_count, 3 * sizeof(float)));
    append(&parts, pooled(&kBytes, mesh.colours_rgb, 3 * mesh.vertex_count, 1));
    append(&parts, pooled(&kInts, mesh.triangles, 3 * mesh.triangle_count, sizeof(uint32_t)));
    append(&parts, integer((int64_t)mesh.version));
    GDN(GDN_VARIANT_DESTROY, gdn_variant_destroy)(&made);
    GDN(GDN_VARIANT_NEW_ARRAY, gdn_variant_new_of)(&made, &parts);
    GDN(GDN_ARRAY_DESTROY, gdn_take_reference)(&parts);
  }
  free(mesh.vertices);
  free(mesh.normals);
  free(mesh.colours_rgb);
  free(mesh.triangles);
  return made;
}

/* blocks(): a mesh per block of the room */
static gdn_variant blocks(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  size_t needed = 0, i;
  roomradar_block* listed;
  gdn_reference array;
  gdn_variant made;
  (void)instance, (void)data, (void)count, (void)arguments;
  roomradar_session_blocks(self->session, NULL, 0, &needed);
  listed = malloc((needed + 1) * sizeof *listed);
  GDN(GDN_ARRAY_NEW, gdn_take_reference)(&array);
  if (listed && roomradar_session_blocks(self->session, listed, needed, &needed) == ROOMRADAR_OK)
    for (i = 0; i < needed; ++i) append(&array, mesh_of(self, block_call, &listed[i].id));
  free(listed);
  GDN(GDN_VARIANT_NEW_ARRAY, gdn_variant_new_of)(&made, &array);
  GDN(GDN_ARRAY_DESTROY, gdn_take_reference)(&array);
  return made;
}

/* moved(): the mesh of the dynamic surfaces in the last frame */
static gdn_variant moved(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  (void)instance, (void)data, (void)count, (void)arguments;
  return mesh_of(self_, moved_call, NULL);
}

/* object_mesh(name) */
static gdn_variant object_mesh(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  char name[256];
  (void)instance, (void)data;
  if (count != 1) return nothing();
  read_text(arguments[0], name, sizeof name);
  return mesh_of(self_, object_call, name);
}

/* Returns a pose's 12 numbers, as rows of a 3 x 4 matrix, and further ones. */
static gdn_variant numbers(const roomradar_pose* pose, const double* further, size_t further_count) {
  float all[24];
  size_t i;
  for (i = 0; i < 12; ++i) all[i] = (float)pose->m[i];
  for (i = 0; i < further_count && 12 + i < 24; ++i) all[12 + i] = (float)further[i];
  return pooled(&kReals, all, 12 + further_count, sizeof(float));
}

/* object(name): pose; then 1 in the room, 1 asleep, kind of surface below */
static gdn_variant object(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  char name[256];
  roomradar_object_state state;
  roomradar_pose pose;
  double further[3];
  (void)instance, (void)data;
  if (count != 1) return nothing();
  read_text(arguments[0], name, sizeof name);
  if (roomradar_session_object(self->session, name, &state) != ROOMRADAR_OK ||
      roomradar_pose_to_engine(ROOMRADAR_AXES_GODOT, &state.T_world_object, &pose) != ROOMRADAR_OK)
    return nothing();
  further[0] = state.is_in_room;
  further[1] = state.is_asleep;
  further[2] = state.rests_on;
  return numbers(&pose, further, 3);
}

/* Returns T_world_b = T_world_a * (T_b_a)^-1. */
static roomradar_pose times_inverse(const roomradar_pose* T_world_a, const roomradar_pose* T_b_a) {
  roomradar_pose made;
  int row, column, k;
  memset(&made, 0, sizeof made);
  made.m[15] = 1.0;
  for (row = 0; row < 3; ++row) {
    for (column = 0; column < 3; ++column)
      for (k = 0; k < 3; ++k) made.m[4 * row + column] += T_world_a->m[4 * row + k] * T_b_a->m[4 * column + k];
    made.m[4 * row + 3] = T_world_a->m[4 * row + 3];
    for (k = 0; k < 3; ++k) made.m[4 * row + 3] -= made.m[4 * row + k] * T_b_a->m[4 * k + 3];
  }
  return made;
}

/* camera(): pose of the colour camera; then width, height, fx, fy, cx, cy, px. null: not located. */
static gdn_variant camera(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  roomradar_pose T_world_colour, pose;
  const roomradar_camera* of = &self->frame.colour_camera;
  double further[6];
  (void)instance, (void)data, (void)count, (void)arguments;
  if (!self->result.is_located || self->frame.colour_rgb == NULL) return nothing();
  T_world_colour = times_inverse(&self->result.T_world_camera, &self->frame.T_colour_depth);
  if (roomradar_camera_to_engine(ROOMRADAR_AXES_GODOT, &T_world_colour, &pose) != ROOMRADAR_OK) return nothing();
  further[0] = of->width_px;
  further[1] = of->height_px;
  further[2] = of->fx_px;
  further[3] = of->fy_px;
  further[4] = of->cx_px;
  further[5] = of->cy_px;
  return numbers(&pose, further, 6);
}

/* picture(): the camera's picture, height x width x 3 bytes RGB */
static gdn_variant picture(gdn_object* instance, void* data, void* self_, int count, gdn_variant** arguments) {
  room* self = self_;
  (void)instance, (void)data, (void)count, (void)arguments;
  if (self->frame.colour_rgb == NULL) return nothing();
  return pooled(&kBytes, self->frame.colour_rgb,
                (size_t)self->frame.colour_camera.width_px * (size_t)self->frame.colour_camera.height_px * 3, 1);
}

static void* create(gdn_object* instance, void* data) {
  room* self = calloc(1, sizeof *self);
  (void)instance, (void)data;
  if (self) close_all(self); /* sets the sizes */
  return self;
}

static void destroy(gdn_object* instance, void* data, void* self) {
  (void)instance, (void)data;
  close_all(self);
  free(self);
}

void godot_gdnative_init(gdn_init_options* options) { core = options->core; }
void godot_gdnative_terminate(void* options) {
  (void)options;
  core = NULL;
}

void godot_nativescript_init(void* handle) {
  static const struct {
    const char* name;
    gdn_variant (*method)(gdn_object*, void*, void*, int, gdn_variant**);
  } methods[] = {{"open", open_room}, {"add", add},       {"drop", drop},         {"step", step},
                 {"error", error},    {"blocks", blocks}, {"moved", moved},       {"object_mesh", object_mesh},
                 {"object", object},  {"camera", camera}, {"picture", picture}};
  const gdn_extension* script = NULL;
  const gdn_create creates = {create, NULL, NULL};
  const gdn_destroy destroys = {destroy, NULL, NULL};
  const gdn_method_attributes plain = {0};
  size_t i;
  for (i = 0; i < core->extension_count; ++i)
    if (core->extensions[i]->type == GDN_EXT_NATIVESCRIPT) script = core->extensions[i];
  if (script == NULL) return;
  ((gdn_register_class)script->functions[GDN_REGISTER_CLASS])(handle, "Roomradar", "Reference", creates, destroys);
  for (i = 0; i < sizeof methods / sizeof methods[0]; ++i) {
    const gdn_method method = {methods[i].method, NULL, NULL};
    ((gdn_register_method)script->functions[GDN_REGISTER_METHOD])(handle, "Roomradar", methods[i].name, plain,
                                                                  method);
  }
}
