// matroska.cpp: parses EBML elements: an identifier and a size of variable length, then the data.
#include "app/sources/containers/matroska.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint64_t kEbml = 0x1A45DFA3, kSegment = 0x18538067, kInfo = 0x1549A966,
                        kTimestampScale = 0x2AD7B1, kTracks = 0x1654AE6B, kTrackEntry = 0xAE,
                        kTrackNumber = 0xD7, kName = 0x536E, kCodecId = 0x86, kCodecPrivate = 0x63A2,
                        kVideo = 0xE0, kPixelWidth = 0xB0, kPixelHeight = 0xBA, kAttachments = 0x1941A469,
                        kAttachedFile = 0x61A7, kFileName = 0x466E, kFileData = 0x465C, kCluster = 0x1F43B675,
                        kTimestamp = 0xE7, kSimpleBlock = 0xA3, kBlockGroup = 0xA0, kBlock = 0xA1,
                        kCues = 0x1C53BB6B, kTags = 0x1254C367, kSeekHead = 0x114D9B74;
constexpr std::uint64_t kMaxText_bytes = 1U << 16U;

struct Element {
  std::uint64_t id = 0;
  std::uint64_t begin = 0;  ///< offset of the data
  std::uint64_t end = 0;    ///< offset after the data; the parent's end if the size is unknown
  bool size_unknown = false;
};

/// Reads elements one after the other between two offsets.
class Elements {
 public:
  Elements(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t end)
      : file_(file), at_(begin), end_(std::min(end, file.size())) {}

  /// Returns the next element, or nullopt at the end or where no element begins. The element may end after
  /// the file.
  std::optional<Element> next() {
    constexpr std::uint64_t kMaxHeader_bytes = 12;
    if (at_ >= end_) return std::nullopt;
    const std::string bytes = file_.read_up_to(at_, std::min(kMaxHeader_bytes, end_ - at_));
    std::size_t used = 0;
    const auto id = number(bytes, used, /*keeps_marker=*/true);
    const std::size_t size_at = used;
    const auto size = number(bytes, used, /*keeps_marker=*/false);
    if (!id || !size) return std::nullopt;
    Element element{*id, at_ + used, 0, false};
    const auto length = static_cast<unsigned>(used - size_at);
    element.size_unknown = *size == (std::uint64_t{1} << (7 * length)) - 1;
    if (element.size_unknown)
      element.end = end_;
    else if (*size > std::numeric_limits<std::uint64_t>::max() / 2 - element.begin)
      return std::nullopt;
    else
      element.end = element.begin + *size;
    at_ = element.end;
    return element;
  }

  /// Continues within the element that next() returned.
  void enter(const Element& element) { at_ = element.begin; }

  /// Returns a number of variable length: the count of leading zeros of its first byte is that of further
  /// bytes.
  static std::optional<std::uint64_t> number(const std::string& bytes, std::size_t& at, bool keeps_marker) {
    if (at >= bytes.size()) return std::nullopt;
    const auto first = static_cast<std::uint8_t>(bytes[at]);
    const auto further = static_cast<std::size_t>(std::countl_zero(first));
    if (further > 7 || (keeps_marker && further > 3) || at + further >= bytes.size()) return std::nullopt;
    std::uint64_t value = keeps_marker ? first : first & (0x7FU >> further);
    for (std::size_t i = 1; i <= further; ++i) value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
    at += further + 1;
    return value;
  }

 private:
  const RandomAccessFile& file_;
  std::uint64_t at_, end_;
};

std::string text_of(const RandomAccessFile& file, const Element& element, const char* what) {
  if (element.end - element.begin > kMaxText_bytes)
    throw Error(file.name() + ": is damaged: its " + what + " has " +
                std::to_string(element.end - element.begin) + " bytes");
  return file.read(element.begin, element.end - element.begin);
}

std::uint64_t integer_of(const RandomAccessFile& file, const Element& element) {
  if (element.end - element.begin > 8)
    throw Error(file.name() + ": is damaged: an integer has more than 8 bytes");
  std::uint64_t value = 0;
  for (const char byte : file.read(element.begin, element.end - element.begin))
    value = value << 8U | static_cast<std::uint8_t>(byte);
  return value;
}

MatroskaTrack track_of(const RandomAccessFile& file, const Element& entry) {
  MatroskaTrack track;
  Elements fields(file, entry.begin, entry.end);
  while (const auto field = fields.next()) {
    if (field->id == kTrackNumber) track.number = integer_of(file, *field);
    if (field->id == kName) track.name = text_of(file, *field, "name of a track");
    if (field->id == kCodecId) track.codec = text_of(file, *field, "codec");
    if (field->id == kCodecPrivate) track.codec_private = text_of(file, *field, "data of a codec");
    if (field->id == kPixelWidth) track.width_px = integer_of(file, *field);
    if (field->id == kPixelHeight) track.height_px = integer_of(file, *field);
    if (field->id == kVideo) fields.enter(*field);
  }
  return track;
}

MatroskaAttachment attachment_of(const RandomAccessFile& file, const Element& attached) {
  MatroskaAttachment attachment;
  Elements fields(file, attached.begin, attached.end);
  while (const auto field = fields.next()) {
    if (field->id == kFileName) attachment.file_name = text_of(file, *field, "name of an attachment");
    if (field->id != kFileData) continue;
    attachment.offset = field->begin;
    attachment.size = field->end - field->begin;
  }
  return attachment;
}

bool is_top_level(std::uint64_t id) {
  return id == kCluster || id == kCues || id == kTags || id == kTracks || id == kAttachments || id == kInfo ||
         id == kSeekHead;
}

/// Lists the blocks of a cluster. Returns the offset at which the walk ended: the end of the cluster, or, if
/// its size is unknown, the next element of the segment.
std::uint64_t read_cluster(const RandomAccessFile& file, const Element& cluster, double tick_s,
                           MatroskaIndex& index) {
  std::uint64_t ticks = 0;
  Elements elements(file, cluster.begin, cluster.end);
  std::uint64_t at = cluster.begin;
  while (const auto element = elements.next()) {
    if (cluster.size_unknown && is_top_level(element->id)) return at;
    at = element->end;
    if (element->end > file.size()) break;  // the recorder was stopped
    if (element->id == kTimestamp) ticks = integer_of(file, *element);
    if (element->id == kBlockGroup) elements.enter(*element);
    if (element->id != kSimpleBlock && element->id != kBlock) continue;
    const std::string head = file.read_up_to(element->begin, 11);
    std::size_t used = 0;
    const auto track = Elements::number(head, used, /*keeps_marker=*/false);
    constexpr std::uint8_t kLacing = 0x06;
    if (!track || head.size() < used + 3 || element->end < element->begin + used + 3 ||
        (static_cast<std::uint8_t>(head[used + 2]) & kLacing) != 0)
      continue;
    const auto offset_ticks = static_cast<std::int16_t>(static_cast<std::uint8_t>(head[used]) << 8 |
                                                        static_cast<std::uint8_t>(head[used + 1]));
    const std::uint64_t begin = element->begin + used + 3;
    index.blocks.push_back(
        {*track, (static_cast<double>(ticks) + offset_ticks) * tick_s, begin, element->end - begin});
  }
  return cluster.size_unknown ? file.size() : cluster.end;
}

}  // namespace

bool is_matroska(const std::filesystem::path& path) { return begins_with(path, "\x1A\x45\xDF\xA3"); }

MatroskaIndex index_matroska(const RandomAccessFile& file) {
  Elements top(file, 0, file.size());
  const auto head = top.next();
  if (!head || head->id != kEbml) throw Error(file.name() + ": is not a Matroska file");
  auto segment = top.next();
  while (segment && segment->id != kSegment) segment = top.next();
  if (!segment) throw Error(file.name() + ": is cut short: it contains no segment");

  MatroskaIndex index;
  double tick_s = 1e-3;
  for (std::uint64_t at = segment->begin; at < std::min(segment->end, file.size());) {
    const auto element = Elements(file, at, segment->end).next();
    if (!element) break;
    at = element->end;
    if (element->id == kCluster) {
      at = read_cluster(file, *element, tick_s, index);
      continue;
    }
    Elements children(file, element->begin, element->end);
    if (element->id == kInfo)
      while (const auto field = children.next())
        if (field->id == kTimestampScale) tick_s = 1e-9 * static_cast<double>(integer_of(file, *field));
    if (element->id == kTracks)
      while (const auto entry = children.next())
        if (entry->id == kTrackEntry) index.tracks.push_back(track_of(file, *entry));
    if (element->id == kAttachments)
      while (const auto attached = children.next())
        if (attached->id == kAttachedFile) index.attachments.push_back(attachment_of(file, *attached));
  }
  return index;
}

}  // namespace roomradar
