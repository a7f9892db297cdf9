// depth_evidence.hpp: whether unit, cameras and poses of a recording agree with its depth.
#pragma once
#include "app/sources/decisions/decide.hpp"

namespace roomradar {

/// Compares the depth of nearby frames, in a dozen places of the recording, with each other. Fills
/// DecidedRecording::evidence, and reports what cannot be right:
/// - poses under which depth does not agree. If it agrees under another convention (inverse, OpenGL's axes,
///   w x y z, mm, cm, one frame early or late), that one is used, else the poses are not used at all. A
///   convention that the user has stated is kept
/// - a unit of depth that a full image's median depth, the sensor's range or the poses contradict
/// - a focal length under which depth agrees much less than under one 10 to 40 % longer or shorter
/// @param is_convention_given  the user has stated the convention of the poses
void question_depth(DecidedRecording& recording, bool is_convention_given);

}  // namespace roomradar
