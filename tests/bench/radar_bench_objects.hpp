// radar_bench_objects.hpp: many virtual objects, each of them scene for the others.
#pragma once
#include "radar_bench_rows.hpp"

namespace roomradar::bench {

/// Measures `count` objects (cubes, tori, cups; all moved since the previous frame). Each queries once its
/// distance to contact with the others and the depth frame. Returns the median over frames of the total time;
/// some results are checked against the exact reference.
Row measure_objects(const FrameScene& frame, int count, int radar_px, RadarMode mode);
/// The same by one call of the GL radar; the depth frame is uploaded as a mesh.
Row measure_objects_gl(GlContext& context, const FrameScene& frame, int count, int radar_px);

}  // namespace roomradar::bench
