// oni_file.cpp: parses the records of a .oni file; decompresses its depth.
#include "app/sources/containers/oni_file.hpp"

#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kRecordMagic = 0x0052494E;  // "NIR"
constexpr std::uint32_t kNodeAddedOldest = 2, kIntegerProperty = 3, kRealProperty = 4, kStringProperty = 5,
                        kGeneralProperty = 6, kNewData = 10, kEnd = 11, kNodeAddedOld = 12, kNodeAdded = 13;
constexpr std::uint64_t kFileHeader_bytes = 24;
constexpr std::uint32_t kMaxFields_bytes = 1U << 16U;

/// Reads a text with its length, which counts a zero at its end.
std::string read_oni_text(ByteReader& reader) {
  std::string text(reader.take(reader.number<std::uint32_t>()));
  while (text.ends_with('\0')) text.pop_back();
  return text;
}

void add_property(std::uint32_t type, ByteReader& reader, OniNode& node) {
  const std::string name = read_oni_text(reader);
  const std::string value(reader.take(reader.number<std::uint32_t>()));
  std::uint64_t number = 0;
  if (type == kIntegerProperty && value.size() <= sizeof number) {
    std::memcpy(&number, value.data(), value.size());
    node.integers[name] = number;
  } else {
    node.values[name] = value;
  }
}

}  // namespace

bool is_oni(const std::filesystem::path& path) { return begins_with(path, "NI10"); }

std::map<std::uint32_t, OniNode> index_oni(const RandomAccessFile& file) {
  const std::string head = file.read(0, kFileHeader_bytes);
  ByteReader head_reader(head, file.name());
  if (head_reader.take(4) != "NI10") throw Error(file.name() + ": is not an OpenNI recording");
  const auto major = head_reader.number<std::uint8_t>(), minor = head_reader.number<std::uint8_t>();
  const auto maintenance = head_reader.number<std::uint16_t>();
  const auto build = head_reader.number<std::uint32_t>();
  if (major != 1 || minor != 0) throw Error(file.name() + ": has an unsupported version; must be OpenNI 1.0");
  // Offsets had 32 bits before version 1.0.0.5.
  const std::uint64_t header_bytes = maintenance == 0 && build < 5 ? 24 : 28;

  std::map<std::uint32_t, OniNode> nodes;
  for (std::uint64_t at = kFileHeader_bytes; file.has(at, header_bytes);) {
    const std::string bytes = file.read(at, header_bytes);
    ByteReader reader(bytes, file.name());
    if (reader.number<std::uint32_t>() != kRecordMagic) break;
    const auto type = reader.number<std::uint32_t>(), id = reader.number<std::uint32_t>();
    const auto fields_bytes = reader.number<std::uint32_t>();  // with the header
    const auto payload_bytes = reader.number<std::uint32_t>();
    if (fields_bytes < header_bytes || fields_bytes > kMaxFields_bytes || type == kEnd) break;
    if (!file.has(at + fields_bytes, payload_bytes)) break;  // the recorder was stopped
    const std::string fields = file.read(at + header_bytes, fields_bytes - header_bytes);
    ByteReader field_reader(fields, file.name() + ": the record at byte " + std::to_string(at));
    if (type == kNodeAdded || type == kNodeAddedOld || type == kNodeAddedOldest) {
      OniNode& node = nodes[id];
      (void)read_oni_text(field_reader);
      node.kind = static_cast<OniNodeKind>(field_reader.number<std::uint32_t>());
      node.codec = std::string(field_reader.take(4));
    } else if (type == kIntegerProperty || type == kRealProperty || type == kStringProperty ||
               type == kGeneralProperty) {
      add_property(type, field_reader, nodes[id]);
    } else if (type == kNewData) {
      nodes[id].frames.push_back({field_reader.number<std::uint64_t>(), at + fields_bytes, payload_bytes});
    }
    at += std::uint64_t{fields_bytes} + payload_bytes;
  }
  return nodes;
}

std::vector<std::uint16_t> decompress_oni_depth(std::string_view packed, bool has_table, std::size_t pixels,
                                                const std::string& where) {
  // A value is a full 16 bit number, or a difference to the value before: 4 bits for -6 to 6, 8 bits after
  // 0xFF for larger ones. 0xE1 to 0xEE repeat the value before twice up to 28 times. 0xF and 0xD in the lower
  // 4 bits mean that 8 or 16 bits follow, and that nothing does.
  ByteReader reader(packed, where);
  std::vector<std::uint16_t> table;
  if (has_table) {
    const auto count = reader.number<std::uint16_t>();
    reader.require(count, sizeof(std::uint16_t));
    table.resize(count);
    reader.raw(table.data(), table.size() * sizeof(std::uint16_t));
  }
  std::vector<std::uint16_t> values;
  values.reserve(pixels);
  std::uint16_t last = 0;
  const auto put = [&](std::size_t times) {
    if (times > pixels - values.size()) throw Error(where + ": is damaged: it has too many pixels");
    if (has_table && last >= table.size()) throw Error(where + ": is damaged: a value is not in its table");
    values.insert(values.end(), times, has_table ? table[last] : last);
  };
  const auto put_long = [&] {  // after 0xF or 0xFF
    const auto first = reader.number<std::uint8_t>();
    if (first & 0x80U)
      last = static_cast<std::uint16_t>(last - (first - 192));
    else
      last = static_cast<std::uint16_t>(first << 8U | reader.number<std::uint8_t>());
    put(1);
  };
  const auto put_nibble = [&](unsigned nibble) {
    last = static_cast<std::uint16_t>(last - (static_cast<int>(nibble) - 6));
    put(1);
  };
  last = reader.number<std::uint16_t>();
  put(1);
  while (reader.left() > 0) {
    const auto byte = reader.number<std::uint8_t>();
    const unsigned high = byte >> 4U, low = byte & 0x0FU;
    if (byte < 0xE0U) {
      put_nibble(high);
      if (low == 0x0FU)
        put_long();
      else if (low != 0x0DU)
        put_nibble(low);
    } else if (byte == 0xFFU) {
      put_long();
    } else {
      put(std::size_t{2} * low);
    }
  }
  if (values.size() != pixels)
    throw Error(where + ": is damaged: it has " + std::to_string(values.size()) + " pixels instead of " +
                std::to_string(pixels));
  return values;
}

}  // namespace roomradar
