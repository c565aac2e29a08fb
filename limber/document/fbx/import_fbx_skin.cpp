#include "limber/document/fbx/import_fbx_skin.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "limber/core/file/read_bounds.h"
#include "limber/document/fbx/records/fbx_values.h"

namespace limber {

namespace {

constexpr Index kMaxInfluences = 8;

struct FbxInfluence {
  Index joint;
  double weight;
};

// Rows of FBX are columns: vectors stand on the left there.
std::optional<Affine> matrixOf(const FbxNode& node, std::string_view child) {
  const std::vector<double> values = fbxNumbers(node, child);
  if (values.size() != 16) return std::nullopt;
  Affine result;
  for (int i = 0; i < 16; ++i) result.matrix()(i % 4, i / 4) = values[static_cast<std::size_t>(i)];
  result.makeAffine();
  if (!result.matrix().allFinite()) return std::nullopt;
  return result;
}

bool isInvertible(const Affine& map) {
  return map.inverse().matrix().allFinite();
}

class SkinReader {
 public:
  SkinReader(const FbxObjects& objects, const FbxModels& models, Index meshModel, Index points, FbxBudget& budget,
             Warnings& warnings)
      : objects_(objects),
        models_(models),
        meshModel_(meshModel),
        budget_(budget),
        warnings_(warnings),
        rows_(points) {}

  std::optional<FbxSkin> read(Index geometry) {
    for (const Index skin : objects_.sources(geometry, "Deformer")) {
      if (objects_.is(skin, "Deformer", "Skin")) {
        const std::string_view bending = fbxChildText(*objects_[skin].node, "SkinningType");
        if (bending == "DualQuaternion" || bending == "Blend") {
          warnings_.add("dual-quaternions", "skins that ask for dual quaternions bend as linear ones",
                        objects_[geometry].name);
        }
        for (const Index cluster : objects_.sources(skin, "Deformer")) addCluster(cluster);
      }
    }
    if (skin_.joints.empty()) return std::nullopt;
    for (Affine& inverseBind : skin_.inverseBinds) inverseBind = inverseBind * skin_.toBound.inverse();
    finishWeights();
    return std::move(skin_);
  }

 private:
  void addCluster(Index cluster) {
    const std::vector<Index> bones = objects_.sources(cluster, "Model");
    const std::optional<Index> bone = bones.empty() ? std::nullopt : models_.modelOf(bones[0]);
    if (!bone) return warnings_.add("clusters", "weights of no bone are left out", objects_[cluster].name);
    const FbxNode& node = *objects_[cluster].node;
    const Affine link = matrixOf(node, "TransformLink").value_or(models_.restWorld(*bone));
    // From the mesh model's space to the bone's, as they were bound.
    const Affine meshToBone =
        matrixOf(node, "Transform").value_or(Affine(link.inverse() * models_.restWorld(meshModel_)));
    if (!isInvertible(link) || !isInvertible(meshToBone)) {
      return warnings_.add("clusters", "weights of bones that were bound with a scale of 0 are left out",
                           objects_[cluster].name);
    }
    if (skin_.joints.empty()) skin_.toBound = link * meshToBone;
    const auto known = std::find(skin_.joints.begin(), skin_.joints.end(), *bone);
    const auto joint = static_cast<Index>(known - skin_.joints.begin());
    if (known == skin_.joints.end()) {
      skin_.joints.push_back(*bone);
      skin_.inverseBinds.push_back(meshToBone);  // as yet from the mesh's space
    }
    addWeights(node, joint);
  }

  void addWeights(const FbxNode& node, Index joint) {
    const std::vector<std::int64_t> points = fbxIntegers(node, "Indexes");
    const std::vector<double> weights = fbxNumbers(node, "Weights");
    std::size_t left = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double weight = i < weights.size() ? weights[i] : 0;
      if (weight == 0) continue;
      if (!(weight > 0) || !std::isfinite(static_cast<float>(weight)) || points[i] < 0 ||
          static_cast<std::size_t>(points[i]) >= rows_.size()) {
        ++left;
        continue;
      }
      std::vector<FbxInfluence>& row = rows_[static_cast<std::size_t>(points[i])];
      if (!row.empty() && row.back().joint == joint) {
        row.back().weight += weight;
      } else {
        row.push_back({joint, weight});
      }
    }
    warnings_.add("invalid-weights", "weights that are negative, not finite or of no vertex are left out", {}, left);
  }

  void finishWeights() {
    const bool isBare = std::any_of(rows_.begin(), rows_.end(), [](const auto& row) { return row.empty(); });
    const auto own = std::find(skin_.joints.begin(), skin_.joints.end(), meshModel_);
    const auto ownJoint = static_cast<Index>(own - skin_.joints.begin());
    if (isBare && own == skin_.joints.end()) {
      skin_.joints.push_back(meshModel_);
      skin_.inverseBinds.push_back(skin_.toBound.inverse());
      skin_.needsOwnModel = true;
    }
    budget_.spend(2 * kMaxInfluences * rows_.size());
    skin_.weights.slots = kMaxInfluences;
    skin_.weights.joints.assign(rows_.size() * kMaxInfluences, 0);
    skin_.weights.weights.assign(rows_.size() * kMaxInfluences, 0.0f);
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      std::vector<FbxInfluence>& row = rows_[v];
      if (row.empty()) row.push_back({ownJoint, 1});
      std::stable_sort(row.begin(), row.end(),
                       [](const FbxInfluence& a, const FbxInfluence& b) { return a.weight > b.weight; });
      row.resize(std::min<std::size_t>(row.size(), kMaxInfluences));
      const double sum = std::accumulate(row.begin(), row.end(), 0.0,
                                         [](double total, const FbxInfluence& i) { return total + i.weight; });
      for (std::size_t i = 0; i < row.size(); ++i) {
        const auto weight = static_cast<float>(row[i].weight / sum);
        if (weight == 0) continue;
        skin_.weights.joints[v * kMaxInfluences + i] = row[i].joint;
        skin_.weights.weights[v * kMaxInfluences + i] = weight;
      }
    }
  }

  const FbxObjects& objects_;
  const FbxModels& models_;
  Index meshModel_;
  FbxBudget& budget_;
  Warnings& warnings_;
  std::vector<std::vector<FbxInfluence>> rows_;  // #control points
  FbxSkin skin_;
};

// `percents`: how much of it each of its points moves; empty: all of it.
FbxShapeTarget readTarget(const FbxNode& node, std::string name, Index pointCount, std::span<const double> percents,
                          Warnings& warnings) {
  const std::vector<std::int64_t> points = fbxIntegers(node, "Indexes");
  std::vector<double> moves = fbxNumbers(node, "Vertices"), normals = fbxNumbers(node, "Normals");
  for (std::vector<double>* values : {&moves, &normals}) {
    for (std::size_t i = 0; !percents.empty() && i < std::min(values->size(), 3 * percents.size()); ++i) {
      (*values)[i] *= 0.01 * percents[i / 3];
    }
  }
  const bool hasNormals = normals.size() >= 3 * points.size() &&
                          std::any_of(normals.begin(), normals.end(), [](double x) { return x != 0; });
  std::vector<std::pair<Index, std::size_t>> order;
  std::size_t left = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool isSound = points[i] >= 0 && points[i] < std::int64_t{pointCount} && 3 * i + 2 < moves.size();
    if (isSound) {
      order.emplace_back(static_cast<Index>(points[i]), i);
    } else {
      ++left;
    }
  }
  warnings.add("invalid-shapes", "moves of blend shapes that are of no vertex are left out", name, left);
  std::stable_sort(order.begin(), order.end());
  FbxShapeTarget result;
  result.name = std::move(name);
  for (const auto& [point, i] : order) {
    if (!result.points.empty() && result.points.back() == point) continue;
    result.points.push_back(point);
    result.moves.emplace_back(moves[3 * i], moves[3 * i + 1], moves[3 * i + 2]);
    if (hasNormals) result.normals.emplace_back(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
  }
  return result;
}

}  // namespace

std::optional<FbxSkin> readFbxSkin(const FbxObjects& objects, const FbxModels& models, Index geometry, Index meshModel,
                                   FbxBudget& budget, Warnings& warnings) {
  const Index points = fbxControlPointCount(*objects[geometry].node);
  return SkinReader(objects, models, meshModel, points, budget, warnings).read(geometry);
}

void FbxShapeChannel::addWeights(double percentage, std::vector<double>& weights) const {
  if (targets.empty()) return;
  // The bare mesh is a key at 0 among those of the targets. Beyond the last it goes on as it came there.
  const auto bare =
      static_cast<std::size_t>(std::lower_bound(fullPercents.begin(), fullPercents.end(), 0.0) - fullPercents.begin());
  const auto percentOf = [&](std::size_t key) { return key == bare ? 0 : fullPercents[key < bare ? key : key - 1]; };
  std::size_t next = 1;
  while (next < targets.size() && percentOf(next) <= percentage) ++next;
  const double before = percentOf(next - 1), span = percentOf(next) - before;
  const double fraction = span != 0 ? (percentage - before) / span : 1;
  const auto add = [&](std::size_t key, double weight) {
    if (key != bare) weights[targets[key < bare ? key : key - 1]] += weight;
  };
  add(next - 1, 1 - fraction);
  add(next, fraction);
}

FbxShapes readFbxShapes(const FbxObjects& objects, Index geometry, FbxBudget& budget, Warnings& warnings) {
  const Index points = fbxControlPointCount(*objects[geometry].node);
  FbxShapes result;
  for (const Index deformer : objects.sources(geometry, "Deformer")) {
    if (!objects.is(deformer, "Deformer", "BlendShape")) continue;
    for (const Index object : objects.sources(deformer, "Deformer")) {
      FbxShapeChannel channel;
      channel.object = object;
      const FbxNode& node = *objects[object].node;
      const FbxNode* stored = node.find("DeformPercent");
      channel.percent = stored ? fbxNumber(*stored, 0).value_or(0) : 0;
      channel.percent = objects.properties(object).number("DeformPercent", channel.percent);
      if (!std::isfinite(channel.percent)) channel.percent = 0;
      const std::vector<double> full = fbxNumbers(node, "FullWeights");
      const std::vector<Index> shapes = objects.sources(object, "Geometry");
      // Of a channel of one shape, Blender writes its vertex group here: a number for each of the shape's points. One
      // number alone is where the shape is reached; in a group of one point that is in full (100) it says the same.
      const bool areOfPoints =
          shapes.size() == 1 && full.size() > 1 &&
          full.size() == fbxIntegers(*objects[shapes[0]].node, "Indexes").size() &&
          std::all_of(full.begin(), full.end(), [](double percent) { return std::isfinite(percent); });
      std::vector<std::pair<double, Index>> order;
      for (std::size_t s = 0; s < shapes.size(); ++s) {
        const double otherwise = 100.0 * static_cast<double>(s + 1) / static_cast<double>(shapes.size());
        const bool isGiven = !areOfPoints && s < full.size() && std::isfinite(full[s]) && full[s] != 0;
        order.emplace_back(isGiven ? full[s] : otherwise, shapes[s]);
      }
      std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      for (const auto& [percent, shape] : order) {
        if (std::uint64_t{points} * (result.targets.size() + 1) > read_bounds::kFbxShapeVertices.of(0)) {
          warnings.add("blend-shapes", "blend shapes beyond what a file may hold are left out", objects[shape].name);
          continue;
        }
        channel.targets.push_back(static_cast<Index>(result.targets.size()));
        channel.fullPercents.push_back(percent);
        // A channel of one shape is what users know by its name.
        const std::string& name =
            order.size() == 1 && !objects[object].name.empty() ? objects[object].name : objects[shape].name;
        result.targets.push_back(readTarget(*objects[shape].node, name, points,
                                            areOfPoints ? std::span<const double>(full) : std::span<const double>(),
                                            warnings));
        budget.spend(12 * result.targets.back().points.size());  // moves and normals in double precision
      }
      if (!channel.targets.empty()) result.channels.push_back(std::move(channel));
    }
  }
  return result;
}

}  // namespace limber
