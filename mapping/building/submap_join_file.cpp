// submap_join_file.cpp: joins as one binary file, with a checksum.
#include "mapping/building/submap_join_file.hpp"

#include <string>

#include "mapping/storage/binary_file.hpp"
#include "mapping/types/serialize.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kJoinsMagic = "RRJOINED";
constexpr std::uint32_t kJoinsVersion = 1;

}  // namespace

template <typename Archive>
static void serialize(Archive& archive, KeyframeLink& link) {
  auto a = static_cast<std::uint64_t>(link.a), b = static_cast<std::uint64_t>(link.b);
  serialize(archive, a);
  serialize(archive, b);
  serialize(archive, link.T_a_b);
  serialize(archive, link.information);
  if constexpr (Archive::kReads) {
    if (!link.information.allFinite()) archive.fail("is damaged: a link's information is not a number");
    link.a = a;
    link.b = b;
  }
}

template <typename Archive>
static void serialize(Archive& archive, SubmapJoin& join) {
  serialize(archive, join.status, JoinStatus::kLooksDifferent);
  serialize(archive, join.links);
  serialize(archive, join.T_a_b);
  serialize(archive, join.agreeing);
  serialize(archive, join.expected);
  serialize(archive, join.recognised);
  serialize(archive, join.agreement);
}

void save_joins(const std::vector<SubmapJoin>& joins, const std::filesystem::path& path) {
  ByteWriter out;
  std::vector<SubmapJoin> copy = joins;
  serialize(out, copy);
  write_binary(path, kJoinsMagic, kJoinsVersion, out.bytes());
}

std::vector<SubmapJoin> load_joins(const std::filesystem::path& path) {
  const std::string bytes = read_binary(path, kJoinsMagic, kJoinsVersion);
  ByteReader in(bytes, path.string());
  std::vector<SubmapJoin> joins;
  serialize(in, joins);
  in.require_end();
  return joins;
}

}  // namespace roomradar
