// radar_bench_objects.hpp: many virtual objects, each of which is scene for the others.
#pragma once
#include "radar_bench_rows.hpp"

namespace roomradar::bench {

/// Median over frames of the time in which `count` objects (cubes, tori, cups; all moved since the frame
/// before) ask once each how far they may go among the others and the depth frame; some answers are judged.
Row measure_objects(const FrameScene& frame, int count, int radar_px, RadarMode mode);
/// The same by one call of the GL radar, the depth frame uploaded as a mesh.
Row measure_objects_gl(GlContext& context, const FrameScene& frame, int count, int radar_px);

}  // namespace roomradar::bench
