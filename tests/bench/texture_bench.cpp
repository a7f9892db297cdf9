// texture_bench.cpp: colours of a scanned surface against frames that were held out: texture beside vertex
// colours, with time and memory.
//
// usage: texture_bench [--pictures FOLDER] [--json FILE] [SOURCE [FIRST LAST]]...
// Default: sim:table?seed=3&frames=360&rate=10, and frames 0-299 of the recorded kitchen where it is. Every
// 20th frame is held out. FOLDER: gets the frames, and both renderings, of the first held-out frames.
//
// PSNR against the held-out frames, seen from their colour cameras, dB: of the mesh with its vertices'
// colours, then of the same mesh with its texture.
//   all        all pixels where the mesh has surface
//   evened     the same after each rendering's channels were scaled to the frame's exposure (median ratio)
//   aligned    the same after the camera of each rendering was moved to where it fits the frame best
//   measured   the same, only where the frame's depth agrees with the mesh's, 2 pixels from silhouettes
//   bake_s     time of reading, choosing and baking; peak_mb: memory of the process before and after
//
// Settings are the defaults: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/open_source.hpp"
#include "app/cli/report.hpp"
#include "app/media/picture_file.hpp"
#include "mapping/deskewed_source.hpp"
#include "mapping/prescan.hpp"
#include "mapping/texture/mesh_raster.hpp"
#include "mapping/texture/view_alignment.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "tests/bench/bench_program.hpp"

namespace roomradar {
namespace {

constexpr std::int64_t kHoldOut = 20;
constexpr std::size_t kPictures = 3;
constexpr std::size_t kPoints = 60'000;  // of the surface, by which held-out frames are aligned

struct Cell {
  std::string source;
  std::optional<FrameRange> frames{};
};

Eigen::Array3f array_of(const Rgb& colour) { return {float(colour.r), float(colour.g), float(colour.b)}; }

/// Colour of a mesh's surface, by vertices or by texture.
class Surface {
 public:
  Surface(const Mesh& mesh, const SurfaceTexture& texture) : mesh_(mesh), texture_(texture) {
    atlas_ = picture_of_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, "atlas");
  }
  [[nodiscard]] Eigen::Array3f vertex_colour(std::uint32_t t, const Eigen::Vector3f& weights) const {
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      sum += weights[static_cast<Eigen::Index>(k)] * array_of(mesh_.colours[mesh_.triangles[t][k]]);
    return sum;
  }
  [[nodiscard]] Eigen::Array3f texture_colour(std::uint32_t t, const Eigen::Vector3f& weights) const {
    Eigen::Array2f p = Eigen::Array2f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const AtlasPoint& corner = texture_.corners[t][k];
      p += weights[static_cast<Eigen::Index>(k)] * Eigen::Array2f(corner[0], corner[1]);
    }
    p = p / 65535.0F * Eigen::Array2f(static_cast<float>(atlas_.width), static_cast<float>(atlas_.height)) -
        0.5F;
    const float x = std::clamp(p.x(), 0.0F, static_cast<float>(atlas_.width) - 1.001F);
    const float y = std::clamp(p.y(), 0.0F, static_cast<float>(atlas_.height) - 1.001F);
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const float u = x - static_cast<float>(left), v = y - static_cast<float>(top);
    return (1.0F - v) *
               ((1.0F - u) * array_of(atlas_.at(left, top)) + u * array_of(atlas_.at(left + 1, top))) +
           v * ((1.0F - u) * array_of(atlas_.at(left, top + 1)) + u * array_of(atlas_.at(left + 1, top + 1)));
  }

 private:
  const Mesh& mesh_;
  const SurfaceTexture& texture_;
  ColourImage atlas_;
};

/// Weights of the triangle's vertices where a ray of the camera meets its plane.
Eigen::Vector3f weights_of(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0], n = ab.cross(ac);
  const Eigen::Vector3d p = ray * (n.dot(corners[0]) / n.dot(ray)) - corners[0];
  const double area2 = n.squaredNorm();
  const double b = p.cross(ac).dot(n) / area2, c = ab.cross(p).dot(n) / area2;
  return Eigen::Vector3d(1.0 - b - c, b, c).cast<float>();
}

struct Rendering {
  ColourImage frame, vertices, texture;  ///< black where the mesh has no surface
  MaskImage is_surface;
  /// 255: the frame measured the mesh's surface there, away from silhouettes.
  MaskImage is_measured;
};

Rgb rounded(const Eigen::Array3f& colour) {
  const Eigen::Array3f c = (colour + 0.5F).max(0.0F).min(255.0F);
  return {static_cast<std::uint8_t>(c.x()), static_cast<std::uint8_t>(c.y()),
          static_cast<std::uint8_t>(c.z())};
}

Rendering render(const Frame& frame, const TextureView& view, const Mesh& mesh, const Surface& surface) {
  const Intrinsics& camera = frame.colour_camera;
  const Eigen::Isometry3d T_camera_world =
      view.T_camera_local.cast<double>() * Eigen::Translation3d(-mesh.origin);
  const MeshRaster raster = rasterise(mesh, camera, T_camera_world);
  Rendering rendering{frame.colour, ColourImage(camera.width_px, camera.height_px),
                      ColourImage(camera.width_px, camera.height_px),
                      MaskImage(camera.width_px, camera.height_px),
                      MaskImage(camera.width_px, camera.height_px)};
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const std::uint32_t t = raster.triangle.at(x, y);
      if (t == kNoTriangle) continue;
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = T_camera_world * (mesh.origin + mesh.vertices[mesh.triangles[t][k]].cast<double>());
      Eigen::Array3f by_vertices = Eigen::Array3f::Zero(), by_texture = by_vertices;
      for (const double v : {-0.25, 0.25})  // 2 x 2 rays per pixel, as a texture has more detail than it
        for (const double u : {-0.25, 0.25}) {
          const Eigen::Vector3f weights = weights_of(corners, back_project(camera, x + u, y + v, 1.0));
          by_vertices += 0.25F * surface.vertex_colour(t, weights);
          by_texture += 0.25F * surface.texture_colour(t, weights);
        }
      rendering.vertices.at(x, y) = rounded(by_vertices);
      rendering.texture.at(x, y) = rounded(by_texture);
      rendering.is_surface.at(x, y) = 255;
      const MeshPoint point = mesh_point(mesh, t, weights_of(corners, back_project(camera, x, y, 1.0)));
      if (shown(view, point.p_local, point.normal).score > 0.0F) rendering.is_measured.at(x, y) = 255;
    }
  return rendering;
}

/// Factor per channel that brings a rendering to the frame's exposure.
std::array<float, 3> gains(const ColourImage& rendered, const Rendering& rendering) {
  std::array<std::vector<float>, 3> ratios;
  for (std::size_t i = 0; i < rendered.pixels.size(); i += 7) {
    const Eigen::Array3f a = array_of(rendered.pixels[i]), b = array_of(rendering.frame.pixels[i]);
    if (rendering.is_surface.pixels[i] == 0 || a.minCoeff() < 8.0F || b.minCoeff() < 8.0F) continue;
    for (Eigen::Index c = 0; c < 3; ++c) ratios[static_cast<std::size_t>(c)].push_back(b[c] / a[c]);
  }
  std::array<float, 3> gain{1.0F, 1.0F, 1.0F};
  for (std::size_t c = 0; c < 3; ++c) {
    if (ratios[c].empty()) continue;
    const auto middle = ratios[c].begin() + static_cast<std::ptrdiff_t>(ratios[c].size() / 2);
    std::nth_element(ratios[c].begin(), middle, ratios[c].end());
    gain[c] = *middle;
  }
  return gain;
}

/// Sum of squared differences of channels.
struct Difference {
  double squares = 0.0, count = 0.0;

  void add(const ColourImage& rendered, const Rendering& rendering, const MaskImage& mask,
           const std::array<float, 3>& gain) {
    for (std::size_t i = 0; i < rendered.pixels.size(); ++i) {
      if (mask.pixels[i] == 0) continue;
      const Eigen::Array3f evened =
          (array_of(rendered.pixels[i]) * Eigen::Array3f(gain[0], gain[1], gain[2])).min(255.0F);
      squares += static_cast<double>((evened - array_of(rendering.frame.pixels[i])).square().sum());
      count += 3.0;
    }
  }
  [[nodiscard]] double psnr_db() const { return 10.0 * std::log10(255.0 * 255.0 * count / squares); }
};

nlohmann::json judge(const Cell& cell, const std::filesystem::path& pictures) {
  using Clock = std::chrono::steady_clock;
  const std::unique_ptr<FrameSource> source = open_source(cell.source, cell.frames);
  PrescanConfig config;
  config.hold_out = kHoldOut;
  config.bake_texture = true;
  StageTimes times;
  double peak_before_mb = 0.0;
  Clock::time_point begun;
  const PrescanResult scanned =
      prescan(*source, config, times, [&](const std::string& stage, const std::string&) {
        if (stage != "texture") return;
        peak_before_mb = peak_rss_mb();
        begun = Clock::now();
      });
  const std::map<std::string, StageSummary> stages = times.summaries();
  const double bake_s =
      std::chrono::duration<double>(Clock::now() - begun).count() - 1e-3 * stages.at("coverage").max_ms;
  const double peak_mb = peak_rss_mb();
  const std::shared_ptr<const SurfaceTexture> texture = scanned.map.texture.load();
  if (!texture) throw Error(cell.source + ": no texture was baked; have the frames colour?");

  const Surface surface(scanned.map.mesh, *texture);
  std::map<std::int64_t, Eigen::Isometry3d> poses;
  for (const TimedPose& pose : scanned.map.trajectory) poses[pose.frame_index] = pose.T_world_camera;
  DeskewedSource deskewed(*source, scanned.map.trajectory, scanned.counts.timing);
  deskewed.rewind();
  const std::vector<MeshPoint> points = sample_mesh(scanned.map.mesh, kPoints);
  std::vector<float> vertex_brightness, texture_brightness;
  for (const MeshPoint& point : points) {
    vertex_brightness.push_back(surface.vertex_colour(point.triangle, point.weights).mean());
    texture_brightness.push_back(surface.texture_colour(point.triangle, point.weights).mean());
  }
  // By vertices, and by texture.
  std::array<Difference, 2> all, evened, aligned, measured;
  std::size_t held_out = 0;
  Frame frame;
  for (ReadResult read; (read = deskewed.next(frame)).status != ReadStatus::kEnd;) {
    const auto pose = poses.find(frame.index);
    if (read.status != ReadStatus::kFrame || !is_held_out(frame.index, kHoldOut) || pose == poses.end())
      continue;
    const TextureView view = make_texture_view(frame, pose->second, scanned.map.mesh, 0.0);
    const Rendering rendering = render(frame, view, scanned.map.mesh, surface);
    std::array<Rendering, 2> best;
    for (const std::size_t i : {0U, 1U}) {
      const auto picture_of = [i](const Rendering& from) -> const ColourImage& {
        return i == 0 ? from.vertices : from.texture;
      };
      const std::array<float, 3> gain = gains(picture_of(rendering), rendering);
      all[i].add(picture_of(rendering), rendering, rendering.is_surface, {1.0F, 1.0F, 1.0F});
      evened[i].add(picture_of(rendering), rendering, rendering.is_surface, gain);
      // The frame's pose has errors of its own: each rendering is also judged from the pose where it fits
      // best.
      TextureView moved = view;
      for (std::size_t c = 0; c < 3; ++c) moved.gain[c] = 1.0F / gain[c];
      align_view(points, i == 0 ? vertex_brightness : texture_brightness, moved);
      best[i] = render(frame, moved, scanned.map.mesh, surface);
      const std::array<float, 3> best_gain = gains(picture_of(best[i]), best[i]);
      aligned[i].add(picture_of(best[i]), best[i], best[i].is_surface, best_gain);
      measured[i].add(picture_of(best[i]), best[i], best[i].is_measured, best_gain);
    }
    if (!pictures.empty() && held_out < kPictures) {
      const std::string stem = (pictures / std::to_string(frame.index)).string();
      write_png(best[1].is_measured, stem + "-measured.png");
      write_png(rendering.frame, stem + "-frame.png");
      write_png(best[0].vertices, stem + "-vertices.png");
      write_png(best[1].texture, stem + "-texture.png");
    }
    ++held_out;
  }
  return {{"source", cell.source},
          {"held_out", held_out},
          {"all_db", {all[0].psnr_db(), all[1].psnr_db()}},
          {"evened_db", {evened[0].psnr_db(), evened[1].psnr_db()}},
          {"aligned_db", {aligned[0].psnr_db(), aligned[1].psnr_db()}},
          {"measured_db", {measured[0].psnr_db(), measured[1].psnr_db()}},
          {"bake_s", bake_s},
          {"views", stages.at("texture").count - 1},
          {"peak_before_mb", peak_before_mb},
          {"peak_mb", peak_mb},
          {"triangles", scanned.map.mesh.triangles.size()},
          {"atlas_px", {texture->width_px, texture->height_px}},
          {"jpeg_mb", 1e-6 * static_cast<double>(texture->atlas_jpeg.size())}};
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  using roomradar::Cell;
  return roomradar::test::run_or_say("texture_bench", [&] {
    std::string json, pictures;
    std::vector<Cell> cells;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--json" && i + 1 < argc) {
        json = argv[++i];
      } else if (word == "--pictures" && i + 1 < argc) {
        pictures = argv[++i];
      } else if (word.starts_with("--")) {
        std::fprintf(stderr,
                     "usage: texture_bench [--pictures FOLDER] [--json FILE] [SOURCE [FIRST LAST]]...\n");
        return 2;
      } else {
        cells.push_back({word});
        if (i + 2 < argc && std::isdigit(static_cast<unsigned char>(argv[i + 1][0])) != 0) {
          cells.back().frames = roomradar::FrameRange{std::atoll(argv[i + 1]), std::atoll(argv[i + 2])};
          i += 2;
        }
      }
    }
    if (cells.empty()) {
      cells = {{"sim:table?seed=3&frames=360&rate=10"}};
      const char* const data = std::getenv("ROOMRADAR_DATA");
      const std::filesystem::path kitchen =
          std::filesystem::path(data != nullptr ? data : ROOMRADAR_DATA_DEFAULT) / "kitchen";
      if (std::filesystem::is_directory(kitchen))
        cells.push_back({kitchen.string(), roomradar::FrameRange{0, 299}});
    }
    nlohmann::json rows = nlohmann::json::array();
    std::printf("%s\n", roomradar::test::processor().c_str());
    for (const Cell& cell : cells) {
      rows.push_back(roomradar::judge(cell, pictures));
      std::printf("%s\n", rows.back().dump().c_str());
    }
    roomradar::test::write_rows(json, rows);
    return 0;
  });
}
