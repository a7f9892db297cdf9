// measured_setting.hpp: work that trades time for accuracy (a prescan, a run): its parameters, measured
// quantities (figures) and scenes.
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

enum class FigureKind {
  kTime,    ///< noisy: summarised by the median of all measurements
  kMemory,  ///< noisy, as kTime
  kError,   ///< smaller is better; Pareto fronts use these
  kFact,    ///< neither good nor bad, such as a number of triangles
};

/// Describes one measured quantity.
struct FigureName {
  std::string name;    ///< column name, with unit: "surface_error_median_m"
  std::string title;   ///< title on the page, with the page's unit: "surface error, median, mm"
  double shown = 1.0;  ///< factor from the measured unit to the page's unit
  FigureKind kind = FigureKind::kFact;
  double negligible = 0.0;  ///< kError, > 0: errors that differ by less count as equal
};

/// One value per entry of MeasuredWork::figures; kNotMeasured if there is none.
using Readings = std::vector<double>;
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Does the work once with a setting and returns its figures. Throws Error if this is impossible.
using Measure = std::function<Readings(const Setting& setting)>;

struct MeasuredWork {
  std::string name;  ///< "prescan", "run"
  std::vector<Parameter> parameters = {};
  std::vector<FigureName> figures = {};
  std::size_t time = 0;                  ///< index of the figure that serves as time in comparisons
  std::vector<std::string> scenes = {};  ///< names of the scenes in which the work is done
  /// Prepares a scene; the returned function owns its data. Throws Error if that fails.
  std::function<Measure(std::size_t scene)> open = {};
};

/// Returns the index of a figure among the work's; throws Error if there is none of that name.
std::size_t place_of(const MeasuredWork& work, const std::string& figure);

}  // namespace roomradar
