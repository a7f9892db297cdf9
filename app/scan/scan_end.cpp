// scan_end.cpp: deletes or keeps checkpoints, and reports it.
#include "app/scan/scan_end.hpp"

#include <cmath>
#include <cstdio>

#include "app/cli/interrupt.hpp"
#include "app/cli/shell_line.hpp"
#include "app/scan/unfinished_scan.hpp"
#include "app/sources/recordings/spooled_source.hpp"

namespace roomradar {
namespace {

bool holds_frames(const std::filesystem::path& spool) {
  return !spool.empty() && SpooledSource::has_frames(spool);
}

/// Returns the beginning of a sentence.
std::string stopped_for_memory(const PrescanOptions& options, bool keep_frames) {
  return options.source + ": stopped by --max-memory " + std::to_string(std::llround(options.max_memory_mb)) +
         ": " +
         (keep_frames ? "its frames are kept, and the same command with --resume scans them again; " : "");
}

/// Returns the end of a sentence: the command with more memory, if frames are kept.
std::string with_more_memory(const PrescanOptions& options, bool keep_frames) {
  if (!keep_frames) return "";
  PrescanOptions unlimited = options;
  unlimited.line = without_option(options.line, "--max-memory");
  return ":\n  " + command_to_resume(unlimited);
}

}  // namespace

void say_at_once_how_to_resume(const PrescanOptions& options) {
  static std::string sentence;  // the signal handler reads it
  Interrupt::say_when_ended("");
  sentence = "\nroomradar: ended at once; this continues the scan:\n  " + command_to_resume(options) + "\n";
  Interrupt::say_when_ended(sentence.c_str());
}

void stop(const PrescanOptions& options, Checkpoints* checkpoints) {
  const bool resumable = checkpoints && checkpoints->has_any();
  throw StoppedByUser(options.map + ": stopped by Ctrl-C; no map was saved" +
                      (resumable
                           ? ", and the same command with --resume continues from the last checkpoint:\n  " +
                                 command_to_resume(options)
                           : ""));
}

void fail(const PrescanOptions& options, const std::string& fault, const ScanStart& start) {
  const bool is_kept = start.checkpoints && (start.checkpoints->has_any() || holds_frames(start.spool));
  if (!is_kept) {
    if (start.checkpoints) start.checkpoints->remove();  // an empty spool would block the name
    throw Error(fault);
  }
  throw Error(fault + "\nroomradar: what was scanned is kept in " + start.checkpoints->folder().string() +
              ": the same command with --resume continues from there; delete it to start again:\n  " +
              command_to_resume(options));
}

void finish(Checkpoints& checkpoints, bool keep_frames) {
  if (keep_frames)
    checkpoints.forget();
  else
    checkpoints.remove();
  if (checkpoints.failures() > 0)
    std::fprintf(stderr, "roomradar: %s: %lld checkpoints could not be written; is the disk full?\n",
                 checkpoints.folder().c_str(), static_cast<long long>(checkpoints.failures()));
}

void fail_to_extend(const PrescanOptions& options, bool keep_frames) {
  throw Error(
      stopped_for_memory(options, keep_frames) + options.map +
      " is unchanged, because the rest could not be added later; with more memory it is added completely" +
      with_more_memory(options, keep_frames));
}

void say_stopped_for_memory(const PrescanOptions& options, std::int64_t frames_fused, bool keep_frames) {
  throw Error(stopped_for_memory(options, keep_frames) + "the map of the " + std::to_string(frames_fused) +
              " fused frames is saved and complete; " +
              (keep_frames
                   ? "with more memory the rest is included"
                   : "with a coarser --resolution or more memory the rest is included, from the beginning") +
              with_more_memory(options, keep_frames));
}

}  // namespace roomradar
