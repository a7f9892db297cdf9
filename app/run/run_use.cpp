// run_use.cpp: sums, prints and explains the fractions of the room's mesh and of the depth images that frames
// used.
#include "app/run/run_use.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>
#include <utility>

#include "app/objects/virtual_object.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

double share_of(std::size_t part, std::size_t whole) {
  return whole > 0 ? std::min(1.0, static_cast<double>(part) / static_cast<double>(whole)) : 0.0;
}

nlohmann::json to_json(const Shares& shares) {
  return {{"mean", shares.mean()}, {"p95", shares.percentile(0.95)}};
}

}  // namespace

void Shares::add(std::size_t part, std::size_t whole) {
  const double share = share_of(part, whole);
  const auto most = static_cast<double>(histogram_.size() - 1);
  ++histogram_[static_cast<std::size_t>(std::lround(std::sqrt(share) * most))];
  sum_ += share;
  ++count_;
}

double Shares::mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0; }

double Shares::percentile(double p) const {
  const double rank = p * static_cast<double>(count_);
  double below = 0.0;
  for (std::size_t i = 0; i < histogram_.size(); ++i) {
    below += histogram_[i];
    if (below >= rank && below > 0.0) {
      const double root = static_cast<double>(i) / static_cast<double>(histogram_.size() - 1);
      return root * root;
    }
  }
  return 0.0;
}

void RunUse::add(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects) {
  ++frames;
  frames_kept += use.views_drawn == 0 ? 1 : 0;
  frames_still += use.meshed_px == 0 ? 1 : 0;
  room_triangles = use.room_triangles;
  drawn.add(use.room_drawn, use.room_triangles);
  asked.add(use.room_asked, use.room_triangles);
  meshed.add(use.meshed_px, use.valid_px);
  room_drawn += static_cast<double>(use.room_drawn);
  room_asked += static_cast<double>(use.room_asked);
  meshed_px += static_cast<double>(use.meshed_px);
  mesh_triangles += static_cast<double>(use.mesh_triangles);
  flat += static_cast<double>(use.cells.flat);
  cut += static_cast<double>(use.cells.cut);
  full += static_cast<double>(use.cells.full);
  bool is_fine = false;
  for (const auto& object : objects) {
    if (object->fine_cells == 0) continue;
    ++frames_fine[object->body.name];
    is_fine = true;
  }
  frames_fine_near += is_fine ? 1 : 0;
}

nlohmann::json to_json(const RunUse& use) {
  const double per_frame = use.frames > 0 ? 1.0 / static_cast<double>(use.frames) : 0.0;
  nlohmann::json fine = nlohmann::json::array();
  for (const auto& [name, frames] : use.frames_fine) fine.push_back({{"object", name}, {"frames", frames}});
  return {{"room_triangles", use.room_triangles},
          {"room_drawn_mean", use.room_drawn * per_frame},
          {"room_drawn_share", to_json(use.drawn)},
          {"room_asked_by_radar_mean", use.room_asked * per_frame},
          {"room_asked_by_radar_share", to_json(use.asked)},
          {"meshed_px_mean", use.meshed_px * per_frame},
          {"meshed_share", to_json(use.meshed)},
          {"mesh_triangles_mean", use.mesh_triangles * per_frame},
          {"cells_mean",
           {{"flat", use.flat * per_frame}, {"cut", use.cut * per_frame}, {"full", use.full * per_frame}}},
          {"why",
           {{"frames", use.frames},
            {"frames_view_kept", use.frames_kept},
            {"frames_nothing_moved", use.frames_still},
            {"frames_fine_near", use.frames_fine_near},
            {"fine_near", fine}}}};
}

void print_use(const RunUse& use) {
  if (use.frames == 0) return;
  const double per_frame = 1.0 / static_cast<double>(use.frames);
  std::printf(
      "of the room's %zu triangles, %.1f %% were drawn per frame (p95: %.1f %%), none in %zu frames with a "
      "stationary camera; the radar examined %.0f\n",
      use.room_triangles, 100.0 * use.drawn.mean(), 100.0 * use.drawn.percentile(0.95), use.frames_kept,
      use.room_asked * per_frame);
  std::printf(
      "of the depth, %.2f %% was meshed per frame (p95: %.2f %%), nothing in %zu frames; cells of 4 x 4 "
      "pixels: %.0f flat, %.0f cut by outlines, %.0f at full resolution",
      100.0 * use.meshed.mean(), 100.0 * use.meshed.percentile(0.95), use.frames_still, use.flat * per_frame,
      use.cut * per_frame, use.full * per_frame);
  for (const auto& [name, frames] : use.frames_fine)
    std::printf("; full resolution near %s in %zu frames", name.c_str(), frames);
  std::printf("\n");
}

std::string reasons_of(const FrameUse& use, std::span<const std::unique_ptr<VirtualObject>> objects) {
  std::string why =
      use.views_drawn > 0 ? "the camera moved" : "the camera is stationary, the last view is reused";
  if (!use.knows_moved) return why + "; without the map's surfaces everything is meshed";
  if (use.meshed_px == 0) return why + "; nothing moved";
  const double percent = 100.0 * share_of(use.meshed_px, use.valid_px);
  std::array<char, 64> share{};
  format_classic(share.data(), share.size(), "; %.*f %% of the depth moved", percent < 1.0 ? 2 : 0, percent);
  why += share.data();
  for (const auto& object : objects)
    if (object->fine_cells > 0)
      why += "; full resolution near " + object->body.name + " (" + std::to_string(object->fine_cells) +
             " cells)";
  return why;
}

FrameUseFile::FrameUseFile(std::filesystem::path path)
    : file_(std::move(path),
            "frame,room_triangles,views_drawn,room_drawn,room_asked_by_radar,valid_px,meshed_px,"
            "mesh_triangles,flat_cells,cut_cells,full_cells,why\n") {}

void FrameUseFile::write(std::int64_t frame, const FrameUse& use,
                         std::span<const std::unique_ptr<VirtualObject>> objects) {
  std::string why = reasons_of(use, objects);
  std::replace(why.begin(), why.end(), '"', '\'');  // names of objects may contain quotes
  std::ostringstream line;
  line.imbue(std::locale::classic());
  line << frame << ',' << use.room_triangles << ',' << use.views_drawn << ',' << use.room_drawn << ','
       << use.room_asked << ',' << use.valid_px << ',' << use.meshed_px << ',' << use.mesh_triangles << ','
       << use.cells.flat << ',' << use.cells.cut << ',' << use.cells.full << ",\"" << why << "\"\n";
  file_.append(line.str());
}

}  // namespace roomradar
