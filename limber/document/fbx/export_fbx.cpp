#include "limber/document/fbx/export_fbx.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "limber/core/text/names.h"
#include "limber/document/clip/clip_name.h"
#include "limber/document/fbx/export_fbx_angles.h"
#include "limber/document/fbx/export_fbx_clips.h"
#include "limber/document/fbx/export_fbx_geometry.h"
#include "limber/document/fbx/export_fbx_materials.h"
#include "limber/document/fbx/export_fbx_objects.h"
#include "limber/document/fbx/export_fbx_scene.h"
#include "limber/document/fbx/export_fbx_space.h"
#include "limber/document/fbx/records/fbx_encode.h"

namespace limber {

namespace {

constexpr std::string_view kCreator = "limber";

std::vector<Index> chosenFbxClips(const Asset& asset, const FbxOptions& options) {
  std::vector<std::string> names;
  for (const gltf::Animation& animation : asset.document.animations) names.push_back(animation.name);
  std::vector<Index> chosen;
  for (Index c = 0; !options.clips && c < names.size(); ++c) chosen.push_back(c);
  for (const std::string& name : options.clips.value_or(std::vector<std::string>())) {
    const Index clip = clipNamed(names, name, asset.name);
    if (std::find(chosen.begin(), chosen.end(), clip) == chosen.end()) chosen.push_back(clip);
  }
  return chosen;
}

class FbxWriter {
 public:
  FbxWriter(const Asset& asset, const FbxOptions& options)
      : asset_(asset),
        options_(options),
        clips_(chosenFbxClips(asset, options)),
        scene_(readFbxScene(asset)),
        space_(options.unit == FbxUnit::kCentimetre ? 100 : 1, options.up == FbxUpAxis::kZ) {
    result_.warnings = std::move(scene_.warnings);
  }

  FbxExport write() {
    for (const FbxModelPlan& model : scene_.models) models_.push_back(writeModel(model));
    writeGeometries();
    writeBindPose();
    stacks_ = writeFbxClips(asset_, clips_, {scene_, models_, geometries_}, space_, objects_, result_.warnings);
    std::vector<FbxNode> records = {header(),
                                    {"FileId", {Bytes(fbxFileId().begin(), fbxFileId().end())}, {}},
                                    {"CreationTime", {std::string(kFbxCreationTime)}, {}},
                                    {"Creator", {std::string(kCreator)}, {}},
                                    globalSettings(),
                                    documents(),
                                    {"References", {}, {}},
                                    definitions()};
    records.push_back(objects_.takeObjects());
    records.push_back(objects_.takeConnections());
    records.push_back(takes());
    result_.bytes = encodeFbxFile(records);
    return std::move(result_);
  }

 private:
  // A node, and the attribute that says what kind of node it is.
  FbxId writeModel(const FbxModelPlan& model) {
    const bool isMesh = model.kind == FbxModelKind::kMesh, isLimb = model.kind == FbxModelKind::kLimb;
    const char* const kind = isMesh ? "Mesh" : isLimb ? "LimbNode" : "Null";
    const Transform local = space_.local(model.local, !model.parent);
    FbxObjectWriter::Made made = objects_.make("Model", model.name, "Model", kind);
    const FbxId id = made.id;
    addRecord(made.record, "Version", {std::int32_t{232}});
    {
      FbxPropertyWriter properties(made.record);
      properties.choice("RotationOrder", 0);
      properties.flag("RotationActive", true);
      properties.choice("InheritType", 1);  // matrices are multiplied: glTF's
      properties.animatable("Lcl Translation", local.translation);
      properties.animatable("Lcl Rotation", eulerDegrees(local.rotation));
      properties.animatable("Lcl Scaling", local.scale);
      properties.integer("DefaultAttributeIndex", 0);
    }
    addRecord(made.record, "Shading", {true});
    addRecord(made.record, "Culling", {std::string("CullingOff")});
    objects_.connect(id, model.parent ? models_[*model.parent] : kFbxRoot);
    if (isMesh) return id;
    FbxObjectWriter::Made attribute = objects_.make("NodeAttribute", model.name, "NodeAttribute", kind);
    addRecord(attribute.record, "TypeFlags", {std::string(isLimb ? "Skeleton" : "Null")});
    objects_.connect(attribute.id, id);
    return id;
  }

  // Meshes that a skin or blend shapes move are written once for each model, others once for all.
  void writeGeometries() {
    geometries_.resize(scene_.models.size());
    std::map<Index, const FbxGeometry*> shared;  // by the document's mesh
    for (std::size_t m = 0; m < scene_.models.size(); ++m) {
      const FbxModelPlan& model = scene_.models[m];
      if (model.kind != FbxModelKind::kMesh) continue;
      const FbxGeometry*& known = shared[*model.mesh];
      const FbxGeometry* geometry = model.skin ? nullptr : known;
      if (geometry == nullptr) {
        made_.push_back(writeFbxGeometry(asset_, *model.mesh, *model.meshNode, space_, objects_));
        geometry = &made_.back();
        if (model.skin) {
          writeFbxSkin(asset_, scene_, model, *geometry, models_, space_, objects_);
        } else if (geometry->shapeChannels.empty()) {
          known = geometry;
        }
      }
      geometries_[m] = geometry;
      objects_.connect(geometry->id, models_[m]);
      for (const std::optional<Index> material : geometry->materials) {
        objects_.connect(materials_.material(material), models_[m]);
      }
    }
  }

  // All limbs, skinned meshes, and what is above either: readers warn of what is missing.
  void writeBindPose() {
    std::vector<bool> isPosed(scene_.models.size(), false);
    for (std::size_t m = scene_.models.size(); m-- > 0;) {
      const FbxModelPlan& model = scene_.models[m];
      isPosed[m] = isPosed[m] || model.kind == FbxModelKind::kLimb || model.skin;
      if (isPosed[m] && model.parent) isPosed[*model.parent] = true;
    }
    const auto count = static_cast<std::int32_t>(std::count(isPosed.begin(), isPosed.end(), true));
    if (count == 0) return;
    FbxObjectWriter::Made pose = objects_.make("Pose", "BindPose", "Pose", "BindPose");
    addRecord(pose.record, "Type", {std::string("BindPose")});
    addRecord(pose.record, "Version", {std::int32_t{100}});
    addRecord(pose.record, "NbPoseNodes", {count});
    for (std::size_t m = 0; m < scene_.models.size(); ++m) {
      if (!isPosed[m]) continue;
      FbxNode& node = addRecord(pose.record, "PoseNode");
      addRecord(node, "Node", {models_[m]});
      addRecord(node, "Matrix", {fbxMatrix(space_.world(scene_.models[m].bindWorld))});
    }
  }

  static FbxNode header() {
    FbxNode header{"FBXHeaderExtension", {}, {}};
    addRecord(header, "FBXHeaderVersion", {std::int32_t{1003}});
    addRecord(header, "FBXVersion", {std::int32_t{7400}});
    addRecord(header, "EncryptionType", {std::int32_t{0}});
    FbxNode& stamp = addRecord(header, "CreationTimeStamp");
    addRecord(stamp, "Version", {std::int32_t{1000}});
    for (const auto& [part, value] : std::initializer_list<std::pair<const char*, std::int32_t>>{{"Year", 1970},
                                                                                                 {"Month", 1},
                                                                                                 {"Day", 1},
                                                                                                 {"Hour", 10},
                                                                                                 {"Minute", 0},
                                                                                                 {"Second", 0},
                                                                                                 {"Millisecond", 0}}) {
      addRecord(stamp, part, {value});
    }
    addRecord(header, "Creator", {std::string(kCreator)});
    FbxNode& info = addRecord(header, "SceneInfo", {fbxName("GlobalInfo", "SceneInfo"), std::string("UserData")});
    addRecord(info, "Type", {std::string("UserData")});
    addRecord(info, "Version", {std::int32_t{100}});
    FbxPropertyWriter properties(info);
    for (const char* part : {"Original", "LastSaved"}) {
      properties.add(part, "Compound", "", "");
      properties.text(std::string(part) + "|ApplicationVendor", kCreator);
      properties.text(std::string(part) + "|ApplicationName", kCreator);
    }
    return header;
  }

  FbxNode globalSettings() const {
    FbxNode settings{"GlobalSettings", {}, {}};
    addRecord(settings, "Version", {std::int32_t{1000}});
    FbxPropertyWriter properties(settings);
    const bool zUp = options_.up == FbxUpAxis::kZ;
    const double unit = options_.unit == FbxUnit::kCentimetre ? 1 : 100;  // centimetres
    properties.integer("UpAxis", zUp ? 2 : 1);
    properties.integer("UpAxisSign", 1);
    properties.integer("FrontAxis", zUp ? 1 : 2);
    properties.integer("FrontAxisSign", zUp ? -1 : 1);
    properties.integer("CoordAxis", 0);
    properties.integer("CoordAxisSign", 1);
    properties.integer("OriginalUpAxis", -1);
    properties.integer("OriginalUpAxisSign", 1);
    properties.number("UnitScaleFactor", unit, "");
    properties.number("OriginalUnitScaleFactor", unit, "");
    properties.color("AmbientColor", Vec3::Zero());
    properties.text("DefaultCamera", "Producer Perspective");
    double last = 0;
    for (const FbxStack& stack : stacks_) last = std::max(last, stack.duration);
    const double rate = stacks_.empty() ? 30 : stacks_[0].rate;
    properties.choice("TimeMode", timeMode(rate));
    properties.time("TimeSpanStart", 0);
    properties.time("TimeSpanStop", fbxTime(last > 0 ? last : 1));
    properties.number("CustomFrameRate", timeMode(rate) == kCustomRate ? rate : -1, "");
    return settings;
  }

  static constexpr int kCustomRate = 14;

  // Of the SDK's FbxTime::EMode, those of so many frames a second.
  static int timeMode(double rate) {
    constexpr std::pair<double, int> kModes[] = {{120, 1}, {100, 2}, {60, 3},  {50, 4},
                                                 {48, 5},  {30, 6},  {25, 10}, {24, 11}};
    for (const auto& [framesPerSecond, mode] : kModes) {
      if (std::abs(rate - framesPerSecond) < 1e-2) return mode;
    }
    return kCustomRate;
  }

  FbxNode documents() {
    FbxNode documents{"Documents", {}, {}};
    addRecord(documents, "Count", {std::int32_t{1}});
    FbxNode& document =
        addRecord(documents, "Document", {objects_.newId(), std::string("Scene"), std::string("Scene")});
    {
      FbxPropertyWriter properties(document);
      properties.add("SourceObject", "object", "", "");
      properties.text("ActiveAnimStackName", stacks_.empty() ? "" : stacks_[0].name);
    }
    addRecord(document, "RootNode", {std::int64_t{0}});
    return documents;
  }

  FbxNode definitions() const {
    FbxNode definitions{"Definitions", {}, {}};
    addRecord(definitions, "Version", {std::int32_t{100}});
    std::int32_t all = 1;
    for (const auto& [type, count] : objects_.counts()) all += count;
    addRecord(definitions, "Count", {all});
    const auto add = [&](const std::string& type, std::int32_t count) {
      addRecord(addRecord(definitions, "ObjectType", {type}), "Count", {count});
    };
    add("GlobalSettings", 1);
    for (const auto& [type, count] : objects_.counts()) add(type, count);
    return definitions;
  }

  FbxNode takes() const {
    FbxNode takes{"Takes", {}, {}};
    addRecord(takes, "Current", {stacks_.empty() ? std::string() : stacks_[0].name});
    for (const FbxStack& stack : stacks_) {
      FbxNode& take = addRecord(takes, "Take", {stack.name});
      addRecord(take, "FileName", {stack.name + ".tak"});
      addRecord(take, "LocalTime", {std::int64_t{0}, fbxTime(stack.duration)});
      addRecord(take, "ReferenceTime", {std::int64_t{0}, fbxTime(stack.duration)});
    }
    return takes;
  }

  const Asset& asset_;
  const FbxOptions& options_;
  std::vector<Index> clips_;
  FbxScenePlan scene_;
  FbxSpace space_;
  FbxExport result_;
  FbxObjectWriter objects_;
  FbxMaterialWriter materials_{asset_, objects_, result_.warnings};
  std::vector<FbxId> models_;                   // of scene_.models
  std::deque<FbxGeometry> made_;                // stay where they are
  std::vector<const FbxGeometry*> geometries_;  // of scene_.models; null: none
  std::vector<FbxStack> stacks_;
};

}  // namespace

FbxExport encodeFbx(const Asset& asset, const FbxOptions& options) {
  return FbxWriter(asset, options).write();
}

}  // namespace limber
