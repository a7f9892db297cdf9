/* gdnative.h: the part of Godot 3's GDNative interface that the add-on uses. Debian has no package of its headers.
 * Types, and places in the tables, are those of the published interface (modules/gdnative/gdnative_api.json of
 * Godot 3.2: core 1.0, nativescript 1.0); later 3.x versions only append. */
#ifndef ROOMRADAR_GDNATIVE_H
#define ROOMRADAR_GDNATIVE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct gdn_variant {
  uint64_t opaque[3];
} gdn_variant;
/* A reference to a string, a pool array or an array. */
typedef struct gdn_reference {
  void* opaque;
} gdn_reference;
typedef void gdn_object;
typedef void gdn_access; /* locks a pool array while it is written */
typedef void (*gdn_function)(void);

typedef struct gdn_version {
  unsigned int major, minor;
} gdn_version;
typedef struct gdn_extension {
  unsigned int type;
  gdn_version version;
  const struct gdn_extension* next;
  gdn_function functions[6];
} gdn_extension;
typedef struct gdn_core {
  unsigned int type;
  gdn_version version;
  const void* next;
  unsigned int extension_count;
  const gdn_extension** extensions;
  gdn_function functions[744];
} gdn_core;

typedef struct gdn_init_options {
  bool in_editor;
  uint64_t core_api_hash, editor_api_hash, no_api_hash;
  gdn_function report_version_mismatch, report_loading_error;
  gdn_object* library;
  const gdn_core* core;
  const gdn_reference* active_library_path;
} gdn_init_options;

/* Places in gdn_core::functions. */
enum {
  GDN_BYTES_NEW = 155,
  GDN_BYTES_RESIZE = 164,
  GDN_BYTES_WRITE = 166,
  GDN_BYTES_DESTROY = 170,
  GDN_INTS_NEW = 171,
  GDN_INTS_RESIZE = 180,
  GDN_INTS_WRITE = 182,
  GDN_INTS_DESTROY = 186,
  GDN_REALS_NEW = 187,
  GDN_REALS_RESIZE = 196,
  GDN_REALS_WRITE = 198,
  GDN_REALS_DESTROY = 202,
  GDN_VECTORS_NEW = 235,
  GDN_VECTORS_RESIZE = 244,
  GDN_VECTORS_WRITE = 246,
  GDN_VECTORS_DESTROY = 250,
  GDN_BYTES_ACCESS_PTR = 296,
  GDN_BYTES_ACCESS_END = 298,
  GDN_INTS_ACCESS_PTR = 300,
  GDN_INTS_ACCESS_END = 302,
  GDN_REALS_ACCESS_PTR = 304,
  GDN_REALS_ACCESS_END = 306,
  GDN_VECTORS_ACCESS_PTR = 316,
  GDN_VECTORS_ACCESS_END = 318,
  GDN_ARRAY_NEW = 323,
  GDN_ARRAY_APPEND = 336,
  GDN_ARRAY_DESTROY = 361,
  GDN_VARIANT_NEW_NIL = 509,
  GDN_VARIANT_NEW_INT = 512,
  GDN_VARIANT_NEW_STRING = 514,
  GDN_VARIANT_NEW_ARRAY = 529,
  GDN_VARIANT_NEW_BYTES = 530,
  GDN_VARIANT_NEW_INTS = 531,
  GDN_VARIANT_NEW_REALS = 532,
  GDN_VARIANT_NEW_VECTORS = 535,
  GDN_VARIANT_AS_INT = 539,
  GDN_VARIANT_AS_REAL = 540,
  GDN_VARIANT_AS_STRING = 541,
  GDN_VARIANT_DESTROY = 570,
  GDN_CHARS_DATA = 572,
  GDN_CHARS_DESTROY = 573,
  GDN_STRING_UTF8 = 678,
  GDN_STRING_OF_UTF8 = 681,
  GDN_STRING_DESTROY = 721
};
/* Places in gdn_extension::functions of nativescript, whose type is 1. */
enum { GDN_EXT_NATIVESCRIPT = 1, GDN_REGISTER_CLASS = 0, GDN_REGISTER_METHOD = 2 };

typedef struct gdn_create {
  void* (*create)(gdn_object* instance, void* method_data);
  void* method_data;
  void (*free_data)(void*);
} gdn_create;
typedef struct gdn_destroy {
  void (*destroy)(gdn_object* instance, void* method_data, void* user_data);
  void* method_data;
  void (*free_data)(void*);
} gdn_destroy;
typedef struct gdn_method {
  gdn_variant (*method)(gdn_object* instance, void* method_data, void* user_data, int count, gdn_variant** arguments);
  void* method_data;
  void (*free_data)(void*);
} gdn_method;
typedef struct gdn_method_attributes {
  int rpc_type; /* 0: none */
} gdn_method_attributes;

typedef void (*gdn_register_class)(void* handle, const char* name, const char* base, gdn_create, gdn_destroy);
typedef void (*gdn_register_method)(void* handle, const char* class_name, const char* name, gdn_method_attributes,
                                    gdn_method);
typedef void (*gdn_take_reference)(gdn_reference*);             /* new, destroy */
typedef void (*gdn_resize)(gdn_reference*, int);                /* pool arrays */
typedef gdn_access* (*gdn_write)(gdn_reference*);               /* pool arrays */
typedef void* (*gdn_access_ptr)(const gdn_access*);             /* pool arrays */
typedef void (*gdn_access_end)(gdn_access*);                    /* pool arrays */
typedef void (*gdn_append)(gdn_reference*, const gdn_variant*); /* array */
typedef void (*gdn_variant_new_nil)(gdn_variant*);
typedef void (*gdn_variant_new_int)(gdn_variant*, int64_t);
typedef void (*gdn_variant_new_of)(gdn_variant*, const gdn_reference*);
typedef int64_t (*gdn_variant_as_int)(const gdn_variant*);
typedef double (*gdn_variant_as_real)(const gdn_variant*);
typedef gdn_reference (*gdn_variant_as_string)(const gdn_variant*);
typedef void (*gdn_variant_destroy)(gdn_variant*);
typedef gdn_reference (*gdn_string_utf8)(const gdn_reference*);
typedef const char* (*gdn_chars_data)(const gdn_reference*);
typedef gdn_reference (*gdn_string_of_utf8)(const char*);

#endif
