// sources.cpp: opens sources, reads frames without the interpreter's lock.
#include "app/python/sources.hpp"

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "app/cli/open_source.hpp"
#include "app/python/arrays.hpp"
#include "app/python/bindings.hpp"

namespace roomradar::python {

Source::Source(std::unique_ptr<FrameSource> source, std::shared_ptr<const InputReport> input)
    : source_(std::move(source)), input_(input ? std::move(input) : std::make_shared<const InputReport>()) {}

FrameSource& Source::opened() const {
  if (!source_) throw Error("the source is closed; open it again");
  return *source_;
}

std::shared_ptr<Frame> Source::next() {
  const UseFlag::Lock lock(use_, "the source");
  FrameSource& source = opened();
  was_read_ = true;
  while (true) {
    auto frame = std::make_shared<Frame>();
    const ReadResult read = without_gil([&] { return source.next(*frame); });
    if (read.status == ReadStatus::kFrame) return frame;
    if (read.status == ReadStatus::kEnd) return nullptr;
    if (read.status == ReadStatus::kSkipped) {
      ++skipped_;
      last_fault_ = read.fault;
    }
    throw_if_interrupted();
  }
}

bool Source::restart() {
  const UseFlag::Lock lock(use_, "the source");
  FrameSource& source = opened();
  if (!was_read_) return true;
  if (!without_gil([&] { return source.rewind(); })) return false;
  was_read_ = false;
  return true;
}

bool Source::seek(std::int64_t index) {
  const UseFlag::Lock lock(use_, "the source");
  FrameSource& source = opened();
  const std::optional<std::int64_t> count = source.frame_count();
  if (index < 0 || (count && index >= *count))
    throw py::index_error("frame " + std::to_string(index) + " of " +
                          (count ? std::to_string(*count) : "an unknown number"));
  was_read_ = true;
  return without_gil([&] { return source.seek(index); });
}

void Source::close() {
  const UseFlag::Lock lock(use_, "the source");
  std::unique_ptr<FrameSource> closed = std::move(source_);  // first: others see at once that it is closed
  without_gil([&] { closed.reset(); });
}

namespace {

/// Frames in memory as a source.
class FrameList final : public FrameSource {
 public:
  FrameList(std::vector<std::shared_ptr<Frame>> frames, std::string name)
      : frames_(std::move(frames)), name_(std::move(name)) {}

  ReadResult next(Frame& frame) override {
    if (at_ == frames_.size()) return {};
    frame = *frames_[at_++];
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override { return at_ = 0, true; }
  bool seek(std::int64_t index) override { return at_ = static_cast<std::size_t>(index), true; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(frames_.size());
  }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  std::vector<std::shared_ptr<Frame>> frames_;
  std::string name_;
  std::size_t at_ = 0;
};

/// Returns the decisions about a recording as dictionaries.
py::list dictionaries_of(const std::vector<InputDecision>& decisions) {
  py::list list;
  for (const InputDecision& decision : decisions) {
    py::dict each;
    each["topic"] = decision.topic;
    each["sentence"] = text_of(decision.sentence);
    each["count"] = decision.count;
    each["option"] = decision.option;
    each["advice"] = decision.is_advice;
    list.append(each);
  }
  return list;
}

std::unique_ptr<Source> open(const std::filesystem::path& source,
                             const std::optional<std::pair<std::int64_t, std::int64_t>>& frames,
                             const std::filesystem::path& calibration,
                             const std::optional<Intrinsics>& depth_camera, bool keep_all, bool cache,
                             const std::optional<double>& depth_unit_m, const std::filesystem::path& camera,
                             const std::string& poses_convention, const std::string& depth_topic) {
  SourceOptions options;
  options.depth_camera = depth_camera;
  options.depth_unit_m = depth_unit_m;
  options.camera_file = camera;
  options.depth_topic = depth_topic;
  if (!poses_convention.empty()) {
    options.pose_convention = parse_pose_convention(poses_convention);
    if (!options.pose_convention)
      throw py::value_error("poses_convention: must be stated, or a list of inverse, opengl, wxyz, mm, cm");
  }
  options.questions = Questions::kDepth;
  options.input = std::make_shared<InputReport>();
  options.keep_all = keep_all;
  options.cache_simulated = cache;
  std::optional<FrameRange> range;
  if (frames) range = FrameRange{frames->first, frames->second};
  std::unique_ptr<Source> opened = without_gil([&] {
    return std::make_unique<Source>(open_source(source.string(), range, calibration, options), options.input);
  });
  for (const InputDecision& decision : options.input->decisions())
    if (decision.is_advice)
      py::module_::import("warnings").attr("warn")(text_of(source.string() + ": " + line_of(decision)));
  return opened;
}

std::unique_ptr<Source> of_frames(const py::iterable& frames, const std::string& name) {
  std::vector<std::shared_ptr<Frame>> held;
  for (const py::handle frame : frames) {
    if (!py::isinstance<Frame>(frame)) throw py::type_error("frames: must hold roomradar.Frame only");
    held.push_back(frame.cast<std::shared_ptr<Frame>>());
    if (held.size() > 1 && !(held.back()->stamp_s > held[held.size() - 2]->stamp_s))
      throw py::value_error("frames: stamp_s of frame " + std::to_string(held.size() - 1) +
                            " must be later than that of the frame before it");
  }
  if (held.empty()) throw py::value_error("frames: there is none");
  return std::make_unique<Source>(std::make_unique<FrameList>(std::move(held), name));
}

std::int64_t length(Source& source) {
  const std::optional<std::int64_t> count = source.opened().frame_count();
  if (!count) throw py::type_error("the length of this source is not known in advance");
  return *count;
}

std::shared_ptr<Frame> next_or_stop(Source& source) {
  std::shared_ptr<Frame> frame = source.next();
  if (!frame) throw py::stop_iteration();
  return frame;
}

}  // namespace

void bind_sources(py::module_& module) {
  py::class_<Source>(
      module, "Source",
      "Frames of a recording or a live device, in the order of their times. `for frame in source` begins at "
      "the\n"
      "first frame each time; a live device continues. Unreadable frames are skipped and counted.")
      .def_static("of_frames", &of_frames, py::arg("frames"), py::kw_only(), py::arg("name") = "frames",
                  "Returns a source of frames that are in memory. Their times must increase.")
      .def("__iter__",
           [](const py::object& self) {
             self.cast<Source&>().restart();
             return self;
           })
      .def("__next__", &next_or_stop)
      .def("__len__", &length)
      .def("next_frame", method(&Source::next), "Returns the next readable frame; None at the end.")
      .def("rewind", method(&Source::restart),
           "Goes back to the first frame. Returns False for a live device, which continues.")
      .def("seek", method(&Source::seek), py::arg("index"),
           "Makes frame `index`, from 0, the next one. Returns False if the source reads in order only.")
      .def("close", method(&Source::close), "Closes files and devices.")
      .def_property_readonly("name", [](const Source& source) { return text_of(source.opened().name()); })
      .def_property_readonly(
          "frame_count", [](const Source& source) { return source.opened().frame_count(); },
          "Number of frames, unreadable ones included; None if unknown.")
      .def_property_readonly("skipped", method(&Source::skipped), "Number of unreadable frames so far.")
      .def_property_readonly(
          "last_fault", [](const Source& source) { return text_of(source.last_fault()); },
          "Why the last skipped frame was unreadable.")
      .def_property_readonly(
          "input", [](const Source& source) { return dictionaries_of(source.input().decisions()); },
          "What was decided about a recording so far: a list of dictionaries with topic, sentence, count, option\n"
          "and advice. Decisions with advice are also given as warnings when it is opened.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Source& source, const py::args&) { source.close(); });

  module.def(
      "open_source", &open, py::arg("source"), py::kw_only(), py::arg("frames") = py::none(),
      py::arg("calibration") = "", py::arg("depth_camera") = py::none(), py::arg("keep_all") = false,
      py::arg("cache") = false, py::arg("depth_unit_m") = py::none(), py::arg("camera") = "",
      py::arg("poses_convention") = "", py::arg("depth_topic") = "",
      "Opens a recording (folder or file), a device (kinect:N, openni:N) or a simulated one (sim:ROOM).\n\n"
      "frames: first and last frame, both included; None: all\n"
      "calibration: file of `roomradar calibrate`; empty: that of the recording, if any\n"
      "depth_camera: replaces the recording's intrinsics\n"
      "keep_all: a live device queues its frames; otherwise only the newest is kept\n"
      "cache: simulated frames are kept on disk, for callers that read them several times\n"
      "depth_unit_m: length of a unit of the recorded depth; None: as the recording states\n"
      "camera: a camera.json, or a text file with the depth camera's 3 x 3 matrix\n"
      "poses_convention: stated, or a list of inverse, opengl, wxyz, mm, cm; empty: recognised\n"
      "depth_topic: topic of a ROS recording with the depth images; empty: chosen");
}

}  // namespace roomradar::python
