// doctor.cpp: one function per check.
#include "app/start/doctor.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/kinect_source.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {
namespace {

constexpr double kUsb2_mbit_s = 480.0;

// The compositor draws at the cameras' size; a map's coverage picture is the largest image.
constexpr GLint kLeastTexture_px = 4096;

Finding judge_one(const KinectOnUsb& kinect) {
  if (!kinect.has_camera)
    return {Health::kBad, "a Kinect's motor or microphones are on USB, its cameras are not",
            "plug in its own power supply; if it is in, unplug the Kinect and plug it in again"};
  const std::string name = kinect.model + " at " + kinect.node.string();
  if (!kinect.may_open && kinect.model == kKinectForWindows)  // not named by Debian's rule
    return {Health::kBad, name + ": this user may not open it",
            "echo 'SUBSYSTEM==\"usb\", ATTR{idVendor}==\"045e\", MODE=\"0666\"' | sudo tee "
            "/etc/udev/rules.d/60-kinect.rules; sudo udevadm control --reload; then unplug the Kinect and "
            "plug it "
            "in again"};
  if (!kinect.may_open)
    return {
        Health::kBad, name + ": this user may not open it",
        "install libfreenect0.5, which brings the udev rule, then unplug the Kinect and plug it in again; "
        "or join the group plugdev"};
  if (kinect.speed_mbit_s > 0.0 && kinect.speed_mbit_s < kUsb2_mbit_s)
    return {Health::kBad,
            name + ": its port runs at " + std::to_string(static_cast<int>(kinect.speed_mbit_s)) +
                " Mbit/s, its images need 480",
            "plug it into a USB 2 or 3 port, without an old hub between"};
  if (kinect.has_power && !*kinect.has_power)
    return {Health::kBad, name + ": only its cameras answer, not its motor and microphones",
            "plug in its own power supply"};
  if (!kinect.kernel_driver.empty() && kinect.kernel_driver != "usbfs")
    return {Health::kBad, name + ": the kernel driver " + kinect.kernel_driver + " holds it",
            "sudo modprobe -r " + kinect.kernel_driver + "; to keep it away: echo blacklist " +
                kinect.kernel_driver + " | sudo tee /etc/modprobe.d/kinect.conf"};
  if (kinect.kernel_driver == "usbfs")
    return {Health::kBad, name + ": another program uses it", "end that program"};
  return {Health::kGood, name + ": can be opened", {}};
}

}  // namespace

std::vector<Finding> judge_kinects(const std::vector<KinectOnUsb>& on_usb, int seen_by_libfreenect) {
  std::vector<Finding> findings;
  if (seen_by_libfreenect < 0)
    findings.push_back({Health::kMissing, "this program was built without Kinect",
                        "configure it with -DROOMRADAR_WITH_KINECT=ON and libfreenect-dev installed"});
  for (const KinectOnUsb& kinect : on_usb) findings.push_back(judge_one(kinect));
  for (std::size_t i = 1; i < on_usb.size(); ++i)
    if (on_usb[i].bus == on_usb[i - 1].bus)  // sorted by their nodes
      findings.push_back({Health::kBad,
                          "two Kinects share USB bus " + std::to_string(on_usb[i].bus) +
                              ", which has room for the images of one",
                          "plug one into a port of another controller (lsusb -t shows them)"});
  const auto sees = static_cast<std::size_t>(std::max(seen_by_libfreenect, 0));
  if (on_usb.empty() && sees == 0)
    findings.push_back({Health::kMissing, "no Kinect is plugged in",
                        "plug it into USB and into its own power supply; recordings and sim: need none"});
  else if (seen_by_libfreenect >= 0 && sees < on_usb.size() && on_usb.front().has_camera)
    findings.push_back({Health::kBad,
                        "of " + std::to_string(on_usb.size()) + " Kinects on the bus libfreenect sees " +
                            std::to_string(sees),
                        "unplug it and plug it in again, into a USB 2 port of its own"});
  else if (sees > 0)
    findings.push_back({Health::kGood,
                        "libfreenect sees " + std::to_string(sees) + ": kinect:0" +
                            (sees > 1 ? " to kinect:" + std::to_string(sees - 1) : ""),
                        {}});
  return findings;
}

Finding judge_replay(const std::filesystem::path& recording) {
  const std::string what = "kinect:0 is " + recording.string() + ", replayed by fakenect";
  try {
    const FakenectReplay replay(recording);
    if (replay.broken().empty()) return {Health::kGood, what, {}};
    return {Health::kBad,
            what + "; " + std::to_string(replay.broken().size()) + " of its depth images " +
                replay.broken().begin()->second,
            "they are skipped; copy the recording again if there is a complete one"};
  } catch (const Error& error) {
    return {Health::kBad, what + ": " + error.what(), "copy or record it again"};
  }
}

Finding judge_renderer() {
  try {
    const GlContext context;
    GLint texture_px = 0, image_px = 0;
    std::array<GLint, 2> view_px{};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture_px);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &image_px);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, view_px.data());
    const GLint least_px = std::min({texture_px, image_px, view_px[0], view_px[1]});
    const std::string what =
        "renderer: " + context.renderer() + ", images up to " + std::to_string(least_px) + " px";
    if (least_px < kLeastTexture_px)
      return {Health::kBad, what,
              "at least " + std::to_string(kLeastTexture_px) +
                  " px are needed; update the driver, or "
                  "set ROOMRADAR_RENDERER=software"};
    if (context.is_software())
      return {Health::kGood, what + " (no GPU is used: a frame of run takes some 10 to 30 ms)", {}};
    return {Health::kGood, what, {}};
  } catch (const Error& error) {
    return {Health::kBad, error.what(), "install libegl-mesa0 and libgl1-mesa-dri; unset ROOMRADAR_RENDERER"};
  }
}

Finding judge_fakenect(const std::string& path) {
  std::istringstream folders(path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = folder + "/fakenect";
    if (!folder.empty() && access(program.c_str(), X_OK) == 0)
      return {Health::kGood, "fakenect: " + program + " replays recordings as a Kinect", {}};
  }
  return {Health::kMissing, "fakenect is not installed",
          "install libfreenect-bin to replay recordings through kinect:0"};
}

std::vector<Finding> check_setup() {
  const auto replayed = replayed_folder();
  std::vector<Finding> findings;
  if (replayed)
    findings.push_back(judge_replay(*replayed));
  else
    findings = judge_kinects(kinects_on_usb(), count_kinects());
  findings.push_back(judge_renderer());
  const char* path = std::getenv("PATH");
  findings.push_back(judge_fakenect(path ? path : ""));
  return findings;
}

}  // namespace roomradar
