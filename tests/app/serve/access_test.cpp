// access_test.cpp: addresses, tokens, names of hosts; poses on the earth.
#include "app/serve/access.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/serve/geo_pose.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::access_test {
namespace {

namespace fs = std::filesystem;

TEST(Access, AddressesAreParsed) {
  EXPECT_EQ(parse_listen_address("127.0.0.1:80").port, 80);
  EXPECT_EQ(parse_listen_address("localhost:0").host, "127.0.0.1");
  EXPECT_EQ(parse_listen_address("[::1]:8080").host, "::1");
  for (const char* wrong : {"", ":", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1",
                            "127.0.0.1:1e3", "::1:80", "example.org:80", "[127.0.0.1]:80", "256.0.0.1:80"})
    EXPECT_THROW((void)parse_listen_address(wrong), Error) << wrong;
  EXPECT_TRUE(is_loopback(parse_listen_address("127.3.0.1:80")));
  EXPECT_TRUE(is_loopback(parse_listen_address("[::1]:80")));
  EXPECT_FALSE(is_loopback(parse_listen_address("0.0.0.0:80")));
  EXPECT_FALSE(is_loopback(parse_listen_address("[::]:80")));
}

TEST(Access, TokensAreLongAndPrivate) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "token";
  const auto write = [&](const std::string& text, fs::perms permissions) {
    write_bytes(path, text);
    fs::permissions(path, permissions);
  };
  const fs::perms own = fs::perms::owner_read | fs::perms::owner_write;
  write("0123456789abcdef\n", own);
  EXPECT_EQ(read_token(path), "0123456789abcdef");
  for (const char* wrong : {"", "short\n", "0123456789abcdef 0\n", "0123456789abcdef\n0123456789abcdef\n"}) {
    write(wrong, own);
    EXPECT_THROW((void)read_token(path), Error) << wrong;
  }
  write("0123456789abcdef\n", own | fs::perms::others_read);
  EXPECT_THROW((void)read_token(path), Error);
  EXPECT_TRUE(has_token("Bearer 0123456789abcdef", "0123456789abcdef"));
  for (const char* wrong :
       {"", "Bearer ", "Bearer 0123456789abcdeF", "0123456789abcdef", "Bearer 0123456789abcdef "})
    EXPECT_FALSE(has_token(wrong, "0123456789abcdef")) << wrong;
}

TEST(Access, OnlyLocalNamesAreLocal) {
  for (const char* name : {"localhost", "127.0.0.1:8080", "[::1]:1", "[::1]"})
    EXPECT_TRUE(is_local_name(name)) << name;
  for (const char* name : {"", "evil.org", "localhost.evil.org", "127.0.0.1.evil.org:80", "localhost:80evil"})
    EXPECT_FALSE(is_local_name(name)) << name;
}

TEST(GeoPose, OneDegreeOfLatitudeAndLongitudeHaveTheirLengths) {
  const GeoAnchor anchor = parse_geo_anchor("0,0,0,0");
  // Lengths of a degree at the equator: NIMA TR8350.2; short steps, so the tangent plane is near enough.
  const auto at = [&](double x, double y) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << x, y, 0.0;
    return geo_pose_of(anchor, T);
  };
  EXPECT_NEAR(at(111.31949, 0).longitude_deg, 1e-3, 1e-9);
  EXPECT_NEAR(at(0, 110.57428).latitude_deg, 1e-3, 1e-9);
  EXPECT_NEAR(at(100, 0).height_m, 100.0 * 100.0 / (2 * 6378137.0), 1e-6) << "the earth is round";
}

TEST(GeoPose, TheAnchorIsItself) {
  for (const char* text : {"48.1,11.5,520,0", "-33.9,151.2,-12.5,270", "90,0,10,45", "0,180,0,-90"}) {
    const GeoAnchor anchor = parse_geo_anchor(text);
    const GeoPose pose = geo_pose_of(anchor, Eigen::Isometry3d::Identity());
    EXPECT_NEAR(pose.latitude_deg, anchor.latitude_deg, 1e-9) << text;
    EXPECT_NEAR(pose.height_m, anchor.height_m, 1e-6) << text;
    if (std::abs(anchor.latitude_deg) == 90.0) continue;  // there, longitude and heading are one
    EXPECT_NEAR(std::remainder(pose.longitude_deg - anchor.longitude_deg, 360.0), 0.0, 1e-9) << text;
    const double heading_rad = anchor.heading_deg * 3.14159265358979323846 / 180.0;
    const Eigen::Vector3d ahead = pose.R_enu_camera * Eigen::Vector3d::UnitY();
    EXPECT_NEAR(ahead.x(), std::sin(heading_rad), 1e-9) << text;
    EXPECT_NEAR(ahead.y(), std::cos(heading_rad), 1e-9) << text;
  }
  for (const char* wrong :
       {"", "1,2,3", "1,2,3,4,5", "91,0,0,0", "0,181,0,0", "0,0,nan,0", "a,0,0,0", "0,0,0,"})
    EXPECT_THROW((void)parse_geo_anchor(wrong), Error) << wrong;
}

}  // namespace
}  // namespace roomradar::access_test
