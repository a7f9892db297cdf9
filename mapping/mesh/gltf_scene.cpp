// gltf_scene.cpp: primitives to triangles, then nodes to the scene. Source: glTF 2.0 specification, 3.5, 3.7.
#include "mapping/mesh/gltf_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/draco_mesh.hpp"
#include "mapping/mesh/gltf_accessor.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMaxVertices = 3 * kMaxMeshTriangles;
/// Degenerate triangles, which strips have many of, are not counted by kMaxMeshTriangles.
constexpr std::size_t kMaxConsideredTriangles = 4 * kMaxMeshTriangles;

using Numbers = std::shared_ptr<const GltfNumbers>;

/// Vertices of a primitive in its mesh's frame, without equal ones.
struct Primitive {
  std::optional<std::size_t> material;
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals{};  // these four are empty if the file has none
  std::vector<Eigen::Vector2f> texture_points{};
  std::vector<Eigen::Vector4f> colours{};
  std::vector<float> influences{};  // joint and weight, `influence_count` pairs per vertex
  std::size_t influence_count = 0;
  std::vector<Triangle> triangles{};
};

/// Attributes of vertices, by their names in the file; each has as many elements as POSITION.
struct Attributes {
  std::map<std::string, Numbers> named;

  [[nodiscard]] const GltfNumbers* find(const std::string& name) const {
    const auto found = named.find(name);
    return found == named.end() ? nullptr : found->second.get();
  }
};

std::vector<Triangle> triangles_of(std::uint64_t mode, const std::vector<std::uint32_t>& corners) {
  constexpr std::uint64_t kStrip = 5, kFan = 6;
  std::vector<Triangle> triangles;
  if (mode == kStrip) {
    for (std::size_t i = 0; i + 2 < corners.size(); ++i)
      triangles.push_back(i % 2 == 0 ? Triangle{corners[i], corners[i + 1], corners[i + 2]}
                                     : Triangle{corners[i], corners[i + 2], corners[i + 1]});
  } else if (mode == kFan) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      triangles.push_back({corners[i], corners[i + 1], corners[0]});
  } else {
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  return triangles;
}

/// Numbers vertices of equal attributes alike, in the order of their first use.
class VertexRows {
 public:
  explicit VertexRows(std::size_t width) : width_(width), known_(16, Hash{this}, Equal{this}) {}

  /// Returns the row to fill next.
  std::vector<float>& next() {
    next_.assign(width_, 0.0F);
    return next_;
  }
  /// Returns the number of the vertex in next().
  std::uint32_t add() {
    for (float& value : next_) value += 0.0F;  // -0 equals 0
    rows_.insert(rows_.end(), next_.begin(), next_.end());
    const auto row = static_cast<std::uint32_t>(rows_.size() / width_ - 1);
    const auto [known, is_new] = known_.insert(row);
    if (!is_new) rows_.resize(rows_.size() - width_);
    return *known;
  }
  [[nodiscard]] std::size_t size() const { return rows_.size() / width_; }
  [[nodiscard]] const float* at(std::size_t row) const { return rows_.data() + row * width_; }

 private:
  struct Hash {
    const VertexRows* of;
    std::size_t operator()(std::uint32_t row) const {
      return std::hash<std::string_view>{}(
          {reinterpret_cast<const char*>(of->at(row)), of->width_ * sizeof(float)});
    }
  };
  struct Equal {
    const VertexRows* of;
    bool operator()(std::uint32_t a, std::uint32_t b) const {
      return std::memcmp(of->at(a), of->at(b), of->width_ * sizeof(float)) == 0;
    }
  };
  std::size_t width_;
  std::vector<float> rows_, next_;
  std::unordered_set<std::uint32_t, Hash, Equal> known_;
};

/// Joints of a skin: matrices from the mesh's rest pose to the scene.
using Joints = std::vector<Eigen::Matrix4d>;

class GltfCollector {
 public:
  GltfCollector(GltfDocument& document, const GltfUseOf& use_of, NotDrawn& not_drawn)
      : document_(document), use_of_(use_of), not_drawn_(not_drawn) {}

  GltfScene collect() {
    const std::vector<std::size_t> roots = roots_of_scene();
    visited_.assign(document_.count("nodes"), false);
    for (const std::size_t root : roots) add_tree(root);
    not_drawn_.add("animation", "not drawn; the model is drawn at rest", document_.count("animations"));
    std::size_t with_normals = 0, with_colours = 0, with_points = 0;
    for (const GltfPart& part : scene_.parts) {
      with_normals += part.has_normals ? 1 : 0;
      with_colours += part.has_colours ? 1 : 0;
      with_points += part.has_texture_points ? 1 : 0;
    }
    if (with_normals == 0) scene_.mesh.normals.clear();
    if (with_colours == 0) scene_.colours.clear();
    if (with_points == 0) scene_.texture_points.clear();
    return std::move(scene_);
  }

 private:
  GltfDocument& document_;
  const GltfUseOf& use_of_;
  NotDrawn& not_drawn_;
  GltfScene scene_;
  std::vector<bool> visited_;
  std::size_t considered_triangles_ = 0;
  std::map<std::size_t, Numbers> numbers_;  // by accessor
  std::map<std::size_t, std::vector<std::shared_ptr<const Primitive>>> meshes_;
  std::map<std::size_t, Joints> skins_;
  std::optional<std::vector<Eigen::Matrix4d>> T_scene_nodes_;

  // Nodes.

  std::vector<std::size_t> roots_of_scene() {
    const std::size_t scenes = document_.count("scenes");
    if (scenes > 0) {
      const std::size_t shown = document_.root().index("scene").value_or(0);
      const GltfObject scene = document_.element("scenes", shown);
      not_drawn_.add("other scene", "not drawn", scenes - 1);
      return scene.indices("nodes");
    }
    // A library of meshes: all nodes that are nobody's children.
    std::vector<bool> is_child(document_.count("nodes"), false);
    for (std::size_t i = 0; i < is_child.size(); ++i)
      for (const std::size_t child : document_.element("nodes", i).indices("children"))
        if (child < is_child.size()) is_child[child] = true;
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) roots.push_back(i);
    return roots;
  }

  static Eigen::Matrix4d T_parent_node(const GltfObject& node) {
    const std::vector<double> matrix = node.numbers("matrix", node.has("matrix") ? 16 : 0);
    if (!matrix.empty()) return Eigen::Map<const Eigen::Matrix4d>(matrix.data());
    const auto numbers = [&](const char* key, std::vector<double> fallback) {
      return node.has(key) ? node.numbers(key, fallback.size()) : fallback;
    };
    const std::vector<double> t = numbers("translation", {0, 0, 0}), r = numbers("rotation", {0, 0, 0, 1}),
                              s = numbers("scale", {1, 1, 1});
    return transform_of({t[0], t[1], t[2]}, {r[3], r[0], r[1], r[2]}, {s[0], s[1], s[2]});
  }

  static Eigen::Matrix4d transform_of(const Eigen::Vector3d& translation, Eigen::Quaterniond rotation,
                                      const Eigen::Vector3d& scale) {
    if (!(rotation.norm() > 1e-12)) rotation = Eigen::Quaterniond::Identity();
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = rotation.normalized().toRotationMatrix() * scale.asDiagonal();
    T.topRightCorner<3, 1>() = translation;
    return T;
  }

  /// Adds a node and all below it, in the order of the file.
  void add_tree(std::size_t root) {
    struct Waiting {
      std::size_t node;
      Eigen::Matrix4d T_scene_parent;
    };
    std::vector<Waiting> waiting{{root, Eigen::Matrix4d::Identity()}};
    while (!waiting.empty()) {
      const Waiting next = waiting.back();
      waiting.pop_back();
      const GltfObject node = document_.element("nodes", next.node);
      if (visited_[next.node])
        document_.fail("its node " + std::to_string(next.node) +
                       " is reached twice: nodes must form a tree; is it damaged?");
      visited_[next.node] = true;
      if (const auto visibility = node.extension("KHR_node_visibility");
          visibility && !visibility->truth("visible", true))
        continue;
      const Eigen::Matrix4d T_scene_node = next.T_scene_parent * T_parent_node(node);
      add_node(node, T_scene_node);
      const std::vector<std::size_t> children = node.indices("children");
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        waiting.push_back({*child, T_scene_node});
    }
  }

  void add_node(const GltfObject& node, const Eigen::Matrix4d& T_scene_node) {
    const std::optional<std::size_t> mesh = node.index("mesh");
    if (!mesh) return;
    std::vector<std::shared_ptr<const Primitive>> own;
    const bool has_weights = node.has("weights");
    if (has_weights) own = primitives_of(*mesh, node.numbers("weights"));
    const auto& primitives = has_weights ? own : shared_primitives_of(*mesh);
    const std::optional<std::size_t> skin = node.index("skin");
    const Joints* const joints = skin ? &joints_of(*skin) : nullptr;
    for (const Eigen::Matrix4d& T_node_instance : instances_of(node))
      for (const auto& primitive : primitives) add(*primitive, T_scene_node * T_node_instance, joints);
  }

  /// Returns the transforms of a node's instances; the identity if it has no list of them. Source:
  /// EXT_mesh_gpu_instancing.
  std::vector<Eigen::Matrix4d> instances_of(const GltfObject& node) {
    const std::optional<GltfObject> instancing = node.extension("EXT_mesh_gpu_instancing");
    if (!instancing) return {Eigen::Matrix4d::Identity()};
    const std::optional<GltfObject> attributes = instancing->object("attributes");
    if (!attributes) instancing->fail("has no attributes");
    const auto read = [&](const char* name, std::size_t width) {
      const std::optional<std::size_t> accessor = attributes->index(name);
      Numbers numbers = accessor ? numbers_of(*accessor) : nullptr;
      if (numbers && numbers->width != width) attributes->fail("has the wrong type of " + std::string(name));
      return numbers;
    };
    const Numbers translation = read("TRANSLATION", 3), rotation = read("ROTATION", 4),
                  scale = read("SCALE", 3);
    std::optional<std::size_t> count;
    for (const Numbers& numbers : {translation, rotation, scale}) {
      if (!numbers) continue;
      if (count && *count != numbers->size()) attributes->fail("have different numbers of elements");
      count = numbers->size();
    }
    if (count.value_or(0) > kMaxMeshTriangles)
      document_.fail("has a mesh with " + std::to_string(*count) + " instances, more than " +
                     std::to_string(kMaxMeshTriangles) + "; simplify it first");
    std::vector<Eigen::Matrix4d> transforms;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
      const auto vector = [&](const Numbers& numbers, double fallback) -> Eigen::Vector3d {
        if (!numbers) return Eigen::Vector3d::Constant(fallback);
        return Eigen::Map<const Eigen::Vector3f>(numbers->at(i)).cast<double>();
      };
      const float* const r = rotation ? rotation->at(i) : nullptr;
      const Eigen::Quaterniond turn =
          r == nullptr ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(r[3], r[0], r[1], r[2]);
      transforms.push_back(transform_of(vector(translation, 0.0), turn, vector(scale, 1.0)));
    }
    return transforms;
  }

  /// Returns the transform of each node to the scene.
  const std::vector<Eigen::Matrix4d>& T_scene_nodes() {
    if (T_scene_nodes_) return *T_scene_nodes_;
    const std::size_t count = document_.count("nodes");
    std::vector<std::size_t> parents(count, count);
    for (std::size_t i = 0; i < count; ++i)
      for (const std::size_t child : document_.element("nodes", i).indices("children")) {
        if (child >= count) document_.element("nodes", i).fail("names a child that is not there");
        parents[child] = i;
      }
    std::vector<Eigen::Matrix4d> T(count);
    std::vector<char> is_known(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::size_t> chain;  // from the node to the first known one above it
      for (std::size_t at = i; at < count && is_known[at] == 0; at = parents[at]) {
        if (chain.size() > count) document_.fail("its nodes form a circle; is it damaged?");
        chain.push_back(at);
      }
      for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
        const Eigen::Matrix4d own = T_parent_node(document_.element("nodes", *at));
        T[*at] = parents[*at] < count ? Eigen::Matrix4d(T[parents[*at]] * own) : own;
        is_known[*at] = 1;
      }
    }
    return T_scene_nodes_.emplace(std::move(T));
  }

  const Joints& joints_of(std::size_t skin) {
    const auto known = skins_.find(skin);
    if (known != skins_.end()) return known->second;
    const GltfObject of = document_.element("skins", skin);
    const std::vector<std::size_t> nodes = of.indices("joints");
    const std::optional<std::size_t> inverse = of.index("inverseBindMatrices");
    const Numbers bind = inverse ? numbers_of(*inverse) : nullptr;
    if (bind && (bind->width != 16 || bind->size() < nodes.size()))
      of.fail("has fewer inverseBindMatrices than joints");
    Joints joints;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] >= T_scene_nodes().size()) of.fail("names a joint that is not there");
      const Eigen::Matrix4d T_scene_joint = T_scene_nodes()[nodes[i]];
      joints.push_back(bind ? Eigen::Matrix4d(T_scene_joint *
                                              Eigen::Map<const Eigen::Matrix4f>(bind->at(i)).cast<double>())
                            : T_scene_joint);
    }
    return skins_[skin] = std::move(joints);
  }

  // Primitives.

  Numbers numbers_of(std::size_t accessor) {
    const auto known = numbers_.find(accessor);
    if (known != numbers_.end()) return known->second;
    return numbers_[accessor] = std::make_shared<const GltfNumbers>(gltf_numbers(document_, accessor));
  }

  const std::vector<std::shared_ptr<const Primitive>>& shared_primitives_of(std::size_t mesh) {
    const auto known = meshes_.find(mesh);
    if (known != meshes_.end()) return known->second;
    return meshes_[mesh] = primitives_of(mesh, document_.element("meshes", mesh).numbers("weights"));
  }

  std::vector<std::shared_ptr<const Primitive>> primitives_of(std::size_t mesh,
                                                              const std::vector<double>& weights) {
    constexpr std::uint64_t kFirstTriangles = 4, kLast = 6;
    std::vector<std::shared_ptr<const Primitive>> primitives;
    const GltfObject of = document_.element("meshes", mesh);
    for (std::size_t i = 0; i < of.size_of("primitives"); ++i) {
      const GltfObject primitive = of.element("primitives", i);
      const std::uint64_t mode = primitive.whole("mode", kFirstTriangles);
      if (mode > kLast) primitive.fail("has the unknown mode " + std::to_string(mode));
      const std::optional<GltfObject> attributes = primitive.object("attributes");
      if (!attributes) primitive.fail("has no attributes");
      if (mode < kFirstTriangles)
        not_drawn_.add(mode == 0 ? "set of points" : "set of lines", "not drawn: only triangles are");
      else if (!attributes->has("POSITION"))
        not_drawn_.add("primitive without positions", "not drawn");
      else if (!use_of_(primitive.index("material")).is_visible)
        not_drawn_.add("primitive of a transparent material", "invisible and left out");
      else
        primitives.push_back(
            std::make_shared<const Primitive>(primitive_of(primitive, *attributes, mode, weights)));
    }
    return primitives;
  }

  Primitive primitive_of(const GltfObject& of, const GltfObject& attributes, std::uint64_t mode,
                         const std::vector<double>& weights) {
    const std::optional<std::size_t> material = of.index("material");
    std::vector<std::string> names{"POSITION", "NORMAL", "COLOR_0"};
    const std::optional<std::size_t> set = use_of_(material).texture_set;
    const std::string points = set ? "TEXCOORD_" + std::to_string(*set) : std::string();
    if (set) names.push_back(points);
    std::size_t influences = 0;
    for (; attributes.has(("JOINTS_" + std::to_string(influences)).c_str()) &&
           attributes.has(("WEIGHTS_" + std::to_string(influences)).c_str());
         ++influences) {
      names.push_back("JOINTS_" + std::to_string(influences));
      names.push_back("WEIGHTS_" + std::to_string(influences));
    }
    Attributes read;
    std::optional<std::vector<std::uint32_t>> corners;
    const std::optional<GltfObject> draco = of.extension("KHR_draco_mesh_compression");
    if (draco) {
      corners = read_draco(*draco, attributes, names, read);
      mode = 4;  // a strip is decompressed to a list
    }
    for (const std::string& name : names) {
      const std::optional<std::size_t> accessor = attributes.index(name.c_str());
      if (accessor && read.find(name) == nullptr) read.named[name] = numbers_of(*accessor);
    }
    require_fitting(of, read, points);
    if (!corners) {
      const std::optional<std::size_t> indices = of.index("indices");
      if (indices) corners = gltf_wholes(document_, *indices, 1);
    }
    morph(of, weights, read);
    const PrimitiveForm form{
        .material = material, .texture_points = points, .influences = influences, .mode = mode};
    return joined(of, form, read, corners);
  }

  /// Reads the attributes that are compressed, and returns the corners of the triangles.
  std::vector<std::uint32_t> read_draco(const GltfObject& draco, const GltfObject& attributes,
                                        const std::vector<std::string>& names, Attributes& read) {
    DracoMesh mesh;
    try {
      mesh = draco_mesh(document_.view(draco.whole("bufferView")));
    } catch (const Error& fault) {
      if (std::string_view(fault.what()).starts_with(document_.path().string())) throw;
      document_.fail("its Draco mesh " + std::string(fault.what()));
    }
    const std::optional<GltfObject> ids = draco.object("attributes");
    if (!ids) draco.fail("has no attributes");
    for (const std::string& name : names) {
      const std::optional<std::size_t> id = ids->index(name.c_str());
      const std::optional<std::size_t> accessor = attributes.index(name.c_str());
      if (!id || !accessor) continue;
      const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                                      [&](const DracoAttribute& attribute) { return attribute.id == *id; });
      if (found == mesh.attributes.end()) ids->fail("names an attribute that is not there");
      const GltfLayout layout = gltf_layout(document_, *accessor);
      auto numbers = std::make_shared<GltfNumbers>();
      numbers->width = found->width;
      document_.require_memory(found->values.size() * sizeof(float));
      for (const double value : found->values) {
        const auto number = static_cast<float>(value);
        const bool is_fraction = layout.is_normalised && !found->is_float;
        numbers->values.push_back(is_fraction ? normalised_value(number, layout.component) : number);
      }
      read.named[name] = std::move(numbers);
    }
    return std::move(mesh.corners);
  }

  static void require_fitting(const GltfObject& of, const Attributes& read, const std::string& points) {
    const GltfNumbers* const positions = read.find("POSITION");
    for (const auto& [name, numbers] : read.named) {
      if (numbers->size() != positions->size())
        of.fail("has " + std::to_string(positions->size()) + " positions, but " +
                std::to_string(numbers->size()) + " elements of " + name);
      const std::size_t width = numbers->width;
      const bool fits = name == points                           ? width == 2
                        : name == "COLOR_0"                      ? width == 3 || width == 4
                        : name == "POSITION" || name == "NORMAL" ? width == 3
                                                                 : width == 4;
      if (!fits) of.fail("has " + std::to_string(width) + " numbers per element of " + name);
    }
  }

  /// Adds the weighted differences of the morph targets to the attributes.
  void morph(const GltfObject& of, const std::vector<double>& weights, Attributes& read) {
    const std::size_t targets = of.size_of("targets");
    std::map<std::string, std::shared_ptr<GltfNumbers>> morphed;
    for (std::size_t t = 0; t < std::min(targets, weights.size()); ++t) {
      const auto weight = static_cast<float>(weights[t]);
      if (weight == 0.0F) continue;
      const GltfObject target = of.element("targets", t);
      for (auto& [name, numbers] : read.named) {
        const std::optional<std::size_t> accessor = target.index(name.c_str());
        if (!accessor) continue;
        const Numbers differences = numbers_of(*accessor);
        if (differences->size() != numbers->size() || differences->width > numbers->width)
          target.fail("has another number of elements than its primitive");
        std::shared_ptr<GltfNumbers>& sum = morphed[name];
        if (!sum) {
          document_.require_memory(numbers->values.size() * sizeof(float));
          sum = std::make_shared<GltfNumbers>(*numbers);
        }
        for (std::size_t i = 0; i < differences->size(); ++i)
          for (std::size_t k = 0; k < differences->width; ++k)
            sum->values[i * sum->width + k] += weight * differences->at(i)[k];
      }
    }
    for (auto& [name, numbers] : morphed) read.named[name] = std::move(numbers);
  }

  /// What a primitive consists of.
  struct PrimitiveForm {
    std::optional<std::size_t> material{};
    std::string texture_points{};  ///< name of the attribute; empty: none
    std::size_t influences = 0;    ///< number of pairs of JOINTS_ and WEIGHTS_ attributes
    std::uint64_t mode = 4;        ///< list, strip or fan of triangles
  };

  /// Makes the triangles of a primitive, and merges equal vertices.
  Primitive joined(const GltfObject& of, const PrimitiveForm& form, const Attributes& read,
                   std::optional<std::vector<std::uint32_t>>& corners) {
    const std::size_t influences = form.influences;
    const GltfNumbers& positions = *read.find("POSITION");
    if (!corners) {
      corners.emplace(positions.size());
      for (std::size_t i = 0; i < corners->size(); ++i) (*corners)[i] = static_cast<std::uint32_t>(i);
    }
    std::vector<std::uint32_t> vertex_of(positions.size(), 0);
    for (const std::uint32_t corner : *corners) {
      if (corner >= positions.size()) of.fail("has a triangle that names a vertex that is not there");
      vertex_of[corner] = 1;
    }
    const GltfNumbers* const normals = read.find("NORMAL");
    const GltfNumbers* const points = form.texture_points.empty() ? nullptr : read.find(form.texture_points);
    const GltfNumbers* const colours = read.find("COLOR_0");
    std::vector<std::pair<const GltfNumbers*, const GltfNumbers*>> joints_weights;
    for (std::size_t i = 0; i < influences; ++i)
      joints_weights.emplace_back(read.find("JOINTS_" + std::to_string(i)),
                                  read.find("WEIGHTS_" + std::to_string(i)));
    constexpr std::size_t kFixed = 3 + 3 + 2 + 4;
    VertexRows rows(kFixed + 8 * influences);
    for (std::size_t v = 0; v < positions.size(); ++v) {
      if (vertex_of[v] == 0) continue;
      std::vector<float>& row = rows.next();
      std::copy_n(positions.at(v), 3, row.begin());
      if (normals != nullptr) std::copy_n(normals->at(v), 3, row.begin() + 3);
      if (points != nullptr && std::isfinite(points->at(v)[0]) && std::isfinite(points->at(v)[1]))
        std::copy_n(points->at(v), 2, row.begin() + 6);
      row[11] = 1.0F;
      if (colours != nullptr) std::copy_n(colours->at(v), colours->width, row.begin() + 8);
      for (std::size_t i = 0; i < influences; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
          row[kFixed + 8 * i + 2 * k] = joints_weights[i].first->at(v)[k];
          row[kFixed + 8 * i + 2 * k + 1] = joints_weights[i].second->at(v)[k];
        }
      vertex_of[v] = rows.add();
    }
    Primitive primitive{form.material, {}};
    for (std::size_t v = 0; v < rows.size(); ++v) {
      const float* const row = rows.at(v);
      primitive.positions.emplace_back(row[0], row[1], row[2]);
      if (normals != nullptr) primitive.normals.emplace_back(row[3], row[4], row[5]);
      if (points != nullptr) primitive.texture_points.emplace_back(row[6], row[7]);
      if (colours != nullptr) primitive.colours.emplace_back(row[8], row[9], row[10], row[11]);
      primitive.influences.insert(primitive.influences.end(), row + kFixed, row + kFixed + 8 * influences);
    }
    primitive.influence_count = 4 * influences;
    for (std::uint32_t& corner : *corners) corner = vertex_of[corner];
    primitive.triangles = triangles_of(form.mode, *corners);
    return primitive;
  }

  // The scene's mesh.

  void add(const Primitive& primitive, const Eigen::Matrix4d& T_scene_mesh, const Joints* joints) {
    Mesh& mesh = scene_.mesh;
    considered_triangles_ += primitive.triangles.size();
    if (mesh.triangles.size() + primitive.triangles.size() > kMaxMeshTriangles ||
        considered_triangles_ > kMaxConsideredTriangles)
      fail_for_size(document_.path(),
                    std::max(considered_triangles_, mesh.triangles.size() + primitive.triangles.size()));
    if (mesh.vertices.size() + primitive.positions.size() > kMaxVertices)
      document_.fail("has more than " + std::to_string(kMaxVertices) + " vertices; simplify it first");
    GltfPart part{primitive.material, static_cast<std::uint32_t>(mesh.vertices.size()),
                  static_cast<std::uint32_t>(primitive.positions.size()),
                  static_cast<std::uint32_t>(mesh.triangles.size())};
    part.has_normals = !primitive.normals.empty();
    part.has_colours = !primitive.colours.empty();
    part.has_texture_points = !primitive.texture_points.empty();
    const bool is_skinned = joints != nullptr && primitive.influence_count > 0;
    Eigen::Matrix3d of_normals = normal_matrix(T_scene_mesh);
    bool is_mirrored = T_scene_mesh.topLeftCorner<3, 3>().determinant() < 0.0;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const Eigen::Matrix4d T = is_skinned ? blended(primitive, v, *joints, T_scene_mesh) : T_scene_mesh;
      if (is_skinned) of_normals = normal_matrix(T);
      if (is_skinned && v == 0) is_mirrored = T.topLeftCorner<3, 3>().determinant() < 0.0;
      const Eigen::Vector3f p =
          (T.topLeftCorner<3, 3>() * primitive.positions[v].cast<double>() + T.topRightCorner<3, 1>())
              .cast<float>();
      if (!p.allFinite())
        document_.fail("vertex " + std::to_string(mesh.vertices.size()) + " is not finite; repair the mesh");
      mesh.vertices.push_back(p);
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      if (part.has_normals)
        normal = (of_normals * primitive.normals[v].cast<double>()).normalized().cast<float>();
      mesh.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f(Eigen::Vector3f::Zero()));
      scene_.colours.push_back(part.has_colours ? primitive.colours[v]
                                                : Eigen::Vector4f(Eigen::Vector4f::Ones()));
      scene_.texture_points.push_back(part.has_texture_points ? primitive.texture_points[v]
                                                              : Eigen::Vector2f(Eigen::Vector2f::Zero()));
    }
    for (const Triangle& of : primitive.triangles) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) triangle[k] = part.first_vertex + of[is_mirrored ? 2 - k : k];
      if (triangle_area_m2(mesh, triangle) > 0.0) mesh.triangles.push_back(triangle);
    }
    part.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()) - part.first_triangle;
    scene_.parts.push_back(part);
  }

  static Eigen::Matrix3d normal_matrix(const Eigen::Matrix4d& T) {
    const Eigen::Matrix3d linear = T.topLeftCorner<3, 3>();
    return linear.inverse().transpose();
  }

  /// Returns the transform of a skinned vertex: the mean of its joints' transforms, by their weights.
  Eigen::Matrix4d blended(const Primitive& primitive, std::size_t vertex, const Joints& joints,
                          const Eigen::Matrix4d& T_scene_mesh) const {
    Eigen::Matrix4d T = Eigen::Matrix4d::Zero();
    double sum = 0.0;
    const float* const pairs = primitive.influences.data() + 2 * primitive.influence_count * vertex;
    for (std::size_t i = 0; i < primitive.influence_count; ++i) {
      const double weight = pairs[2 * i + 1];
      if (!(weight > 0.0)) continue;
      if (!(pairs[2 * i] >= 0.0F && pairs[2 * i] < static_cast<float>(joints.size())))
        document_.fail("a vertex of a skin names a joint that is not there; is it damaged?");
      T += weight * joints[static_cast<std::size_t>(pairs[2 * i])];
      sum += weight;
    }
    return sum > 0.0 ? Eigen::Matrix4d(T / sum) : T_scene_mesh;
  }
};

}  // namespace

void NotDrawn::add(const std::string& noun, const std::string& fate, std::size_t count) {
  if (count == 0) return;
  for (auto& [kind, counted] : kinds_)
    if (kind.first == noun && kind.second == fate) {
      counted += count;
      return;
    }
  kinds_.push_back({{noun, fate}, count});
}

std::vector<std::string> NotDrawn::sentences() const {
  std::vector<std::string> sentences;
  for (const auto& [kind, count] : kinds_) {
    // The first word takes the plural: "sets of points".
    const auto& [noun, fate] = kind;
    const std::size_t of = std::min({noun.find(" of "), noun.find(" without "), noun.size()});
    const std::string plural = noun.substr(0, of) + "s" + noun.substr(of);
    sentences.push_back(std::to_string(count) + " " + (count == 1 ? noun + " is " : plural + " are ") + fate);
  }
  return sentences;
}

GltfScene gltf_scene(GltfDocument& document, const GltfUseOf& use_of, NotDrawn& not_drawn) {
  return GltfCollector(document, use_of, not_drawn).collect();
}

}  // namespace roomradar
