// map_package.cpp: writes and reads the ZIP with minizip.
#include "mapping/map/map_package.hpp"

#include <minizip/unzip.h>
#include <minizip/zip.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_places.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxUnpackedBytes = std::uint64_t{64} << 30U;
constexpr std::uint64_t kMaxGrowth = 1000;
constexpr std::uint64_t kUncountedBytes = std::uint64_t{64} << 20U;
constexpr std::size_t kMaxNameBytes = 1000;
constexpr std::size_t kMaxNamePartBytes = 255;
constexpr std::size_t kBufferBytes = std::size_t{1} << 18U;
constexpr uLong kMadeOnUnix = 3U << 8U;
constexpr uLong kNamesAreUtf8 = 1U << 11U;
constexpr uLong kIsEncrypted = 1U;
constexpr uLong kFirstDate = (1U << 21U) | (1U << 16U);  // 1 January 1980, the earliest of the format
constexpr std::uint64_t kLongFileBytes = std::uint64_t{1} << 31U;

[[noreturn]] void fail_package(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

[[noreturn]] void fail_damaged(const fs::path& file, const std::string& fault) {
  fail_package(
      file,
      fault + "; copy the file again from where it came, or pack the map again with `roomradar map pack`");
}

std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', begin)) {
    parts.push_back(name.substr(begin, slash - begin));
    begin = slash + 1;
  }
  parts.push_back(name.substr(begin));
  return parts;
}

/// Returns true if the text names one file or folder, in any file system.
bool is_plain_part(const std::string& part) {
  return !part.empty() && part != "." && part != ".." && part.size() <= kMaxNamePartBytes &&
         std::none_of(part.begin(), part.end(),
                      [](char c) { return (c >= 0 && c < ' ') || c == '\x7f' || c == '/' || c == '\\'; });
}

/// Returns true if a map may have a file of this name, relative to its folder.
bool is_map_file(const std::vector<std::string>& parts) {
  if (!std::all_of(parts.begin(), parts.end(), is_plain_part) || !is_map_entry(parts.front())) return false;
  if (parts.front() == kMapObjectsFolder) return parts.size() > 1;
  return parts.size() == 1 || (parts.front() != kMapInfoFile && !is_map_part(parts.front()));
}

// Writing.

uLong write_to_stream(void* stream, void* /*file*/, const void* bytes, uLong size) {
  auto& out = *static_cast<std::ostream*>(stream);
  return out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size)) ? size : 0;
}

ZPOS64_T place_in_stream(void* stream, void* /*file*/) {
  return static_cast<ZPOS64_T>(static_cast<std::ostream*>(stream)->tellp());
}

long seek_in_stream(void* stream, void* /*file*/, ZPOS64_T offset, int origin) {
  const std::ios::seekdir from = origin == ZLIB_FILEFUNC_SEEK_SET   ? std::ios::beg
                                 : origin == ZLIB_FILEFUNC_SEEK_CUR ? std::ios::cur
                                                                    : std::ios::end;
  return static_cast<std::ostream*>(stream)->seekp(static_cast<std::streamoff>(offset), from) ? 0 : -1;
}

/// Writes a ZIP to a stream. Throws Error naming `path` if the stream fails.
class ZipWriter {
 public:
  ZipWriter(std::ostream& stream, const fs::path& path) : stream_(stream), path_(path) {
    zlib_filefunc64_def functions{};
    functions.zopen64_file = [](void* opaque, const void*, int) { return opaque; };
    functions.zread_file = [](void*, void*, void*, uLong) -> uLong { return 0; };
    functions.zwrite_file = write_to_stream;
    functions.ztell64_file = place_in_stream;
    functions.zseek64_file = seek_in_stream;
    functions.zclose_file = [](void*, void*) { return 0; };
    functions.zerror_file = [](void* opaque, void*) { return *static_cast<std::ostream*>(opaque) ? 0 : 1; };
    functions.opaque = &stream;
    zip_ = zipOpen2_64(path.c_str(), APPEND_STATUS_CREATE, nullptr, &functions);
    if (zip_ == nullptr) fail_package(path, "cannot be written: memory ran out");
  }
  ~ZipWriter() {
    if (zip_ != nullptr) zipClose(zip_, nullptr);
  }
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  void begin_file(const std::string& name, std::uint64_t bytes) {
    zip_fileinfo facts{};
    facts.dosDate = kFirstDate;
    facts.external_fa = uLong{S_IFREG | 0644U} << 16U;
    check(zipOpenNewFileInZip4_64(zip_, name.c_str(), &facts, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                  Z_DEFAULT_COMPRESSION, 0, -MAX_WBITS, DEF_MEM_LEVEL, Z_DEFAULT_STRATEGY,
                                  nullptr, 0, kMadeOnUnix, kNamesAreUtf8, bytes >= kLongFileBytes ? 1 : 0));
  }
  void write(std::string_view bytes) {
    check(zipWriteInFileInZip(zip_, bytes.data(), static_cast<unsigned>(bytes.size())));
  }
  void end_file() { check(zipCloseFileInZip(zip_)); }
  void finish() { check(zipClose(std::exchange(zip_, nullptr), nullptr)); }

 private:
  std::ostream& stream_;
  fs::path path_;
  zipFile zip_ = nullptr;

  void check(int status) const {
    require_written(stream_, path_);
    if (status != ZIP_OK) fail_package(path_, "cannot be written: the system refused it");
  }
};

void add_file(ZipWriter& zip, const fs::path& file, const std::string& name, std::uint64_t bytes) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_package(file, "cannot be opened; do you have permission to read it?");
  zip.begin_file(name, bytes);
  std::string buffer(kBufferBytes, '\0');
  while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || stream.gcount() > 0)
    zip.write(std::string_view(buffer).substr(0, static_cast<std::size_t>(stream.gcount())));
  if (stream.bad()) fail_package(file, "cannot be read to its end");
  zip.end_file();
}

/// Returns the files to pack. Throws Error if their package could not be unpacked.
std::vector<MapContent> packable_contents(const fs::path& folder) {
  std::vector<MapContent> contents = contents_of_map(folder);
  std::uint64_t bytes = 0;
  for (const MapContent& content : contents) {
    if (content.name.size() > kMaxNameBytes || !is_map_file(parts_of(content.name)))
      fail_package(folder / content.name, "is not part of a map; move it elsewhere before the map is packed");
    bytes += content.bytes;
  }
  if (contents.size() > kMaxPackedFiles || bytes > kMaxUnpackedBytes)
    fail_package(folder, "has " + std::to_string(contents.size()) + " files of " + std::to_string(bytes) +
                             " bytes; a packed map has at most " + std::to_string(kMaxPackedFiles) +
                             " and 64 GB");
  return contents;
}

/// Returns the map's name in a package.
std::string packed_name(const fs::path& folder) {
  std::error_code fault;
  std::string name = fs::weakly_canonical(fs::absolute(folder), fault).filename().string();
  if (fault || !is_plain_part(name))
    fail_package(folder,
                 "its name has a backslash or a control character; rename it with `roomradar map rename`");
  return name;
}

void require_package_place(const fs::path& file) {
  if (file.extension() != kMapPackageExtension)
    fail_package(file, std::string("the name of a packed map must end in ") + kMapPackageExtension);
  require_outside_maps(file);
  std::error_code ignored;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
    fail_package(file, "exists and is not a file; choose another name");
}

// Reading.

/// A file in a package.
struct Packed {
  std::vector<std::string> parts;  ///< of its name, relative to the map's folder; empty: a folder
  std::uint64_t bytes = 0;         ///< unpacked
};

struct CloseZip {
  void operator()(void* zip) const { unzClose(zip); }
};
using ZipReader = std::unique_ptr<void, CloseZip>;

/// Checks the names of a package one by one.
class NameCheck {
 public:
  explicit NameCheck(const fs::path& file) : file_(file) {}

  /// Returns the parts of the name relative to the map's folder; empty for a folder. Throws Error if no map
  /// has such a file, or the package has it twice.
  std::vector<std::string> check(std::string name, const unz_file_info64& facts) {
    const bool is_folder = name.ends_with('/');
    if (is_folder) name.pop_back();
    std::vector<std::string> parts = parts_of(name);
    if (name.size() > kMaxNameBytes || !std::all_of(parts.begin(), parts.end(), is_plain_part))
      refuse(name, "which leads out of a map's folder or has invalid characters");
    if (is_link_or_device(facts)) refuse(name, "which is a link or a device");
    if (map_.empty()) map_ = parts.front();
    if (parts.front() != map_) refuse(name, "which is not in the folder " + map_);
    parts.erase(parts.begin());
    if (is_folder) {
      if (facts.uncompressed_size != 0) refuse(name, "which is a folder with content");
      if (!parts.empty() && !is_map_entry(parts.front())) refuse(name, "which no map has");
      return {};
    }
    if (parts.empty() || !is_map_file(parts)) refuse(name, "which no map has");
    take(name);
    return parts;
  }

  [[nodiscard]] const std::string& map() const { return map_; }

 private:
  fs::path file_;
  std::string map_;  ///< name of the map
  std::set<std::string> files_, folders_;

  [[noreturn]] void refuse(const std::string& name, const std::string& why) const {
    fail_package(file_, "holds \"" + name.substr(0, 200) + "\", " + why +
                            "; it is not a packed map, or was altered, and nothing was unpacked");
  }

  static bool is_link_or_device(const unz_file_info64& facts) {
    if ((facts.version >> 8U) != (kMadeOnUnix >> 8U)) return false;
    const uLong kind = (facts.external_fa >> 16U) & S_IFMT;
    return kind != 0 && kind != S_IFREG && kind != S_IFDIR;
  }

  void take(const std::string& name) {
    if (!files_.insert(name).second || folders_.contains(name)) refuse(name, "which it has twice");
    for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
      if (files_.contains(name.substr(0, slash))) refuse(name, "which lies in a file");
      folders_.insert(name.substr(0, slash));
    }
  }
};

void require_readable(const fs::path& file) {
  std::error_code fault;
  const fs::file_status status = fs::status(file, fault);
  if (!fs::exists(status))
    fail_package(file, "is missing; give a packed map, as `roomradar map pack` writes");
  if (fs::is_directory(status)) fail_package(file, "is a folder; a packed map is a file");
  if (!fs::is_regular_file(status)) fail_package(file, "is not a regular file; give a packed map");
  if (!std::ifstream(file)) fail_package(file, "cannot be opened; do you have permission to read it?");
}

/// Throws Error unless the file ends with the ZIP's last record, of which minizip accepts a part.
void require_whole_end(const fs::path& file, std::uint64_t comment_bytes) {
  constexpr std::uint64_t kRecordBytes = 22;
  constexpr std::string_view kRecordBegins("PK\x05\x06", 4);
  const std::uint64_t bytes = fs::file_size(file);
  std::string begin(kRecordBegins.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (bytes < kRecordBytes + comment_bytes ||
      !stream.seekg(static_cast<std::streamoff>(bytes - kRecordBytes - comment_bytes)) ||
      !stream.read(begin.data(), static_cast<std::streamsize>(begin.size())) || begin != kRecordBegins)
    fail_damaged(file, "is cut short, or something was appended to it");
}

/// Reads the name and the sizes of the file at which the reader is.
std::pair<std::string, unz_file_info64> entry_at(const ZipReader& zip, const fs::path& file) {
  unz_file_info64 facts{};
  std::string name(std::size_t{1} << 16U, '\0');
  if (unzGetCurrentFileInfo64(zip.get(), &facts, name.data(), static_cast<uLong>(name.size()), nullptr, 0,
                              nullptr, 0) != UNZ_OK)
    fail_damaged(file, "its list of files is damaged");
  name.resize(std::min<std::size_t>(facts.size_filename, name.size()));
  return {std::move(name), facts};
}

struct PackageList {
  std::string map;            ///< name of the map
  std::vector<Packed> files;  ///< all entries, in the package's order
};

/// Reads the list of files and checks names, number and sizes.
PackageList read_list(const ZipReader& zip, const fs::path& file) {
  unz_global_info64 global{};
  if (unzGetGlobalInfo64(zip.get(), &global) != UNZ_OK) fail_damaged(file, "its list of files is damaged");
  require_whole_end(file, global.size_comment);
  const std::uint64_t most = max_unpacked_bytes(fs::file_size(file));
  const auto refuse_size = [&](const std::string& what) {
    fail_package(file,
                 "would unpack to more than " + what + "; it is not a packed map, and nothing was unpacked");
  };
  if (global.number_entry > kMaxPackedFiles) refuse_size(std::to_string(kMaxPackedFiles) + " files");
  PackageList list;
  NameCheck names(file);
  std::uint64_t bytes = 0;
  bool has_info = false;
  for (int status = unzGoToFirstFile(zip.get()); status != UNZ_END_OF_LIST_OF_FILE;
       status = unzGoToNextFile(zip.get())) {
    if (status != UNZ_OK) fail_damaged(file, "its list of files is damaged");
    if (list.files.size() >= kMaxPackedFiles) refuse_size(std::to_string(kMaxPackedFiles) + " files");
    const auto [name, facts] = entry_at(zip, file);
    if ((facts.flag & kIsEncrypted) != 0) fail_package(file, "is encrypted; pack the map without a password");
    if (facts.compression_method != 0 && facts.compression_method != Z_DEFLATED)
      fail_package(file, "is compressed in a way that is not read; pack the map with `roomradar map pack`");
    if (facts.uncompressed_size > most - bytes) refuse_size(std::to_string(most) + " bytes");
    bytes += facts.uncompressed_size;
    list.files.push_back({names.check(name, facts), facts.uncompressed_size});
    has_info |= list.files.back().parts == std::vector<std::string>{kMapInfoFile};
  }
  list.map = names.map();
  if (!has_info) fail_package(file, std::string("holds no ") + kMapInfoFile + ", so it is not a packed map");
  return list;
}

/// Writes the file at which the reader is into the folder.
void unpack_file(const ZipReader& zip, const Packed& packed, const fs::path& folder, const fs::path& file) {
  fs::path path = folder;
  for (const std::string& part : packed.parts) path /= part;
  make_folder(path.parent_path());
  const auto damaged = [&] { fail_damaged(file, "is cut short or damaged at " + packed.parts.back()); };
  if (unzOpenCurrentFile(zip.get()) != UNZ_OK) damaged();
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  std::string buffer(kBufferBytes, '\0');
  std::uint64_t written = 0;
  for (;;) {
    const int count = unzReadCurrentFile(zip.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    if (count == 0) break;
    if (count < 0 || static_cast<std::uint64_t>(count) > packed.bytes - written) damaged();
    out.write(buffer.data(), count);
    require_written(out, path);
    written += static_cast<std::uint64_t>(count);
  }
  if (unzCloseCurrentFile(zip.get()) != UNZ_OK || written != packed.bytes) damaged();
  out.close();
  require_written(out, path);
  sync_to_disk(path);
}

void unpack_files(const ZipReader& zip, const std::vector<Packed>& files, const fs::path& folder,
                  const fs::path& file) {
  int status = unzGoToFirstFile(zip.get());
  for (const Packed& packed : files) {
    if (status != UNZ_OK) fail_damaged(file, "its list of files is damaged");
    if (!packed.parts.empty()) unpack_file(zip, packed, folder, file);
    status = unzGoToNextFile(zip.get());
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory()) sync_to_disk(entry.path());
}

/// Throws Error naming the package if the map in the folder is damaged.
void require_sound_map(const fs::path& folder, const fs::path& file) {
  const std::vector<std::string> faults = verify_map(folder);
  if (faults.empty()) return;
  const std::string here = folder.string() + "/";
  std::string fault = faults.front();
  if (fault.starts_with(here)) fault.erase(0, here.size());
  fail_damaged(file, "holds a damaged map: " + fault);
}

}  // namespace

std::uint64_t max_unpacked_bytes(std::uint64_t package_bytes) {
  const std::uint64_t counted = std::min(package_bytes, kMaxUnpackedBytes);  // does not overflow below
  return std::min(kMaxUnpackedBytes, kMaxGrowth * counted + kUncountedBytes);
}

void pack_map(const fs::path& map, const fs::path& file) {
  constexpr int kAttempts = 10;
  const fs::path folder = existing_map(map);
  require_package_place(file);
  require_outside_map(file, folder);
  require_only_map(folder);
  const std::string name = packed_name(folder);
  if (const std::vector<std::string> faults = verify_map(folder); !faults.empty())
    throw Error(faults.front() + "; a damaged map is not packed");
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::vector<MapContent> contents = packable_contents(folder);
    const auto is_unchanged = [&] { return contents_of_map(folder) == contents; };
    AtomicFile out(file);
    try {
      ZipWriter zip(out.stream(), file);
      for (const MapContent& content : contents)
        add_file(zip, folder / content.name, name + "/" + content.name, content.bytes);
      zip.finish();
    } catch (const Error&) {
      if (is_unchanged()) throw;
    }
    if (!is_unchanged()) continue;
    out.commit();
    sync_to_disk(file);
    return;
  }
  fail_replaced_too_often(folder);
}

fs::path unpack_map(const fs::path& file, const fs::path& to) {
  require_readable(file);
  const ZipReader zip(unzOpen64(file.c_str()));
  if (!zip) fail_damaged(file, "is not a packed map, or is cut short or damaged");
  const PackageList list = read_list(zip, file);
  const fs::path target = place_for_map(to.empty() ? fs::path(list.map) : to);
  AtomicFolder folder(target);
  unpack_files(zip, list.files, folder.path(), file);
  require_sound_map(folder.path(), file);
  folder.commit_as_new();
  return target;
}

}  // namespace roomradar
