// numbered_images.cpp: images, poses and matrices by the number in their names.
#include "app/sources/datasets/dataset_readers.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/sources/datasets/numbered_files.hpp"
#include "app/sources/datasets/text_lists.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Sets the frames' poses by a list of poses beside the images, such as traj.txt: one pose per depth image,
/// or poses that begin with the images' numbers.
void read_listed_poses(const fs::path& folder, const std::vector<std::int64_t>& numbers,
                       RecordingFacts& facts) {
  std::error_code ignored;
  fs::path file;
  for (const char* name :
       {"groundtruth.txt", "traj.txt", "trajectory.txt", "poses.txt", "pose.txt", "camera_poses.txt"})
    if (file.empty() && fs::is_regular_file(folder / name, ignored)) file = folder / name;
  if (file.empty()) return;
  const ListedPoses listed = read_pose_list(file, std::ssize(numbers), facts);
  std::int64_t without_image = 0;
  for (std::size_t i = 0; i < listed.poses.size(); ++i) {
    std::size_t frame = i;
    if (listed.are_stamped) {
      const auto place = std::lower_bound(
          numbers.begin(), numbers.end(), listed.poses[i].stamp,
          [](std::int64_t number, double stamp) { return static_cast<double>(number) < stamp; });
      frame = static_cast<std::size_t>(place - numbers.begin());
      if (frame == numbers.size() || static_cast<double>(numbers[frame]) != listed.poses[i].stamp) {
        ++without_image;
        continue;
      }
    }
    facts.frames[frame].T_world_camera = listed.poses[i].T_world_camera;
    if (!listed.poses[i].T_world_camera) facts.frames[frame].pose_fault = "is no rigid transform";
  }
  if (without_image > 0)
    facts.notes.push_back({"poses",
                           std::to_string(without_image) + " of " + std::to_string(listed.poses.size()) +
                               " poses of " + file.filename().string() +
                               " begin with no number of a depth image; they are left out",
                           without_image, "", true});
}

/// Reads the camera of a 4 x 4 or 3 x 3 matrix. The matrix states no size: if its principal point is far from
/// the middle of the images, they were scaled after the export, and the camera is scaled by the same factor, which is
/// noted. Throws Error naming the file if it is none.
Intrinsics read_camera_matrix(const fs::path& path, ImageSize size, RecordingFacts& facts) {
  constexpr std::uintmax_t kMax_bytes = 1U << 16U;
  const std::string name = path.string();
  const std::vector<double> m = parse_numbers(read_bytes(path, "a camera matrix", kMax_bytes), name);
  if (m.size() != 16 && m.size() != 9)
    throw Error(name + ": has " + std::to_string(m.size()) + " numbers; must be a 4 x 4 matrix");
  const std::size_t columns = m.size() == 16 ? 4 : 3;
  Intrinsics camera{size.width_px, size.height_px, m[0], m[columns + 1], m[2], m[columns + 2]};
  const double width_px = 2.0 * camera.cx_px, height_px = 2.0 * camera.cy_px;  // of images with it in the middle
  const auto differs = [](double stated, int is) { return stated < 0.6 * is || stated > 1.4 * is; };
  if (differs(width_px, size.width_px) && differs(height_px, size.height_px) && width_px >= 2 && height_px >= 2) {
    const double x = size.width_px / (width_px + 1), y = size.height_px / (height_px + 1);
    camera = {size.width_px, size.height_px, x * camera.fx_px, y * camera.fy_px, x * camera.cx_px, y * camera.cy_px};
    facts.notes.push_back({"camera",
                           path.filename().string() + " is of images of about " + format_readable(width_px + 1, 4) +
                               " x " + format_readable(height_px + 1, 4) + ", but they are " +
                               size_text(size.width_px, size.height_px) + "; it is scaled to them",
                           0, "--camera FILE", true});
  }
  require_valid(camera, name.c_str());
  return camera;
}

/// Sets the cameras that a folder intrinsic of ScanNet's export states.
void read_scannet_cameras(const fs::path& intrinsic, ImageSize depth, std::optional<ImageSize> colour,
                          RecordingFacts& facts) {
  facts.rig.depth_camera = read_camera_matrix(intrinsic / "intrinsic_depth.txt", depth, facts);
  facts.camera_origin = Origin::kRecording;
  facts.camera_source = "intrinsic/intrinsic_depth.txt";
  if (!colour) return;
  const fs::path colour_file = intrinsic / "intrinsic_color.txt";
  facts.rig.colour_camera = fs::exists(colour_file) ? read_camera_matrix(colour_file, *colour, facts)
                                                    : fitted_to(facts.rig.depth_camera, *colour);
  facts.rig.T_colour_depth.setIdentity();
  const StatedPose T_device_colour = read_pose_file(intrinsic / "extrinsic_color.txt");
  const StatedPose T_device_depth = read_pose_file(intrinsic / "extrinsic_depth.txt");
  if (T_device_colour.T_world_camera && T_device_depth.T_world_camera)
    facts.rig.T_colour_depth = T_device_colour.T_world_camera->inverse() * *T_device_depth.T_world_camera;
  else
    facts.colour_pose_origin = Origin::kAssumed;
}

/// The files of a folder of numbered images.
struct NumberedRecording {
  std::vector<fs::path> depths, colours;
  std::vector<std::int64_t> numbers{};  ///< per depth image
  std::vector<std::string> poses{};     ///< per depth image: its file; empty: none
  bool has_pose_files = false;
  std::int64_t without_colour = 0, first_without_colour = -1;  ///< if colour images are paired by number
  std::int64_t without_depth = 0;  ///< colour images, if they are paired by number
};

/// Lists the files, and adds a frame per depth image. Colour images belong to the depth image with the same
/// number. Numbers of ten digits and more are times: colour images are then paired by time.
NumberedRecording list_numbered(const fs::path& folder, const fs::path& depth_images,
                                const fs::path& colour_images, RecordingFacts& facts) {
  const auto colour_files = numbered_files(colour_images, {".jpg", ".jpeg", ".png"});
  const auto pose_files = numbered_files(folder_named(folder, {"pose", "poses"}), {".txt"});
  const auto depth_files = numbered_files(depth_images, {".png", ".pgm"});
  constexpr std::int64_t kLeastTime = 1'000'000'000;
  const bool are_times = !depth_files.empty() && depth_files.begin()->first >= kLeastTime;
  facts.has_no_clock = !are_times;
  facts.stamps_have_no_unit = are_times;
  NumberedRecording files;
  files.has_pose_files = !pose_files.empty();
  if (are_times)
    for (const auto& [number, file] : colour_files) {
      facts.colours.push_back({.stamp_s = static_cast<double>(number)});
      files.colours.push_back(file);
    }
  for (const auto& [number, file] : depth_files) {
    StatedFrame frame{.time = {.stamp_s = static_cast<double>(number) / (are_times ? 1.0 : kNominalRate_hz)}};
    if (are_times) {
      // Colour images are paired by time.
    } else if (const auto colour = colour_files.find(number); colour != colour_files.end()) {
      frame.colour = files.colours.size();
      files.colours.push_back(colour->second);
    } else if (files.without_colour++ == 0) {
      files.first_without_colour = number;
    }
    const auto pose = pose_files.find(number);
    files.poses.push_back(pose == pose_files.end() ? "" : pose->second.string());
    files.depths.push_back(file);
    files.numbers.push_back(number);
    facts.frames.push_back(std::move(frame));
  }
  files.without_depth = std::ssize(colour_files) - std::ssize(files.colours);
  return files;
}

/// Throws Error naming the first file that looks like a depth image of another form, if there is one.
void refuse_other_depth(const fs::path& depth_images) {
  for (const fs::path& file : entries_of(depth_images))
    if (file.has_extension())
      throw Error(file.string() + ": is not read as depth; depth must be 16 bit grey images " +
                  depth_images.filename().string() + "/NNNNN.png or .pgm, so convert them");
}

void note_missing_colour(const NumberedRecording& files, const fs::path& colour_images,
                         RecordingFacts& facts) {
  std::error_code ignored;
  if (files.colours.empty() && !colour_images.empty() && !is_empty_folder(colour_images, ignored))
    facts.notes.push_back(
        {"images",
         "no file in " + colour_images.filename().string() +
             " is a .jpg or .png with the number of a depth image; depth is used without colour",
         static_cast<std::int64_t>(files.depths.size()), "", true});
  if (!files.colours.empty() && files.without_colour > 0)
    facts.notes.push_back({"images",
                           "the colour image of " + std::to_string(files.without_colour) + " of " +
                               std::to_string(files.depths.size()) +
                               " frames is missing, the first: number " +
                               std::to_string(files.first_without_colour) + "; these frames are used without",
                           files.without_colour});
  if (!files.colours.empty() && files.without_depth > 0)
    facts.notes.push_back(unused_colours(files.without_depth));
}

}  // namespace

bool is_numbered_images(const fs::path& folder) { return !depth_folder(folder).empty(); }

RecordingFacts index_numbered_images(const fs::path& folder) {
  RecordingFacts facts{.name = fs::canonical(folder).string(), .has_no_clock = true};
  facts.is_written_by_many = true;
  const fs::path depth_images = depth_folder(folder), colour_images = colour_folder(folder);
  const NumberedRecording files = list_numbered(folder, depth_images, colour_images, facts);
  if (facts.frames.empty()) {
    refuse_other_depth(depth_images);
    return facts;
  }
  note_missing_colour(files, colour_images, facts);

  const ImageSize size = size_of_images(files.depths, folder);
  const std::optional<ImageSize> colour_size = size_of_colours(files.colours, folder, facts);
  facts.rig = nominal_rig(NominalRig::kNumbered, size, colour_size);
  facts.camera_origin = Origin::kAssumed;
  facts.camera_source = nominal_name(NominalRig::kNumbered);
  facts.is_registered_if_given = true;
  facts.unit_source = "millimetres, as most folders of numbered images have it";
  facts.unit_origin = Origin::kAssumed;
  if (fs::exists(folder / "intrinsic" / "intrinsic_depth.txt"))
    read_scannet_cameras(folder / "intrinsic", size, colour_size, facts);
  facts.read_depth = [depths = files.depths](std::size_t frame, double unit_m, DepthImage& depth_m) {
    read_depth_file(depths[frame], DepthEncoding::kMillimetres, unit_m, depth_m);
  };
  facts.read_colour = [colours = files.colours](std::size_t colour, ColourImage& image) {
    read_colour_file(colours[colour], image);
  };
  if (files.has_pose_files)
    facts.read_pose = [poses = files.poses](std::size_t frame, double) {
      return poses[frame].empty() ? StatedPose{} : read_pose_file(poses[frame]);
    };
  else
    read_listed_poses(folder, files.numbers, facts);
  return facts;
}

}  // namespace roomradar
