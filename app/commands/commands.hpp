// commands.hpp: the commands of roomradar: one function per command, which executes it with its options.
#pragma once
#include "app/cli/options/map_options.hpp"
#include "app/cli/options/measuring_options.hpp"
#include "app/cli/options/prescan_options.hpp"
#include "app/cli/options/recording_options.hpp"
#include "app/cli/options/run_options.hpp"

namespace roomradar {

// roomradar start, or roomradar without arguments: offers maps and actions in a window.

/// Shows the start view, performs the chosen action in the same window, and shows the view again, until the
/// user closes the window. The view shows the error messages of failed actions. Returns the exit status: that
/// of the last action if the window was closed during it, else 0.
/// @throws Error if there is no window
int run(const StartOptions& options);

/// Does what run() does if stdin and stdout are a terminal and there is a display. Otherwise prints
/// `first_steps` to stderr and returns 2, the exit status of wrong usage.
int run_start_alone(const char* first_steps);

// roomradar prescan and run: scans a room once and saves it as a map; augmented reality in a saved room. Both
// alternate between scanning and playing in one window. See scan_and_play.hpp for each part.

/// Scans without a window, see scan(). With options.window, scans in a window, then plays in the map and
/// scans more of it as the user asks. Returns the exit status of the last part.
int run(const PrescanOptions& options);

/// Plays without a window, see play(). With options.window, plays in a window, then scans more of the map and
/// plays in it as the user asks. Returns the exit status of the last part.
int run(const RunOptions& options);

// roomradar map info|verify|export|objects: describes, checks and exports a saved map. Each function returns
// the exit status, and throws Error if a file cannot be read or written.

/// Prints the map's properties.
int run(const MapInfoOptions& options);
/// Compares the map's files with their checksums. Returns 1 if a file differs.
int run(const MapVerifyOptions& options);
/// Writes the octree, the mesh or the frontier of unknown space to a file.
int run(const MapExportOptions& options);

/// Lists, removes or renames the objects that stay in the room. Throws Error if there is no object of a name.
int run(const MapObjectsOptions& options);

/// Lists the revisions of a map.
int run(const MapLogOptions& options);
/// Makes an earlier revision the map's present state.
int run(const MapRestoreOptions& options);
/// Goes back to the revision from which the present state was made.
int run(const MapUndoOptions& options);
/// Removes the oldest revisions.
int run(const MapPruneOptions& options);
// roomradar map list|copy|rename|delete|pack|unpack: maps as folders and files. Each function returns the
// exit status, and throws Error, with the maps as they were, if a file cannot be read or written, a folder is
// not a map, or the new place is taken.

/// Prints a line per map in a folder. Returns 1 if one is damaged.
int run(const MapListOptions& options);
/// Copies a map.
int run(const MapCopyOptions& options);
/// Gives a map another path.
int run(const MapRenameOptions& options);
/// Moves a map to the trash, or deletes it for good.
int run(const MapDeleteOptions& options);
/// Writes a map as one file.
int run(const MapPackOptions& options);
/// Makes a map from such a file.
int run(const MapUnpackOptions& options);

// roomradar map merge|diff: merges or compares two maps of one room. Both functions return the exit status 0,
// and throw Error if a file cannot be read or written, or if the maps cannot be registered reliably.

/// Adds map b to map a and saves the result as a new map.
int run(const MapMergeOptions& options);
/// Prints the objects that appeared or vanished between map a and map b.
int run(const MapDiffOptions& options);

// roomradar check: examines a recording.

/// Prints what a recording states and what was decided about it. Reads some of its frames only. Returns the
/// exit status: 1 if there is advice. Throws Error if the recording cannot be opened.
int run(const CheckOptions& options);

// roomradar record: writes a source's frames as a recording.

/// Records the frames until the source ends or Ctrl-C is pressed. Returns the exit status 0.
/// @throws Error if no frame can be read, or if a frame cannot be written. Frames written before it are
///         complete
int run(const RecordOptions& options);

// roomradar calibrate: estimates intrinsics, lens distortion and depth errors from a recording of a
// checkerboard.

/// Estimates and writes the calibration, and prints residuals before and after. Returns the exit status 0.
/// @throws Error as calibrate() does, or if a file cannot be read or written
int run(const CalibrateOptions& options);

// roomradar doctor: checks the installation and gives advice on repairs.

/// Prints a line per Finding. Returns the exit status: 0, or 1 if a finding is kBad.
int run_doctor();

// roomradar simulate: records a simulated Kinect with ground truth.

/// Writes the recording. Returns the exit status 0.
/// @throws Error if an option is not valid (require_valid()), or if the folder cannot be written
int run(const SimulateOptions& options);

// roomradar fallthrough: drops objects onto hidden surfaces, with each surface policy.

/// Runs the scenarios in simulated rooms, or run_grid() if a source is given. Prints a table and writes the
/// requested files. Returns the exit status: 1 if a job of options.jobs failed, else 0.
/// @throws Error if a room cannot be scanned or a file cannot be written. Results obtained before the error
///         are written
int run(const FallthroughOptions& options);

// roomradar farm: runs a list of commands as jobs. See farm_command.hpp for the jobs of other commands.

/// Executes the command. Returns the exit status: 1 if a job failed. Throws Error on failure.
int run(const FarmOptions& options);

// roomradar trade: measures time and accuracy of quality settings.

/// Measures the settings, prints the chosen presets and writes the requested files. Ctrl-C ends the
/// measurements; results then cover the measurements made so far. Returns the exit status: 1 if a job failed.
/// @throws Error if a scene is not suitable, nothing was measured, or a file cannot be written. Measurements
///         made before the error are written
int run(const TradeOptions& options);

}  // namespace roomradar
