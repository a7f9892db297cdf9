// sim_options_test.cpp: the sim: form of a source: its options, and the error messages for invalid ones.
#include <gtest/gtest.h>

#include "app/sim/building/building_walk.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::sim_options_test {
namespace {

TEST(SimSpec, SetsWhatItNamesAndLeavesTheRest) {
  const SimOptions options =
      parse_sim_spec("sim:shelf?seed=3&frames=90&path=view&moving=hand,ball&noise=0&width=320");
  EXPECT_EQ(options.room, "shelf");
  EXPECT_EQ(options.seed, 3U);
  EXPECT_EQ(options.frames, 90);
  EXPECT_EQ(options.path, CameraPathKind::kView);
  EXPECT_EQ(options.movers, (std::vector{MoverKind::kHand, MoverKind::kBall}));
  EXPECT_EQ(options.noise_scale, 0.0);
  EXPECT_EQ(options.depth_camera.width_px, 320);
  EXPECT_EQ(options.depth_camera.height_px, 240);
  EXPECT_DOUBLE_EQ(options.depth_camera.fx_px, 292.5);
  EXPECT_DOUBLE_EQ(options.rate_hz, 30.0);
  EXPECT_EQ(parse_sim_spec("sim:wall").depth_camera, kKinectDepthCamera);
}

TEST(SimSpec, ComesBackFromItsOptions) {
  for (const char* const spec :
       {"sim:table", "sim:wall?seed=12", "sim:shelf?seed=3&frames=90&path=view&moving=hand,person&noise=0.5",
        "sim:table?rate=15&width=160&colour=separate", "sim:table?moving=person&pace=leaves",
        "sim:table?shutter=30&delay=-40&exposure=20&turn=90", "sim:random?moved=0.2", "sim:table?crate=1",
        "sim:table?crate=comes", "sim:table?crate=goes", "sim:building",
        "sim:building?seed=2&frames=300&rooms=40&floors=3&alike=4&walk=12", "sim:building?walk=ring&rate=15"})
    EXPECT_EQ(sim_spec(parse_sim_spec(spec)), spec);
}

TEST(SimSpec, TheBuildingHasKeysOfItsOwnAndByDefaultTheFramesOfItsWalk) {
  const SimOptions options = parse_sim_spec("sim:building?rooms=30&floors=3&alike=6&walk=7");
  EXPECT_EQ(options.building, (BuildingSize{30, 3, 6}));
  EXPECT_EQ(options.walk, 7);
  EXPECT_EQ(options.frames, 0);
  EXPECT_EQ(parse_sim_spec("sim:building?walk=ring&frames=5").walk, kRingWalk);
  EXPECT_EQ(parse_sim_spec("sim:table").frames, 300);
}

TEST(SimSpec, FaultsAreNamedWithWhatIsKnown) {
  const auto message = [](const char* spec) -> std::string {
    try {
      parse_sim_spec(spec);
      return "accepted";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const std::pair<const char*, const char*> cases[] = {
      {"table", "sim:ROOM"},
      {"sim:", "table, shelf, wall"},
      {"sim:attic", "table, shelf, wall"},
      {"sim:table?", "not a key=value pair"},
      {"sim:table?sead=1", "known are: seed, frames"},
      {"sim:table?seed", "not a key=value pair"},
      {"sim:table?seed=-1", "seed"},
      {"sim:table?seed=1x", "1x"},
      {"sim:table?frames=0", "frames"},
      {"sim:table?frames=", "frames"},
      {"sim:table?rate=0", "rate"},
      {"sim:table?rate=nan", "rate"},
      {"sim:table?noise=-1", "noise"},
      {"sim:table?noise=inf", "noise"},
      {"sim:table?path=fly", "scan, view or swing"},
      {"sim:table?crate=2", "comes or goes"},
      {"sim:table?moving=cat", "hand, ball, person"},
      {"sim:table?moving=hand,hand", "once"},
      {"sim:table?moving=", "hand, ball, person"},
      {"sim:table?pace=run", "steady, slow, waits or leaves"},
      {"sim:table?width=63", "width"},
      {"sim:table?width=99999999999", "width"},
      {"sim:table?shutter=51", "0 to 50"},
      {"sim:table?shutter=nan", "0 to 50"},
      {"sim:table?delay=-101", "-100 to 100"},
      {"sim:table?exposure=-1", "0 to 50"},
      {"sim:table?turn=361", "0 to 360"},
      {"sim:random?moved=1.5", "0 to 1"},
      {"sim:table?moved=0.2", "sim:random only"},
      {"sim:table?colour=red", "registered, separate or none"},
      {"sim:table?rooms=4", "of sim:building only"},
      {"sim:table?walk=0", "of sim:building only"},
      {"sim:attic", "building"},
      {"sim:building?rooms=1", "2 to 1000"},
      {"sim:building?rooms=1001", "2 to 1000"},
      {"sim:building?rooms=ten", "2 to 1000"},
      {"sim:building?floors=11", "1 to 10"},
      {"sim:building?floors=0", "1 to 10"},
      {"sim:building?rooms=3&floors=4", "at most the number of rooms, 3"},
      {"sim:building?alike=3", "even number, 0 to 10"},
      {"sim:building?alike=99999999999", "even number"},
      {"sim:building?walk=-1", "ring, or a whole number, 0 to 9999"},
      {"sim:building?walk=10000", "ring, or a whole number, 0 to 9999"},
      {"sim:building?walk=up", "ring, or a whole number, 0 to 9999"},
      {"sim:building?frames=-1", "frames"},
  };
  for (const auto& [spec, part] : cases)
    EXPECT_NE(message(spec).find(part), std::string::npos) << spec << ": " << message(spec);
}

}  // namespace
}  // namespace roomradar::sim_options_test
