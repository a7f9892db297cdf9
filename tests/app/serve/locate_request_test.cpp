// locate_request_test.cpp: bodies are parsed as they were made, and refused with a sentence if they are not.
#include "app/serve/locate_request.hpp"

#include <gtest/gtest.h>

#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/locate_body.hpp"

namespace roomradar::locate_request_test {
namespace {

Frame small_frame() {
  Frame frame;
  frame.depth_camera = frame.colour_camera = {40, 30, 35.0, 35.0, 19.5, 14.5};
  frame.depth_m = DepthImage(40, 30, 1.25F);
  frame.colour = ColourImage(40, 30, {10, 200, 30});
  return frame;
}

TEST(LocateRequest, IsParsedAsItWasMade) {
  const Frame frame = small_frame();
  test::LocateBody body = test::locate_body_of(frame);
  Frame parsed = parse_locate_request(body.text());
  EXPECT_EQ(parsed.depth_camera, frame.depth_camera);
  EXPECT_EQ(parsed.depth_m.pixels, frame.depth_m.pixels);
  EXPECT_EQ(parsed.colour.pixels, frame.colour.pixels);
  body.header["depth_units_per_m"] = 5000;
  EXPECT_FLOAT_EQ(parse_locate_request(body.text()).depth_m.at(3, 3), 0.25F);
  body.header["camera"].erase("colour");
  body.header["camera"].erase("T_colour_depth");
  EXPECT_EQ(parse_locate_request(body.text()).colour_camera, frame.depth_camera);
}

TEST(LocateRequest, WrongBodiesAreRefused) {
  const test::LocateBody good = test::locate_body_of(small_frame());
  const auto refused = [&](const char* what, const auto& change) {
    test::LocateBody body = good;
    change(body);
    EXPECT_GT(test::error_of([&] { (void)parse_locate_request(body.text()); }).size(), 10U) << what;
  };
  using Body = test::LocateBody;
  refused("no camera", [](Body& b) { b.header.erase("camera"); });
  refused("no length", [](Body& b) { b.header.erase("depth_bytes"); });
  refused("negative length", [](Body& b) { b.header["depth_bytes"] = -1; });
  refused("huge length", [](Body& b) { b.header["depth_bytes"] = 18446744073709551615ULL; });
  refused("length as text", [](Body& b) { b.header["colour_bytes"] = "12"; });
  refused("truncated", [](Body& b) { b.colour_png.resize(b.colour_png.size() / 2); });
  refused("longer", [](Body& b) { b.colour_png += "x"; });
  refused("camera of another size", [](Body& b) { b.header["camera"]["depth"]["width_px"] = 41; });
  refused("no focal length", [](Body& b) { b.header["camera"]["depth"]["fx_px"] = 0; });
  refused("camera as list", [](Body& b) { b.header["camera"] = {1, 2}; });
  refused("units of 0", [](Body& b) { b.header["depth_units_per_m"] = 0; });
  refused("units as text", [](Body& b) { b.header["depth_units_per_m"] = "mm"; });
  refused("colour for depth", [](Body& b) {
    b.depth_png = b.colour_png;
    b.header["depth_bytes"] = b.depth_png.size();
  });
  refused("no image", [](Body& b) {
    b.depth_png = "text";
    b.header["depth_bytes"] = 4;
  });
  for (const char* text : {"", "\n", "{}\n", "[]\n", "7\n", "no json\n"})
    EXPECT_THROW((void)parse_locate_request(text), Error) << text;
  EXPECT_THROW((void)parse_locate_request(std::string(1'000'000, '[')), Error);
  EXPECT_THROW((void)parse_locate_request(std::string(10'000, '[') + "\n"), Error);
}

TEST(LocateRequest, AnImageOfTooManyPixelsIsRefused) {
  Frame frame = small_frame();
  frame.depth_camera = {2000, 1500, 1700.0, 1700.0, 1000.0, 750.0};
  frame.depth_m = DepthImage(2000, 1500, 1.25F);  // 3 million pixels in a few kB
  const test::LocateBody body = test::locate_body_of(frame);
  EXPECT_LT(body.depth_png.size(), 100'000U);
  EXPECT_NE(test::error_of([&] { (void)parse_locate_request(body.text()); }).find("more than"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar::locate_request_test
