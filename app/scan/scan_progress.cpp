// scan_progress.cpp: titles and totals of the stages.
#include "app/scan/scan_progress.hpp"

#include <algorithm>
#include <cstdio>

#include "app/cli/interrupt.hpp"
#include "app/scan/controlled_source.hpp"
#include "app/scan/scan_end.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/revision/ghosts.hpp"

namespace roomradar {
namespace {

constexpr const char* kSearched = "searched";  // the note of each frame in which ghosts are searched

std::optional<std::int64_t> most_fused(std::optional<std::int64_t> frames, const PrescanConfig& config) {
  if (!frames) return std::nullopt;
  const std::int64_t every = (*frames + config.fuse_every - 1) / config.fuse_every;
  return config.max_fused_frames > 0 ? std::min(every, std::int64_t{config.max_fused_frames}) : every;
}

}  // namespace

void ScanProgress::show(const std::string& stage, const std::string& note) {
  if (stage_.empty() && start_.checkpoints)  // the checkpoints have been read
    for (const std::string& fault : start_.checkpoints->faults())
      std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  if (stage == "surface" || stage == "texture") {
    show_in_window(stage);
    progress_.reset();
    std::fprintf(stderr, "%s\n",
                 stage == "texture"
                     ? "texture: is baked from the best frames"
                     : "surface: is extracted; then what the scan missed is listed, and the map is saved");
    return;
  }
  const bool is_again = stage == "ghosts" && note != kSearched;
  if (const std::string title = is_again ? "fuse again" : stage; title != stage_) begin(title);
  if (stage == "fuse" && note == to_string(FuseStatus::kFused)) ++fused_;
  progress_->step(is_again && fused_ > 0 ? note + ", of at most " + std::to_string(fused_) : note);
  if (!is_tracking(stage)) show_in_window(stage_);
  const bool ends_by_itself = start_.is_live && is_tracking(stage);
  if (is_stopping_) stop(options_, start_.checkpoints.get());
  is_stopping_ = !ends_by_itself && Interrupt::take();
  if (is_stopping_ && start_.checkpoints) start_.checkpoints->write_soon();
}

/// Returns the number of frames of a stage. Of frames to fuse, the number is an upper limit. The search for
/// ghosts looks at evenly spaced fused frames; after a resumed scan their number is not known here.
std::optional<std::int64_t> ScanProgress::total_of(const std::string& stage) const {
  if (stage == "fuse again" || (stage == "ghosts" && fused_ == 0)) return std::nullopt;
  if (stage == "fuse") return most_fused(start_.source->frame_count(), config_);
  if (stage != "ghosts") return start_.source->frame_count();
  const std::int64_t stride = look_stride(fused_, GhostConfig{});
  return (fused_ + stride - 1) / stride;
}

void ScanProgress::show_in_window(const std::string& stage) {
  if (!window_.channel) return;
  throw_if_discarded(*window_.channel);
  window_.view.reset();  // the first pass is over
  const bool has_frames = stage != "surface" && stage != "texture";
  window_.channel->set_stage({stage, has_frames ? ++shown_ : 0, has_frames ? total_of(stage) : std::nullopt});
}

void ScanProgress::begin(const std::string& stage) {
  progress_.reset();
  shown_ = 0;
  progress_ = std::make_unique<Progress>(stage, total_of(stage));
  stage_ = stage;
  if (!is_tracking(stage)) Interrupt::say(kStopsWithoutMap);
}

}  // namespace roomradar
