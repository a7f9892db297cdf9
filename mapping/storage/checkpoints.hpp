// checkpoints.hpp: the state of long work on disk, so that work that was cut off can go on where it was.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roomradar {

/// A state that was read back: every file's size and checksum are right.
struct Checkpoint {
  std::string stage;             ///< as it was given to write()
  std::filesystem::path folder;  ///< holds the files that were written; only to be read
};

/// The folder of one unfinished piece of work: `work.json` (what the work is), `lock`, and the last two
/// checkpoints, each a folder that appears whole or not at all, and only once all that was written beside it
/// before (as a live scan's frames) is on the disk, too. A checkpoint is written by a forked child,
/// which sees the state as it was and lets the work go on; it dies with its parent. The folder comes into
/// being with the first checkpoint. One process at a time may have it.
class Checkpoints {
 public:
  /// Writes a state's files into `into`, an empty folder. `previous`, unless empty, is the checkpoint before:
  /// files that have not changed may be linked from there with carry_over(). Runs in a child process: what it
  /// changes in memory is lost.
  using WriteFiles =
      std::function<void(const std::filesystem::path& into, const std::filesystem::path& previous)>;

  /// @param folder    where checkpoints go
  /// @param identity  what the work is, by name: source, settings. Work of another identity cannot go on
  ///                  from a checkpoint.
  /// @param every_s   seconds between two checkpoints, at least
  Checkpoints(std::filesystem::path folder, std::map<std::string, std::string> identity, double every_s);
  /// Waits for a checkpoint that is being written. The folder stays, unless remove() was called or there is
  /// nothing in it to go on from.
  ~Checkpoints();
  Checkpoints(const Checkpoints&) = delete;
  Checkpoints& operator=(const Checkpoints&) = delete;

  /// The newest sound checkpoint in the folder. Damaged ones are passed over, and named in faults(). Nothing
  /// if there is none. Throws Error if the folder holds other work than `identity` says, naming the
  /// difference, or another process has it.
  std::optional<Checkpoint> resume();

  /// Throws Error if the folder holds other work than `identity` says, naming the difference.
  void require_same_work() const;

  /// Whether the time for a checkpoint has come and the last one is written.
  bool is_due();
  /// Whether it has come at the end of a stage, where a third of the time is enough; waits for the last one.
  bool is_due_at_end();
  /// Writes a checkpoint beside the work; takes some milliseconds itself. A failure (disk full) leaves the
  /// one before, is counted in failures(), and the first one is told.
  void write(const std::string& stage, const WriteFiles& write_files);
  /// Whether there is one to go on from, after the one that is being written.
  [[nodiscard]] bool has_any();
  /// The work is done: the folder goes.
  void remove();
  /// The work is to begin anew: the checkpoints go, and what their owner keeps beside them stays.
  void forget();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Makes the folder and takes its lock now, for whoever puts files of its own beside the checkpoints.
  void ensure_folder();
  /// One sentence for each damaged checkpoint that resume() passed over.
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }
  [[nodiscard]] std::int64_t failures() const { return failures_; }
  /// Whom to tell, in one sentence, as soon as a checkpoint could not be written; nobody by default.
  void tell_failure(std::function<void(const std::string& sentence)> tell) { tell_ = std::move(tell); }

 private:
  void take_lock();
  /// Since the last one was begun, or this object made.
  [[nodiscard]] double since_last_s() const;
  void note_written(bool is_written);
  void fail_to_write();
  void reap(bool wait);
  bool try_to_write(const std::string& stage, const WriteFiles& write_files) const;
  void write_numbered(std::int64_t number, const std::string& stage, const WriteFiles& write_files) const;
  [[nodiscard]] std::filesystem::path numbered(std::int64_t number) const;

  std::filesystem::path folder_;
  std::map<std::string, std::string> identity_;
  std::chrono::duration<double> every_s_;
  std::chrono::steady_clock::time_point last_start_;
  std::filesystem::file_time_type being_written_since_;
  std::filesystem::file_time_type on_disk_until_ = std::filesystem::file_time_type::min();
  std::int64_t last_number_ = 0;  ///< of the last whole checkpoint; 0: none
  int lock_ = -1;
  pid_t writer_ = -1;
  std::int64_t failures_ = 0;
  std::function<void(const std::string& sentence)> tell_;
  std::vector<std::string> faults_;
};

/// What such a folder is called while it is removed; one that a crash left behind is of no use.
std::filesystem::path done_beside(const std::filesystem::path& folder);

/// Throws Error if something of that name is there that is no such folder, or that holds anything but
/// checkpoints and `beside`, what else their owner keeps there: somebody else's, which must not be removed.
void require_checkpoints_only(const std::filesystem::path& folder, std::string_view beside);

/// What the work in such a folder is. Throws Error if its work.json is missing or damaged.
std::map<std::string, std::string> identity_of(const std::filesystem::path& folder);

/// Makes `to` the same file as `from` without copying it (by a hard link; a copy where links fail). False if
/// there is no such file.
bool carry_over(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace roomradar
