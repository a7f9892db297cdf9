// ar.cpp: augmented reality in another program: opens a map and a recording, puts two objects into the room,
// steps through the frames, and writes the last picture.
#include <cstdio>
#include <exception>
#include <memory>

#include "app/media/picture_file.hpp"
#include "app/objects/published_objects.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/session/session.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/map/map_folder.hpp"

int main(int argc, char** argv) {
  using namespace roomradar;
  if (argc != 4) {
    std::fprintf(stderr, "usage: ar MAP RECORDING PICTURE.png\n");
    return 2;
  }
  try {
    const SavedMap map = load_map(argv[1]);
    const std::unique_ptr<FrameSource> recording = open_folder(argv[2]);
    Session session(map, {});
    session.add_object("pot", object_mesh("teapot"));
    session.add_object("box", box_mesh({0.1F, 0.1F, 0.1F}));
    session.drop({.name = "pot"});  // over a level surface in view, as soon as a frame shows one

    Frame frame;
    StageTimes times;
    int located = 0;
    for (ReadResult read = recording->next(frame); read.status != ReadStatus::kEnd;
         read = recording->next(frame)) {
      if (read.status != ReadStatus::kFrame) continue;
      const FrameResult result = session.step(frame, times);
      if (result.status != FrameStatus::kDone) continue;
      if (++located == 2) {  // half a metre over the pot, wherever that was dropped
        ObjectState above;
        above.position_world =
            session.objects()[0]->body.T_world_object.translation() + Eigen::Vector3d(0, 0, 0.5);
        session.place("box", above);
      }
    }
    write_png(session.picture(), argv[3]);
    std::printf("%d frames located\n", located);
    for (const auto& object : session.objects()) {
      const Eigen::Vector3d p_world = object->body.T_world_object.translation();
      std::printf("%s at %.3f %.3f %.3f m\n", object->body.name.c_str(), p_world.x(), p_world.y(),
                  p_world.z());
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ar: %s\n", error.what());
    return 1;
  }
}
