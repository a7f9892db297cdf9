/* c_program.c: a program in C99: runs a recording in a saved map, and drops an object that rests on what is
 * really there. Prints where it lies.
 *
 * usage: c_program MAP RECORDING COPY    COPY: folder for a map that it saves */
#include <math.h>
#include <roomradar.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define REQUIRE(condition)                                                               \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      fprintf(stderr, "%s:%d: not so: %s; last error: %s\n", __FILE__, __LINE__, #condition, \
              roomradar_last_error());                                                   \
      exit(1);                                                                           \
    }                                                                                    \
  } while (0)
#define OK(call) REQUIRE((call) == ROOMRADAR_OK)

/* Fetches every block's mesh, with room for the largest. Returns the number of triangles. */
static uint64_t fetch_blocks(roomradar_session* session, int32_t axes) {
  size_t count = 0, i;
  uint64_t triangles = 0;
  roomradar_block* blocks;
  REQUIRE(roomradar_session_blocks(session, NULL, 0, &count) == ROOMRADAR_BUFFER_TOO_SMALL);
  REQUIRE(count > 0);
  blocks = malloc(count * sizeof *blocks);
  OK(roomradar_session_blocks(session, blocks, count, &count));
  for (i = 0; i < count; ++i) {
    roomradar_mesh_buffers mesh;
    size_t v;
    memset(&mesh, 0, sizeof mesh);
    mesh.struct_size = sizeof mesh;
    mesh.axes = axes;
    REQUIRE(roomradar_session_block_mesh(session, blocks[i].id, &mesh) == ROOMRADAR_BUFFER_TOO_SMALL);
    REQUIRE(mesh.vertex_count == blocks[i].vertex_count && mesh.triangle_count == blocks[i].triangle_count);
    mesh.vertex_capacity = mesh.vertex_count;
    mesh.triangle_capacity = mesh.triangle_count;
    mesh.vertices = malloc(mesh.vertex_capacity * 3 * sizeof(float));
    mesh.normals = malloc(mesh.vertex_capacity * 3 * sizeof(float));
    mesh.colours_rgb = malloc(mesh.vertex_capacity * 3);
    mesh.triangles = malloc(mesh.triangle_capacity * 3 * sizeof(uint32_t));
    OK(roomradar_session_block_mesh(session, blocks[i].id, &mesh));
    REQUIRE(mesh.version == 1 && blocks[i].version == 1);
    for (v = 0; v < mesh.vertex_count; ++v) {
      double p[3], p_world[3];
      int axis;
      for (axis = 0; axis < 3; ++axis) p[axis] = mesh.origin[axis] + mesh.vertices[3 * v + (size_t)axis];
      OK(roomradar_points_from_engine(axes, p, p_world, 1));
      for (axis = 0; axis < 3; ++axis) {
        REQUIRE(p_world[axis] > blocks[i].min_world_m[axis] - 1e-4);
        REQUIRE(p_world[axis] < blocks[i].max_world_m[axis] + 1e-4);
      }
    }
    for (v = 0; v < 3 * mesh.triangle_count; ++v) REQUIRE(mesh.triangles[v] < mesh.vertex_count);
    triangles += mesh.triangle_count;
    free(mesh.vertices);
    free(mesh.normals);
    free(mesh.colours_rgb);
    free(mesh.triangles);
  }
  free(blocks);
  return triangles;
}

/* Asks the radar how far a small box falls from above a point, in the session's scene and in the map's alone. */
static void query(const roomradar_map* map, roomradar_session* session, const double* from_world) {
  static const float corners[] = {-0.02F, -0.02F, -0.02F, 0.02F, -0.02F, -0.02F, 0.02F, 0.02F, -0.02F,
                                  -0.02F, 0.02F,  -0.02F, -0.02F, -0.02F, 0.02F, 0.02F, -0.02F, 0.02F,
                                  0.02F,  0.02F,  0.02F,  -0.02F, 0.02F, 0.02F};
  static const uint32_t faces[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                   1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  roomradar_mesh mesh;
  roomradar_shape *box = NULL, *room = NULL;
  roomradar_radar* radar = NULL;
  roomradar_placed_shape placed;
  roomradar_query down;
  roomradar_contact in_map, in_session;
  memset(&mesh, 0, sizeof mesh);
  mesh.struct_size = sizeof mesh;
  mesh.vertices_m = corners;
  mesh.vertex_count = 8;
  mesh.triangles = faces;
  mesh.triangle_count = 12;
  OK(roomradar_shape_open(&mesh, &box));
  OK(roomradar_map_shape(map, &room));
  OK(roomradar_radar_open(NULL, &radar));
  memset(&placed, 0, sizeof placed);
  placed.shape = room;
  placed.kind = ROOMRADAR_SURFACE_STATIC;
  placed.T_world_shape.m[0] = placed.T_world_shape.m[5] = placed.T_world_shape.m[10] =
      placed.T_world_shape.m[15] = 1.0;
  OK(roomradar_radar_set_scene(radar, &placed, 1));
  OK(roomradar_shape_close(room)); /* the scene keeps it */
  memset(&down, 0, sizeof down);
  down.T_world_object = placed.T_world_shape;
  down.T_world_object.m[3] = from_world[0];
  down.T_world_object.m[7] = from_world[1];
  down.T_world_object.m[11] = from_world[2] + 0.5;
  down.direction_world[2] = -1.0;
  down.distance_m = 10.0;
  OK(roomradar_radar_query(radar, box, &down, &in_map));
  OK(roomradar_session_query_shape(session, box, &down, 1, &in_session));
  REQUIRE(in_map.status == ROOMRADAR_CONTACT_TOUCHES && in_map.kind == ROOMRADAR_SURFACE_STATIC);
  REQUIRE(in_session.status == ROOMRADAR_CONTACT_TOUCHES && in_session.kind == ROOMRADAR_SURFACE_OBJECT);
  REQUIRE(in_session.travel_m < in_map.travel_m);
  REQUIRE(in_map.normal_world[2] > 0.9);
  printf("a box falls %.4f m onto the pot, %.4f m without it\n", in_session.travel_m, in_map.travel_m);
  OK(roomradar_radar_close(radar));
  OK(roomradar_shape_close(box));
}

int main(int argc, char** argv) {
  roomradar_map* map = NULL;
  roomradar_source* source = NULL;
  roomradar_session* session = NULL;
  roomradar_session_options options;
  roomradar_map_info info;
  roomradar_frame frame;
  roomradar_frame_result result;
  roomradar_object_state pot;
  roomradar_status status;
  uint8_t *picture = NULL, *mask = NULL;
  float* depth_m = NULL;
  size_t needed = 0, pixels = 0, i;
  int32_t width_px = 0, height_px = 0;
  int frames = 0, located = 0;
  roomradar_camera camera;
  if (argc != 4) {
    fprintf(stderr, "usage: c_program MAP RECORDING COPY\n");
    return 2;
  }

  OK(roomradar_map_open(argv[1], &map));
  memset(&info, 0, sizeof info);
  info.struct_size = sizeof info;
  OK(roomradar_map_describe(map, &info));
  REQUIRE(info.triangles > 100 && info.max_world_m[0] > info.min_world_m[0]);
  OK(roomradar_source_open(argv[2], &source));
  REQUIRE(roomradar_source_input(source) && roomradar_source_input(source)[0] == '[');
  REQUIRE(roomradar_source_input(NULL) == NULL);
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.poses = ROOMRADAR_POSES_RECORDED;
  options.watches_changes = 1;
  OK(roomradar_session_open(map, &options, &session));
  OK(roomradar_session_add_file(session, "object", "teapot", 0.0, NULL));
  OK(roomradar_session_drop(session, "object", NULL, 0.3));
  REQUIRE(roomradar_session_picture(session, NULL, 0, &needed, NULL, NULL) == ROOMRADAR_OK && needed == 0);

  memset(&frame, 0, sizeof frame);
  frame.struct_size = sizeof frame;
  memset(&result, 0, sizeof result);
  result.struct_size = sizeof result;
  while ((status = roomradar_source_next(source, &frame)) != ROOMRADAR_END) {
    if (status == ROOMRADAR_SKIPPED) continue;
    REQUIRE(status == ROOMRADAR_OK);
    OK(roomradar_session_step(session, &frame, &result));
    ++frames;
    located += result.is_located;
    OK(roomradar_session_object(session, "object", &pot));
    printf("frame %ld object %.17g %.17g %.17g\n", (long)frame.index, pot.T_world_object.m[3],
           pot.T_world_object.m[7], pot.T_world_object.m[11]);
  }
  REQUIRE(frames > 0 && located == frames);
  REQUIRE(pot.is_in_room && pot.mass_kg > 0.0);

  REQUIRE(roomradar_session_picture(session, NULL, 0, &needed, &width_px, &height_px) ==
          ROOMRADAR_BUFFER_TOO_SMALL);
  REQUIRE(needed == (size_t)width_px * (size_t)height_px * 3);
  picture = malloc(needed);
  OK(roomradar_session_picture(session, picture, needed, &needed, &width_px, &height_px));
  REQUIRE(roomradar_session_expected_depth(session, NULL, 0, &pixels, &camera) == ROOMRADAR_BUFFER_TOO_SMALL);
  depth_m = malloc(pixels * sizeof *depth_m);
  mask = malloc(pixels);
  OK(roomradar_session_expected_depth(session, depth_m, pixels, &pixels, &camera));
  REQUIRE(pixels == (size_t)camera.width_px * (size_t)camera.height_px);
  OK(roomradar_session_moved_mask(session, mask, pixels, &pixels, NULL, NULL));
  for (needed = 0, i = 0; i < pixels; ++i) needed += depth_m[i] > 0.0F && isfinite(depth_m[i]);
  printf("%zu of %zu pixels show the room\n", needed, pixels);
  REQUIRE(needed > pixels / 4);
  OK(roomradar_session_view(session, &camera, &frame.T_world_camera));

  REQUIRE(fetch_blocks(session, ROOMRADAR_AXES_WORLD) == info.triangles);
  REQUIRE(fetch_blocks(session, ROOMRADAR_AXES_UNREAL) == info.triangles);
  {
    double at[3] = {0.0, 0.0, 0.0};
    at[0] = pot.T_world_object.m[3];
    at[1] = pot.T_world_object.m[7];
    at[2] = pot.T_world_object.m[11];
    query(map, session, at);
  }
  {
    roomradar_map* copy = NULL;
    OK(roomradar_session_save(session, argv[3]));
    OK(roomradar_map_open(argv[3], &copy));
    OK(roomradar_map_close(copy));
  }
  OK(roomradar_map_close(map)); /* the session keeps what it needs */
  OK(roomradar_source_close(source));
  OK(roomradar_session_remove(session, "object"));
  OK(roomradar_session_close(session));
  REQUIRE(roomradar_session_step(session, &frame, NULL) == ROOMRADAR_CLOSED_HANDLE);
  printf("%s\n%d frames\n", roomradar_last_error(), frames);
  free(picture);
  free(depth_m);
  free(mask);
  return 0;
}
