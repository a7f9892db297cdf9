// tile_shaders.hpp: GLSL that draws triangles into tiles (regions of a texture) with guaranteed bounds of
// coverage and depth.
#pragma once

namespace roomradar {

// For every triangle, the geometry shader emits the rectangle of its tile's pixels that the triangle may
// touch. The fragment shader computes coverage and depth of each pixel from the triangle's three vertices.
// The results do not depend on the driver's vertex snapping or depth interpolation, so all renderers agree
// within the guaranteed bounds. The bounds include all float errors, beginning with that of the matrix-vertex
// product. GL_MIN blending combines the fragments of a pixel, so the passes need no depth buffer and no
// drawing order.
//
// A tile's coordinates are its query's outline coordinates (RadarOutline): x and y in pixels, z in metres
// along the motion. The sample line of a pixel is the line along z through its sample position (kSample).
// kNothing marks pixels without a fragment.
//
// Object tiles, by colour channel (z is along the motion):
//   r: -z, where z is an upper bound of the object's foremost point in the pixel's square
//   g: -z, where z is a lower bound of the foremost surface on the sample line
//   b:  z, a lower bound of the rearmost point in the square
//   a: -z, where z is an upper bound of the foremost surface that faces against the motion (or is edge-on)
//      and may be within two rounding errors of the sample line. g and a enclose the front slab: the object's
//      solid between its front and that rear surface.
// Scene tiles, by colour channel:
//   r: lower bound of the distance to contact with any surface in the square
//   g: upper bound of the distance to contact with a surface that certainly crosses the sample line
//   b: distance to contact on the sample line; negative for an overlap

/// First piece of every shader in this file.
inline constexpr const char* kTilePreamble = R"(#version 450 core
const float kNothing = 3e38, kAnything = 1e38;  // kNothing: clear value; values below kAnything are results
const vec2 kSample = vec2(0.5 + 1.0 / 64.0, 0.5 + 1.0 / 97.0);  // sample position in a pixel; off centre, because edges often pass through the exact centre
// Data passed from the vertex shader to the geometry shader.
#define TILE_VERTEX Vertex { vec3 p; vec3 error; ivec4 corners; ivec4 item; vec4 limits_m; float margin; }
)";

/// Transforms vertices to outline coordinates, and computes bounds of their rounding errors.
inline constexpr const char* kTileVertexShader = R"(layout(location = 0) in vec3 p_local;
layout(location = 1) in vec4 outline_x;  // rows of the matrix from mesh to outline coordinates: x and y in pixels, z in m
layout(location = 2) in vec4 outline_y;
layout(location = 3) in vec4 outline_z;
layout(location = 4) in ivec4 corners;  // tile corners: x, y in the object atlas, x, y in the scene's
layout(location = 5) in ivec4 item;     // width_px, height_px, query, first key
layout(location = 6) in vec4 limits_m;  // TileQuery::far_m, touching_m, tolerance_m, length_m
layout(location = 7) in vec4 margin_px;  // x: TileQuery::margin_px; y, z, w: unused
out TILE_VERTEX to;
void main() {
  const float kRounding = 4.2e-7;  // 7 x 2^-24: rounded rows, three products, three sums
  to.p = vec3(dot(outline_x.xyz, p_local) + outline_x.w, dot(outline_y.xyz, p_local) + outline_y.w,
              dot(outline_z.xyz, p_local) + outline_z.w);
  vec3 q = abs(p_local);
  to.error = kRounding * vec3(dot(abs(outline_x.xyz), q) + abs(outline_x.w),
                              dot(abs(outline_y.xyz), q) + abs(outline_y.w),
                              dot(abs(outline_z.xyz), q) + abs(outline_z.w));
  to.corners = corners;
  to.item = item;
  to.limits_m = limits_m;
  to.margin = margin_px.x;
}
)";

/// Computes a triangle's coverage of a pixel and its depth range there, from the vertices and their errors
/// only.
inline constexpr const char* kSpanSource = R"(
struct Span {
  bool in_square;  // may touch the pixel's square
  bool is_near;    // may touch the sample line; if true, a point of the triangle is within 2 errors of the line
  bool is_around;  // may touch a line within 2 errors of the sample line
  bool is_across;  // certainly crosses every line within `margin` of the sample line
  int facing;      // 1: along the motion, -1: against it, 0: edge-on or unknown
  float square_min, square_max;  // guaranteed bounds of z in the square
  float line_min, line_max;      // guaranteed bounds of z within 3 errors and `margin` of the sample line
  float line;                    // z on the sample line
};

/// a, b, c: vertices; error: of each vertex, per axis; p: sample position. Not split up, because all bounds
/// are computed from the same edges and plane.
Span span_of(vec3 a, vec3 b, vec3 c, vec3 error, float margin, vec2 p) {
  const float kRounding = 6e-7;  // 10 x 2^-24, more than any sum of products here needs
  Span s;
  float z_min = min(a.z, min(b.z, c.z)), z_max = max(a.z, max(b.z, c.z));
  s.square_min = s.line_min = z_min - error.z;
  s.square_max = s.line_max = z_max + error.z;
  s.line = 0.5 * (z_min + z_max);
  s.facing = 0;
  if (!(error.x < 1e20 && error.y < 1e20 && error.z < 1e20)) {  // beyond float precision
    s.in_square = s.is_near = s.is_around = true;
    s.is_across = false;
    s.square_min = s.line_min = -3e37;
    s.square_max = s.line_max = 3e37;
    return s;
  }
  vec3 ab = b - a, ac = c - a, bc = c - b;
  vec3 n = cross(ab, ac);
  vec3 n_error = kRounding * (abs(ab.yzx * ac.zxy) + abs(ab.zxy * ac.yzx));

  // Separating axes: pixel and triangle overlap if their projections on all axes do. The two pixel axes:
  vec2 below = min(a.xy, min(b.xy, c.xy)) - p, above = max(a.xy, max(b.xy, c.xy)) - p;
  vec2 reach = kSample + error.xy;
  s.in_square = all(lessThanEqual(below, reach)) && all(greaterThanEqual(above, -reach));
  s.is_near = all(lessThanEqual(below, error.xy)) && all(greaterThanEqual(above, -error.xy));
  s.is_around = all(lessThanEqual(below, 3.0 * error.xy)) && all(greaterThanEqual(above, -3.0 * error.xy));
  s.is_across = true;
  // The three axes across the edges; the third vertex is at +-n.z from its opposite edge.
  for (int i = 0; i < 3; ++i) {
    vec2 edge = i == 0 ? ab.xy : i == 1 ? bc.xy : -ac.xy;
    vec2 start = p - (i == 0 ? a.xy : i == 1 ? b.xy : c.xy);
    vec2 across = vec2(-edge.y, edge.x);
    float at = dot(across, start);  // signed distance of the sample from the edge, times the edge's length
    float slack = kRounding * dot(abs(across), abs(start)) + n_error.z;
    float near_reach = dot(abs(across), error.xy) + slack;
    float around_reach = 3.0 * near_reach;
    float across_reach = near_reach + margin * (abs(across.x) + abs(across.y));
    float square_reach = dot(abs(across), reach) + slack;
    float low = min(0.0, n.z), high = max(0.0, n.z);
    s.in_square = s.in_square && at >= low - square_reach && at <= high + square_reach;
    s.is_near = s.is_near && at >= low - near_reach && at <= high + near_reach;
    s.is_around = s.is_around && at >= low - around_reach && at <= high + around_reach;
    s.is_across = s.is_across && (n.z > 0.0 ? at : -at) > across_reach;
  }

  // The plane's depth, unless the triangle is so nearly edge-on that rounding decides its slope.
  if (!(abs(n.z) > 8.0 * n_error.z)) {
    s.is_across = false;
    return s;
  }
  s.facing = n.z > 0.0 ? 1 : -1;
  vec2 slope = -n.xy / n.z;
  vec2 slope_error = 1.2 * (n_error.xy + abs(slope) * n_error.z) / abs(n.z) + kRounding * abs(slope);
  vec2 off = p - a.xy;
  float z = a.z + dot(slope, off);
  float z_error = error.z + dot(slope_error, abs(off)) + kRounding * (abs(a.z) + dot(abs(slope), abs(off)));
  vec2 steepest = abs(slope) + slope_error;
  float line_span = dot(steepest, 3.0 * error.xy + margin) + z_error;
  float square_span = dot(steepest, reach) + z_error;
  s.square_min = max(s.square_min, z - square_span);
  s.square_max = min(s.square_max, z + square_span);
  s.line_min = max(s.line_min, z - line_span);
  s.line_max = min(s.line_max, z + line_span);
  s.line = clamp(z, z_min, z_max);
  return s;
}
)";

inline constexpr const char* kTileGeometryInputs = R"(layout(triangles) in;
in TILE_VERTEX from[];
)";

/// Emits the rectangle of pixels that a triangle may touch.
inline constexpr const char* kTileGeometryShader = R"(
layout(triangle_strip, max_vertices = 4) out;
layout(location = 0) uniform vec2 pixel_ndc;  // 2 / atlas size in pixels
layout(location = 1) uniform int which;       // 0: object tiles, 1: scene tiles
out Corner {
  flat vec3 a, b, c, error;
  flat ivec4 corners;
  flat vec4 limits_m;
  flat float margin;
} to;
void main() {
  vec3 a = from[0].p, b = from[1].p, c = from[2].p;
  vec3 error = max(from[0].error, max(from[1].error, from[2].error));
  vec4 limits_m = from[0].limits_m;
  vec2 size = vec2(from[0].item.xy);
  vec2 first = vec2(0.0), last = size - 1.0;
  if (error.x < 1e20 && error.y < 1e20 && error.z < 1e20) {
    if (min(a.z, min(b.z, c.z)) - error.z > limits_m.x) return;
    if (max(a.z, max(b.z, c.z)) + error.z < -limits_m.w - limits_m.y) return;
    vec2 low = min(a.xy, min(b.xy, c.xy)) - error.xy, high = max(a.xy, max(b.xy, c.xy)) + error.xy;
    first = max(first, ceil(low) - 1.0);  // a corner on the line between two pixels touches both
    last = min(last, floor(high));
    if (first.x > last.x || first.y > last.y) return;
  }
  vec2 corner = vec2(which == 0 ? from[0].corners.xy : from[0].corners.zw);
  for (int i = 0; i < 4; ++i) {
    vec2 at = corner + vec2((i & 1) != 0 ? last.x + 1.0 : first.x, (i & 2) != 0 ? last.y + 1.0 : first.y);
    gl_Position = vec4(at * pixel_ndc - 1.0, 0.0, 1.0);
    to.a = a;
    to.b = b;
    to.c = c;
    to.error = error;
    to.corners = from[0].corners;
    to.limits_m = limits_m;
    to.margin = from[0].margin;
    EmitVertex();
  }
}
)";

inline constexpr const char* kTileFragmentInputs = R"(
in Corner {
  flat vec3 a, b, c, error;
  flat ivec4 corners;
  flat vec4 limits_m;
  flat float margin;
} from;
layout(location = 0) out vec4 least;
)";

/// Writes an object tile, see the channels above.
inline constexpr const char* kObjectTileShader = R"(
void main() {
  vec2 p = floor(gl_FragCoord.xy) - vec2(from.corners.xy) + kSample;
  Span s = span_of(from.a, from.b, from.c, from.error, 0.0, p);
  if (!s.in_square) discard;
  least = vec4(-s.square_max, s.is_near ? -s.line_min : kNothing, s.square_min,
               s.is_around && s.facing <= 0 ? -s.line_max : kNothing);
}
)";

/// Compares a scene surface with the object in one pixel. A surface behind the object's front is ignored
/// unless it is certainly inside the front slab; see GlRadar.
inline constexpr const char* kGapSource = R"(
bool is_in_the_way(Span s, vec4 object, vec4 limits_m, out float gap_m) {
  gap_m = s.line + object.g;
  if (!s.is_across || object.g > kAnything) return false;
  if (gap_m >= -limits_m.y) return true;
  return s.facing < 0 && gap_m >= -limits_m.z && s.line_max + object.g < 0.0 && s.line_min > -object.a;
}
)";

/// Writes a scene tile, see the channels above.
inline constexpr const char* kSceneTileShader = R"(
layout(binding = 0) uniform sampler2D object_tiles;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) - from.corners.zw;
  vec4 object = texelFetch(object_tiles, from.corners.xy + at, 0);
  if (object.r > kAnything) discard;
  Span s = span_of(from.a, from.b, from.c, from.error, from.margin, vec2(at) + kSample);
  if (!s.in_square || s.square_max < object.b) discard;
  float gap_m;
  bool is_met = is_in_the_way(s, object, from.limits_m, gap_m);
  least = vec4(max(s.square_min + object.r, 0.0), is_met && gap_m >= -from.limits_m.y ? max(s.line_max + object.g, 0.0) : kNothing,
               is_met ? gap_m : kNothing, kNothing);
}
)";

/// Computes the minimum over each scene tile, one work group per tile. If several pixels are equally near,
/// chooses the one nearest to the centre of their bounding box.
inline constexpr const char* kLeastShader = R"(layout(local_size_x = 128) in;
struct Query { ivec4 corners; ivec4 item; vec4 limits_m; vec4 margin_px; };
struct Result { uint stamp; float lower_m, upper_m, travel_m; int x, y; uint key, unused; };
layout(binding = 0) uniform sampler2D scene_tiles;
layout(std430, binding = 0) readonly buffer Queries { Query queries[]; };
layout(std430, binding = 1) writeonly buffer Results { Result results[]; };
layout(location = 0) uniform uint stamp;
shared uint lower, upper, travel, least_off, least_at;
shared int x_min, x_max, y_min, y_max;
uint ordered(float f) { uint b = floatBitsToUint(f); return (b >> 31) != 0u ? ~b : b | 0x80000000u; }
float value(uint o) { return uintBitsToFloat((o >> 31) != 0u ? o & 0x7fffffffu : ~o); }
void main() {
  Query query = queries[gl_WorkGroupID.x];
  int width = query.item.x, count = query.item.x * query.item.y, thread = int(gl_LocalInvocationID.x);
  ivec2 corner = query.corners.zw;
  if (thread == 0) {
    lower = upper = travel = ordered(kNothing);
    least_off = least_at = 0xffffffffu;
    x_min = y_min = 0x7fffffff;
    x_max = y_max = -1;
  }
  barrier();
  vec3 least = vec3(kNothing);
  for (int i = thread; i < count; i += 128) {
    least = min(least, texelFetch(scene_tiles, corner + ivec2(i % width, i / width), 0).rgb);
  }
  atomicMin(lower, ordered(least.r));
  atomicMin(upper, ordered(least.g));
  atomicMin(travel, ordered(least.b));
  barrier();
  float equal_m = value(travel) + query.limits_m.y;
  bool is_met = value(travel) < kAnything;
  if (is_met) {
    for (int i = thread; i < count; i += 128) {
      ivec2 at = ivec2(i % width, i / width);
      if (texelFetch(scene_tiles, corner + at, 0).b > equal_m) continue;
      atomicMin(x_min, at.x);
      atomicMax(x_max, at.x);
      atomicMin(y_min, at.y);
      atomicMax(y_max, at.y);
    }
  }
  barrier();
  ivec2 middle2 = ivec2(x_min + x_max, y_min + y_max);
  if (is_met) {
    for (int i = thread; i < count; i += 128) {
      ivec2 at = ivec2(i % width, i / width), off = 2 * at - middle2;
      if (texelFetch(scene_tiles, corner + at, 0).b <= equal_m) atomicMin(least_off, uint(off.x * off.x + off.y * off.y));
    }
  }
  barrier();
  if (is_met) {
    for (int i = thread; i < count; i += 128) {
      ivec2 at = ivec2(i % width, i / width), off = 2 * at - middle2;
      if (uint(off.x * off.x + off.y * off.y) == least_off && texelFetch(scene_tiles, corner + at, 0).b <= equal_m) {
        atomicMin(least_at, uint(i));
      }
    }
  }
  barrier();
  if (thread != 0) return;
  ivec2 at = is_met ? ivec2(int(least_at) % width, int(least_at) / width) : ivec2(-1);
  results[query.item.z] = Result(stamp, value(lower), value(upper), value(travel), at.x, at.y, 0xffffffffu, 0u);
}
)";

/// Finds the triangle touched at the pixel that kLeastShader chose. If several triangles are touched in that
/// pixel, chooses the one with the least key.
inline constexpr const char* kWhichShader = R"(
layout(points, max_vertices = 1) out;
struct Result { uint stamp; float lower_m, upper_m, travel_m; int x, y; uint key, unused; };
layout(std430, binding = 1) buffer Results { Result results[]; };
layout(binding = 0) uniform sampler2D object_tiles;
void main() {
  int query = from[0].item.z;
  ivec2 at = ivec2(results[query].x, results[query].y);
  if (at.x < 0) return;
  vec2 p = vec2(at) + kSample;
  vec3 error = max(from[0].error, max(from[1].error, from[2].error));
  Span s = span_of(from[0].p, from[1].p, from[2].p, error, from[0].margin, p);
  float gap_m;
  vec4 object = texelFetch(object_tiles, from[0].corners.xy + at, 0);
  if (!is_in_the_way(s, object, from[0].limits_m, gap_m)) return;
  if (abs(gap_m - results[query].travel_m) > from[0].limits_m.y) return;
  atomicMin(results[query].key, uint(from[0].item.w) + uint(gl_PrimitiveIDIn));
}
)";

/// Overwrites an object tile with kNothing before it is redrawn.
inline constexpr const char* kClearVertexShader = R"(layout(location = 4) in ivec4 corners;
layout(location = 5) in ivec4 item;
layout(location = 0) uniform vec2 pixel_ndc;
void main() {
  vec2 at = vec2(corners.xy) + vec2(gl_VertexID & 1, gl_VertexID >> 1) * vec2(item.xy);
  gl_Position = vec4(at * pixel_ndc - 1.0, 0.0, 1.0);
}
)";
inline constexpr const char* kClearFragmentShader = R"(layout(location = 0) out vec4 cleared;
void main() { cleared = vec4(kNothing); }
)";

}  // namespace roomradar
