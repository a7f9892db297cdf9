// doctor_command.cpp: roomradar doctor: checks the set-up and says how to repair it.
#include "app/commands/doctor_command.hpp"

#include <cstdio>
#include <cstdlib>

#include "app/commands/doctor.hpp"
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/kinect_source.hpp"

namespace roomradar {

int run_doctor() {
  const auto replayed = replayed_folder();
  std::vector<Finding> findings;
  if (replayed)
    findings.push_back(judge_replay(*replayed));
  else
    findings = judge_kinects(kinects_on_usb(), count_kinects());
  findings.push_back(judge_renderer());
  const char* path = std::getenv("PATH");
  findings.push_back(judge_fakenect(path ? path : ""));

  bool is_well = true;
  for (const Finding& finding : findings) {
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
