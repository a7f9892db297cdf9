// trade_work.hpp: a kind of work whose time is traded for accuracy: what can be turned, what is measured, and
// where.
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

enum class FigureKind {
  kTime,    ///< noisy: the median of all measurements
  kMemory,  ///< likewise
  kError,   ///< the less the better; what fronts are made of
  kFact,    ///< neither good nor bad, such as a number of triangles
};

/// One thing that is measured of a setting.
struct FigureName {
  std::string name;    ///< the column's head, with its unit: "surface_error_median_m"
  std::string title;   ///< on the page, with the unit that it has there: "surface error, median, mm"
  double shown = 1.0;  ///< times this on the page
  FigureKind kind = FigureKind::kFact;
  double negligible = 0.0;  ///< of an error, > 0: two that differ by less are as good as each other
};

/// One number for each of the work's figures; kNotMeasured where there is none.
using Readings = std::vector<double>;
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Does the work once as the setting says. Throws Error where that cannot be.
using Measure = std::function<Readings(const Setting& setting)>;

struct MeasuredWork {
  std::string name;  ///< "prescan", "run"
  std::vector<Parameter> parameters = {};
  std::vector<FigureName> figures = {};
  std::size_t time = 0;                  ///< which of them is the time that settings are compared by
  std::vector<std::string> scenes = {};  ///< where it is done
  /// Makes a scene ready; what it takes is held for as long as the answer. Throws Error.
  std::function<Measure(std::size_t scene)> open = {};
};

/// Where a figure of that name is among the work's; throws Error if it is none.
std::size_t place_of(const MeasuredWork& work, const std::string& figure);

}  // namespace roomradar
