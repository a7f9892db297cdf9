// table1.hpp: the frame rates of table 1 of the Cyber Radar paper, compared with this machine's.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/evaluation/trade/trade_scale.hpp"

namespace roomradar {

/// Results for one size of virtual object ("sensor object").
struct Table1Row {
  int published_polygons = 0;
  double published_ms = 0.0;  ///< frame time of the published application on its GPU
  std::size_t triangles = 0;  ///< triangles of our object
  double frame_median_ms = 0.0, frame_p95_ms = 0.0;
  double radar_median_ms = 0.0;    ///< time of all radar queries of a frame
  double static_triangles = 0.0;   ///< room triangles drawn per frame
  double dynamic_triangles = 0.0;  ///< triangles of the dynamic foreground's mesh per frame
};

struct Table1 {
  std::string renderer;
  std::string scene;
  std::vector<Table1Row> rows;
  double contact_error_median_m = 0.0, contact_error_p95_m = 0.0;
  int contacts = 0;
  double passed = 0.0;  ///< fraction that fell through
};

/// Maps a simulated room, runs a session in it with each of published_objects(), then drops and pushes other
/// objects onto its hidden surfaces. Throws Error as a session does.
Table1 measure_table1(const std::string& room, const TradeScale& scale);

std::string text_of(const Table1& table);
nlohmann::json to_json(const Table1& table);

}  // namespace roomradar
