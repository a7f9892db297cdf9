// text_lists.cpp: cuts files into lines and lines into numbers; recognises a list of poses by its numbers per line.
#include "app/sources/datasets/text_lists.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/time_tracks.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {

namespace fs = std::filesystem;

void for_each_line(const fs::path& path,
                   const std::function<void(std::string_view line, const std::string& where)>& use) {
  constexpr std::uintmax_t kMaxList_bytes = std::uintmax_t{1} << 30;
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string text = read_bytes(path, "a list", kMaxList_bytes);
  if (text.starts_with("\xff\xfe")) std::erase(text.erase(0, 2), '\0');  // UTF-16 of plain characters
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#')
      use(line.substr(first), path.string() + ", line " + std::to_string(line_number));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
}

void BadLines::add(const std::string& fault) {
  if (count++ == 0) first = fault;
}

void BadLines::report(const char* topic, const std::string& name, RecordingFacts& facts) const {
  if (count == 0) return;
  facts.notes.push_back({topic,
                         std::to_string(count) + (count == 1 ? " line of " : " lines of ") + name +
                             (count == 1 ? " is left out: " : " are left out, the first: ") + first,
                         static_cast<std::int64_t>(count)});
}

std::vector<std::vector<double>> read_rows(const fs::path& file, const char* topic, std::vector<std::size_t> counts,
                                           RecordingFacts& facts) {
  std::vector<std::vector<double>> rows;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return rows;
  const auto is_known = [&](std::size_t count) {
    return std::find(counts.begin(), counts.end(), count) != counts.end();
  };
  BadLines bad;
  bool is_at_first = true;
  for_each_line(file, [&](std::string_view line, const std::string& where) {
    std::vector<double> row;
    std::string text(line);
    std::replace(text.begin(), text.end(), ';', ' ');
    const bool has_decimal_commas = is_known(split_words(text).size()) && text.find('.') == std::string::npos;
    std::replace(text.begin(), text.end(), ',', has_decimal_commas ? '.' : ' ');
    const bool is_first = std::exchange(is_at_first, false);
    for (const std::string_view word : split_words(text)) {
      const auto value = parse_number(word);
      if (!value && is_first && row.empty() && std::isalpha(static_cast<unsigned char>(word[0])))
        return;  // a heading
      if (!value) return bad.add(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
      row.push_back(*value);
    }
    if (!is_known(row.size()))
      return bad.add(where + ": has " + std::to_string(row.size()) + " numbers instead of " +
                     std::to_string(counts.front()));
    counts = {row.size()};
    if (std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
      rows.push_back(std::move(row));
  });
  bad.report(topic, file.filename().string(), facts);
  return rows;
}

namespace {

/// Form of the lines of a list of poses, by its number of numbers.
struct PoseForm {
  std::size_t numbers;
  std::size_t pose_at;  ///< index of the first number of the pose; 0: the lines have no stamps
  bool is_matrix;       ///< rows of a matrix; false: translation and quaternion x y z w
  const char* words;
};
constexpr std::array kPoseForms{
    PoseForm{8, 1, false, "a stamp, a translation and a quaternion"},
    PoseForm{9, 1, false, "a stamp, a translation, a quaternion and a number that is not used"},
    PoseForm{13, 1, true, "a stamp and the rows of a 3 x 4 matrix"},
    PoseForm{17, 1, true, "a stamp and the rows of a 4 x 4 matrix"},
    PoseForm{7, 0, false, "a translation and a quaternion without a stamp, one per depth image"},
    PoseForm{12, 0, true, "the rows of a 3 x 4 matrix without a stamp, one per depth image"},
    PoseForm{16, 0, true, "the rows of a 4 x 4 matrix without a stamp, one per depth image"}};

std::optional<Eigen::Isometry3d> pose_of(const std::vector<double>& row, const PoseForm& form) {
  const double* p = row.data() + form.pose_at;
  if (!form.is_matrix) return rigid_pose({p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]});
  return rigid_transform(Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(p));
}

}  // namespace

ListedPoses read_pose_list(const fs::path& file, std::ptrdiff_t depth_images, RecordingFacts& facts) {
  const std::string name = file.filename().string();
  std::vector<std::size_t> counts;
  for (const PoseForm& form : kPoseForms) counts.push_back(form.numbers);
  const auto rows = read_rows(file, "poses", counts, facts);
  if (rows.empty()) return {};
  const PoseForm& form = *std::find_if(kPoseForms.begin(), kPoseForms.end(), [&](const PoseForm& known) {
    return known.numbers == rows.front().size();
  });
  if (form.pose_at == 0 && std::ssize(rows) != depth_images) {
    facts.notes.push_back({"poses",
                           name + " has " + std::to_string(form.numbers) + " numbers per line, so no stamps, and " +
                               std::to_string(rows.size()) + " lines for " + std::to_string(depth_images) +
                               " depth images; the poses are not used. Begin each line with a stamp",
                           std::ssize(rows)});
    return {};
  }
  if (form.numbers != kPoseForms.front().numbers)
    facts.notes.push_back({"poses",
                           name + " has " + std::to_string(form.numbers) + " numbers per line, taken as " + form.words,
                           std::ssize(rows)});
  ListedPoses listed{.are_stamped = form.pose_at > 0};
  for (const auto& row : rows) listed.poses.push_back({form.pose_at > 0 ? row[0] : kNoStamp, pose_of(row, form)});
  return listed;
}

}  // namespace roomradar
