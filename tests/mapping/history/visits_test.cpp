// visits_test.cpp: blocks, plain forms, and revisions of a folder's files.
#include "mapping/history/visits.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "mapping/history/block_store.hpp"
#include "mapping/history/plain_form.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Bytes without a pattern, as of depth with noise.
std::string noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes;
  while (bytes.size() < count) bytes += static_cast<char>(random() & 15U);
  return bytes;
}

std::string text_of(const fs::path& path) { return read_bytes(path, "a file"); }

TEST(Blocks, ALocalChangeChangesFewBlocks) {
  const std::string before = noise(2'000'000, 1);
  std::string after = before;
  after.insert(1'000'000, "something new");
  const std::vector<std::string_view> old_blocks = cut_into_blocks(before), blocks = cut_into_blocks(after);
  std::string joined;
  for (const std::string_view block : blocks) joined += block;
  EXPECT_EQ(joined, after);
  const std::set<std::string_view> known(old_blocks.begin(), old_blocks.end());
  const auto changed = std::count_if(blocks.begin(), blocks.end(),
                                     [&](std::string_view block) { return !known.contains(block); });
  EXPECT_LE(changed, 3);
  EXPECT_GT(blocks.size(), 100U);
}

TEST(Blocks, EmptyTinyAndUniformBytes) {
  EXPECT_TRUE(cut_into_blocks("").empty());
  EXPECT_EQ(cut_into_blocks("x").size(), 1U);
  const std::string zeros(1'000'000, '\0');
  std::size_t bytes = 0;
  for (const std::string_view block : cut_into_blocks(zeros)) {
    EXPECT_LE(block.size(), 65536U);
    bytes += block.size();
  }
  EXPECT_EQ(bytes, zeros.size());
}

TEST(Blocks, StoreReadsWhatItWrote) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "blocks";
  std::vector<std::string> contents, sums;
  for (unsigned i = 0; i < 20; ++i) contents.push_back(noise(100 + 997 * i, i));
  {
    BlockStore store(file);
    for (const std::string& content : contents) sums.push_back(store.add(content));
    EXPECT_EQ(store.add(contents[3]), sums[3]);  // once only
    store.append();
  }
  const auto size = fs::file_size(file);
  const BlockStore store(file);
  for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(store.read(sums[i]), contents[i]);
  EXPECT_NE(test::error_of([&] { static_cast<void>(store.read(std::string(32, 'x'))); }).find("missing"),
            std::string::npos);
  BlockStore again(file);
  again.add(contents[5]);
  again.append();
  EXPECT_EQ(fs::file_size(file), size);
}

TEST(Blocks, ABlockCutOffByAKillIsReplaced) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "blocks";
  const std::string first = noise(5000, 1), second = noise(6000, 2), third = noise(7000, 3);
  std::string sum_first, sum_third;
  {
    BlockStore store(file);
    sum_first = store.add(first);
    store.append();
    store.add(second);
    store.append();
  }
  for (std::uintmax_t size = fs::file_size(file) - 1; size > 6000; size -= 500) {
    fs::resize_file(file, size);
    BlockStore store(file);
    sum_third = store.add(third);
    store.append();
    EXPECT_EQ(store.read(sum_first), first);
    EXPECT_EQ(BlockStore(file).read(sum_third), third);
    if (fs::file_size(file) < 6500) break;
  }
}

TEST(Blocks, DamageIsNoticed) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "blocks";
  std::string sum;
  {
    BlockStore store(file);
    sum = store.add(noise(5000, 1));
    store.append();
  }
  std::string bytes = text_of(file);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_bytes(file, bytes);
  EXPECT_NE(test::error_of([&] { static_cast<void>(BlockStore(file).read(sum)); }).find("damaged"),
            std::string::npos);
  write_bytes(file, "something else");
  EXPECT_NE(test::error_of([&] { BlockStore store(file); }).find("does not hold"), std::string::npos);
}

/// A binary PLY file as write_mesh() writes it, with triangles along a strip.
std::string ply_of(std::uint32_t vertices, std::uint32_t extra_at) {
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                    "\nproperty float x\nelement face " + std::to_string(vertices - 2) +
                    "\nproperty list uchar uint vertex_indices\nend_header\n";
  const auto number = [&](std::uint32_t value) {
    ply.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (std::uint32_t i = 0; i < vertices; ++i) number(i < extra_at ? i * 7919U : i * 7919U - 7919U);
  for (std::uint32_t i = 0; i + 2 < vertices; ++i) {
    ply += '\3';
    for (std::uint32_t k = 0; k < 3; ++k) number(i + k);
  }
  return ply;
}

TEST(PlainForm, RestoresEachFileBitByBit) {
  std::string columns = "header";
  std::vector<std::uint32_t> numbers(50'000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i * i);
  put_column(columns, numbers);
  put_column(columns, numbers);
  columns += "end";
  const std::string magic("\x28\xB5\x2F\xFD", 4);
  for (const std::string& file :
       {std::string(), std::string("x"), noise(10'000, 1), columns, columns.substr(0, columns.size() / 2),
        magic, magic + magic + "no frame", ply_of(1000, 2000), ply_of(1000, 2000).substr(0, 9000),
        std::string("ply\n")}) {
    const std::string plain = plain_form(file);
    EXPECT_EQ(from_plain_form(plain, "here"), file);
  }
  EXPECT_GT(plain_form(columns).size(), 2 * 200'000U);  // its frames are unpacked
}

TEST(PlainForm, AVertexMoreChangesTheIndicesAtOnePlaceOnly) {
  const std::string a = plain_form(ply_of(60'000, 100'000)), b = plain_form(ply_of(60'001, 30'000));
  const auto blocks_a = cut_into_blocks(a), blocks_b = cut_into_blocks(b);
  const std::set<std::string_view> known(blocks_a.begin(), blocks_a.end());
  const auto changed = std::count_if(blocks_b.begin(), blocks_b.end(),
                                     [&](std::string_view block) { return !known.contains(block); });
  EXPECT_LE(changed, 6);
}

TEST(PlainForm, DamageIsSaid) {
  EXPECT_NE(test::error_of([] { static_cast<void>(from_plain_form("\x09rest", "F")); }).find("F: "),
            std::string::npos);
  EXPECT_NE(test::error_of([] { static_cast<void>(from_plain_form("", "F")); }), "");
  EXPECT_NE(test::error_of([] { static_cast<void>(from_plain_form(std::string("\1\0", 2), "F")); }), "");
}

/// A folder with three files, saved over and over as a map is.
class Visits : public ::testing::Test {
 protected:
  static RevisionFiles files_of(const fs::path& folder) {
    RevisionFiles files;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("visits")) files[name] = {entry.file_size(), sha256_of_file(entry.path()), ""};
    }
    return files;
  }
  static std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> all;
    for (const auto& [name, file] : files_of(folder)) all[name] = text_of(folder / name);
    return all;
  }
  /// Saves the folder: the next revision has another small part in one file, and another file.
  void save(unsigned seed) {
    const fs::path next = at("next");
    fs::create_directory(next);
    std::string large = noise(300'000, 1);
    large.replace(1000 * seed, 20, noise(20, seed));
    std::string columns;
    put_column(columns, large.data(), large.size(), 1);
    write_bytes(next / "large.bin", columns);
    write_bytes(next / "same.txt", "always the same");
    write_bytes(next / "other.txt", "revision " + std::to_string(seed));
    if (seed % 3 == 0) write_bytes(next / "sometimes.txt", noise(5000, seed));
    const bool is_first = !fs::exists(map());
    const VisitsLock lock(map());
    record_visit(map(), is_first ? RevisionFiles() : files_of(map()), next, files_of(next),
                 {"test", "source", {{"appeared", {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, seed)}}}});
    fs::remove_all(map());
    fs::rename(next, map());
  }
  fs::path at(const char* name) const { return folder_.path() / name; }
  fs::path map() const { return at("map"); }
  std::map<std::string, std::string> extracted(int revision) const {
    fs::remove_all(at("out"));
    fs::create_directory(at("out"));
    extract_revision(map(), files_of(map()), revision, at("out"));
    return contents(at("out"));
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Visits, EachRevisionIsRestoredBitByBit) {
  std::vector<std::map<std::string, std::string>> saved;
  for (unsigned i = 0; i < 10; ++i) {
    save(i);
    saved.push_back(contents(map()));
  }
  for (int revision = 1; revision <= 10; ++revision)
    EXPECT_EQ(extracted(revision), saved[static_cast<std::size_t>(revision) - 1]) << revision;
  EXPECT_TRUE(verify_visits(map(), files_of(map())).empty());
  const std::vector<Visit> visits = read_visits(map());
  ASSERT_EQ(visits.size(), 10U);
  EXPECT_EQ(visits[4].revision, 5);
  EXPECT_EQ(visits[4].note.made_by, "test");
  EXPECT_EQ(visits[4].note.changes.at(0).box_world.max(), Eigen::Vector3d(1, 2, 4));
  EXPECT_NE(test::error_of([&] { extracted(11); }).find("1 to 10"), std::string::npos);
}

TEST_F(Visits, StoreOnlyWhatChanged) {
  save(0);
  save(1);
  const auto first = fs::file_size(map() / kVisitsBlocks);
  EXPECT_LT(first, 60'000U);  // of 300 kB
  for (unsigned i = 2; i < 12; ++i) save(i);
  EXPECT_LT(fs::file_size(map() / kVisitsBlocks), 12 * 60'000U);
}

TEST_F(Visits, PruningKeepsTheLatestAndFreesTheirBlocks) {
  std::vector<std::map<std::string, std::string>> saved;
  for (unsigned i = 0; i < 10; ++i) {
    save(i);
    saved.push_back(contents(map()));
  }
  const auto before = fs::file_size(map() / kVisitsBlocks);
  EXPECT_EQ(prune_visits(map(), files_of(map()), 3), 7);
  EXPECT_LT(fs::file_size(map() / kVisitsBlocks), before);
  for (int revision = 8; revision <= 10; ++revision)
    EXPECT_EQ(extracted(revision), saved[static_cast<std::size_t>(revision) - 1]) << revision;
  EXPECT_NE(test::error_of([&] { extracted(7); }).find("8 to 10"), std::string::npos);
  save(20);  // numbers go on
  EXPECT_EQ(read_visits(map()).back().revision, 11);
  EXPECT_EQ(extracted(9), saved[8]);
  EXPECT_EQ(prune_visits(map(), files_of(map()), 1), 3);
  EXPECT_FALSE(fs::exists(map() / kVisitsBlocks));
}

TEST_F(Visits, AFolderOfAnEarlierVersionIsTheFirstRevision) {
  save(0);
  const auto before = contents(map());
  fs::remove(map() / kVisitsLog);
  save(1);
  ASSERT_EQ(read_visits(map()).size(), 2U);
  EXPECT_EQ(extracted(1), before);
}

TEST_F(Visits, DamageCostsARevisionAndIsSaid) {
  for (unsigned i = 0; i < 4; ++i) save(i);
  std::string blocks = text_of(map() / kVisitsBlocks);
  blocks[blocks.size() / 3] = static_cast<char>(blocks[blocks.size() / 3] ^ 4);
  write_bytes(map() / kVisitsBlocks, blocks);
  EXPECT_FALSE(verify_visits(map(), files_of(map())).empty());
  fs::remove(map() / kVisitsBlocks);
  EXPECT_NE(test::error_of([&] { extracted(1); }).find("lost"), std::string::npos);
  EXPECT_EQ(extracted(4), contents(map()));  // the latest needs no blocks
  const std::string log = text_of(map() / kVisitsLog);
  for (const std::string& bad :
       {std::string("{}\n"), std::string("no JSON"), log + log, log.substr(0, log.size() / 2),
        std::string("{\"revision\":1,\"made_at\":\"\",\"made_by\":\"\",\"source\":\"\",\"changes\":[],"
                    "\"files\":{\"../x\":{\"bytes\":1,\"sha256\":\"\"}}}\n")}) {
    write_bytes(map() / kVisitsLog, bad);
    EXPECT_NE(test::error_of([&] { static_cast<void>(read_visits(map())); }).find("visits.jsonl: line"),
              std::string::npos);
  }
}

TEST_F(Visits, OneWriterAtATime) {
  save(0);
  const pid_t other = fork();
  if (other == 0) {
    const VisitsLock lock(map());
    write_bytes(at("held"), "");
    sleep(1);
    _exit(0);
  }
  while (!fs::exists(at("held"))) usleep(1000);
  const VisitsLock lock(map());  // waits
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, WNOHANG) == 0 ? 0 : status, 0);
  waitpid(other, &status, 0);
}

}  // namespace
}  // namespace roomradar
