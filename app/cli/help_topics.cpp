// help_topics.cpp: the texts. Tests run every script line and open every source that they show.
#include "app/cli/help_topics.hpp"

#include <array>

namespace roomradar {
namespace {

constexpr std::string_view kScript =
    R"(An events file of `roomradar run --script FILE` has one event per line. An event is due before a frame of
the run (frame N, from 0) or at a time (time SECONDS, from the first frame). Events happen in the order of
the file: an event that stands below a later one waits for it. Positions are in the map's world in metres
(z up), velocities in m/s, angles in degrees. # begins a comment.

  frame 0    add pot teapot size 0.2          # longest side, m
  frame 0    add chair chair.obj size 0.9 up z   # axis of the file that points up: x, y, z, -x, -y, -z
  frame 0    add ball teapot density 600 friction 0.3 restitution 0.8   # kg/m3 (or mass, kg); 0..10; 0..1
  frame 10   drop pot view height 0.3         # on the free level place nearest to the view's middle
  frame 11   drop pot near 0.4 -0.1 0.7       # on the one nearest to this point, at most 25 cm away
             # drop view and near: from 0.05 m instead where the object would topple or move away
  time 2.5   drop pot at 0.4 -0.1 0.75 height 0.3
  time 4     place pot 0.4 -0.1 0.9           # drop, place, throw may end: turned YAW PITCH ROLL
  time 4     stand pot 0.4 -0.1 0.75 0 0 0.6 0.8   # exactly there, asleep; quaternion x y z w
  time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 0.5
  time 5.5   throw pot 0.4 -0.1 1.2 velocity 1 0 0.5 spin 0 6 0    # rad/s about x y z
  time 5.5   turn pot 0 0 45                  # about the world's axes
  time 5.6   carry pot 0.4 -0.1 1.0           # held in the air, on its way there
  time 5.9   release pot velocity 0 0 0
  time 5.9   material pot mass 2 friction 0.1 # what is not named stays as it is
  time 6     remove pot
  time 7     commit                           # what stands still in view becomes part of the room
  frame 200  surfaces skirt                   # holes, skirt, border or map
  frame 210  unknown solid                    # or free
  frame 220  radar sampled 64                 # exact, sampled or passes; pixels
  frame 225  quality depth_stride 2 shadows off   # others get their defaults; options keep theirs
  frame 230  camera hold                      # go, rewind, loop, stay or resume
  frame 300  quit

A camera that is held, or that stays or loops at the end of its recording, goes on until a quit event.
Without one, and without a window, the run ends 5 s after the script's last event.
`roomradar map info DIR` lists the level surfaces of a room with their positions; in the play window the
position under the mouse is shown, and Ctrl+C copies it.
)";

constexpr std::string_view kModels =
    R"(Objects are .glb, .gltf, .obj, .ply, .stl or .dae files, drawn with their base-colour textures, material and
vertex colours, in their rest pose.

  axes      A .glb, .gltf or .obj stands with its y axis up, a .ply or .stl with z, a .dae as it states. up=AXIS
            (--object-up; `up` in a script) overrides this.
  units     Numbers are metres, unless a .dae states another unit. size=M (--object-size; `size` in a script)
            scales the longest side. A model that is less than 5 mm, more than 5 m or more than half of the room
            long is refused unless a size is given.
  material  mass=KG or density=KG/M3, friction=F (on surfaces of the room) and restitution=E follow the name like
            size=M; in a script `mass`, `density`, `friction` and `restitution` follow `add` or `material`. A
            closed mesh weighs 1000 kg/m3, an open one 5 kg/m2; friction is 0.5 and restitution 0 unless given.
            Between two objects, friction is the geometric mean, and restitution the larger of both.
  textures  are found beside the file, or inside it. One that cannot be read is named on standard error, and the
            material's colour is drawn.

  roomradar run RECORDING --map maps/kitchen --object chair.glb,size=0.9,at=0.4,-0.1,0.75 --object teapot
)";

constexpr std::string_view kSources =
    R"(A SOURCE is one of

  DIR or FILE      a recording, recognised by its content:
                     7-Scenes    frame-XXXXXX.depth.png, .color.jpg (or .png; an empty .none: no colour),
                                 .pose.txt
                     TUM RGB-D   depth.txt, rgb.txt, groundtruth.txt, accelerometer.txt
                     fakenect    INDEX.txt and the raw images of a Kinect
                     numbered    depth/00000.png (mm), color/00000.jpg; also pose/0.txt and intrinsic/ of
                                 ScanNet's exports, and traj.txt or poses.txt with a pose per line
                     Record3D    an export "EXR + RGB": metadata, depth/0.exr (m), rgb/0.jpg
                     ROS 1       FILE.bag with depth, colour and camera_info; poses from tf, gravity from an IMU
                     ROS 2       FILE.db3, FILE.mcap or their folder, as ROS 1
                     RTAB-Map    FILE.db
                     OpenNI      FILE.oni
                     ScanNet     FILE.sens;  ElasticFusion: FILE.klg
                     Azure       FILE.mkv of k4arecorder (Azure Kinect, Femto), with its calibration
                     Stray       Stray Scanner's odometry.csv, camera_matrix.csv, depth/000000.png, and
                                 rgb.mp4 if it is there
                     Redwood     depth/N.png (mm), color/N.jpg, *.log or intrinsic.json (also Open3D)
                     ICL-NUIM    depth/N.png (1/5000 m), rgb/N.png, *.gt.freiburg
                   A camera.json in it describes the cameras, a calibration.json their errors. camera.json
                   may also state "depth_unit_m" and "poses_convention", for any kind of recording.
                   `roomradar check RECORDING` says what a recording states, whether its depth agrees with
                   that, and what was decided. --depth-unit, --camera, --poses-convention, --stamps
                   and --depth-topic overrule it.
  SESSION          a folder that `run --record-session` wrote: replayed with identical results
  kinect:N         a Kinect v1, numbered from 0. It continues until Ctrl-C is pressed once. kinect:0?depth=mm
                   and kinect:0?depth=registered let libfreenect convert or register the depth.
  openni:N         an Xtion, PrimeSense or other device of OpenNI2, numbered from 0
  sim:ROOM[?KEY=VALUE&...]
                   a simulated Kinect in the room table, shelf, wall, random, flat (four
                   rooms), building (2 to 1000 rooms) or board. Keys:
                     seed=N      the camera's path, the noise, the furniture of `random`, `flat`
                                 and `building` (1)
                     frames=N    number of frames (300; of `building` its whole walk, or less)
                     rate=HZ     frames per second (30)
                     path=KIND   scan (round the room), view (looking at its focus), swing (a board) (scan)
                     moving=LIST hand, ball, person, with commas between them (none)
                     pace=WORD   steady, slow, waits or leaves (steady)
                     noise=X     0: none; 1: a Kinect's (1)
                     crate=WORD  0, 1, comes or goes (0)
                     moved=X     of `random`: share of the furniture that stands elsewhere, 0 to 1;
                                 scanned on another path (0)
                     width=PX    width of the images (640)
                     colour=WORD registered, separate or none (registered)
                     faults=0|1  1: the cameras deviate from what they declare (0)
                     shutter=MS  readout time of depth and colour, row by row (0)
                     delay=MS    time of the colour image after the depth image (0)
                     exposure=MS motion blur of the colour image (0)
                     turn=DPS    the camera swings at this many degrees per second, too (0)
                   Further keys of `building`, whose walks share one world:
                     rooms=N     rooms, 2 to 1000, along corridors (10)
                     floors=N    floors, 1 to 10, joined by stairs (2)
                     alike=N     rooms that look like another one, an even number (a fifth)
                     walk=WORD   0 to 9999: a walk through 2 to 4 neighbouring rooms, sharing one
                                 with the next walk; walks up to half the number of rooms visit all.
                                 ring: round the corridors, back to the start (0)

Quote a source that contains ? or &: 'sim:table?seed=3&frames=100'.
)";

constexpr std::string_view kUnits =
    R"(Lengths are metres, times seconds, angles degrees, velocities m/s; other units are part of the name (depth_mm).

  world     right-handed, +z up. A new map that was tracked has its floor at z = 0 and its first camera
            above x = y = 0; with --poses recorded it has the recording's own origin.
  camera    x right, y down, z forward (as in OpenCV); the centre of the first pixel is (0, 0)
  depth     distance along the optical axis; 0: nothing was measured
  T_a_b     maps coordinates in b to coordinates in a
  R, M, L   the radar's pictures: R is the way of the room's surfaces along the direction of motion, M that
            of the object, both from the target volume's ends; L = R + M - d is the free way per pixel,
            with d the length of the target volume
  --report  JSON; keys end with their unit (_m, _s, _ms, _mb, _px, _deg)
)";

constexpr std::string_view kCalibrate =
    R"(A calibration removes what the nominal cameras do not know of your device: focal lengths, lens distortion, the
pose of the colour camera, and the errors of the depth. It takes five minutes:

1. Print a checkerboard of 9 x 7 squares (8 x 6 inner corners) and fix it to something flat. Measure one
   square: most printers scale.
2. Record it. Hold the board still for a second in each of 20 or more places, at 0.5 to 2 m: near and far,
   tilted in every direction, in every corner of the image.
     roomradar record kinect:0 board
3. Estimate the cameras, with the size that you measured:
     roomradar calibrate board --columns 8 --rows 6 --square 0.03 --out kinect.json --plot kinect.png
   It says while it reads what is missing, and refuses a fit that the views do not support.
4. Give it with every later command, or save it as calibration.json in a recording:
     roomradar prescan kinect:0 --calibration kinect.json --map maps/room

Without a Kinect, the simulated board shows the whole way:
  roomradar calibrate 'sim:board?path=swing&colour=separate&faults=1&frames=800&rate=15' --square 0.06 \
      --out kinect.json
)";

constexpr std::string_view kFiles =
    R"(  MAP/             a saved map: map.json (facts and checksums), octree.bin (`map export` writes it as .ot
                   and .bt), mesh.ply, places.bin (keyframe database for localisation), trajectory.txt,
                   coverage.png, unknown.bin (the frontier of unknown space), texture.jpg and texture.bin
                   (colours of the surface). It is saved completely or not at all.
  MAP.unfinished   checkpoint of an interrupted scan, for `prescan --resume`
  SESSION/         frames, events and results of `run --record-session`

Environment:
  ROOMRADAR_RENDERER=gpu|software   selects the renderer; otherwise a GPU is used if there is one

Exit status: 0: done. 1: the work failed; standard error says what, where and what to do. 2: wrong usage.
)";

constexpr std::string_view kHttp =
    R"(Requests to `roomradar serve MAP...`; NAME is the name of a map's folder. Each connection has one request.

  GET /health                        {"status": "ok"}
  GET /maps                          names and kinds (building, room) of the maps
  GET /maps/NAME                     facts, as `roomradar map info --json`: files, extents, floors
  GET /maps/NAME/tileset.json        a building for viewers of 3D Tiles 1.1; its tiles are below tiles/
  GET /maps/NAME/tiles/FILE          .glb, .mesh, .octree, .unknown of a tile; only files that the facts list
  GET /maps/NAME/mesh.ply            surface of a room; also texture.jpg
  POST /maps/NAME/locate             pose of a camera in this map
  POST /locate                       the same in all maps; refused if two of them fit

An answer has an ETag: a request with it in If-None-Match is answered 304 if nothing changed. Files can be read in
parts (Range, one part). Faults are {"error": "sentence"}. A map that is replaced on disk is taken up at the next
request.

The body of a request to locate is one line of JSON, then the bytes of both images, 8 MB at most:

  {"camera": {"depth": {"width_px": 640, "height_px": 480, "fx_px": 585, "fy_px": 585, "cx_px": 320, "cy_px": 240}},
   "depth_bytes": 183042, "colour_bytes": 90211, "depth_units_per_m": 1000}      # in one line
  depth: grey PNG of 16 bit, 0 is not measured; colour: JPEG or PNG

"camera" is as in camera.json; "colour" and "T_colour_depth" are needed if the colour image has a view of its own.
In Python, without other packages:

  head = json.dumps({"camera": camera, "depth_bytes": len(depth), "colour_bytes": len(colour)})
  request = urllib.request.Request(url, head.encode() + b"\n" + depth + colour,
                                   {"Content-Type": "application/octet-stream"})
  print(json.load(urllib.request.urlopen(request)))

The answer has "found", "map", "pose" (position_m and quaternion_xyzw of the depth camera in the map's world; the
camera has x right, y down, z forward), "feature_inliers" and "rival_inliers" (features that agree with the pose,
and with another one), "depth_agreement" and "overlap" (0 to 1), "tiles" within 5 m, and "geopose": an OGC GeoPose
with --anchor, otherwise "local". If "found" is false, "reason" and "sentence" say why: no depth, no colour, no
match, not verified, or ambiguous (two places fit equally well; rooms that look alike are refused, not guessed).

Without a token the server answers on this machine only. For others: --listen 0.0.0.0:8080 --allow-remote
--token-file FILE, and a proxy with TLS in front, which also limits how slowly a client may send.
)";

constexpr std::array<HelpTopic, 7> kTopics = {{
    {"script", "events of `run --script`: add, drop, throw, ... at a frame or a time", kScript},
    {"models", "which files can be objects, their axes, units and textures", kModels},
    {"sources", "recordings, devices and sim:ROOM with all keys", kSources},
    {"units", "metres, frames of reference, the radar's R, M and L", kUnits},
    {"calibrate", "how to calibrate a device, step by step", kCalibrate},
    {"http", "requests to `roomradar serve` and its answers", kHttp},
    {"files", "what the program writes, environment, exit status", kFiles},
}};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

}  // namespace roomradar
