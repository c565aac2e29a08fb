// A body cut into meshes that meet at the very same vertices, stored as different files store them: whatever the last
// bits of a seam's vertices are, its weights are one.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "limber/document/scene/geometry.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/samples/samples.h"

namespace limber {
namespace {

using testing::SceneBuilder;

struct CutBody {
  SceneBuilder scene;
  std::vector<Index> nodes;
  std::vector<Index> vertexOf;  // the whole body's vertex, of each vertex of the parts

  Geometry geometry() {
    scene.addScene(nodes);
    return collectGeometry(scene.build());
  }
};

const TriMesh& wholeBody() {
  static const TriMesh body = [] {
    const Geometry geometry = collectGeometry(makeSample("biped"));
    const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
    TriMesh mesh = prepared.mesh;
    for (Index v = 0; v < mesh.vertexCount(); ++v) {
      mesh.positions[v] = prepared.frame.toSource(mesh.position(v)).cast<float>();
    }
    return mesh;
  }();
  return body;
}

struct CutPart {
  std::vector<Index> vertexOf;
  std::vector<Triangle> triangles;
};

// Legs, hips, trunk with the arms, and head.
std::vector<CutPart> cutAcross(const TriMesh& body) {
  std::vector<CutPart> parts(4);
  std::vector<std::map<Index, Index>> moved(4);
  for (const Triangle& t : body.triangles) {
    const double height = (body.position(t[0]) + body.position(t[1]) + body.position(t[2])).y() / 3;
    const std::size_t part = height < 0.45 ? 0 : height < 0.85 ? 1 : height < 1.3 ? 2 : 3;
    Triangle own;
    for (std::size_t i = 0; i < 3; ++i) {
      own[i] = moved[part].try_emplace(t[i], static_cast<Index>(parts[part].vertexOf.size())).first->second;
      if (own[i] == parts[part].vertexOf.size()) parts[part].vertexOf.push_back(t[i]);
    }
    parts[part].triangles.push_back(own);
  }
  return parts;
}

// How a part's vertices are stored: the transform of its node, and what becomes of the numbers below it.
struct Storage {
  Transform node;
  int bits = 0;           // of the part's own grid; 0 for floats
  bool integers = false;  // normalised 16-bit integers, as KHR_mesh_quantization has them; else floats on the grid
  double noise = 0;       // standard deviation
};

void addPart(const TriMesh& body, const CutPart& part, const Storage& storage, CutBody& cut) {
  const Affine toWorld = storage.node.toAffine(), toLocal = toWorld.inverse();
  std::mt19937 random(static_cast<std::uint32_t>(cut.nodes.size()));
  std::normal_distribution<double> normal(0, 1);
  std::vector<Vec3> local;
  Box box;
  for (const Index v : part.vertexOf) {
    const Vec3 noise = storage.noise > 0 ? Vec3(normal(random), normal(random), normal(random)) : Vec3(Vec3::Zero());
    local.push_back(toLocal * (body.position(v) + storage.noise * noise));
    box.add(local.back());
  }
  const double levels = std::ldexp(1.0, storage.bits - 1) - 1, half = 0.5 * box.longestSide();
  std::vector<Vec3f> positions;
  std::vector<std::int16_t> integers;
  for (const Vec3& p : local) {
    if (storage.bits == 0) {
      positions.push_back(p.cast<float>());
      continue;
    }
    Vec3 on;
    for (int i = 0; i < 3; ++i) on[i] = std::round((p[i] - box.center()[i]) / half * levels);
    positions.push_back((on / levels * half + box.center()).cast<float>());
    for (int i = 0; i < 3; ++i) integers.push_back(static_cast<std::int16_t>(on[i]));
  }
  Json primitive = cut.scene.primitive(positions, part.triangles);
  Affine placed = toWorld;
  if (storage.integers) {
    Asset& asset = cut.scene.asset();
    primitive["attributes"]["POSITION"] =
        addAccessor(asset, {static_cast<Index>(positions.size()), 3, ComponentType::kI16, true},
                    {reinterpret_cast<const std::uint8_t*>(integers.data()), integers.size() * sizeof(std::int16_t)});
    placed = toWorld * Eigen::Translation3d(box.center()) * Eigen::UniformScaling<double>(half * 32767 / levels);
  }
  std::vector<double> matrix(placed.matrix().data(), placed.matrix().data() + 16);
  Json primitives = Json::array({primitive});
  const Index mesh = cut.scene.addMesh(std::move(primitives));
  cut.nodes.push_back(cut.scene.addNode({{"mesh", mesh}, {"matrix", matrix}}));
  cut.vertexOf.insert(cut.vertexOf.end(), part.vertexOf.begin(), part.vertexOf.end());
}

const Transform kSampleCount[] = {
    {Vec3(0.1, 0.2, 0.03), Quat(Eigen::AngleAxisd(0.2, Vec3::UnitY())), Vec3::Constant(0.01)},
    {Vec3(-0.3, 0.5, 0.1), Quat(Eigen::AngleAxisd(0.6, Vec3::UnitX())), Vec3::Constant(0.7)},
    {Vec3(0, 1, 0), Quat::Identity(), Vec3::Ones()},
    {Vec3(20, 1.4, 0.02), Quat(Eigen::AngleAxisd(1.3, Vec3::UnitZ())), Vec3::Constant(2.54)}};

CutBody cutBody(const std::function<Storage(std::size_t part)>& storageOf) {
  CutBody cut;
  const std::vector<CutPart> parts = cutAcross(wholeBody());
  for (std::size_t p = 0; p < parts.size(); ++p) addPart(wholeBody(), parts[p], storageOf(p), cut);
  return cut;
}

CutBody triangleSoup(double noise) {
  CutPart all;
  for (const Triangle& t : wholeBody().triangles) {
    const auto first = static_cast<Index>(all.vertexOf.size());
    all.vertexOf.insert(all.vertexOf.end(), t.begin(), t.end());
    all.triangles.push_back({first, first + 1, first + 2});
  }
  CutBody cut;
  addPart(wholeBody(), all, {{}, 0, false, noise}, cut);
  return cut;
}

struct Stored {
  std::string name;
  std::function<CutBody()> make;
};

std::vector<Stored> storages() {
  const double noise = 1e-7 * 1.8;  // of the size
  std::vector<Stored> result = {
      {"as_they_are", [] { return cutBody([](std::size_t) { return Storage(); }); }},
      {"nodes", [] { return cutBody([](std::size_t p) { return Storage{kSampleCount[p]}; }); }},
      {"noise", [=] { return cutBody([=](std::size_t) {
                        return Storage{{}, 0, false, noise};
                      }); }},
      {"soup", [=] { return triangleSoup(noise); }}};
  for (const int bits : {8, 10, 12, 14, 16}) {
    const std::string name = std::to_string(bits) + "_bits";
    result.push_back({name + "_integers", [=] {
                        return cutBody([=](std::size_t) { return Storage{{}, bits, true}; });
                      }});
    result.push_back({name + "_nodes", [=] {
                        return cutBody([=](std::size_t p) { return Storage{kSampleCount[p], bits, true}; });
                      }});
    if (bits > 14) continue;  // floats on a grid that fine look like any others
    result.push_back({name + "_floats", [=] { return cutBody([=](std::size_t) { return Storage{{}, bits}; }); }});
  }
  return result;
}

std::ostream& operator<<(std::ostream& out, const Stored& stored) {
  return out << stored.name;
}

class Seams : public ::testing::TestWithParam<Stored> {};

// Bones through the middle of legs, trunk, arms and head.
std::vector<Bone> bonesIn(const WorkingFrame& frame) {
  std::vector<Bone> bones;
  const auto add = [&](const Vec3& a, const Vec3& b, std::optional<Index> parent) {
    const auto joint = static_cast<Index>(bones.size());
    bones.push_back({joint, frame.toWorking(a), frame.toWorking(b), 0, parent});
    return joint;
  };
  const Index hips = add({0, 0.9, 0}, {0, 1.15, 0}, std::nullopt), chest = add({0, 1.15, 0}, {0, 1.4, 0}, hips);
  add({0, 1.4, 0}, {0, 1.7, 0}, chest);
  for (const double side : {-1.0, 1.0}) {
    const Index thigh = add({side * 0.1, 0.85, 0}, {side * 0.12, 0.47, 0}, hips);
    add({side * 0.12, 0.47, 0}, {side * 0.13, 0.08, 0}, thigh);
    add({side * 0.2, 1.35, 0}, {side * 0.5, 1.0, 0}, chest);
  }
  return bones;
}

TEST_P(Seams, HaveTheSameWeightsOnEitherSide) {
  CutBody cut = GetParam().make();
  const Geometry geometry = cut.geometry();
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  const std::vector<Bone> bones = bonesIn(prepared.frame);
  for (const char* method : {"bone-heat", "geodesic-voxel", "bounded-biharmonic", "envelopes"}) {
    Progress progress;
    const SkinWeights weights = expandWeights(
        findWeightMethod(method).compute(prepared.mesh, bones, {}, progress).weights, prepared.weldedVertex);
    std::map<Index, std::map<Index, double>> of;  // by the body's vertex
    double worst = 0;
    for (Index v = 0; v < weights.vertexCount(); ++v) {
      std::map<Index, double> own;
      for (Index k = 0; k < weights.slots; ++k) own[weights.jointsOf(v)[k]] += weights.weightsOf(v)[k];
      const std::map<Index, double>& other = of.try_emplace(cut.vertexOf[v], own).first->second;
      for (const Bone& bone : bones) {
        const auto weightIn = [&](const std::map<Index, double>& w) {
          const auto found = w.find(bone.joint);
          return found == w.end() ? 0.0 : found->second;
        };
        worst = std::max(worst, std::abs(weightIn(own) - weightIn(other)));
      }
    }
    EXPECT_LE(worst, 1e-3) << method;
  }
}

TEST_P(Seams, AloneAreJoined) {
  CutBody cut = GetParam().make();
  const Geometry geometry = cut.geometry();
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  std::map<Index, std::vector<Index>> members;  // by welded vertex
  std::set<Index> wrong;
  for (Index v = 0; v < geometry.positions.size(); ++v) {
    std::vector<Index>& others = members[prepared.weldedVertex[v]];
    // A coarse grid itself makes one position of two.
    const bool isOne = std::any_of(others.begin(), others.end(), [&](Index w) {
      return cut.vertexOf[w] == cut.vertexOf[v] || geometry.positions[w] == geometry.positions[v];
    });
    if (!others.empty() && !isOne) wrong.insert(v);
    others.push_back(v);
  }
  EXPECT_TRUE(wrong.empty()) << wrong.size();
}

INSTANTIATE_TEST_SUITE_P(Storages, Seams, ::testing::ValuesIn(storages()),
                         [](const auto& storage) { return storage.param.name; });

}  // namespace
}  // namespace limber
