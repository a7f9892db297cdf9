// doctor_command.cpp: roomradar doctor: checks the set-up and says how to repair it.
#include "app/commands/commands.hpp"

#include <cstdio>

#include "app/start/doctor.hpp"

namespace roomradar {

int run_doctor() {
  bool is_well = true;
  for (const Finding& finding : check_setup()) {
    const char* mark = finding.health == Health::kGood  ? "good"
                       : finding.health == Health::kBad ? "BAD"
                                                        : "-";
    std::printf("%-5s %s\n", mark, finding.what.c_str());
    if (!finding.what_to_do.empty()) std::printf("      %s\n", finding.what_to_do.c_str());
    is_well = is_well && finding.health != Health::kBad;
  }
  return is_well ? 0 : 1;
}

}  // namespace roomradar
