// sim_kinds.cpp: names of the kinds.
#include "app/sim/sensor/sim_kinds.hpp"

namespace roomradar {

std::string_view to_string(CameraPathKind kind) {
  switch (kind) {
    case CameraPathKind::kScan:
      return "scan";
    case CameraPathKind::kView:
      return "view";
    case CameraPathKind::kSwing:
      return "swing";
  }
  return "?";
}

std::string_view to_string(MoverKind kind) {
  switch (kind) {
    case MoverKind::kHand:
      return "hand";
    case MoverKind::kBall:
      return "ball";
    case MoverKind::kPerson:
      return "person";
  }
  return "?";
}

std::string_view to_string(Pace pace) {
  switch (pace) {
    case Pace::kSteady:
      return "steady";
    case Pace::kSlow:
      return "slow";
    case Pace::kWaits:
      return "waits";
    case Pace::kLeaves:
      return "leaves";
  }
  return "?";
}

std::string_view to_string(CrateKind kind) {
  switch (kind) {
    case CrateKind::kNone:
      return "0";
    case CrateKind::kStays:
      return "1";
    case CrateKind::kComes:
      return "comes";
    case CrateKind::kGoes:
      return "goes";
  }
  return "?";
}

}  // namespace roomradar
