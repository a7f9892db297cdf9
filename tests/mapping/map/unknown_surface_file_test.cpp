// unknown_surface_file_test.cpp: the border of unknown space comes back from its file, and damage is
// reported.
#include "mapping/surface/unknown/unknown_surface.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "mapping/map/map_folder.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::unknown_surface_file_test {
namespace {

using Eigen::Vector3i;
using test::error_of;

/// Returns a surface with random cells and a small mesh; the two need not fit each other.
UnknownSurface random_surface(const Vector3i& size, std::uint32_t seed) {
  std::mt19937 random(seed);
  UnknownSurface surface;
  surface.grid = {Vector3i(-30, 5, -2), size, 0.02};
  BitGrid cells(size, false);
  for (int i = 0; i < 60; ++i) {
    const Vector3i low(static_cast<int>(random() % static_cast<unsigned>(size.x())),
                       static_cast<int>(random() % static_cast<unsigned>(size.y())),
                       static_cast<int>(random() % static_cast<unsigned>(size.z())));
    cells.set_box(low, low + Vector3i(static_cast<int>(random() % 90), 2, 1), random() % 3 != 0);
  }
  surface.unknown = RunGrid(cells);
  surface.mesh_world.origin = {1.25, -2.5, 0.125};
  for (int i = 0; i < 9; ++i)
    surface.mesh_world.vertices.emplace_back(0.1F * static_cast<float>(i), 0.2F, -0.3F);
  surface.mesh_world.triangles = {{0, 1, 2}, {3, 4, 8}};
  return surface;
}

std::string refusal(const std::filesystem::path& path) {
  return error_of([&] { static_cast<void>(read_unknown_surface(path)); });
}

TEST(UnknownSurfaceFile, ComesBackToTheBit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  for (const Vector3i& size :
       {Vector3i(1, 1, 1), Vector3i(63, 4, 3), Vector3i(64, 3, 2), Vector3i(65, 5, 4), Vector3i(200, 7, 9)}) {
    UnknownSurface surface = random_surface(size, static_cast<std::uint32_t>(size.x()));
    for (const bool is_full : {false, true}) {  // full: one run across all rows
      if (is_full) surface.unknown = RunGrid(BitGrid(size, true));
      write_unknown_surface(surface, path);
      const UnknownSurface read = read_unknown_surface(path);
      EXPECT_EQ(read.grid.first_cell, surface.grid.first_cell);
      EXPECT_EQ(read.grid.size, surface.grid.size);
      EXPECT_EQ(read.grid.cell_m, surface.grid.cell_m);
      EXPECT_TRUE(read.unknown == surface.unknown) << size.transpose();
      EXPECT_EQ(read.mesh_world.origin, surface.mesh_world.origin);
      EXPECT_EQ(read.mesh_world.vertices, surface.mesh_world.vertices);
      EXPECT_EQ(read.mesh_world.triangles, surface.mesh_world.triangles);
    }
  }
}

TEST(UnknownSurfaceFile, TheVersionBeforeIsRead) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  const UnknownSurface surface = random_surface({200, 7, 9}, 3);
  write_unknown_surface(surface, path);
  const std::string body = read_binary(path, "RRUNKNWN", 2);
  const auto words = ColumnReader(body, path.string()).take<std::uint32_t>("words");
  write_binary(path, "RRUNKNWN", 1, {reinterpret_cast<const char*>(words.data()), 4 * words.size()});
  const UnknownSurface read = read_unknown_surface(path);
  EXPECT_TRUE(read.unknown == surface.unknown);
  EXPECT_EQ(read.mesh_world.vertices, surface.mesh_world.vertices);
}

TEST(UnknownSurfaceFile, AMapWithoutFreeSpaceHasAnEmptyOne) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  write_unknown_surface({}, path);
  const UnknownSurface read = read_unknown_surface(path);
  EXPECT_TRUE(read.mesh_world.triangles.empty());
  EXPECT_FALSE(is_unknown(read, {0.0, 0.0, 0.0}));
}

TEST(UnknownSurfaceFile, WhatIsCutOrAlteredIsRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  write_unknown_surface(random_surface({70, 5, 4}, 1), path);
  const std::string whole = read_bytes(path, "a test file", 1U << 20U);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    write_bytes(path, whole.substr(0, size));
    EXPECT_NE(refusal(path).find("unknown.bin"), std::string::npos) << size << ": " << refusal(path);
  }
  std::string altered = whole;
  altered[whole.size() / 2] = static_cast<char>(altered[whole.size() / 2] ^ 4);
  write_bytes(path, altered);
  EXPECT_NE(refusal(path).find("altered"), std::string::npos) << refusal(path);
}

TEST(UnknownSurfaceFile, ContentsThatNoMapHasAreRefused) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  const UnknownSurface sound = random_surface({70, 5, 4}, 1);
  const auto expect_refused = [&](const UnknownSurface& surface, const char* reason) {
    write_unknown_surface(surface, path);
    EXPECT_NE(refusal(path).find(reason), std::string::npos) << refusal(path);
  };
  UnknownSurface bad = sound;
  bad.grid.size = {70, 5, 3};  // fewer cells than the runs
  expect_refused(bad, "leaves the grid");
  bad = sound;
  bad.grid.size = {100'000, 100'000, 100'000};
  expect_refused(bad, "a grid of");
  bad = sound;
  bad.grid.size.y() = -1;
  expect_refused(bad, "a grid of");
  bad = sound;
  bad.grid.cell_m = 0.0;
  expect_refused(bad, "cells of");
  bad = sound;
  bad.grid.cell_m = std::numeric_limits<double>::quiet_NaN();
  expect_refused(bad, "edge of a cell");
  bad = sound;
  bad.grid.first_cell.x() = 100'000'000;
  expect_refused(bad, "where no map reaches");
  bad = sound;
  bad.mesh_world.vertices[3].x() = std::numeric_limits<float>::quiet_NaN();
  expect_refused(bad, "vertex");
  bad = sound;
  bad.mesh_world.triangles.push_back({0, 1, 9});
  expect_refused(bad, "triangle");
  bad = sound;
  bad.mesh_world.origin.z() = std::numeric_limits<double>::infinity();
  expect_refused(bad, "origin");
}

TEST(UnknownSurfaceFile, CountsThatLieAreRefusedBeforeMemoryIsTaken) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "unknown.bin";
  ByteWriter body;
  body(0.01, 0, 0, 0, 10, 10, 10);
  ByteWriter no_runs = body;
  no_runs(0U, 0.0, 0.0, 0.0, 0xFFFFFFFFU);
  body(0xFFFFFFFFU);
  for (const std::string& lies : {body.bytes, no_runs.bytes}) {
    write_binary(path, "RRUNKNWN", 1, lies);
    EXPECT_NE(refusal(path).find("cut short"), std::string::npos) << refusal(path);
  }
}

}  // namespace
}  // namespace roomradar::unknown_surface_file_test
