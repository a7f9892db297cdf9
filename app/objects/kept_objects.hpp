// kept_objects.hpp: the virtual objects of a room between two runs, in the folder MAP/objects:
//
//   objects.json   name, pose, material and model of each object
//   HASH.model     copy of a model with its textures, upright and scaled; HASH is the SHA-256 of the file
#pragma once
#include <chrono>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/physics/body_material.hpp"

namespace roomradar {

/// An object that stands in a room.
struct KeptObject {
  std::string name{};
  std::string model{};  ///< name of the model's file in the folder
  BodyMaterial material{};
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  friend bool operator==(const KeptObject& a, const KeptObject& b) {
    return a.name == b.name && a.model == b.model && a.material == b.material &&
           a.T_world_object.matrix() == b.T_world_object.matrix();
  }
};

/// Throws Error unless the text can be the name of an object in a script: without blanks and #, not empty.
void require_object_name(const std::string& name);

/// Reads the objects that are kept in a folder, in the order in which they were added. Empty if the folder,
/// or objects.json in it, is missing. Throws Error naming the file and the fault if objects.json is damaged,
/// or a model's file is missing.
std::vector<KeptObject> read_kept_objects(const std::filesystem::path& folder);

/// Replaces objects.json, whole or not at all. Creates the folder. Throws Error if the file cannot be
/// written.
void write_kept_objects(const std::filesystem::path& folder, const std::vector<KeptObject>& objects);

/// Adds the objects of one folder to those of another, whose room is the same, and copies their models. An
/// object that the other folder has already (same model, within 5 mm) is left out; one whose name is taken
/// gets a number. Throws Error as read_kept_objects() and write_kept_objects() do.
/// @param T_to_from  from the world frame of `from` to that of `to`
void add_kept_objects(const std::filesystem::path& from, const Eigen::Isometry3d& T_to_from,
                      const std::filesystem::path& to);

/// Deletes the models of a folder that no object of objects.json has.
void delete_unused_models(const std::filesystem::path& folder);

/// Keeps the objects of a run in a folder. Writes on another thread. Not thread safe.
class ObjectKeeper {
 public:
  explicit ObjectKeeper(std::filesystem::path folder);

  /// Begins to write the objects in the room if they have changed, at most every 2 s. Call after each frame.
  /// Throws an Error of the last write, once; the objects are then written again.
  void keep(std::span<const std::unique_ptr<VirtualObject>> objects);
  /// Writes the objects in the room, waits until they are on disk, and deletes unused models. Does nothing if
  /// keep() was never called. Throws Error if the objects cannot be written.
  void finish(std::span<const std::unique_ptr<VirtualObject>> objects);

 private:
  struct Standing {
    std::string name;
    std::shared_ptr<const ObjectModel> model;
    BodyMaterial material;
    Eigen::Isometry3d T_world_object;
    friend bool operator==(const Standing& a, const Standing& b) {
      return a.name == b.name && a.model == b.model && a.material == b.material &&
             a.T_world_object.matrix() == b.T_world_object.matrix();
    }
  };

  std::filesystem::path folder_;
  bool has_begun_ = false;
  std::chrono::steady_clock::time_point last_{};
  // Read by the thread that writes, and changed only while it does not run.
  std::vector<Standing> latest_;
  std::map<std::shared_ptr<const ObjectModel>, std::string> files_;  ///< file of each model
  std::future<void> writing_;  ///< declared last: its destructor waits for the thread

  static std::vector<Standing> in_room(std::span<const std::unique_ptr<VirtualObject>> objects);
  void begin_to_write(std::vector<Standing> standing);
  void wait();
};

}  // namespace roomradar
