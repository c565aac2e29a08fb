#include "limber/document/fbx/import_fbx.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/fbx/import_fbx_animation.h"
#include "limber/document/fbx/import_fbx_material.h"
#include "limber/document/fbx/import_fbx_mesh.h"
#include "limber/document/fbx/import_fbx_models.h"
#include "limber/document/fbx/import_fbx_skin.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/skin_roots.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

// What a file's own lengths and directions are in metres and +Y up.
struct FbxConvention {
  double scale = 0.01;  // centimetres
  Affine axes = Affine::Identity();
};

// The settings name the axes that point right, up and out of the screen.
FbxConvention conventionOf(const FbxFile& file) {
  const FbxNode* settings = file.root.find("GlobalSettings");
  const FbxProperties properties(settings ? settings->find("Properties70") : nullptr, nullptr);
  FbxConvention result;
  const double unit = properties.number("UnitScaleFactor", 1);  // in centimetres
  if (unit > 0) result.scale = 0.01 * unit;
  Mat3 axes = Mat3::Zero();
  const char* kNames[] = {"CoordAxis", "UpAxis", "FrontAxis"};
  for (int row = 0; row < 3; ++row) {
    const std::int64_t axis = properties.integer(kNames[row], row);
    const std::int64_t sign = properties.integer(std::string(kNames[row]) + "Sign", 1);
    if (axis >= 0 && axis < 3) axes(row, static_cast<int>(axis)) = sign < 0 ? -1 : 1;
  }
  if (std::abs(axes.determinant()) == 1) result.axes.linear() = axes;
  return result;
}

class FbxConverter {
 public:
  FbxConverter(const FbxFile& file, std::size_t fileSize, const Resolver& resolver)
      : convention_(conventionOf(file)),
        budget_(fileSize),
        objects_(file),
        models_(objects_),
        animations_(objects_, models_, asset_.warnings),
        materials_(asset_, objects_, resolver),
        nodeOf_(models_.count()) {}

  Asset convert() {
    document_.about.generator = "limber";
    models_.findCompensated(animations_.scales());
    planMeshes();
    addNodes();
    for (MeshPart& part : parts_) addPart(part);
    if (!roots_.empty()) {
      document_.scene = 0;
      document_.scenes.emplace_back().nodes = roots_;
      joinSkinRoots(document_, names_);
    }
    animations_.addClips(asset_, nodeOf_, shapesInUse_, convention_.scale);
    warnOfConversion();
    warnOfOthers();
    return std::move(asset_);
  }

 private:
  // A mesh on a model.
  struct MeshPart {
    Index model = 0, geometry = 0;
    std::optional<FbxSkin> skin;
    FbxShapes shapes;
  };

  void planMeshes() {
    for (Index m = 0; m < models_.count(); ++m) {
      for (const Index geometry : objects_.sources(models_[m].object, "Geometry")) {
        if (!objects_.is(geometry, "Geometry", "Mesh")) continue;
        MeshPart part{m, geometry, {}, {}};
        if (!objects_.sources(geometry, "Deformer").empty()) {
          part.skin = readFbxSkin(objects_, models_, geometry, m, budget_, asset_.warnings);
          part.shapes = readFbxShapes(objects_, geometry, budget_, asset_.warnings);
        }
        if (part.skin) joints_.insert(part.skin->joints.begin(), part.skin->joints.end());
        hasMesh_.insert(m);
        if (!part.skin) hasRigidMesh_.insert(m);
        parts_.push_back(std::move(part));
      }
    }
  }

  // A leaf that serves no purpose once its skinned mesh is a node of its own.
  bool isSuperfluous(Index model) const {
    return hasMesh_.count(model) > 0 && hasRigidMesh_.count(model) == 0 && joints_.count(model) == 0 &&
           models_.childrenOf(model).empty();
  }

  void addNodes() {
    std::optional<Index> top;
    if (!convention_.axes.isApprox(Affine::Identity(), 0) && models_.count() > 0) {
      gltf::Node node;
      node.name = names_.add("Y_up");
      setNodeTransform(node, convention_.axes, false);
      top = addElement(document_.nodes, std::move(node));
      roots_.push_back(*top);
    }
    for (Index m = 0; m < models_.count(); ++m) {
      if (isSuperfluous(m)) continue;
      gltf::Node node;
      const std::string& name = objects_[models_[m].object].name;
      if (!name.empty()) node.name = names_.add(name);
      setLocal(node, m);
      const Index index = addElement(document_.nodes, std::move(node));
      nodeOf_[m] = index;
      const std::optional<Index> parent = models_[m].parent ? nodeOf_[*models_[m].parent] : top;
      (parent ? document_.nodes[*parent].children : roots_).push_back(index);
    }
  }

  void setLocal(gltf::Node& node, Index model) {
    if (!models_[model].isCompensated) return setOwnLocal(node, models_[model].transform);
    Affine local = models_.restLocal(model);
    local.translation() *= convention_.scale;
    const std::vector<Index> chain = models_.chainOf(model);  // all of it moves a compensated model
    const bool mayHaveMatrix = joints_.count(model) == 0 && std::none_of(chain.begin(), chain.end(), [&](Index of) {
                                 return animations_.moves()[of];
                               });
    bool isSheared = false;
    decompose(local, &isSheared);
    if (isSheared && !mayHaveMatrix) {
      asset_.warnings.add("scale-inheritance", "shear that glTF cannot animate is left out",
                          objects_[models_[model].object].name);
    }
    setNodeTransform(node, local, mayHaveMatrix);
  }

  // As the tracks of it are: a matrix would not tell a rotation from a scale of 0.
  void setOwnLocal(gltf::Node& node, const FbxTransform& transform) const {
    const Transform local = transform.localMirroredOnX(transform.rest);
    const Vec3 translation = convention_.scale * local.translation;
    if (translation != Vec3::Zero()) node.translation = translation.unaryExpr(&shortDouble);
    if (local.rotation.coeffs() != Quat::Identity().coeffs()) {
      node.rotation = local.rotation.coeffs().unaryExpr(&shortDouble);
    }
    if (local.scale != Vec3::Ones()) node.scale = local.scale.unaryExpr(&shortDouble);
  }

  void addPart(MeshPart& part) {
    const std::string& name = objects_[models_[part.model].object].name;
    FbxMeshPlan plan;
    plan.shapes = part.shapes.targets;
    const Affine toMetres = Affine(Eigen::Scaling(convention_.scale));
    plan.placement = toMetres * models_[part.model].transform.geometric;
    if (part.skin) {
      plan.placement = convention_.axes * toMetres * part.skin->toBound * models_[part.model].transform.geometric;
      plan.weights = std::move(part.skin->weights);
      plan.jointCount = static_cast<Index>(part.skin->joints.size());
    }
    const std::optional<Index> mesh =
        part.skin || !part.shapes.targets.empty() ? addMesh(part, plan, name) : sharedMesh(part, plan, name);
    if (!mesh) return;
    const Index node =
        part.skin ? addSkinnedNode(*part.skin, *mesh, name, part.model) : rigidNode(*nodeOf_[part.model], *mesh, name);
    if (!part.shapes.channels.empty()) shapesInUse_.push_back({node, &part.shapes});
  }

  // One mesh for all models that show the same geometry alike.
  std::optional<Index> sharedMesh(const MeshPart& part, const FbxMeshPlan& plan, const std::string& name) {
    const Mat4 placement = plan.placement.matrix();
    const std::pair key(std::vector<double>(placement.data(), placement.data() + 16),
                        std::pair(part.geometry, objects_.sources(models_[part.model].object, "Material")));
    const auto known = sharedMeshes_.find(key);
    if (known != sharedMeshes_.end()) return known->second;
    return sharedMeshes_[key] = addMesh(part, plan, name);
  }

  std::optional<Index> addMesh(const MeshPart& part, const FbxMeshPlan& plan, const std::string& name) {
    FbxMesh made = importFbxMesh(asset_, *objects_[part.geometry].node, name, plan, budget_);
    const std::vector<Index> materials = objects_.sources(models_[part.model].object, "Material");
    gltf::Mesh mesh;
    mesh.name = objects_[part.geometry].name.empty() ? name : objects_[part.geometry].name;
    for (FbxPrimitive& one : made.primitives) {
      one.primitive.material = one.material < materials.size()
                                   ? materials_.material(materials[one.material], made.textureSets)
                                   : materials_.defaultMaterial();
      mesh.primitives.push_back(std::move(one.primitive));
    }
    if (mesh.primitives.empty()) return std::nullopt;
    setShapes(mesh, part.shapes);
    return addElement(document_.meshes, std::move(mesh));
  }

  static void setShapes(gltf::Mesh& mesh, const FbxShapes& shapes) {
    if (shapes.targets.empty()) return;
    Json names = Json::array();
    for (const FbxShapeTarget& target : shapes.targets) names.push_back(target.name);
    mesh.extras = gltf::KeptJson(Json{{"targetNames", std::move(names)}});
    mesh.weights.assign(shapes.targets.size(), 0);
    for (const FbxShapeChannel& channel : shapes.channels) channel.addWeights(channel.percent, mesh.weights);
  }

  // The model's own node, or one below it for a second mesh.
  Index rigidNode(Index node, Index mesh, const std::string& name) {
    if (!document_.nodes[node].mesh) {
      document_.nodes[node].mesh = mesh;
      return node;
    }
    gltf::Node below;
    below.name = names_.add(name);
    below.mesh = mesh;
    const Index index = addElement(document_.nodes, std::move(below));
    document_.nodes[node].children.push_back(index);
    return index;
  }

  Index addSkinnedNode(const FbxSkin& skin, Index mesh, const std::string& name, Index model) {
    std::vector<float> inverseBinds;
    gltf::Skin bound;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      Affine inverseBind = skin.inverseBinds[j];
      inverseBind.translation() *= convention_.scale;
      appendMatrix(inverseBind * convention_.axes.inverse(), inverseBinds);
      bound.joints.push_back(nodeOf_[skin.joints[j]].value());
    }
    bound.inverseBindMatrices = addFloatAccessor(asset_, inverseBinds, 16);
    gltf::Node node;
    if (!name.empty()) node.name = names_.add(nodeOf_[model] ? name + "_skinned" : name);
    node.mesh = mesh;
    node.skin = addElement(document_.skins, std::move(bound));
    const Index index = addElement(document_.nodes, std::move(node));
    roots_.push_back(index);
    return index;
  }

  void warnOfConversion() {
    if (std::abs(convention_.scale - 1) > 1e-6) {
      asset_.warnings.add("converted-units",
                          fmt::format("lengths are converted to metres (1 unit was {:g} m)", convention_.scale));
    }
    if (!convention_.axes.isApprox(Affine::Identity(), 0)) {
      asset_.warnings.add("converted-axes", "directions are converted to Y up");
    }
  }

  void warnOfOthers() {
    for (Index o = 0; o < objects_.count(); ++o) {
      const FbxObject& object = objects_[o];
      const bool isAttribute = objects_.is(o, "NodeAttribute");
      if (isAttribute && object.kind == "Light") asset_.warnings.add("lights", "lights are left out", object.name);
      if (isAttribute && object.kind == "Camera") asset_.warnings.add("cameras", "cameras are left out", object.name);
      if (objects_.is(o, "Constraint")) {
        asset_.warnings.add("constraints", "constraints are left out", object.name);
      }
      if (objects_.is(o, "Geometry") && object.kind != "Mesh" && object.kind != "Shape") {
        asset_.warnings.add("other-geometry", "geometry that is not made of polygons is left out", object.name);
      }
      if (objects_.is(o, "Deformer", "VertexCacheDeformer")) {
        asset_.warnings.add("vertex-caches", "cached motions of vertices are left out", object.name);
      }
    }
  }

  FbxConvention convention_;
  FbxBudget budget_;
  Asset asset_;
  gltf::Document& document_ = asset_.document;
  FbxObjects objects_;
  FbxModels models_;
  FbxAnimations animations_;
  FbxMaterials materials_;
  UniqueNames names_;
  std::vector<MeshPart> parts_;
  std::set<Index> joints_, hasMesh_, hasRigidMesh_;  // models
  std::vector<std::optional<Index>> nodeOf_;         // #models
  std::map<std::pair<std::vector<double>, std::pair<Index, std::vector<Index>>>, std::optional<Index>> sharedMeshes_;
  std::vector<FbxShapesInUse> shapesInUse_;
  std::vector<Index> roots_;
};

}  // namespace

Asset importFbx(ByteSpan bytes, const Resolver& resolver) {
  try {
    Asset asset = FbxConverter(parseFbx(bytes), bytes.size(), resolver).convert();
    asset.format = "fbx";
    return asset;
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("cannot be read as FBX: {}", error.message()), error.where(), error.remedy());
  }
}

}  // namespace limber
