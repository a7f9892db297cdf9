// map_server_absent.cpp: replaces map_server.cpp in builds without cpp-httplib.
#include "app/serve/map_server.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

struct MapServer::State {};

MapServer::MapServer(MapServerConfig /*config*/, MapCatalogue /*catalogue*/) {
  throw Error("this roomradar was built without cpp-httplib; install libcpp-httplib-dev and build it again");
}
MapServer::~MapServer() = default;
int MapServer::port() const { return 0; }
void MapServer::run() {}
void MapServer::stop() {}

}  // namespace roomradar
