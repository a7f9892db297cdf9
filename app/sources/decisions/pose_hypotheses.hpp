// pose_hypotheses.hpp: which convention of the poses, scale of depth or camera explains how depth differs.
#pragma once
#include <vector>

#include "app/sources/decisions/compared_frames.hpp"

namespace roomradar {

/// Finds what explains best how the depth of nearby frames differs: the recording as it is, another
/// convention of the poses, scale of depth, camera, or place of the camera. Fills what DepthEvidence tells
/// about poses; uses another convention if that is clear; reports what cannot be right. See question_depth().
/// @param near_pairs  pairs of which three or more have poses
/// @param is_convention_given  the user has stated the convention of the poses, which is then kept
void question_poses(DecidedRecording& recording, const std::vector<FramePair>& near_pairs,
                    ComparedFrames& samples, bool is_convention_given);

}  // namespace roomradar
