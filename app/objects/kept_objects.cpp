// kept_objects.cpp: objects.json as JSON; models by their content.
#include "app/objects/kept_objects.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "app/models/model_file.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kList = "objects.json";
constexpr const char* kFormat = "roomradar objects";
constexpr int kFormatVersion = 1;
constexpr std::uintmax_t kMaxListBytes = 16U << 20U;
constexpr std::uintmax_t kMaxModelBytes = std::uintmax_t{4} << 30U;
constexpr std::chrono::seconds kBetweenWrites{2};

Json json_of(const KeptObject& object) {
  const Eigen::Vector3d p = object.T_world_object.translation();
  const Eigen::Quaterniond q(object.T_world_object.linear());
  Json json = {{"name", object.name},
               {"model", object.model},
               {"position_m", {p.x(), p.y(), p.z()}},
               {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
  for (const MaterialField& field : kMaterialFields)
    if (const std::optional<double>& value = object.material.*field.value)
      json["material"][std::string(field.name)] = *value;
  return json;
}

std::string text_of(const std::vector<KeptObject>& objects) {
  Json json = {{"format", kFormat}, {"format_version", kFormatVersion}, {"objects", Json::array()}};
  for (const KeptObject& object : objects) json["objects"].push_back(json_of(object));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Reads one object; `where` begins the messages.
class ObjectReader {
 public:
  ObjectReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) fail("is not an object");
  }

  [[nodiscard]] KeptObject read(const fs::path& folder) const {
    KeptObject object{.name = text("name"), .model = text("model"), .material = material()};
    try {
      require_object_name(object.name);
    } catch (const Error& fault) {
      fail(fault.what());
    }
    const std::string stem = fs::path(object.model).stem().string();
    if (stem.size() != 64 || stem.find_first_not_of("0123456789abcdef") != std::string::npos ||
        object.model != stem + kModelCopyExtension)
      fail("\"model\" is not the name of a model in this folder");
    std::error_code fault;
    if (!fs::is_regular_file(fs::symlink_status(folder / object.model, fault)))
      fail("its model " + object.model + " is missing");
    const std::array<double, 3> p = numbers<3>("position_m");
    const std::array<double, 4> q = numbers<4>("quaternion_xyzw");
    const Eigen::Quaterniond R(q[3], q[0], q[1], q[2]);
    if (!(std::abs(R.norm() - 1.0) < 1e-6)) fail("\"quaternion_xyzw\" has not the length 1");
    object.T_world_object = Eigen::Translation3d(p[0], p[1], p[2]) * R.normalized();
    return object;
  }

 private:
  const Json& json_;
  std::string where_;

  [[noreturn]] void fail(const std::string& fault) const { throw Error(where_ + ": " + fault); }

  [[nodiscard]] std::string text(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || !found->is_string()) fail("\"" + std::string(key) + "\" is not text");
    return found->get<std::string>();
  }

  template <std::size_t kCount>
  [[nodiscard]] std::array<double, kCount> numbers(const char* key) const {
    const auto found = json_.find(key);
    std::array<double, kCount> values{};
    bool are_numbers = found != json_.end() && found->is_array() && found->size() == kCount;
    for (std::size_t i = 0; are_numbers && i < kCount; ++i) {
      are_numbers = (*found)[i].is_number() && std::isfinite((*found)[i].template get<double>());
      if (are_numbers) values[i] = (*found)[i].template get<double>();
    }
    if (!are_numbers)
      fail("\"" + std::string(key) + "\" is not a list of " + std::to_string(kCount) + " numbers");
    return values;
  }

  [[nodiscard]] BodyMaterial material() const {
    BodyMaterial material;
    const auto found = json_.find("material");
    if (found == json_.end()) return material;
    if (!found->is_object()) fail("\"material\" is not an object");
    for (const MaterialField& field : kMaterialFields) {
      const auto value = found->find(std::string(field.name));
      if (value == found->end()) continue;
      if (!value->is_number()) fail("\"material\": \"" + std::string(field.name) + "\" is not a number");
      material.*field.value = value->get<double>();
    }
    try {
      require_valid(material);
    } catch (const Error& fault) {
      fail(fault.what());
    }
    return material;
  }
};

/// Writes a file whole or not at all.
void replace_file(const fs::path& path, const std::string& bytes) {
  AtomicFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

/// Writes the model unless the folder has it. Returns the name of its file.
std::string keep_model(const Model& model, const fs::path& folder) {
  const std::string bytes = model_copy(model);
  std::string name = sha256_of(bytes) + kModelCopyExtension;
  std::error_code fault;
  if (fs::file_size(folder / name, fault) == bytes.size() && !fault) return name;
  replace_file(folder / name, bytes);
  return name;
}

}  // namespace

void require_object_name(const std::string& name) {
  if (name.empty() || name.find_first_of(" \t\r\n\v\f#") != std::string::npos)
    throw Error("\"" + name + "\" cannot be the name of an object: it is empty, or has a blank or #");
}

std::vector<KeptObject> read_kept_objects(const fs::path& folder) {
  const fs::path path = folder / kList;
  std::error_code fault;
  if (!fs::exists(fs::symlink_status(path, fault))) return {};
  const Json json = Json::parse(read_bytes(path, "the objects of a room", kMaxListBytes), nullptr,
                                /*allow_exceptions=*/false);
  const auto fail = [&](const std::string& why) {
    throw Error(path.string() + ": " + why + "; --objects none runs without the kept objects");
  };
  if (!json.is_object() || !json.contains("format") || json["format"] != kFormat)
    fail("is not the list of a room's objects, or is damaged");
  const auto version = json.find("format_version");
  if (version == json.end() || !version->is_number_integer() || *version < 1 || *version > kFormatVersion)
    fail("is of a format version that this roomradar does not read");
  const auto list = json.find("objects");
  if (list == json.end() || !list->is_array()) fail("\"objects\" is not a list");
  std::vector<KeptObject> objects;
  std::set<std::string> names;
  for (const Json& one : *list) {
    try {
      objects.push_back(ObjectReader(one, "object " + std::to_string(objects.size() + 1)).read(folder));
    } catch (const Error& error) {
      fail(error.what());
    }
    if (!names.insert(objects.back().name).second) fail("has the name " + objects.back().name + " twice");
  }
  return objects;
}

void write_kept_objects(const fs::path& folder, const std::vector<KeptObject>& objects) {
  const fs::path path = folder / kList;
  const std::string text = text_of(objects);
  std::error_code fault;
  if (fs::exists(path, fault) && read_bytes(path, "the objects of a room", kMaxListBytes) == text) return;
  make_folder(folder);
  replace_file(path, text);
}

void add_kept_objects(const fs::path& from, const Eigen::Isometry3d& T_to_from, const fs::path& to) {
  constexpr double kSame_m = 0.005;
  const std::vector<KeptObject> more = read_kept_objects(from);
  if (more.empty()) return;
  std::vector<KeptObject> objects = read_kept_objects(to);
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(objects.begin(), objects.end(),
                       [&](const KeptObject& object) { return object.name == name; });
  };
  make_folder(to);
  for (KeptObject object : more) {
    object.T_world_object = T_to_from * object.T_world_object;
    const auto is_there = [&](const KeptObject& other) {
      return other.model == object.model &&
             (other.T_world_object.translation() - object.T_world_object.translation()).norm() < kSame_m;
    };
    if (std::any_of(objects.begin(), objects.end(), is_there)) continue;
    const std::string stem = object.name;
    for (int number = 2; is_taken(object.name); ++number) object.name = stem + std::to_string(number);
    std::error_code fault;
    if (!fs::exists(to / object.model, fault))
      replace_file(to / object.model, read_bytes(from / object.model, "a model", kMaxModelBytes));
    objects.push_back(std::move(object));
  }
  write_kept_objects(to, objects);
}

void delete_unused_models(const fs::path& folder) {
  std::set<std::string> used;
  for (const KeptObject& object : read_kept_objects(folder)) used.insert(object.model);
  std::error_code fault;
  std::vector<fs::path> unused;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault))
    if (entry.path().extension() == kModelCopyExtension && !used.contains(entry.path().filename().string()))
      unused.push_back(entry.path());
  for (const fs::path& path : unused) fs::remove(path, fault);
}

ObjectKeeper::ObjectKeeper(fs::path folder) : folder_(std::move(folder)) {}

std::vector<ObjectKeeper::Standing> ObjectKeeper::in_room(
    std::span<const std::unique_ptr<VirtualObject>> objects) {
  std::vector<Standing> standing;
  for (const auto& object : objects)
    if (object->in_room)
      standing.push_back(
          {object->body.name, object->model, object->body.material, object->body.T_world_object});
  return standing;
}

void ObjectKeeper::begin_to_write(std::vector<Standing> standing) {
  latest_ = std::move(standing);
  writing_ = std::async(std::launch::async, [this] {
    std::vector<KeptObject> objects;
    if (!latest_.empty()) make_folder(folder_);
    for (const Standing& one : latest_) {
      std::string& file = files_[one.model];
      if (file.empty()) file = keep_model(one.model->source, folder_);
      objects.push_back({one.name, file, one.material, one.T_world_object});
    }
    std::error_code fault;
    if (objects.empty() && !fs::exists(folder_ / kList, fault)) return;
    write_kept_objects(folder_, objects);
  });
}

void ObjectKeeper::wait() {
  if (!writing_.valid()) return;
  try {
    writing_.get();
  } catch (const Error&) {
    latest_.clear();  // to be written again
    throw;
  }
}

void ObjectKeeper::keep(std::span<const std::unique_ptr<VirtualObject>> objects) {
  has_begun_ = true;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kBetweenWrites) return;
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  last_ = now;
  wait();
  std::vector<Standing> standing = in_room(objects);
  if (standing != latest_) begin_to_write(std::move(standing));
}

void ObjectKeeper::finish(std::span<const std::unique_ptr<VirtualObject>> objects) {
  if (!has_begun_) return;  // the room's objects are not in the session yet
  try {
    wait();
  } catch (const Error&) {  // an earlier write; this one tells if the fault remains
  }
  begin_to_write(in_room(objects));
  wait();
  std::error_code fault;
  if (fs::exists(folder_, fault)) delete_unused_models(folder_);
}

}  // namespace roomradar
