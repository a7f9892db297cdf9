// doctor_test.cpp: Kinects simulated by files, and the diagnosis of each possible fault.
#include "app/start/doctor.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::doctor_test {
namespace {

namespace fs = std::filesystem;

/// A USB bus as Linux presents it.
struct Bus {
  TemporaryFolder folder;
  fs::path sys = folder.path() / "sys", dev = folder.path() / "dev";

  void plug_in(const std::string& name, const std::string& product, int number,
               const std::string& driver = {}, const std::string& speed = "480") const {
    const fs::path device = sys / name;
    fs::create_directories(device / (name + ":1.0"));
    std::ofstream(device / "idVendor") << "045e\n";
    std::ofstream(device / "idProduct") << product << "\n";
    std::ofstream(device / "busnum") << "3\n";
    std::ofstream(device / "devnum") << number << "\n";
    std::ofstream(device / "speed") << speed << "\n";
    char node[8];
    std::snprintf(node, sizeof node, "%03d", number);
    fs::create_directories(dev / "003");
    std::ofstream(dev / "003" / node) << "";
    if (!driver.empty())
      fs::create_symlink("/sys/bus/usb/drivers/" + driver, device / (name + ":1.0") / "driver");
  }
  [[nodiscard]] std::vector<KinectOnUsb> kinects() const { return kinects_on_usb(sys, dev); }
};

bool says(const std::vector<Finding>& findings, Health health, const std::string& words) {
  for (const Finding& finding : findings)
    if (finding.health == health && (finding.what + finding.what_to_do).find(words) != std::string::npos)
      return true;
  return false;
}

TEST(Doctor, AKinectThatWorksIsGood) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7);
  bus.plug_in("3-1.1", "02b0", 6);
  bus.plug_in("3-1.3", "02ad", 8);
  const std::vector<KinectOnUsb> kinects = bus.kinects();
  ASSERT_EQ(kinects.size(), 1U);
  EXPECT_EQ(kinects[0].node, bus.dev / "003" / "007");
  EXPECT_TRUE(kinects[0].may_open);
  EXPECT_EQ(kinects[0].has_power, true);
  const std::vector<Finding> findings = judge_kinects(kinects, 1);
  EXPECT_TRUE(says(findings, Health::kGood, "Xbox 360"));
  EXPECT_TRUE(says(findings, Health::kGood, "kinect:0"));
  for (const Finding& finding : findings) EXPECT_EQ(finding.health, Health::kGood) << finding.what;
}

TEST(Doctor, AKernelDriverInTheWayIsNamedWithTheCommandThatRemovesIt) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7, "gspca_kinect");
  bus.plug_in("3-1.1", "02b0", 6);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 1), Health::kBad, "modprobe -r gspca_kinect"));
}

TEST(Doctor, AnotherProgramIsTold) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7, "usbfs");
  bus.plug_in("3-1.1", "02b0", 6);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 1), Health::kBad, "another program"));
}

TEST(Doctor, ANodeThatMayNotBeOpenedIsAMatterOfRights) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7);
  std::vector<KinectOnUsb> kinects = bus.kinects();
  ASSERT_EQ(kinects.size(), 1U);
  if (geteuid() != 0) {  // root may open everything
    chmod(kinects[0].node.c_str(), 0);
    kinects = bus.kinects();
    EXPECT_FALSE(kinects[0].may_open);
  }
  fs::remove(kinects[0].node);
  kinects = bus.kinects();
  EXPECT_FALSE(kinects[0].may_open);
  EXPECT_TRUE(says(judge_kinects(kinects, 0), Health::kBad, "udev"));
}

TEST(Doctor, CamerasWithoutAMotorLackPower) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 1), Health::kBad, "power supply"));
}

TEST(Doctor, AMotorWithoutCamerasLacksPower) {
  for (const char* const companion : {"02b0", "02c2"}) {
    const Bus bus;
    bus.plug_in("3-1.1", companion, 6);
    const std::vector<Finding> findings = judge_kinects(bus.kinects(), 0);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_TRUE(says(findings, Health::kBad, "power supply"));
  }
}

TEST(Doctor, NoKinectIsNoIllness) {
  const Bus bus;
  EXPECT_TRUE(bus.kinects().empty());
  const std::vector<Finding> findings = judge_kinects({}, 0);
  EXPECT_TRUE(says(findings, Health::kMissing, "no Kinect"));
  for (const Finding& finding : findings) EXPECT_NE(finding.health, Health::kBad);
  EXPECT_TRUE(says(judge_kinects({}, -1), Health::kMissing, "built without"));
}

TEST(Doctor, ADeviceThatLibfreenectDoesNotSeeIsToldOf) {
  const Bus bus;
  bus.plug_in("3-1.2", "02bf", 7);
  bus.plug_in("3-1.1", "02c2", 6);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 0), Health::kBad, "libfreenect sees 0"));
}

TEST(Doctor, AKinectForWindowsWithoutRightsIsGivenARuleOfItsOwn) {
  const Bus bus;
  bus.plug_in("3-1.2", "02bf", 7);
  fs::remove(bus.dev / "003" / "007");
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 0), Health::kBad, "/etc/udev/rules.d/60-kinect.rules"));
}

TEST(Doctor, APortThatIsTooSlowIsTold) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7, {}, "12");
  bus.plug_in("3-1.1", "02b0", 6);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 1), Health::kBad, "12 Mbit/s"));
}

TEST(Doctor, TwoKinectsOnOneBusAreOneTooMany) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7);
  bus.plug_in("3-2.2", "02ae", 9);
  EXPECT_TRUE(says(judge_kinects(bus.kinects(), 2), Health::kBad, "share USB bus 3"));
}

TEST(Doctor, AReplayIsToldFromADeviceAndItsBrokenImagesAreCounted) {
  const TemporaryFolder folder;
  const fs::path recording = folder.path();
  std::ofstream(recording / "INDEX.txt") << "d-1.0-0.pgm\nd-1.1-2000000.pgm\n";
  const std::string image = "P5 640 480 65535\n" + std::string(640 * 480 * 2, '\1');
  std::ofstream(recording / "d-1.0-0.pgm") << image;
  std::ofstream(recording / "d-1.1-2000000.pgm") << image;
  EXPECT_EQ(judge_replay(recording).health, Health::kGood);
  fs::resize_file(recording / "d-1.1-2000000.pgm", 1000);
  const Finding finding = judge_replay(recording);
  EXPECT_EQ(finding.health, Health::kBad);
  EXPECT_NE(finding.what.find("1 of its depth images"), std::string::npos) << finding.what;
  fs::remove(recording / "INDEX.txt");
  EXPECT_NE(judge_replay(recording).what.find("INDEX.txt"), std::string::npos);
}

TEST(Doctor, FilesThatMakeNoSenseArePassedOver) {
  const Bus bus;
  bus.plug_in("3-1.2", "02ae", 7);
  std::ofstream(bus.sys / "3-1.2" / "devnum") << "../../etc\n";
  EXPECT_TRUE(bus.kinects().empty());
}

TEST(Doctor, FakenectIsLookedForInThePath) {
  const TemporaryFolder folder;
  EXPECT_EQ(judge_fakenect("").health, Health::kMissing);
  EXPECT_EQ(judge_fakenect(folder.path().string()).health, Health::kMissing);
  const fs::path program = folder.path() / "fakenect";
  std::ofstream(program) << "#!/bin/sh\n";
  chmod(program.c_str(), 0755);
  EXPECT_EQ(judge_fakenect("/nowhere::" + folder.path().string()).health, Health::kGood);
}

TEST(Doctor, TheRendererIsNamed) {
  const Finding finding = judge_renderer();
  EXPECT_EQ(finding.health, Health::kGood) << finding.what;
  EXPECT_NE(finding.what.find("OpenGL"), std::string::npos) << finding.what;
}

}  // namespace
}  // namespace roomradar::test::doctor_test
