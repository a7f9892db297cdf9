// keyframe_database_test.cpp: map keyframes on disk, and relocalisation among them.
#include "mapping/localization/keyframe_database.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::keyframe_database_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};

Frame painted(const Eigen::Isometry3d& T_world_camera, const test::Scene& scene = test::corner_with_ball()) {
  Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
  test::paint(frame, T_world_camera);
  test::add_depth_noise(frame, 7);
  return frame;
}

Eigen::Isometry3d eye(double x_m) { return test::looking_at({x_m, -0.3, 1.2}, {x_m, 2.0, 0.6}); }

KeyframeDatabase three_places() {
  KeyframeDatabase keyframe_database;
  for (const double x_m : {-0.8, 0.0, 0.8})
    keyframe_database.keyframes.push_back(make_map_keyframe(painted(eye(x_m)), eye(x_m)));
  return keyframe_database;
}

KeyframeDatabase without_features(KeyframeDatabase keyframe_database) {
  for (MapKeyframe& place : keyframe_database.keyframes) {
    place.descriptors.clear();
    place.points_camera.clear();
  }
  return keyframe_database;
}

double error_m(const Relocalisation& found, const Eigen::Isometry3d& truth) {
  return (found.T_world_camera.translation() - truth.translation()).norm();
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    (void)read_keyframe_database(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DescribePlace, FeaturePointsLieOnTheSurface) {
  const Eigen::Isometry3d T = eye(0.0);
  const MapKeyframe place = make_map_keyframe(painted(T), T);
  ASSERT_GT(place.descriptors.size(), 100U);
  ASSERT_EQ(place.descriptors.size(), place.points_camera.size());
  for (const Eigen::Vector3f& p : place.points_camera) {
    const Eigen::Vector3d direction = T.linear() * (p / p.z()).cast<double>();
    EXPECT_NEAR(static_cast<double>(p.z()), test::corner_with_ball()(T.translation(), direction), 0.1);
  }
  EXPECT_EQ(place.preview_camera.width_px, 160);
  EXPECT_NEAR(place.preview_depth_mm.at(80, 60) * 1e-3, static_cast<double>(painted(T).depth_m.at(160, 120)),
              0.05);
}

/// Expects equal databases. Points and directions may differ by their rounding.
void expect_near(const KeyframeDatabase& is, const KeyframeDatabase& was, float point_m, float direction) {
  const auto off = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return (a - b).cwiseAbs().maxCoeff();
  };
  ASSERT_EQ(is.keyframes.size(), was.keyframes.size());
  for (std::size_t i = 0; i < is.keyframes.size(); ++i) {
    const MapKeyframe &a = is.keyframes[i], &b = was.keyframes[i];
    EXPECT_EQ(a.frame_index, b.frame_index);
    EXPECT_EQ(a.T_world_camera.matrix(), b.T_world_camera.matrix());
    EXPECT_EQ(a.descriptors, b.descriptors);
    EXPECT_EQ(a.preview_depth_mm.pixels, b.preview_depth_mm.pixels);
    EXPECT_EQ(a.preview_camera, b.preview_camera);
    ASSERT_EQ(a.points_camera.size(), b.points_camera.size());
    for (std::size_t k = 0; k < a.points_camera.size(); ++k)
      EXPECT_LE(off(a.points_camera[k], b.points_camera[k]), point_m);
    ASSERT_EQ(a.patches.size(), b.patches.size());
    for (std::size_t k = 0; k < a.patches.size(); ++k) {
      EXPECT_LE(off(a.patches[k].point, b.patches[k].point), point_m);
      EXPECT_LE(off(a.patches[k].normal, b.patches[k].normal), direction);
      EXPECT_LE(off(a.patches[k].along, b.patches[k].along), direction);
      EXPECT_EQ(a.patches[k].size, b.patches[k].size);
      EXPECT_EQ(a.patches[k].bits, b.patches[k].bits);
    }
  }
}
constexpr float kPoint_m = 1.01e-4F, kDirection = 0.51F / 32767.0F;

TEST(PlacesFile, ComesBackAsItWasButForRounding) {
  const test::TemporaryFolder folder;
  const KeyframeDatabase keyframe_database = three_places();
  ASSERT_GT(keyframe_database.keyframes[0].patches.size(), 100U);
  write_keyframe_database(keyframe_database, folder.path() / "places.bin");
  const KeyframeDatabase read = read_keyframe_database(folder.path() / "places.bin");
  expect_near(read, keyframe_database, kPoint_m, kDirection);
  // Nothing is rounded twice.
  write_keyframe_database(read, folder.path() / "again.bin");
  expect_near(read_keyframe_database(folder.path() / "again.bin"), read, 0.0F, 0.0F);
  EXPECT_EQ(read_bytes(folder.path() / "again.bin"), read_bytes(folder.path() / "places.bin"));

  write_keyframe_database({}, folder.path() / "none.bin");
  EXPECT_TRUE(read_keyframe_database(folder.path() / "none.bin").keyframes.empty());
}

/// Returns the body of a file of version 2.
std::string body_of_version_2(const KeyframeDatabase& keyframe_database) {
  ByteWriter out;
  out(static_cast<std::uint32_t>(keyframe_database.keyframes.size()));
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    out(place.frame_index);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) out(place.T_world_camera.linear()(row, column));
    out(Eigen::Vector3d(place.T_world_camera.translation()));
    const Intrinsics& camera = place.preview_camera;
    out(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
    for (const std::uint16_t depth_mm : place.preview_depth_mm.pixels) out(depth_mm);
    out(static_cast<std::uint32_t>(place.descriptors.size()));
    for (const Eigen::Vector3f& p : place.points_camera) out(p);
    for (const Descriptor& bits : place.descriptors) out.raw(bits.data(), bits.size());
    out(static_cast<std::uint32_t>(place.patches.size()));
    for (const SurfacePatch& patch : place.patches) {
      out(patch.point, patch.normal, patch.along, patch.size);
      out.raw(patch.bits.data(), patch.bits.size());
    }
  }
  return out.bytes;
}

TEST(PlacesFile, TheVersionBeforeIsReadToTheBit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "places.bin";
  const KeyframeDatabase keyframe_database = three_places();
  const std::string body = body_of_version_2(keyframe_database);
  write_binary(path, "RRPLACES", 2, body);
  expect_near(read_keyframe_database(path), keyframe_database, 0.0F, 0.0F);
  for (std::size_t size = 0; size < body.size(); size += 1 + body.size() / 50) {
    write_binary(path, "RRPLACES", 2, body.substr(0, size));
    EXPECT_NE(refusal(path).find("cut short"), std::string::npos) << refusal(path);
  }
}

/// Writes one view of 2 x 1 pixels with a feature and a patch, as a file of the present version.
std::string refusal_of(const std::filesystem::path& path, const std::vector<std::uint16_t>& depth,
                       const std::vector<std::int32_t>& points, const std::vector<std::int16_t>& directions,
                       std::size_t bytes, std::uint32_t features = 1) {
  ByteWriter out;
  put_column(out.bytes, depth);
  put_column(out.bytes, points);
  put_column(out.bytes, directions);
  put_column(out.bytes, std::vector<std::uint8_t>(bytes));
  out(1U, std::int64_t{0}, Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(0.0, 0.0, 0.0));
  out(2U, 1U, 2.0, 2.0, 0.5, 0.5, features, 1U);
  write_binary(path, "RRPLACES", 3, out.bytes);
  return refusal(path);
}

TEST(PlacesFile, ColumnsThatDoNotFitTheViewsAreRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "places.bin";
  const std::vector<std::int32_t> points(6);
  const std::vector<std::int16_t> right{32767, 0, 0, 0, 32767, 0}, parallel{32767, 0, 0, 32767, 0, 0};
  EXPECT_EQ(refusal_of(path, {1, 2}, points, right, 65), "accepted");
  EXPECT_EQ(read_keyframe_database(path).keyframes[0].preview_depth_mm.at(1, 0), 3);
  EXPECT_NE(refusal_of(path, {1}, points, right, 65).find("preview depth missing"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, points, right, 64).find("missing"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, points, right, 65, 9999).find("missing"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, {0, 0, 0, 0, 0}, right, 65).find("missing"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, points, {32767, 0, 0, 0, 32767}, 65).find("missing"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, points, parallel, 65).find("right angles"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2, 3}, points, right, 65).find("more than"), std::string::npos);
  EXPECT_NE(refusal_of(path, {1, 2}, points, right, 66).find("more than"), std::string::npos);
}

TEST(PlacesFile, WhatIsCutOrAlteredIsRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "places.bin";
  write_keyframe_database(three_places(), path);
  const std::string whole = read_bytes(path);
  for (const std::size_t size : {std::size_t{0}, std::size_t{4}, std::size_t{11}, std::size_t{17},
                                 whole.size() / 2, whole.size() - 1}) {
    write_bytes(path, whole.substr(0, size));
    EXPECT_NE(refusal(path).find("places.bin"), std::string::npos) << size << ": " << refusal(path);
  }
  for (const std::size_t at : {std::size_t{13}, std::size_t{100}, whole.size() / 2, whole.size() - 3}) {
    std::string altered = whole;
    altered[at] = static_cast<char>(altered[at] ^ 0x10);
    write_bytes(path, altered);
    EXPECT_NE(refusal(path).find("altered"), std::string::npos) << at << ": " << refusal(path);
  }
  std::string later = whole;
  later[8] = 9;
  write_bytes(path, later);
  EXPECT_NE(refusal(path).find("version 9"), std::string::npos) << refusal(path);
  write_bytes(path, "garbage that is no file of places at all");
  EXPECT_NE(refusal(path).find("not a file of this kind"), std::string::npos);
  EXPECT_NE(refusal(folder.path() / "absent.bin").find("absent.bin"), std::string::npos);
}

TEST(PlacesFile, APlaceThatNoMapReachesIsRefused) {
  const test::TemporaryFolder folder;
  for (const double away_m : {-1.1e5, 1e12}) {
    KeyframeDatabase keyframe_database = three_places();
    keyframe_database.keyframes.back().T_world_camera.translation().z() = away_m;
    write_keyframe_database(keyframe_database, folder.path() / "far.bin");
    EXPECT_NE(refusal(folder.path() / "far.bin").find("where no map reaches"), std::string::npos) << away_m;
  }
}

TEST(PlacesFile, AViewOfMoreThanAnySearchComparesIsRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "crowded.bin";
  const auto most = static_cast<std::size_t>(kMostDescribed);
  for (const std::size_t count : {most, most + 1}) {
    const std::string wanted = count == most ? "accepted" : "a view of 10001 ";
    KeyframeDatabase features = three_places(), patches = features;
    features.keyframes.back().points_camera.resize(count, Eigen::Vector3f::Zero());
    features.keyframes.back().descriptors.resize(count);
    write_keyframe_database(features, path);
    EXPECT_NE(refusal(path).find(wanted), std::string::npos) << refusal(path);
    patches.keyframes.back().patches.resize(count);
    write_keyframe_database(patches, path);
    EXPECT_NE(refusal(path).find(wanted), std::string::npos) << refusal(path);
  }
}

TEST(PlacesFile, SizesThatLieAreRefusedBeforeMemoryIsTaken) {
  // A file with a correct checksum and wrong counts: 4 billion views, none of them present.
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "places.bin";
  std::string bytes("RRPLACES\x02\0\0\0\xff\xff\xff\xff", 16);
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  bytes.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
  write_bytes(path, bytes);
  EXPECT_NE(refusal(path).find("cut short"), std::string::npos) << refusal(path);
}

TEST(PlacesFile, AFolderThatIsNotThereIsNamed) {
  EXPECT_THROW(write_keyframe_database({}, "/no/such/folder/places.bin"), Error);
}

TEST(Relocalise, FindsAViewBetweenPlaces) {
  const Eigen::Isometry3d truth = eye(0.3) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  const Relocalisation found = relocalise(painted(truth), three_places());
  ASSERT_TRUE(found) << to_string(found.status);
  EXPECT_LT(error_m(found, truth), 0.015);
  EXPECT_GE(found.feature_inliers, 20);
  EXPECT_GT(found.depth_agreement, 0.7);
}

TEST(Relocalise, FollowsTheWorldWhenItIsTurned) {
  KeyframeDatabase keyframe_database = three_places();
  const Eigen::Isometry3d T_new_old =
      Eigen::Translation3d(300.0, 2.0, -1.0) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX());
  transform(keyframe_database, T_new_old);
  const Relocalisation found = relocalise(painted(eye(0.1)), keyframe_database);
  ASSERT_TRUE(found);
  EXPECT_LT(error_m(found, T_new_old * eye(0.1)), 0.015);
}

TEST(Relocalise, AnotherRoomIsNotFound) {
  using namespace test;
  const Scene other = nearest_of(plane({0, 0, 1}, 0.0), plane({0.6, 0.8, 0}, 2.0));
  const Eigen::Isometry3d elsewhere = looking_at({40, -30, 1.2}, {42, -28, 0.7});
  const Scene shifted = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    return other(from - Eigen::Vector3d(40, -30, 0), direction);
  };
  EXPECT_FALSE(relocalise(painted(elsewhere, shifted), three_places()));
  EXPECT_FALSE(relocalise(painted(elsewhere, shifted), without_features(three_places())));
}

TEST(Relocalise, SameLooksWithOtherDepthAreUnproven) {
  // A photograph of the room: every feature is present, on one flat board.
  Frame photograph = painted(eye(0.0));
  std::fill(photograph.depth_m.pixels.begin(), photograph.depth_m.pixels.end(), 1.0F);
  EXPECT_FALSE(relocalise(photograph, three_places()));
}

TEST(Relocalise, FeaturesWithoutTheDepthAreUnproven) {
  // The upper part of the image shows the room with its features; the lower part shows something nearer.
  Frame frame = painted(eye(0.0));
  for (int y = 2 * frame.depth_m.height / 5; y < frame.depth_m.height; ++y) {
    std::fill_n(frame.depth_m.row(y), frame.depth_m.width, 0.7F);
  }
  const KeyframeDatabase one{{three_places().keyframes[1]}, {}};
  EXPECT_TRUE(relocalise(painted(eye(0.0)), one));
  EXPECT_EQ(relocalise(frame, one).status, RelocalisationStatus::kNotVerified);
}

TEST(Relocalise, WithoutColourTheDepthDecides) {
  Frame frame = painted(eye(0.05));
  frame.colour.resize(0, 0);
  const Relocalisation found = relocalise(frame, without_features(three_places()));
  ASSERT_TRUE(found) << to_string(found.status);
  EXPECT_LT(error_m(found, eye(0.05)), 0.03);
  EXPECT_EQ(found.feature_inliers, 0);
}

TEST(Relocalise, WithoutColourItIsFoundAmongMoreViewsThanAreTried) {
  // Only the last of 130 views helps; the others show something else.
  KeyframeDatabase keyframe_database;
  MapKeyframe elsewhere = make_map_keyframe(painted(eye(0.0)), eye(0.0));
  for (std::uint16_t& mm : elsewhere.preview_depth_mm.pixels) mm = static_cast<std::uint16_t>(mm + 1000);
  keyframe_database.keyframes.assign(129, elsewhere);
  keyframe_database.keyframes.push_back(three_places().keyframes[1]);
  Frame frame = painted(eye(0.05));
  frame.colour.resize(0, 0);
  const Relocalisation found = relocalise(frame, without_features(keyframe_database));
  ASSERT_TRUE(found) << to_string(found.status);
  EXPECT_EQ(found.keyframe, 129);
  EXPECT_LT(error_m(found, eye(0.05)), 0.03);
}

TEST(Relocalise, SaysWhyItCannot) {
  EXPECT_EQ(relocalise(painted(eye(0.0)), {}).status, RelocalisationStatus::kNoKeyframes);
  Frame dark = painted(eye(0.0));
  std::fill(dark.depth_m.pixels.begin(), dark.depth_m.pixels.end(), 0.0F);
  EXPECT_EQ(relocalise(dark, three_places()).status, RelocalisationStatus::kNoDepth);
}

TEST(RelocaliseOnARecording, KitchenFramesAreFoundAgain) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  Odometry odometry;
  KeyframeDatabase keyframe_database;
  Frame frame;
  int asked = 0, right = 0, wrong = 0;
  while (source->next(frame).status == ReadStatus::kFrame && frame.index < 500) {
    ASSERT_TRUE(frame.T_world_camera);
    if (frame.index < 400) {
      if (frame.index % 4 == 0) odometry.add_posed(frame, *frame.T_world_camera);
      continue;
    }
    if (keyframe_database.keyframes.empty()) keyframe_database = odometry.take_keyframe_database();
    if (frame.index % 10 != 0) continue;
    ++asked;
    const Relocalisation found = relocalise(frame, keyframe_database);
    if (!found) continue;
    const Eigen::Isometry3d error = frame.T_world_camera->inverse() * found.T_world_camera;
    const bool near = error.translation().norm() < 0.05 && Eigen::AngleAxisd(error.linear()).angle() < 0.0873;
    right += near ? 1 : 0;
    // The recorded poses have errors of some centimetres.
    wrong += error.translation().norm() > 0.15 ? 1 : 0;
  }
  EXPECT_EQ(asked, 10);
  EXPECT_GE(right, 9);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace roomradar::keyframe_database_test
