// submap_join_file.cpp: joins as one binary file, with a checksum.
#include "mapping/building/submap_join_file.hpp"

#include <string_view>

#include "mapping/storage/binary_file.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kJoinsMagic = "RRJOINED";
constexpr std::uint32_t kJoinsVersion = 1;

}  // namespace

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, KeyframeLink> link) {
  static_assert(sizeof link.a == sizeof(std::uint64_t));
  archive(link.a, link.b, link.T_a_b);
  serialize_finite(archive, "is damaged: a link's information", link.information);
}

template <typename Archive>
static void serialize(Archive& archive, Ref<Archive, SubmapJoin> join) {
  serialize(archive, join.status, JoinStatus::kLooksDifferent);
  archive(join.links, join.T_a_b, join.agreeing, join.expected, join.recognised, join.agreement);
}

void save_joins(const std::vector<SubmapJoin>& joins, const std::filesystem::path& path) {
  save_binary(path, kJoinsMagic, kJoinsVersion, joins);
}

std::vector<SubmapJoin> load_joins(const std::filesystem::path& path) {
  std::vector<SubmapJoin> joins;
  load_binary(path, kJoinsMagic, kJoinsVersion, joins);
  return joins;
}

}  // namespace roomradar
