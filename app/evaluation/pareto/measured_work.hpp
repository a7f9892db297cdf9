// measured_work.hpp: work that trades time for accuracy, such as a prescan or a run, with its parameters, the
// values to measure, measured quantities (figures) and scenes.
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// One field of ScanQuality or RunQuality, and the values to measure, as words.
struct Parameter {
  std::string name;                ///< name of the field and of the CSV column
  std::vector<std::string> words;  ///< fastest first
  std::size_t defaults = 0;        ///< index of the default in `words`
  /// True: the parameter sets the amount of work (load), not its quality. It is never changed together with
  /// other parameters. Settings that change a load parameter are never on a Pareto front.
  bool is_load = false;
};

/// A value for each parameter, as index in Parameter::words.
using Setting = std::vector<std::size_t>;

Setting default_setting(const std::vector<Parameter>& parameters);

/// Returns true if all load parameters have their defaults.
bool has_default_load(const std::vector<Parameter>& parameters, const Setting& setting);

/// Returns the differences from the default, such as "radar sampled, radar_px 32", or "default" if there are
/// none.
std::string describe(const std::vector<Parameter>& parameters, const Setting& setting);

/// Returns the differences from the default as one word, such as "radar=sampled,radar_px=32", or "default".
std::string setting_words(const std::vector<Parameter>& parameters, const Setting& setting);
/// Returns the setting that setting_words() wrote. Throws Error if a parameter or its value is unknown, or a
/// parameter occurs twice.
Setting setting_from(const std::vector<Parameter>& parameters, const std::string& words);

enum class FigureKind {
  kTime,    ///< a time, summarised by the median because it is noisy
  kMemory,  ///< memory use; summarised as kTime
  kError,   ///< an error; Pareto fronts minimise times and errors
  kFact,    ///< a quantity without preference, such as a number of triangles
};

/// Description of one measured quantity.
struct FigureName {
  std::string name;  ///< column name with unit, such as "surface_error_median_m"
  /// Title on the HTML page with the page's unit, such as "surface error, median, mm".
  std::string title;
  double shown = 1.0;  ///< factor from the measured unit to the page's unit
  FigureKind kind = FigureKind::kFact;
  double negligible = 0.0;  ///< for kError, > 0; smaller differences of errors are neglected
};

/// One value per entry of MeasuredWork::figures; kNotMeasured if the figure was not measured.
using Readings = std::vector<double>;
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Does the work once with a setting and returns the measured figures. Throws Error if the work fails.
using Measure = std::function<Readings(const Setting& setting)>;

struct MeasuredWork {
  std::string name;  ///< "prescan" or "run"
  std::vector<Parameter> parameters = {};
  std::vector<FigureName> figures = {};
  std::size_t time = 0;                  ///< index in `figures` of the time used in comparisons
  std::vector<std::string> scenes = {};  ///< names of the scenes in which the work is done
  /// Prepares a scene and returns the function that measures in it and owns the scene's data. Throws Error if
  /// the scene cannot be prepared.
  std::function<Measure(std::size_t scene)> open = {};
};

/// Returns the index of a figure in MeasuredWork::figures. Throws Error if there is no figure of that name.
std::size_t place_of(const MeasuredWork& work, const std::string& figure);

}  // namespace roomradar
