// measured_setting.cpp: looks up figures by name.
#include "app/evaluation/pareto/measured_setting.hpp"

#include "mapping/types/system/error.hpp"

namespace roomradar {

std::size_t place_of(const MeasuredWork& work, const std::string& figure) {
  for (std::size_t i = 0; i < work.figures.size(); ++i)
    if (work.figures[i].name == figure) return i;
  throw Error(work.name + ": nothing called " + figure + " is measured");
}

}  // namespace roomradar
