#include "limber/document/vrm/vrm0_materials.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/vrm/loose_json.h"

namespace limber {

namespace {

constexpr const char *kMtoon = "VRMC_materials_mtoon", *kUnlit = "KHR_materials_unlit",
                     *kTransform = "KHR_texture_transform";
constexpr double kGamma = 2.2;      // colours of 0.x are written as screens show them
constexpr int kMaxQueueOffset = 9;  // of VRMC_materials_mtoon

// A number as short as single precision says it, the same natively and in WebAssembly.
double shown(double value) {
  return std::isfinite(value) && std::abs(value) < 1e30 ? shortDouble(value) : 0;
}

double linear(double color) {
  return shown(std::pow(std::max(0.0, color), kGamma));
}

class MaterialConverter {
 public:
  MaterialConverter(Asset& asset, const Json& properties) : document_(asset.document), properties_(properties) {
    for (const Json& each : properties) {
      if (!isTransparent(each) || numberIn(each, "renderQueue", -1) < 0) continue;
      queues_[writesDepth(each)].insert(numberIn(each, "renderQueue", 0));
    }
  }

  // Returns how many materials stay as they are though 0.x asked for more.
  std::size_t run() {
    std::size_t others = 0;
    for (std::size_t m = 0; m < properties_.size() && m < document_.materials.size(); ++m) {
      source_ = &properties_[m];
      material_ = &document_.materials[m];
      const std::string shader = textIn(*source_, "shader");
      if (shader == "VRM/MToon") {
        convertMtoon();
      } else if (shader.starts_with("VRM/Unlit")) {
        convertUnlit(shader);
      } else if (shader != "VRM_USE_GLTFSHADER" && !shader.empty()) {
        ++others;
      }
    }
    return others;
  }

 private:
  static const Json& groupOf(const Json& source, const char* name) {
    static const Json kNone = Json::object();
    const Json* group = member(source, name);
    return group != nullptr ? *group : kNone;
  }
  double number(const char* key, double byDefault) const {
    return numberIn(groupOf(*source_, "floatProperties"), key, byDefault);
  }
  std::vector<double> vector(const char* key, std::vector<double> byDefault) const {
    return numbersIn(groupOf(*source_, "vectorProperties"), key, std::move(byDefault));
  }
  static bool isTransparent(const Json& source) {
    return flagIn(groupOf(source, "keywordMap"), "_ALPHABLEND_ON") ||
           textIn(source, "shader").starts_with("VRM/UnlitTransparent");
  }
  static bool writesDepth(const Json& source) {
    return numberIn(groupOf(source, "floatProperties"), "_ZWrite", 0) == 1 ||
           textIn(source, "shader") == "VRM/UnlitTransparentZWrite";
  }

  // Of all transparent materials those that are drawn later come later here; those without depth count down to 0.
  int queueOffset() const {
    const double queue = numberIn(*source_, "renderQueue", -1);
    if (!isTransparent(*source_) || queue < 0) return 0;
    const bool depth = writesDepth(*source_);
    const std::set<double>& all = queues_[depth];
    const auto placement = static_cast<int>(std::distance(all.begin(), all.find(queue)));
    if (depth) return std::min(placement, kMaxQueueOffset);
    return std::max(placement - static_cast<int>(all.size()) + 1, -kMaxQueueOffset);
  }

  Json colorOf(const char* key, const std::vector<double>& byDefault) const {
    const std::vector<double> color = vector(key, byDefault);
    return {linear(color[0]), linear(color[1]), linear(color[2])};
  }

  std::optional<Index> textureIndex(const char* key) const {
    return indexIn(groupOf(*source_, "textureProperties"), key, document_.textures.size());
  }
  // All textures but the matcap's lie where the main one does.
  std::optional<gltf::TextureUse> texture(const char* key) {
    const std::optional<Index> index = textureIndex(key);
    if (!index) return std::nullopt;
    gltf::TextureUse use;
    use.index = *index;
    if (const Json placement = transform(); !placement.is_null()) use.extensions.change()[kTransform] = placement;
    return use;
  }
  Json transform() {
    const std::vector<double> placement = vector("_MainTex", {0, 0, 1, 1});
    if (placement == std::vector<double>{0, 0, 1, 1}) return nullptr;
    declareExtension(document_, kTransform);
    return {{"offset", {placement[0], 1 - placement[3] - placement[1]}}, {"scale", {placement[2], placement[3]}}};
  }
  void addTexture(Json& mtoon, const char* name, const char* key) {
    const std::optional<Index> index = textureIndex(key);
    if (!index) return;
    Json use = {{"index", *index}};
    if (Json placement = transform(); !placement.is_null()) use["extensions"] = {{kTransform, std::move(placement)}};
    mtoon[name] = std::move(use);
  }

  void setSurface() {
    material_->pbrMetallicRoughness.emplace();
    gltf::MetallicRoughness& surface = *material_->pbrMetallicRoughness;
    const std::vector<double> color = vector("_Color", {1, 1, 1, 1});
    surface.baseColorFactor =
        Vec4(linear(color[0]), linear(color[1]), linear(color[2]), shown(std::clamp(color[3], 0.0, 1.0)));
    for (Eigen::Index i = 0; i < 3; ++i) (*surface.baseColorFactor)[i] = std::min((*surface.baseColorFactor)[i], 1.0);
    surface.metallicFactor = 0;
    surface.baseColorTexture = texture("_MainTex");
  }

  void setAlpha(bool isBlended, bool isCut) {
    material_->alphaMode = isBlended ? "BLEND" : isCut ? "MASK" : "OPAQUE";
    material_->alphaCutoff = isCut && !isBlended ? std::max(0.0, number("_Cutoff", 0.5)) : 0.5;
  }

  void convertMtoon() {
    const bool isBlended = isTransparent(*source_);
    setAlpha(isBlended, flagIn(groupOf(*source_, "keywordMap"), "_ALPHATEST_ON"));
    material_->doubleSided = number("_CullMode", 2) == 0;
    setSurface();
    material_->normalTexture = texture("_BumpMap");
    const double depth = number("_BumpScale", 1);
    if (material_->normalTexture && depth != 1) material_->normalTexture->asRead.change()["scale"] = shown(depth);
    material_->emissiveTexture = texture("_EmissionMap");
    const Json emission = colorOf("_EmissionColor", {0, 0, 0, 1});
    for (Eigen::Index i = 0; i < 3; ++i) {
      material_->emissiveFactor[i] = std::min(emission[static_cast<std::size_t>(i)].get<double>(), 1.0);
    }

    Json mtoon = {{"specVersion", "1.0"}, {"transparentWithZWrite", isBlended && writesDepth(*source_)}};
    mtoon["renderQueueOffsetNumber"] = queueOffset();
    addShading(mtoon);
    addRim(mtoon);
    addOutline(mtoon);
    addMovingTexture(mtoon);
    changeExtension(*material_, kMtoon) = std::move(mtoon);
    changeExtension(*material_, kUnlit);
    declareExtension(document_, kMtoon);
    declareExtension(document_, kUnlit);
  }

  void addShading(Json& mtoon) {
    mtoon["shadeColorFactor"] = colorOf("_ShadeColor", {0.97, 0.81, 0.86, 1});
    addTexture(mtoon, "shadeMultiplyTexture", "_ShadeTexture");
    const double shift = number("_ShadeShift", 0), oldToony = number("_ShadeToony", 0.9);
    const double toony = oldToony + (1 - oldToony) * (0.5 + 0.5 * shift);
    mtoon["shadingShiftFactor"] = shown(-shift - (1 - toony));
    mtoon["shadingToonyFactor"] = shown(toony);
    mtoon["giEqualizationFactor"] = shown(1 - number("_IndirectLightIntensity", 0.1));
  }

  void addRim(Json& mtoon) {
    if (const std::optional<Index> matcap = textureIndex("_SphereAdd")) {
      mtoon["matcapFactor"] = {1, 1, 1};
      mtoon["matcapTexture"] = {{"index", *matcap}};
    }
    mtoon["rimLightingMixFactor"] = shown(number("_RimLightingMix", 0));
    addTexture(mtoon, "rimMultiplyTexture", "_RimTexture");
    mtoon["parametricRimColorFactor"] = colorOf("_RimColor", {0, 0, 0, 1});
    mtoon["parametricRimFresnelPowerFactor"] = shown(number("_RimFresnelPower", 1));
    mtoon["parametricRimLiftFactor"] = shown(number("_RimLift", 0));
  }

  void addOutline(Json& mtoon) {
    // Widths of 0.x are centimetres, or hundredths of half the screen's height; those of 1.0 metres, or of the whole.
    constexpr double kOfWorld = 0.01, kOfScreen = 0.005;
    const double mode = number("_OutlineWidthMode", 0);
    mtoon["outlineWidthMode"] = mode == 1 ? "worldCoordinates" : mode == 2 ? "screenCoordinates" : "none";
    mtoon["outlineWidthFactor"] = shown((mode == 2 ? kOfScreen : kOfWorld) * number("_OutlineWidth", 0));
    addTexture(mtoon, "outlineWidthMultiplyTexture", "_OutlineWidthTexture");
    mtoon["outlineColorFactor"] = colorOf("_OutlineColor", {0, 0, 0, 1});
    const bool isLit = number("_OutlineColorMode", 0) == 1;
    mtoon["outlineLightingMixFactor"] = isLit ? shown(number("_OutlineLightingMix", 1)) : 0;
  }

  void addMovingTexture(Json& mtoon) {
    addTexture(mtoon, "uvAnimationMaskTexture", "_UvAnimMaskTexture");
    mtoon["uvAnimationScrollXSpeedFactor"] = shown(number("_UvAnimScrollX", 0));
    mtoon["uvAnimationScrollYSpeedFactor"] = shown(0 - number("_UvAnimScrollY", 0));
    mtoon["uvAnimationRotationSpeedFactor"] = shown(number("_UvAnimRotation", 0));
  }

  void convertUnlit(const std::string& shader) {
    setAlpha(isTransparent(*source_), shader == "VRM/UnlitCutout");
    setSurface();
    changeExtension(*material_, kUnlit);
    declareExtension(document_, kUnlit);
  }

  gltf::Document& document_;
  const Json& properties_;
  std::set<double> queues_[2];  // of transparent materials, without and with depth
  const Json* source_ = nullptr;
  gltf::Material* material_ = nullptr;
};

}  // namespace

void convertVrm0Materials(Asset& asset, const Json& materialProperties) {
  const std::size_t others = MaterialConverter(asset, materialProperties).run();
  asset.warnings.add("vrm0-materials", "materials of shaders that VRM 1.0 does not know stay as glTF has them", {},
                     others);
}

}  // namespace limber
