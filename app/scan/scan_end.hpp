// scan_end.hpp: keeps or deletes a scan's files at the end of the scan, and throws errors that state which
// files are kept.
#pragma once
#include <exception>
#include <new>
#include <string>

#include "app/cli/options/prescan_options.hpp"
#include "app/scan/controlled_source.hpp"
#include "app/scan/unfinished_scan.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

struct StoppedByUser : Error {
  using Error::Error;
};

/// Sets what a second Ctrl-C prints before it ends the process: the command that continues the scan.
void say_at_once_how_to_resume(const PrescanOptions& options);

/// Throws StoppedByUser, with the command that continues the scan.
/// @param checkpoints  may be null
[[noreturn]] void stop(const PrescanOptions& options, Checkpoints* checkpoints);

/// Throws Error with the fault and, if the scan can be resumed, the command that continues it.
[[noreturn]] void fail(const PrescanOptions& options, const std::string& fault, const ScanStart& start);

/// Calls act(), which scans or saves. Converts exceptions of act() to errors that state whether the scan can
/// be resumed. Deletes the checkpoints of a discarded scan.
template <typename Act>
auto or_say_what_is_kept(const PrescanOptions& options, const ScanStart& start, const Act& act) {
  try {
    return act();
  } catch (const StoppedByUser&) {
    throw;
  } catch (const ScanDiscarded&) {
    if (start.checkpoints) start.checkpoints->remove();
    throw;
  } catch (const std::bad_alloc&) {
    fail(options, "memory ran out; close other programs, or give --max-memory", start);
  } catch (const std::exception& error) {  // also those of libraries
    fail(options, error.what(), start);
  }
}

/// Deletes the checkpoints and, unless keep_frames, the stored frames of a live scan. Call after the map was
/// saved, or if it will not be saved.
void finish(Checkpoints& checkpoints, bool keep_frames);

/// Throws Error: a map that was to be extended is unchanged, because --max-memory stopped the scan.
[[noreturn]] void fail_to_extend(const PrescanOptions& options, bool keep_frames);
/// Throws Error: --max-memory stopped the scan, and the map of the frames so far is saved.
[[noreturn]] void say_stopped_for_memory(const PrescanOptions& options, std::int64_t frames_fused,
                                         bool keep_frames);

}  // namespace roomradar
