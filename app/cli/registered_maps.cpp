// registered_maps.cpp: registers two maps, prints and reports the result.
#include "app/cli/registered_maps.hpp"

#include <cstdio>

#include "mapping/types/system/error.hpp"

namespace roomradar {

Registration require_registered(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                                const std::string& name_b, Report& report) {
  Registration found = report.times.timed("register", [&] { return register_maps(a, b); });
  if (!found)
    throw Error(name_b + ": cannot be registered to " + name_a + ": " + describe(found) +
                "; both must show a large common part of one room");
  std::printf("%s in %s: %s\n", name_b.c_str(), name_a.c_str(), describe(found).c_str());
  nlohmann::json T_a_b = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) T_a_b.push_back(found.T_a_b.matrix()(row, column));
  report.results["registration"] = {{"T_a_b", T_a_b},
                                    {"agreeing_views", found.agreeing_views},
                                    {"overlap", found.overlap},
                                    {"agreement", found.agreement},
                                    {"residual_m", found.residual_m}};
  return found;
}

MapChanges changes_between(const SavedMap& a, const SavedMap& b, const std::string& name_a,
                           const std::string& name_b, Report& report) {
  const Registration found =
      share_world(a.info, b.info) ? Registration{} : require_registered(a, b, name_a, name_b, report);
  return {found.T_a_b, report.times.timed("diff", [&] {
            return diff_maps(a.octree.load(), b.octree.load(), found.T_a_b, found.T_b_a, {});
          })};
}

}  // namespace roomradar
