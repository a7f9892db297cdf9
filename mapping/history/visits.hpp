// visits.hpp: earlier revisions of a folder's files, and what made each.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roomradar {

inline constexpr const char* kVisitsLog = "visits.jsonl";   ///< a line of JSON per revision
inline constexpr const char* kVisitsBlocks = "visits.bin";  ///< a BlockStore; see visits.cpp

/// Place in which a visit changed the room.
struct VisitChange {
  std::string kind;               ///< such as "appeared" or "vanished"
  Eigen::AlignedBox3d box_world;  ///< bounds of the surface that was seen
};

/// What made a revision.
struct VisitNote {
  std::string made_by;  ///< the command, such as "prescan --resume"
  std::string source;   ///< recording or device; no path
  std::vector<VisitChange> changes;
};

/// Returns the last part of a path; a source that is no path, such as "sim:table?seed=1", as it is.
std::string without_folders(const std::string& source);

/// A file of a revision.
struct RevisionFile {
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits
  /// SHA-256 of the root of its blocks (BlockTree), 32 bytes. Empty: the file is that of the next revision,
  /// or for the latest revision that of the folder.
  std::string root;
};
using RevisionFiles = std::map<std::string, RevisionFile>;  ///< by name

/// A revision of the folder, and what made it.
struct Visit {
  int revision = 0;     ///< from 1
  std::string made_at;  ///< in UTC, such as 2026-12-01T15:44:59Z
  VisitNote note;
  RevisionFiles files;  ///< of the latest revision: empty
};

/// Returns the time now, or that of the environment variable SOURCE_DATE_EPOCH (seconds since 1970), as
/// Visit::made_at.
std::string time_of_visit();

/// Holds the right to write revisions of a folder. The destructor gives it back.
class VisitsLock {
 public:
  VisitsLock() = default;
  /// Waits for up to 30 s while another program has it, then throws Error. A folder without a log needs none.
  explicit VisitsLock(const std::filesystem::path& folder);
  ~VisitsLock();
  VisitsLock(VisitsLock&& other) noexcept;
  VisitsLock& operator=(VisitsLock&& other) noexcept;

 private:
  int file_ = -1;
};

/// Returns the revisions, oldest first. Empty if the folder has no log. Throws Error if the log is damaged.
std::vector<Visit> read_visits(const std::filesystem::path& folder);

/// Writes log and blocks into the folder `next`, which will replace `folder`: all revisions of `folder`,
/// whose present files become blocks where those of `next` differ, and one more revision, that of `next`.
/// Keeps `folder` usable as it is. Hold a VisitsLock of `folder` until `next` is in its place.
/// @param folder  may be missing: `next` is then the first revision
/// @param files, next_files  the files of both that belong to a revision, with size and checksum
/// @return the new revision
Visit record_visit(const std::filesystem::path& folder, const RevisionFiles& files,
                   const std::filesystem::path& next, const RevisionFiles& next_files, const VisitNote& note);

/// Writes the files of an earlier revision into `into`, an empty folder. Throws Error if there is no such
/// revision, or one of its files is damaged.
/// @param files  the folder's present files
void extract_revision(const std::filesystem::path& folder, const RevisionFiles& files, int revision,
                      const std::filesystem::path& into);

/// Removes all but the latest `keep` revisions (at least 1), and the blocks that no other uses. Returns how
/// many were removed.
int prune_visits(const std::filesystem::path& folder, const RevisionFiles& files, int keep);

/// Returns one sentence per fault of log and blocks, each of which is read once. Empty if every revision is
/// whole.
std::vector<std::string> verify_visits(const std::filesystem::path& folder, const RevisionFiles& files);

}  // namespace roomradar
