// table1.cpp: the published numbers, and the same measurements with this program.
#include "app/evaluation/trade/table1.hpp"

#include <array>
#include <cstdio>

#include "app/evaluation/fallthrough/totals.hpp"
#include "app/evaluation/trade/run_facts.hpp"
#include "app/objects/published_objects.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Polygons of the object, frames per second. The published method meshes each whole frame: 37,842 triangles.
struct PublishedRow {
  int polygons;
  double fps;
};
constexpr std::array kPublished{PublishedRow{6, 13.9}, PublishedRow{6256, 12.5}, PublishedRow{181412, 9.4}};
constexpr int kPublishedTriangles = 37842;

}  // namespace

Table1 measure_table1(const std::string& room, const TradeScale& scale) {
  const std::unique_ptr<RunScene> scene = run_scene_of_room(room, scale);
  Table1 table;
  table.scene = scene->name;
  const std::vector<Mesh> objects = published_objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const RunFacts facts = run_session(*scene, {}, objects[i]);
    table.renderer = facts.renderer;
    if (!(facts.located > 0.0))
      throw Error("trade --compare-published: " + room + ": no frame could be localised");
    const auto stages = facts.times.summaries();
    table.rows.push_back({.published_polygons = kPublished[i].polygons,
                          .published_ms = 1e3 / kPublished[i].fps,
                          .triangles = objects[i].triangles.size(),
                          .frame_median_ms = stages.at("frame").median_ms,
                          .frame_p95_ms = stages.at("frame").p95_ms,
                          .radar_median_ms = stages.at("radar").median_ms,
                          .static_triangles = facts.static_triangles,
                          .dynamic_triangles = facts.dynamic_triangles});
  }
  const ContactFacts drops = touch_true_surfaces(*scene, {});
  table.contact_error_median_m = drops.error_median_m;
  table.contact_error_p95_m = drops.error_p95_m;
  table.passed = drops.passed;
  table.contacts = static_cast<int>(scene->scenarios.size());
  return table;
}

std::string text_of(const Table1& table) {
  char line[240];
  std::string text =
      "        published, its GPU         |                       here\n"
      "  polygons     ms    fps    meshed | triangles  ms, median   95 %    fps  radar, ms  room drawn  "
      "meshed\n";
  for (const Table1Row& row : table.rows) {
    format_classic(line, sizeof line,
                   "%10d  %5.1f  %5.1f  %8d | %9zu  %10.2f  %5.2f  %5.0f  %9.3f  %10.0f  %6.0f\n",
                   row.published_polygons, row.published_ms, 1e3 / row.published_ms, kPublishedTriangles,
                   row.triangles, row.frame_median_ms, row.frame_p95_ms, 1e3 / row.frame_median_ms,
                   row.radar_median_ms, row.static_triangles, row.dynamic_triangles);
    text += line;
  }
  const Table1Row &few = table.rows.front(), &many = table.rows.back();
  format_classic(line, sizeof line, "most polygons over fewest: %.2f published, %.2f here\n",
                 many.published_ms / few.published_ms, many.frame_median_ms / few.frame_median_ms);
  text += line;
  format_classic(line, sizeof line,
                 "contact error here: %s median, %s at 95 %%, %.0f %% through, of %d onto hidden surfaces "
                 "(none published)\n",
                 millimetres(table.contact_error_median_m).c_str(),
                 millimetres(table.contact_error_p95_m).c_str(), 1e2 * table.passed, table.contacts);
  return text + line + "frames of " + table.scene + ", " + table.renderer + "\n";
}

nlohmann::json to_json(const Table1& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Table1Row& row : table.rows)
    rows.push_back({{"published_polygons", row.published_polygons},
                    {"published_ms", row.published_ms},
                    {"triangles", row.triangles},
                    {"frame_median_ms", row.frame_median_ms},
                    {"frame_p95_ms", row.frame_p95_ms},
                    {"radar_median_ms", row.radar_median_ms},
                    {"static_triangles_drawn", row.static_triangles},
                    {"dynamic_triangles", row.dynamic_triangles}});
  return {{"rows", rows},
          {"published_triangles_meshed", kPublishedTriangles},
          {"contact_error_median_m", table.contact_error_median_m},
          {"contact_error_p95_m", table.contact_error_p95_m},
          {"passed_through", table.passed},
          {"contacts", table.contacts}};
}

}  // namespace roomradar
