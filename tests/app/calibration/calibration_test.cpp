// calibration_test.cpp: lens models and their inverses, the calibration file, corrected frames, and recovery
// of known cameras.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>
#include <sstream>

#include "app/calibration/calibrate.hpp"
#include "app/calibration/calibrated_source.hpp"
#include "app/calibration/calibration_plot.hpp"
#include "app/sim/sensor/sensor_faults.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/types/depth_noise.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/kept_source.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::calibration_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const Lens kBarrel{-0.21, 0.07, 0.0011, -0.0007, 0.01};
const Board kBoard{.columns = 8, .rows = 6, .square_m = 0.06};

/// Pose of the colour camera as stated in the frames.
Isometry3d beside() {
  Isometry3d T_colour_depth = Isometry3d::Identity();
  T_colour_depth.translation().x() = -0.025;
  return T_colour_depth;
}

/// A Kinect with all faults that the simulated one has.
Calibration faulty_kinect() {
  const Intrinsics said = kKinectDepthCamera;
  const SensorFaults faults = sensor_faults(said, said, beside());
  Calibration truth;
  truth.rig = {faults.depth_camera, faults.colour_camera, faults.T_colour_depth};
  truth.depth_lens = faults.depth_lens;
  truth.colour_lens = faults.colour_lens;
  truth.depth_correction = {faults.inverse_depth_scale, 65, 49, {}};
  for (int row = 0; row < 49; ++row)
    for (int column = 0; column < 65; ++column)
      truth.depth_correction.offset_per_m.push_back(
          inverse_depth_offset_per_m(said, column * 639.0 / 64.0, row * 479.0 / 48.0));
  return truth;
}

/// A Kinect's view of a board: corners with 0.1 px of noise, depth with the sensor's noise.
BoardView view_of_board(const Calibration& truth, const Isometry3d& T_colour_board, std::mt19937& random) {
  std::normal_distribution<double> gaussian;
  const Intrinsics& colour = *truth.rig.colour_camera;
  const Intrinsics& depth = truth.rig.depth_camera;
  BoardView view;
  for (int row = 0; row < kBoard.rows; ++row)
    for (int column = 0; column < kBoard.columns; ++column) {
      const Vector3d p = T_colour_board * corner_board(kBoard, column, row);
      const PlanePoint<double> at = distorted({p.x() / p.z(), p.y() / p.z()}, truth.colour_lens);
      view.corners_px.emplace_back(colour.fx_px * at.x + colour.cx_px + 0.1 * gaussian(random),
                                   colour.fy_px * at.y + colour.cy_px + 0.1 * gaussian(random));
    }
  const Isometry3d T_depth_board = truth.rig.T_colour_depth.inverse() * T_colour_board;
  const Vector3d normal = T_depth_board.linear().col(2);
  for (int y = 0; y < depth.height_px; y += 8)
    for (int x = 0; x < depth.width_px; x += 8) {
      const PlanePoint<double> ray =
          undistorted({(x - depth.cx_px) / depth.fx_px, (y - depth.cy_px) / depth.fy_px}, truth.depth_lens);
      const double z = normal.dot(T_depth_board.translation()) / normal.dot(Vector3d(ray.x, ray.y, 1.0));
      const Vector3d p_board = T_depth_board.inverse() * Vector3d(ray.x * z, ray.y * z, z);
      if (!(z > 0.0) || p_board.x() < 0.0 || p_board.y() < 0.0 || p_board.x() > 7 * kBoard.square_m ||
          p_board.y() > 5 * kBoard.square_m)
        continue;
      const double offset = offset_per_m(truth.depth_correction, depth.width_px, depth.height_px, x, y);
      const double reported = truth.depth_correction.inverse_scale / (1.0 / z - offset);
      view.depth.push_back(
          {static_cast<double>(x), static_cast<double>(y),
           reported + depth_sigma_m(DepthNoise{}, static_cast<float>(z)) * gaussian(random)});
    }
  return view;
}

/// @param tilt_rad  max tilt of the board
BoardViews views_of_board(const Calibration& truth, int count, double tilt_rad) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  BoardViews views;
  views.frames = views.with_board = count;
  views.first.depth_m.resize(640, 480);
  views.first.depth_camera = views.first.colour_camera = kKinectDepthCamera;
  views.first.T_colour_depth = beside();
  for (int i = 0; i < count; ++i) {
    const double z = 1.4 + 0.7 * uniform(random);
    Isometry3d T_colour_board = Isometry3d::Identity();
    T_colour_board.translate(Vector3d(0.35 * z * uniform(random), 0.25 * z * uniform(random), z));
    T_colour_board.rotate(Eigen::AngleAxisd(0.6 * uniform(random), Vector3d::UnitZ()));
    T_colour_board.rotate(Eigen::AngleAxisd(tilt_rad * uniform(random), Vector3d::UnitX()));
    T_colour_board.rotate(Eigen::AngleAxisd(tilt_rad * uniform(random), Vector3d::UnitY()));
    T_colour_board.translate(Vector3d(-3.5 * kBoard.square_m, -2.5 * kBoard.square_m, 0.0));
    views.views.push_back(view_of_board(truth, T_colour_board, random));
  }
  return views;
}

TEST(Lens, DistortsAsOpenCvDoes) {
  const cv::Matx33d unit = cv::Matx33d::eye();
  for (const double x : {-0.5, 0.0, 0.31})
    for (const double y : {-0.4, 0.0, 0.27}) {
      std::vector<cv::Point2d> seen;
      cv::projectPoints(std::vector<cv::Point3d>{{x, y, 1.0}}, cv::Vec3d(), cv::Vec3d(), unit,
                        cv::Vec<double, 5>(kBarrel.k1, kBarrel.k2, kBarrel.p1, kBarrel.p2, kBarrel.k3), seen);
      const PlanePoint<double> ours = distorted({x, y}, kBarrel);
      EXPECT_NEAR(ours.x, seen[0].x, 1e-12);
      EXPECT_NEAR(ours.y, seen[0].y, 1e-12);
    }
}

TEST(Lens, UndistortsToWhereItCameFrom) {
  for (double x = -0.55; x <= 0.55; x += 0.05)
    for (double y = -0.42; y <= 0.42; y += 0.05) {
      const PlanePoint<double> back = undistorted(distorted({x, y}, kBarrel), kBarrel);
      EXPECT_NEAR(back.x, x, 1e-12);
      EXPECT_NEAR(back.y, y, 1e-12);
      // Each lens moves a corner by a tenth of its distance from the centre.
      for (const Lens& lens : {Lens{.k1 = 0.2}, Lens{.k2 = 0.4}, Lens{.k3 = 0.9}, Lens{.k1 = -0.2}}) {
        const PlanePoint<double> of_bent = undistorted(distorted({x, y}, lens), lens);
        EXPECT_NEAR(of_bent.x, x, 1e-12);
        EXPECT_NEAR(of_bent.y, y, 1e-12);
      }
    }
  // A lens that folds the image has no inverse; the iteration still ends, with a finite result.
  const PlanePoint<double> folded = undistorted({0.5, 0.4}, Lens{.k1 = -3.0});
  EXPECT_TRUE(std::isfinite(folded.x) && std::isfinite(folded.y));
  const PlanePoint<double> same = distorted({0.3, -0.2}, Lens{});
  EXPECT_EQ(same.x, 0.3);
  EXPECT_EQ(same.y, -0.2);
}

TEST(Calibration, ItsFileComesBackAsItWas) {
  const TemporaryFolder folder;
  const Calibration written = faulty_kinect();
  write_calibration(written, folder.path() / "c.json");
  const Calibration read = read_calibration(folder.path() / "c.json");
  EXPECT_EQ(read.rig.depth_camera, written.rig.depth_camera);
  EXPECT_EQ(read.rig.colour_camera, written.rig.colour_camera);
  EXPECT_TRUE(read.rig.T_colour_depth.isApprox(written.rig.T_colour_depth, 1e-12));
  EXPECT_EQ(read.depth_lens, written.depth_lens);
  EXPECT_EQ(read.colour_lens, written.colour_lens);
  EXPECT_EQ(read.depth_correction.inverse_scale, written.depth_correction.inverse_scale);
  EXPECT_EQ(read.depth_correction.offset_per_m, written.depth_correction.offset_per_m);
}

TEST(Calibration, AFileThatIsBrokenIsNamedWithItsFault) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "c.json";
  write_calibration(faulty_kinect(), path);
  std::stringstream whole;
  whole << std::ifstream(path).rdbuf();
  const auto fault_of = [&](const std::string& from, const std::string& to) {
    std::string text = whole.str();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(path) << text.replace(at, from.size(), to);
    const std::string fault = error_of([&] { read_calibration(path); });
    EXPECT_NE(fault.find("c.json"), std::string::npos) << fault;
    return fault;
  };
  EXPECT_NE(fault_of("roomradar calibration", "roomradar camera").find("format"), std::string::npos);
  EXPECT_NE(fault_of("\"columns\": 65", "\"columns\": 64").find("offset_per_m"), std::string::npos);
  EXPECT_NE(fault_of("\"columns\": 65", "\"columns\": 1e9").find("columns"), std::string::npos);
  EXPECT_NE(fault_of("\"inverse_scale\": 1.006", "\"inverse_scale\": 0").find("inverse_scale"),
            std::string::npos);
  EXPECT_NE(fault_of("\"k1\": -0.06", "\"k1\": -60").find("depth_lens"), std::string::npos);
  EXPECT_NE(fault_of("\"k1\": -0.06", "\"k1\": \"x\"").find("k1"), std::string::npos);
  std::ofstream(path) << whole.str().substr(0, whole.str().size() / 2);
  EXPECT_NE(error_of([&] { read_calibration(path); }).find("cut short"), std::string::npos);
}

/// A source that delivers a prepared frame.
class GivenFrame final : public FrameSource {
 public:
  explicit GivenFrame(Frame frame) : frame_(std::move(frame)) {}
  ReadResult next(Frame& frame) override {
    frame = frame_;
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override { return true; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return 1; }
  [[nodiscard]] std::string name() const override { return "given"; }

 private:
  Frame frame_;
};

TEST(CalibratedSource, APlaneThroughABentLensAndWithWrongDepthIsThePlaneAgain) {
  const Calibration truth = faulty_kinect();
  const Vector3d normal = Vector3d(0.3, -0.2, 1.0).normalized();
  const auto plane_m = [&](double x, double y) { return 1.8 / normal.dot(Vector3d(x, y, 1.0)); };
  Frame real;
  real.depth_m.resize(640, 480);
  const Intrinsics& camera = truth.rig.depth_camera;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const PlanePoint<double> ray = undistorted(
          {(x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px}, truth.depth_lens);
      const double offset = offset_per_m(truth.depth_correction, 640, 480, x, y);
      real.depth_m.at(x, y) =
          static_cast<float>(truth.depth_correction.inverse_scale / (1.0 / plane_m(ray.x, ray.y) - offset));
    }
  real.depth_m.at(320, 240) = 0.0F;
  const auto source = calibrated(std::make_unique<GivenFrame>(real), truth);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);  // the second read gives the same
  EXPECT_EQ(frame.depth_camera, camera);
  int seen = 0;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      if (frame.depth_m.at(x, y) == 0.0F) continue;
      ++seen;
      // The nearest pixel is up to 0.7 px off, and the plane's slope is 0.36 m per metre: 1.2 mm.
      const Vector3d ray = back_project(camera, x, y, 1.0);
      ASSERT_NEAR(frame.depth_m.at(x, y), plane_m(ray.x(), ray.y()), 0.0016) << x << ", " << y;
    }
  EXPECT_GT(seen, 0.98 * 640 * 480);
  EXPECT_LT(seen, 640 * 480);
}

TEST(CalibratedSource, AColourSeenThroughABentLensIsWhereThePinholeHasIt) {
  const Calibration truth = faulty_kinect();
  const Intrinsics& camera = *truth.rig.colour_camera;
  const auto colour_of = [](const PlanePoint<double>& p) {  // colour in a pixel's direction
    const auto byte = [](double wave) { return static_cast<std::uint8_t>(128.5 + 100.0 * std::sin(wave)); };
    return Rgb{byte(10.0 * p.x), byte(10.0 * p.y), byte(7.0 * (p.x - p.y))};
  };
  const auto plane_at = [&](int x, int y) {
    return PlanePoint<double>{(x - camera.cx_px) / camera.fx_px, (y - camera.cy_px) / camera.fy_px};
  };
  Frame real;
  real.depth_m.resize(640, 480);
  real.colour.resize(640, 480);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      real.colour.at(x, y) = colour_of(undistorted(plane_at(x, y), truth.colour_lens));
  const auto source = calibrated(std::make_unique<GivenFrame>(real), truth);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.colour_camera, camera);
  EXPECT_TRUE(frame.T_colour_depth.isApprox(truth.rig.T_colour_depth));
  int seen = 0, moved = 0;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const Rgb pixel = frame.colour.at(x, y), ideal = colour_of(plane_at(x, y)),
                before = real.colour.at(x, y);
      if (pixel.r == 0 && pixel.g == 0 && pixel.b == 0) continue;  // outside the real image
      if (x < 8 || y < 8 || x >= 632 || y >= 472) continue;        // partly outside
      ++seen;
      ASSERT_NEAR(pixel.r, ideal.r, 2) << x << ", " << y;
      ASSERT_NEAR(pixel.g, ideal.g, 2) << x << ", " << y;
      ASSERT_NEAR(pixel.b, ideal.b, 2) << x << ", " << y;
      moved += std::abs(before.r - ideal.r) + std::abs(before.g - ideal.g) > 3 ? 1 : 0;
    }
  EXPECT_GT(seen, 0.9 * 640 * 480);
  EXPECT_GT(moved, 1000) << "or the lens would not have shown";
}

TEST(CalibratedSource, AFrameWithoutItsColourHasTheSameCamerasAsTheOthers) {
  const Calibration truth = faulty_kinect();
  Frame depth_only;
  depth_only.depth_m.resize(640, 480, 1.5F);
  depth_only.colour_camera = {640, 480, 525.0, 525.0, 319.5, 239.5};
  const auto source = calibrated(std::make_unique<GivenFrame>(depth_only), truth);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_TRUE(frame.colour.empty());
  EXPECT_EQ(frame.colour_camera, *truth.rig.colour_camera);
  EXPECT_TRUE(frame.T_colour_depth.isApprox(truth.rig.T_colour_depth));
  // A device without a colour camera does not get one.
  depth_only.colour_camera = {};
  ASSERT_EQ(calibrated(std::make_unique<GivenFrame>(depth_only), truth)->next(frame).status,
            ReadStatus::kFrame);
  EXPECT_EQ(frame.colour_camera.width_px, 0);
}

TEST(CalibratedSource, ImagesOfAnotherSizeAreRefusedWithBothSizes) {
  Frame small;
  small.depth_m.resize(320, 240);
  const auto source = calibrated(std::make_unique<GivenFrame>(small), faulty_kinect());
  Frame frame;
  const std::string fault = error_of([&] { (void)source->next(frame); });
  EXPECT_NE(fault.find("320 x 240"), std::string::npos) << fault;
  EXPECT_NE(fault.find("640 x 480"), std::string::npos) << fault;
}

TEST(BoardViews, AreOfTheWholeStillBoardWithItsDepthOnIt) {
  SimulatedSource simulated(
      parse_sim_spec("sim:board?path=swing&colour=separate&faults=1&frames=40&rate=15"));
  std::vector<Frame> frames;
  for (Frame frame; simulated.next(frame).status == ReadStatus::kFrame;) frames.push_back(frame);
  KeptSource source(std::move(frames));
  std::size_t told = 0;
  const BoardViews views = find_board_views(source, kBoard, 100, [&](const BoardViews&) { ++told; });
  EXPECT_EQ(views.frames, 40);
  EXPECT_EQ(told, 40U);
  EXPECT_GE(views.with_board, 20);
  ASSERT_GE(views.views.size(), 3U);
  EXPECT_TRUE(views.off_plane_ratios.empty());
  for (const BoardView& view : views.views) {
    EXPECT_EQ(view.corners_px.size(), 48U);
    EXPECT_GE(view.depth.size(), 40U);
    const ViewResidual residual =
        residual_of(view, kBoard,
                    {.rig = {views.first.depth_camera, views.first.colour_camera, views.first.T_colour_depth},
                     .depth_lens = {},
                     .colour_lens = {},
                     .depth_correction = {}});
    EXPECT_LT(residual.colour_rms_px, 1.0) << "the bent lens";
    EXPECT_LT(std::abs(residual.depth_bias_m), 0.05 * residual.distance_m) << "the faults";
  }
  // With squares stated as half as large, no view fits, and the error suggests the size that would.
  ASSERT_TRUE(source.rewind());
  BoardViews wrong = find_board_views(source, Board{8, 6, 0.03}, 100, [](const BoardViews&) {});
  EXPECT_TRUE(wrong.views.empty());
  ASSERT_GE(wrong.off_plane_ratios.size(), 3U);
  for (const double ratio : wrong.off_plane_ratios) EXPECT_NEAR(ratio, 2.0, 0.1);
  wrong.off_plane_ratios.resize(4, 2.0);
  EXPECT_NE(advice_on(wrong, Board{8, 6, 0.03}).find("the squares seem to be 0.06 m, not 0.03 m"),
            std::string::npos)
      << advice_on(wrong, Board{8, 6, 0.03});
  const std::string fault = error_of([&] { (void)calibrate(wrong, {.board = Board{8, 6, 0.03}}); });
  EXPECT_NE(fault.find("--square"), std::string::npos) << fault;
}

TEST(BoardViews, WhatIsMissingIsSaidWhileItIsRead) {
  const Board board{8, 6, 0.03};
  BoardViews views;
  EXPECT_EQ(advice_on(views, board), "");  // nothing was read so far
  views.frames = 100;
  EXPECT_NE(advice_on(views, board).find("no board of 8 by 6 inner corners"), std::string::npos);
  views.with_board = 100;
  EXPECT_NE(advice_on(views, board).find("hold it still"), std::string::npos);
  views.still = 50;
  views.views.resize(9);  // all facing the camera
  EXPECT_EQ(count_tilted(views), 0U);
  EXPECT_NE(advice_on(views, board).find("tilt the board"), std::string::npos);
  for (int i = 0; i < 9; ++i)
    views.views[static_cast<std::size_t>(i)].normal_camera =
        Eigen::AngleAxisd(0.6, Eigen::Vector3d(std::cos(i), std::sin(i), 0.0)) * Eigen::Vector3d::UnitZ();
  EXPECT_GE(count_tilted(views), 8U);
  EXPECT_EQ(advice_on(views, board), "");
}

TEST(BoardViews, ASourceWithoutColourIsNotReadToItsEnd) {
  SimulatedSource source(parse_sim_spec("sim:board?colour=none&frames=80&width=80"));
  int told = 0;
  const std::string fault =
      error_of([&] { (void)find_board_views(source, kBoard, 100, [&](const BoardViews&) { ++told; }); });
  EXPECT_NE(fault.find("has no colour images"), std::string::npos) << fault;
  EXPECT_EQ(told, 59);
}

TEST(BoardViews, RegisteredDepthIsNoticed) {
  Frame frame;
  EXPECT_TRUE(SimulatedSource(parse_sim_spec("sim:board?frames=1")).next(frame).status == ReadStatus::kFrame);
  EXPECT_TRUE(is_registered(frame));
  EXPECT_TRUE(SimulatedSource(parse_sim_spec("sim:board?frames=1&colour=separate")).next(frame).status ==
              ReadStatus::kFrame);
  EXPECT_FALSE(is_registered(frame));
}

TEST(Calibrate, WhatNoFileWouldBeReadWithIsNoCalibration) {
  Calibration fit = faulty_kinect();
  require_valid(fit, "the fit");
  fit.colour_lens.k3 = 40.0;
  EXPECT_NE(error_of([&] { require_valid(fit, "the fit"); }).find("the fit, colour_lens"), std::string::npos);
  fit = faulty_kinect();
  fit.depth_correction.inverse_scale = 2.5;
  EXPECT_NE(error_of([&] { require_valid(fit, "the fit"); }).find("inverse_scale"), std::string::npos);
  fit = faulty_kinect();
  fit.depth_correction.offset_per_m[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { require_valid(fit, "the fit"); }).find("offset_per_m"), std::string::npos);
}

TEST(Calibrate, FindsAKinectWithKnownFaults) {
  const Calibration truth = faulty_kinect();
  const BoardViews views = views_of_board(truth, 60, 0.75);
  const CalibrationFit fit = calibrate(views, {.board = kBoard});
  const Calibration& found = fit.calibration;
  const auto within = [](double value, double expected, double sigma, const char* what) {
    EXPECT_NEAR(value, expected, 4.0 * sigma) << what;
  };
  const Intrinsics& colour = *truth.rig.colour_camera;
  within(found.rig.colour_camera->fx_px, colour.fx_px, fit.sigmas.colour_focal_px, "colour fx");
  within(found.rig.colour_camera->fy_px, colour.fy_px, fit.sigmas.colour_focal_px, "colour fy");
  within(found.rig.colour_camera->cx_px, colour.cx_px, fit.sigmas.colour_centre_px, "colour cx");
  within(found.rig.colour_camera->cy_px, colour.cy_px, fit.sigmas.colour_centre_px, "colour cy");
  within(found.rig.depth_camera.fx_px, truth.rig.depth_camera.fx_px, fit.sigmas.depth_focal_px, "depth fx");
  within(found.rig.depth_camera.fy_px, truth.rig.depth_camera.fy_px, fit.sigmas.depth_focal_px, "depth fy");
  within(found.rig.depth_camera.cx_px, truth.rig.depth_camera.cx_px, fit.sigmas.depth_centre_px, "depth cx");
  within(found.rig.depth_camera.cy_px, truth.rig.depth_camera.cy_px, fit.sigmas.depth_centre_px, "depth cy");
  const Isometry3d off = found.rig.T_colour_depth.inverse() * truth.rig.T_colour_depth;
  EXPECT_LT(off.translation().norm(), 5.0 * fit.sigmas.shift_m);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 5.0 * fit.sigmas.turn_rad);
  EXPECT_LT(fit.sigmas.colour_focal_px, 0.5);
  EXPECT_LT(fit.sigmas.depth_focal_px, 3.0);
  ASSERT_EQ(fit.held_out.size(), 12U);
  for (const std::size_t i : fit.held_out) {
    EXPECT_LT(fit.after[i].colour_rms_px, 0.2);
    EXPECT_LT(std::abs(fit.after[i].depth_bias_m), 0.0025) << "at " << fit.after[i].distance_m;
  }
  EXPECT_EQ(calibration_plot(views, fit).width, 1200);
}

TEST(Calibrate, ABoardThatWasNeverTiltedIsRefused) {
  const std::string fault =
      error_of([] { (void)calibrate(views_of_board(faulty_kinect(), 20, 0.0), {.board = kBoard}); });
  EXPECT_NE(fault.find("tilt"), std::string::npos) << fault;
}

TEST(Calibrate, TooFewViewsAreCounted) {
  const std::string fault =
      error_of([] { (void)calibrate(views_of_board(faulty_kinect(), 5, 0.7), {.board = kBoard}); });
  EXPECT_NE(fault.find("5 of these"), std::string::npos) << fault;
}

TEST(BoardViews, CornersAreFoundToAFractionOfAPixel) {
  SimOptions options = parse_sim_spec("sim:board?path=swing&colour=separate&frames=40&rate=2");
  SimulatedSource source(options);
  Frame frame;
  int found = 0;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(source.seek(6 * i));
    ASSERT_EQ(source.next(frame).status, ReadStatus::kFrame);
    const auto corners_px = find_corners(frame.colour, kBoard);
    if (!corners_px) continue;
    ++found;
    const Isometry3d T_colour_world = frame.T_colour_depth * frame.T_world_camera->inverse();
    double sum_px2 = 0.0;
    for (const Eigen::Vector2d& corner : *corners_px) {
      double nearest_px2 = 1e9;
      for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 8; ++column) {
          const Vector3d p_world((column - 3.5) * 0.06, 0.0, 1.4 + (row - 2.5) * 0.06);
          nearest_px2 = std::min(
              nearest_px2, (project(frame.colour_camera, T_colour_world * p_world) - corner).squaredNorm());
        }
      sum_px2 += nearest_px2;
    }
    EXPECT_LT(std::sqrt(sum_px2 / static_cast<double>(corners_px->size())), 0.15) << "frame " << 6 * i;
  }
  EXPECT_GE(found, 3);
}

TEST(BoardViews, AnImageWithoutABoardHasNone) {
  EXPECT_FALSE(find_corners(ColourImage(640, 480, Rgb{120, 130, 140}), kBoard));
}

TEST(BoardViews, ABoardThatCannotBeIsRefused) {
  EXPECT_NE(error_of([] { require_valid(Board{6, 6, 0.03}); }).find("not square"), std::string::npos);
  EXPECT_NE(error_of([] { require_valid(Board{2, 6, 0.03}); }).find("3 to 30"), std::string::npos);
  EXPECT_NE(error_of([] { require_valid(Board{8, 6, 0.0}); }).find("0.001"), std::string::npos);
}

}  // namespace
}  // namespace roomradar::test::calibration_test
