// table1.hpp: measures frame times for comparison with table 1 of the Cyber Radar paper.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/evaluation/trade/trade_frames.hpp"

namespace roomradar {

/// Results for one virtual object (the paper's "sensor object").
struct Table1Row {
  int published_polygons = 0;
  double published_ms = 0.0;  ///< frame time of the published application on the paper's GPU
  std::size_t triangles = 0;  ///< number of triangles of our object
  double frame_median_ms = 0.0, frame_p95_ms = 0.0;
  double radar_median_ms = 0.0;    ///< median time of all radar queries of a frame
  double static_triangles = 0.0;   ///< mean number of room triangles drawn per frame
  double dynamic_triangles = 0.0;  ///< mean number of triangles of the dynamic mesh per frame
};

struct Table1 {
  std::string renderer;
  std::string scene;
  std::vector<Table1Row> rows;
  double contact_error_median_m = 0.0, contact_error_p95_m = 0.0;
  int contacts = 0;
  double passed = 0.0;  ///< fraction of objects that passed through a surface
};

/// Maps a simulated room, and runs a session in it with each of published_objects(). Then drops and pushes
/// other objects onto the room's hidden surfaces. Throws Error as Session does.
Table1 measure_table1(const std::string& room, const TradeScale& scale);

std::string text_of(const Table1& table);
nlohmann::json to_json(const Table1& table);

}  // namespace roomradar
