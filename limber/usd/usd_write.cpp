#include "limber/usd/usd_write.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "limber/asset/images.h"
#include "limber/asset/stored_archive.h"
#include "limber/asset/unique_names.h"
#include "limber/core/names.h"
#include "limber/skeleton/motion.h"
#include "limber/usd/usd_model.h"
#include "limber/usd/usd_text.h"

namespace limber {

namespace {

constexpr std::string_view kRoot = "Model";
constexpr int kMotionDigits = 6;  // of values over time: a millionth of their size

// Single values as USD has them, doubles short.
std::string shortText(double value) {
  return fmt::format("{:.7g}", value + 0.0);
}

std::string colorText(const Vec3& color) {
  return fmt::format("({}, {}, {})", shortText(color.x()), shortText(color.y()), shortText(color.z()));
}

// ---- materials ----

// One texture of a material as it is asked for.
struct TextureInput {
  const char* shader;  // the name of its prim
  const char* output;  // "rgb", "r"
  std::string scale, bias;
  bool isColor = false;
};

class MaterialWriter {
 public:
  MaterialWriter(const Asset& asset, const std::string& imageStem, UsdText& text, UsdFiles& files)
      : asset_(asset), document_(asset.document), imageStem_(imageStem), text_(text), files_(files) {}

  // The path of each of the document's materials, once written.
  const std::vector<std::string>& paths() const { return paths_; }

  void write() {
    if (document_.materials.empty()) return;
    UniqueNames names;
    text_.open("Scope", "Materials");
    for (const gltf::Material& material : document_.materials) {
      const std::string name = names.add(usdName(material.name.empty() ? "material" : material.name));
      paths_.push_back(fmt::format("/{}/Materials/{}", kRoot, name));
      writeMaterial(material, name);
    }
    text_.close();
  }

 private:
  void writeMaterial(const gltf::Material& material, const std::string& name) {
    const gltf::MetallicRoughness surface = material.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
    const Vec4 color = surface.baseColorFactor.value_or(Vec4::Ones());
    const bool blends = material.alphaMode == "BLEND", masks = material.alphaMode == "MASK";
    path_ = paths_.back();
    textures_.clear();
    text_.open("Material", name);
    text_.line(fmt::format("token outputs:surface.connect = <{}/Surface.outputs:surface>", path_));
    text_.open("Shader", "Surface");
    text_.line("uniform token info:id = \"UsdPreviewSurface\"");
    const std::string factors = fmt::format("({}, {}, {}, {})", shortText(color.x()), shortText(color.y()),
                                            shortText(color.z()), shortText(color.w()));
    input("color3f", "diffuseColor", surface.baseColorTexture, {"BaseColor", "rgb", factors, {}, true},
          colorText(color.head<3>()));
    if (blends || masks) {
      input("float", "opacity", surface.baseColorTexture, {"BaseColor", "a", factors, {}, true}, shortText(color.w()));
    }
    if (masks) text_.line(fmt::format("float inputs:opacityThreshold = {}", shortText(material.alphaCutoff)));
    const auto scaled = [](double by) { return fmt::format("({0}, {0}, {0}, 1)", shortText(by)); };
    const std::optional<gltf::TextureUse>& rough = surface.metallicRoughnessTexture;
    input("float", "metallic", rough, {"Metallic", "b", scaled(surface.metallicFactor), {}},
          shortText(surface.metallicFactor));
    input("float", "roughness", rough, {"Roughness", "g", scaled(surface.roughnessFactor), {}},
          shortText(surface.roughnessFactor));
    if (material.normalTexture) {
      input("normal3f", "normal", material.normalTexture, {"Normal", "rgb", "(2, 2, 2, 1)", "(-1, -1, -1, 0)"}, {});
    }
    if (material.occlusionTexture) {
      input("float", "occlusion", material.occlusionTexture, {"Occlusion", "r", {}, {}}, {});
    }
    const Vec3& glow = material.emissiveFactor;
    if (!glow.isZero(0)) {
      const std::string scale =
          fmt::format("({}, {}, {}, 1)", shortText(glow.x()), shortText(glow.y()), shortText(glow.z()));
      input("color3f", "emissiveColor", material.emissiveTexture, {"Emissive", "rgb", scale, {}, true},
            colorText(glow));
    }
    text_.line("token outputs:surface");
    text_.close();
    if (!textures_.empty()) writePlaces();
    for (const auto& [shader, write] : textures_) write();
    text_.close();
  }

  // What all textures of a material read their places on the surface by.
  void writePlaces() {
    text_.open("Shader", "Uv");
    text_.line("uniform token info:id = \"UsdPrimvarReader_float2\"");
    text_.line("string inputs:varname = \"st\"");
    text_.line("float2 outputs:result");
    text_.close();
  }

  // A connection to the texture where it can be had, else the value, if there is one.
  void input(std::string_view type, std::string_view name, const std::optional<gltf::TextureUse>& use,
             const TextureInput& as, const std::string& value) {
    const std::optional<std::string> image = use ? imagePath(use->index) : std::nullopt;
    if (image) {
      text_.line(fmt::format("{} inputs:{}.connect = <{}/{}.outputs:{}>", type, name, path_, as.shader, as.output));
      textures_.try_emplace(as.shader, [this, use = *use, as, image = *image] { writeTexture(use, as, image); });
    } else if (!value.empty()) {
      text_.line(fmt::format("{} inputs:{} = {}", type, name, value));
    }
  }

  void writeTexture(const gltf::TextureUse& use, const TextureInput& as, const std::string& image) {
    const gltf::Texture& texture = document_.textures[use.index];
    const gltf::Sampler sampler = texture.sampler ? document_.samplers[*texture.sampler] : gltf::Sampler();
    const auto wrap = [](Index mode) {
      return mode == gltf::kClampToEdge ? "clamp" : mode == gltf::kMirroredRepeat ? "mirror" : "repeat";
    };
    text_.open("Shader", as.shader);
    text_.line("uniform token info:id = \"UsdUVTexture\"");
    text_.line(fmt::format("asset inputs:file = @{}@", image));
    text_.line(fmt::format("float2 inputs:st.connect = <{}/Uv.outputs:result>", path_));
    text_.line(fmt::format("token inputs:sourceColorSpace = \"{}\"", as.isColor ? "sRGB" : "raw"));
    text_.line(fmt::format("token inputs:wrapS = \"{}\"", wrap(sampler.wrapS)));
    text_.line(fmt::format("token inputs:wrapT = \"{}\"", wrap(sampler.wrapT)));
    if (!as.scale.empty()) text_.line("float4 inputs:scale = " + as.scale);
    if (!as.bias.empty()) text_.line("float4 inputs:bias = " + as.bias);
    for (const char* output : {"float outputs:r", "float outputs:g", "float outputs:b", "float outputs:a"})
      text_.line(output);
    text_.line("float3 outputs:rgb");
    text_.close();
    if (use.extensions.exists()) {
      files_.warnings.add("texture-transforms", "places of textures are written without what extensions say of them",
                          path_);
    }
  }

  // Where the image of a texture lies beside the stage; taken along at the first call for it.
  std::optional<std::string> imagePath(Index texture) {
    const std::optional<Index> source = document_.textures[texture].source;
    if (!source) return std::nullopt;
    const auto [known, isNew] = images_.try_emplace(*source);
    if (!isNew) return known->second;
    std::optional<Bytes> bytes = imageBytes(asset_, *source);
    const std::string_view format = bytes ? imageFormat(*bytes).extension : std::string_view();
    if (format != ".png" && format != ".jpg") {
      files_.warnings.add("missing-images", "textures that are neither PNG nor JPEG are left out",
                          fmt::format("images[{}]", *source));
      return std::nullopt;
    }
    known->second = fmt::format("{}_{}{}", imageStem_, *source, format);
    files_.images.push_back({*known->second, std::move(*bytes)});
    return known->second;
  }

  const Asset& asset_;
  const gltf::Document& document_;
  const std::string& imageStem_;
  UsdText& text_;
  UsdFiles& files_;
  std::vector<std::string> paths_;
  std::map<Index, std::optional<std::string>> images_;     // of the document
  std::string path_;                                       // of the material that is being written
  std::map<std::string, std::function<void()>> textures_;  // its textures, by their prims
};

// ---- motion ----

// Moments at which something over time is sampled: its keys, and between them where it bends; a step just before its
// key.
void addMoments(const std::vector<float>& times, Interpolation interpolation, std::vector<double>& moments) {
  constexpr double kRate = 60, kBeforeStep = 1e-4;  // a second, seconds
  for (std::size_t k = 0; k < times.size(); ++k) {
    moments.push_back(times[k]);
    if (k == 0) continue;
    const double from = times[k - 1], to = times[k];
    if (interpolation == Interpolation::kStep && to - kBeforeStep > from) moments.push_back(to - kBeforeStep);
    if (interpolation != Interpolation::kCubic) continue;
    for (double t = from + 1 / kRate; t < to - 0.5 / kRate; t += 1 / kRate) moments.push_back(t);
  }
}

void sortUnique(std::vector<double>& moments) {
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
}

// Empty where all tracks stand still.
template <typename Value>
std::vector<double> momentsOf(const std::vector<Track<Value>>& tracks) {
  std::vector<double> moments;
  for (const Track<Value>& track : tracks) {
    if (track.times.size() > 1) addMoments(track.times, track.interpolation, moments);
  }
  sortUnique(moments);
  return moments;
}

// A shape's weight at each of the moments; once where there are none.
std::vector<float> weightsAt(const Track<float>& track, std::vector<double> moments) {
  Track<Vec3f> widened{0, track.interpolation, track.times, {}};  // of the type that sampleTrack knows
  for (const float value : track.values) widened.values.emplace_back(value, 0, 0);
  if (moments.empty()) moments = {0};
  std::vector<float> weights;
  for (const double moment : moments) weights.push_back(static_cast<float>(sampleTrack(widened, moment).x()));
  return weights;
}

class MotionWriter {
 public:
  MotionWriter(const UsdModel& model, UsdText& text) : model_(model), text_(text) {
    if (!model.clip) return;
    const double rate = frameRateOf(*model.clip);
    if (rate >= 1 && rate <= 240 && std::abs(rate - std::round(rate)) < 1e-2) timeCodesPerSecond_ = std::round(rate);
  }

  double timeCodesPerSecond() const { return timeCodesPerSecond_; }

  // The last moment of all, in seconds.
  double duration() const {
    double last = model_.clip ? model_.clip->duration() : 0;
    forEachShape([&](const UsdShape& shape) { last = std::max<double>(last, shape.weight.times.back()); });
    return last;
  }

  bool isNeeded() const {
    bool hasShapes = false;
    forEachShape([&](const UsdShape&) { hasShapes = true; });
    return !model_.joints.empty() || hasShapes;
  }

  void write() {
    text_.open("SkelAnimation", "Motion");
    if (!model_.joints.empty()) writeJoints();
    writeShapes();
    text_.close();
  }

 private:
  template <typename Act>
  void forEachShape(const Act& act) const {
    for (const UsdMesh& mesh : model_.meshes) {
      for (const UsdShape& shape : mesh.shapes) act(shape);
    }
  }

  void writeJoints() {
    static const Clip kNone;
    const Clip& clip = model_.clip ? *model_.clip : kNone;
    text_.tokens("uniform token[] joints", model_.joints);
    samples("float3[] translations", momentsOf(clip.translations),
            [](const Transform& t) { return Vec3f(t.translation.cast<float>()); });
    samples("quatf[] rotations", momentsOf(clip.rotations),
            [](const Transform& t) { return Eigen::Quaternionf(t.rotation.cast<float>()); });
    samples("half3[] scales", momentsOf(clip.scales), [](const Transform& t) { return Vec3f(t.scale.cast<float>()); });
  }

  Pose poseAt(double seconds) const {
    if (!model_.clip) return model_.stance;
    Pose pose = restPose(model_.skeleton);
    sampleClip(*model_.clip, seconds, pose);
    return pose;
  }

  template <typename Part>
  void samples(std::string_view name, const std::vector<double>& moments, const Part& part) {
    valuesOverTime(name, moments, [&](std::size_t moment, std::string& out) {
      const char* between = "";
      for (const Transform& local : poseAt(moments.empty() ? 0 : moments[moment]).locals) {
        out += between;
        appendUsd(out, part(local), kMotionDigits);
        between = ",";
      }
    });
  }

  void writeShapes() {
    std::vector<std::string> names;
    std::vector<double> moments;
    forEachShape([&](const UsdShape& shape) {
      names.push_back(shape.name);
      if (shape.weight.times.size() > 1) addMoments(shape.weight.times, shape.weight.interpolation, moments);
    });
    if (names.empty()) return;
    sortUnique(moments);
    std::vector<std::vector<float>> weights;  // of each shape, at each moment
    forEachShape([&](const UsdShape& shape) { weights.push_back(weightsAt(shape.weight, moments)); });
    text_.tokens("uniform token[] blendShapes", names);
    valuesOverTime("float[] blendShapeWeights", moments, [&](std::size_t moment, std::string& out) {
      const char* between = "";
      for (const std::vector<float>& ofShape : weights) {
        out += between;
        appendUsd(out, ofShape[moment], kMotionDigits);
        between = ",";
      }
    });
  }

  // One list of values, or one for each moment.
  void valuesOverTime(std::string_view name, const std::vector<double>& moments, const UsdText::Values& values) {
    if (moments.empty()) return text_.list(fmt::format("{} = [", name), 0, values, "]");
    text_.line(fmt::format("{}.timeSamples = {{", name));
    for (std::size_t m = 0; m < moments.size(); ++m) {
      text_.list(fmt::format("  {}: [", shortText(moments[m] * timeCodesPerSecond_)), m, values, "],");
    }
    text_.line("}");
  }

  const UsdModel& model_;
  UsdText& text_;
  double timeCodesPerSecond_ = 24;
};

// ---- the stage ----

void writeSkeleton(const UsdModel& model, MotionWriter& motion, UsdText& text) {
  text.open("Skeleton", "Skeleton", {"SkelBindingAPI"});
  text.tokens("uniform token[] joints", model.joints);
  text.line(fmt::format("rel skel:animationSource = </{}/Skeleton/Motion>", kRoot));
  text.matrices("uniform matrix4d[] bindTransforms", restGlobals(model.skeleton));
  std::vector<Affine> locals;
  for (const Joint& joint : model.skeleton.joints) locals.push_back(joint.rest.toAffine());
  text.matrices("uniform matrix4d[] restTransforms", locals);
  motion.write();
  text.close();
}

void writeShape(const UsdShape& shape, UsdText& text) {
  text.open("BlendShape", shape.name);
  text.array("uniform vector3f[] offsets", shape.offsets);
  if (!shape.normalOffsets.empty()) text.array("uniform vector3f[] normalOffsets", shape.normalOffsets);
  text.array("uniform int[] pointIndices", shape.vertices);
  text.close();
}

void writeMesh(const UsdMesh& mesh, bool hasSkeleton, const gltf::Material* material, const std::string& materialPath,
               UsdText& text) {
  const bool moves = hasSkeleton && (mesh.influences > 0 || !mesh.shapes.empty());
  std::vector<std::string_view> schemas;
  if (moves) schemas.push_back("SkelBindingAPI");
  if (material != nullptr) schemas.push_back("MaterialBindingAPI");
  text.open("Mesh", mesh.name, schemas);
  if (material != nullptr && material->doubleSided) text.line("uniform bool doubleSided = 1");
  Box box;
  for (const Vec3f& point : mesh.points) box.add(point.cast<double>());
  const std::vector<Vec3f> extent = {Vec3f(box.min.cast<float>()), Vec3f(box.max.cast<float>())};
  text.array("float3[] extent", extent);
  text.array("int[] faceVertexCounts", std::vector<int>(mesh.corners.size() / 3, 3));
  text.array("int[] faceVertexIndices", mesh.corners);
  text.array("point3f[] points", mesh.points);
  if (!mesh.normals.empty()) text.array("normal3f[] normals", mesh.normals, {"interpolation = \"vertex\""});
  if (!mesh.uvs.empty()) text.array("texCoord2f[] primvars:st", mesh.uvs, {"interpolation = \"vertex\""});
  text.line("uniform token subdivisionScheme = \"none\"");
  if (material != nullptr) text.line(fmt::format("rel material:binding = <{}>", materialPath));
  if (moves) {
    text.line(fmt::format("rel skel:skeleton = </{}/Skeleton>", kRoot));
    text.line("matrix4d primvars:skel:geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))");
  }
  if (moves && mesh.influences > 0) {
    const std::vector<std::string> layout = {fmt::format("elementSize = {}", mesh.influences),
                                             "interpolation = \"vertex\""};
    text.array("int[] primvars:skel:jointIndices", mesh.joints, layout);
    text.array("float[] primvars:skel:jointWeights", mesh.weights, layout);
  }
  if (!mesh.shapes.empty()) {
    std::vector<std::string> names;
    std::string targets;
    for (const UsdShape& shape : mesh.shapes) {
      names.push_back(shape.name);
      targets += fmt::format("{}</{}/{}/{}>", targets.empty() ? "" : ", ", kRoot, mesh.name, shape.name);
    }
    text.tokens("uniform token[] skel:blendShapes", names);
    text.line(fmt::format("rel skel:blendShapeTargets = [{}]", targets));
    for (const UsdShape& shape : mesh.shapes) writeShape(shape, text);
  }
  text.close();
}

}  // namespace

UsdFiles usdFiles(const Asset& asset, const UsdOptions& options) {
  const UsdModel model = readUsdModel(asset, options);
  UsdFiles files;
  files.warnings = model.warnings;
  UsdText text(files.text);
  MotionWriter motion(model, text);
  files.text = "#usda 1.0\n(\n";
  text.line(fmt::format("  defaultPrim = \"{}\"", kRoot));
  text.line("  metersPerUnit = 1");
  text.line("  upAxis = \"Y\"");
  if (const double duration = motion.duration(); duration > 0) {
    text.line("  startTimeCode = 0");
    text.line(fmt::format("  endTimeCode = {}", shortText(duration * motion.timeCodesPerSecond())));
    text.line(fmt::format("  timeCodesPerSecond = {}", shortText(motion.timeCodesPerSecond())));
  }
  text.line(")");
  const bool hasSkeleton = motion.isNeeded();
  if (hasSkeleton) {
    text.open("SkelRoot", kRoot, {"SkelBindingAPI"});
    writeSkeleton(model, motion, text);
  } else {
    text.open("Xform", kRoot);
  }
  MaterialWriter materials(asset, options.imageStem, text, files);
  materials.write();
  for (const UsdMesh& mesh : model.meshes) {
    const gltf::Material* material = mesh.material ? &asset.document.materials[*mesh.material] : nullptr;
    writeMesh(mesh, hasSkeleton, material, material != nullptr ? materials.paths()[*mesh.material] : "", text);
  }
  text.close();
  return files;
}

Bytes encodeUsdz(const UsdFiles& files) {
  constexpr std::size_t kAlignment = 64;
  std::vector<StoredFile> stored = {{"model.usda", asBytes(files.text)}};
  for (const UsdFiles::Image& image : files.images) stored.push_back({image.path, image.bytes});
  return writeStoredArchive(stored, kAlignment);
}

bool isUsdFormat(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".usda" || extension == ".usdz";
}

Warnings writeUsd(const Asset& asset, const std::filesystem::path& path, UsdOptions options) {
  if (lowerExtension(path) == ".usdz") {
    const UsdFiles files = usdFiles(asset, options);
    const Bytes archive = encodeUsdz(files);
    writeFiles(std::vector<OutputFile>{{path, archive}});
    return files.warnings;
  }
  options.imageStem = path.stem().string() + "_image";
  const UsdFiles files = usdFiles(asset, options);
  std::vector<OutputFile> outputs;
  for (const UsdFiles::Image& image : files.images) outputs.push_back({path.parent_path() / image.path, image.bytes});
  outputs.push_back({path, asBytes(files.text)});  // last, so that it never stands there without what it refers to
  writeFiles(outputs);
  return files.warnings;
}

}  // namespace limber
