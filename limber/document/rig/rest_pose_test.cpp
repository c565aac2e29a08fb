// A new rest pose: what a viewer shows, played here by the book, is the same before and after.
#include "limber/document/rig/rest_pose.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

using testing::documentJson;
using testing::SceneBuilder;

class Random {
 public:
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Vec3 vector() { return {in(-1, 1), in(-1, 1), in(-1, 1)}; }
  Quat rotation(double most = 1.5) { return Quat(Eigen::AngleAxisd(in(-most, most), vector().normalized())); }

 private:
  std::mt19937 generator_{11};
};

Json numbers(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  Json result = Json::array();
  for (const double x : vector) result.push_back(static_cast<float>(x));
  return result;
}

// hip - chest - arm, hip - leg; their nodes are not in the bind pose. Two skins share chest and hip.
struct TwoSkins {
  SceneBuilder scene;
  Random random;
  Index leg, arm, chest, hip, bodySkin, coatSkin;
  std::vector<Affine> bind;  // by node

  TwoSkins() {
    const auto joint = [&](const char* name, const std::vector<Index>& children) {
      bind.push_back(Affine(Eigen::Translation3d(random.vector()) * random.rotation()));
      Json node = {{"name", name}, {"translation", numbers(random.vector())}};
      node["rotation"] = numbers(random.rotation().coeffs());
      if (!children.empty()) node["children"] = children;
      return scene.addNode(node);
    };
    leg = joint("leg", {});
    arm = joint("arm", {});
    chest = joint("chest", {arm});
    hip = joint("hip", {chest, leg});
    bodySkin = scene.addSkin({hip, chest, arm, leg}, inverses({hip, chest, arm, leg}));
    coatSkin = scene.addSkin({chest, hip}, inverses({chest, hip}));
  }

  std::vector<Affine> inverses(const std::vector<Index>& joints) const {
    std::vector<Affine> result;
    for (const Index j : joints) result.push_back(bind[j].inverse(Eigen::Affine));
    return result;
  }

  // A mesh of tetrahedra, each bound rigidly to one of `joints` joints.
  Index rigidMesh(Index joints) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint8_t> jointOf;
    for (Index i = 0; i < 6; ++i) {
      for (Triangle t : SceneBuilder::tetrahedronTriangles()) {
        for (Index& v : t) v += 4 * i;
        triangles.push_back(t);
      }
      for (const Vec3f& p : SceneBuilder::tetrahedron(random.vector().cast<float>(), 0.3f)) positions.push_back(p);
      jointOf.insert(jointOf.end(), 4, static_cast<std::uint8_t>(i % joints));
    }
    const Index mesh = scene.addMesh(Json::array({scene.primitive(positions, triangles)}));
    scene.bindRigidly(mesh, jointOf);
    std::vector<float> normals, tangents, morph;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const Vec3 n = random.vector().normalized(), t = n.unitOrthogonal();
      for (int k = 0; k < 3; ++k) normals.push_back(static_cast<float>(n[k]));
      for (int k = 0; k < 3; ++k) tangents.push_back(static_cast<float>(t[k]));
      tangents.push_back(1);
      for (int k = 0; k < 3; ++k) morph.push_back(static_cast<float>(random.in(-0.1, 0.1)));
    }
    gltf::Primitive& primitive = scene.primitiveOf(mesh);
    primitive.attributes.set("NORMAL", addFloatAccessor(scene.asset(), normals, 3, kVertexTarget));
    primitive.attributes.set("TANGENT", addFloatAccessor(scene.asset(), tangents, 4, kVertexTarget));
    gltf::Attributes& target = primitive.targets.emplace_back();
    target.set("POSITION", addFloatAccessor(scene.asset(), morph, 3, kVertexTarget, true));
    target.set("NORMAL", addFloatAccessor(scene.asset(), morph, 3, kVertexTarget));
    return mesh;
  }

  void addTurn(Index node, Index keys) {
    std::vector<float> times, values;
    for (Index k = 0; k < keys; ++k) {
      times.push_back(0.5f * static_cast<float>(k));
      const Quat q = random.rotation();
      for (int i = 0; i < 4; ++i) values.push_back(static_cast<float>(q.coeffs()[i]));
    }
    const Index input = addFloatAccessor(scene.asset(), times, 1, 0, true);
    const Index output = addFloatAccessor(scene.asset(), values, 4);
    gltf::Animation& clip = scene.asset().document.animations.emplace_back();
    clip.samplers.push_back({{}, input, output});
    clip.channels.push_back({{}, 0, {{}, node, "rotation"}});
  }
};

// The nodes' local transforms at a time of an animation, written down from the format's definition.
std::vector<Transform> localsAt(const Asset& asset, Index animation, double seconds) {
  std::vector<Transform> locals;
  for (const gltf::Node& node : asset.document.nodes) locals.push_back(decompose(nodeTransform(node)));
  const gltf::Animation& source = asset.document.animations[animation];
  for (const gltf::AnimationChannel& channel : source.channels) {
    const gltf::AnimationSampler& sampler = source.samplers[channel.sampler];
    const std::vector<float> times = readFloats(asset, sampler.input);
    const std::vector<float> values = readFloats(asset, sampler.output);
    std::size_t key = 0;
    while (key + 2 < times.size() && times[key + 1] <= seconds) ++key;
    const std::size_t next = std::min(key + 1, times.size() - 1);
    const double span = times[next] - times[key];
    const double fraction = span > 0 ? std::clamp((seconds - times[key]) / span, 0.0, 1.0) : 0;
    const std::string& path = channel.target.path;
    Transform& local = locals[*channel.target.node];
    const auto at = [&](std::size_t k, Index components, Index i) { return double{values[components * k + i]}; };
    if (path == "rotation") {
      const Quat a(at(key, 4, 3), at(key, 4, 0), at(key, 4, 1), at(key, 4, 2));
      const Quat b(at(next, 4, 3), at(next, 4, 0), at(next, 4, 1), at(next, 4, 2));
      local.rotation = a.normalized().slerp(fraction, b.normalized());
    } else {
      Vec3& vector = path == "translation" ? local.translation : local.scale;
      for (Index i = 0; i < 3; ++i) vector[i] = (1 - fraction) * at(key, 3, i) + fraction * at(next, 3, i);
    }
  }
  return locals;
}

struct Shown {
  std::vector<Vec3> positions, normals, tangents, morphed;
};

// All vertices of all skinned nodes, node by node, at the positions where a viewer shows them.
Shown show(const Asset& asset, const std::vector<Transform>& locals) {
  const SceneGraph graph = readSceneGraph(asset.document);
  std::vector<Affine> world(locals.size());
  for (const Index n : graph.allNodes) {
    world[n] = (graph.parent[n] ? world[*graph.parent[n]] : Affine::Identity()) * locals[n].toAffine();
  }
  Shown result;
  for (const gltf::Node& node : asset.document.nodes) {
    if (!node.skin) continue;
    const SkinBinding binding = readSkinBinding(asset, *node.skin);
    for (const gltf::Primitive& primitive : asset.document.meshes[*node.mesh].primitives) {
      const auto read = [&](const gltf::Attributes& attributes, const char* name) {
        const std::optional<Index> accessor = attributes.find(name);
        return accessor ? readFloats(asset, *accessor) : std::vector<float>();
      };
      const std::vector<float> p = read(primitive.attributes, "POSITION");
      const std::vector<float> n = read(primitive.attributes, "NORMAL");
      const std::vector<float> t = read(primitive.attributes, "TANGENT");
      const std::vector<float> m =
          primitive.targets.empty() ? std::vector<float>() : read(primitive.targets[0], "POSITION");
      const InfluenceSet set = readInfluenceSets(asset, primitive).at(0);
      for (std::size_t v = 0; 3 * v < p.size(); ++v) {
        Mat4 map = Mat4::Zero();
        for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
          const Index j = set.joints[i];
          map += set.weights[i] * (world[binding.joints[j]] * binding.inverseBinds[j]).matrix();
        }
        const Affine affine(map);
        const Vec3 at(p[3 * v], p[3 * v + 1], p[3 * v + 2]);
        result.positions.push_back(affine * at);
        if (!n.empty()) result.normals.push_back(affine.linear() * Vec3(n[3 * v], n[3 * v + 1], n[3 * v + 2]));
        if (!t.empty()) result.tangents.push_back(affine.linear() * Vec3(t[4 * v], t[4 * v + 1], t[4 * v + 2]));
        if (!m.empty()) result.morphed.push_back(affine * Vec3(at + Vec3(m[3 * v], m[3 * v + 1], m[3 * v + 2])));
      }
    }
  }
  return result;
}

void expectSame(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  double size = 0, worst = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    size = std::max(size, a[v].norm());
    worst = std::max(worst, (a[v] - b[v]).norm());
  }
  EXPECT_LE(worst, 1e-5 * size) << what;
}

void expectClipsLookTheSame(const Asset& before, const Asset& after) {
  ASSERT_EQ(before.document.animations.size(), after.document.animations.size());
  for (Index animation = 0; animation < before.document.animations.size(); ++animation) {
    for (double seconds = -0.1; seconds < 2; seconds += 0.13) {
      const Shown a = show(before, localsAt(before, animation, seconds));
      const Shown b = show(after, localsAt(after, animation, seconds));
      expectSame(a.positions, b.positions, "positions");
      expectSame(a.normals, b.normals, "normals");
      expectSame(a.tangents, b.tangents, "tangents");
      expectSame(a.morphed, b.morphed, "morph targets");
    }
  }
}

std::vector<Transform> standing(const Asset& asset) {
  std::vector<Transform> locals;
  for (const gltf::Node& node : asset.document.nodes) locals.push_back(decompose(nodeTransform(node)));
  return locals;
}

// The pose of the nodes, with every joint turned and moved.
Pose otherPose(const Asset& asset, const AssetSkeleton& skeleton, Random& random) {
  Pose pose = readNodePose(asset, skeleton);
  for (Transform& local : pose.locals) {
    local.rotation = (local.rotation * random.rotation()).normalized();
    local.translation += 0.2 * random.vector();
  }
  return pose;
}

TwoSkins dressedCharacter() {
  TwoSkins c;
  const Index body = c.rigidMesh(4), coat = c.rigidMesh(2), both = c.rigidMesh(2);
  std::vector<Index> roots = {c.hip};
  roots.push_back(c.scene.addNode({{"name", "body"}, {"mesh", body}, {"skin", c.bodySkin}}));
  roots.push_back(c.scene.addNode({{"name", "coat"}, {"mesh", coat}, {"skin", c.coatSkin}}));
  roots.push_back(c.scene.addNode({{"name", "one"}, {"mesh", both}, {"skin", c.bodySkin}}));
  roots.push_back(c.scene.addNode({{"name", "other"}, {"mesh", both}, {"skin", c.coatSkin}}));
  c.scene.addScene(roots);
  c.addTurn(c.arm, 4);
  c.addTurn(c.hip, 1);
  c.addTurn(c.leg, 3);
  return c;
}

TEST(RestPose, ClipsLookTheSameAndThePoseIsTheBindPose) {
  TwoSkins c = dressedCharacter();
  Asset asset = c.scene.build();
  const Asset before = asset.clone();
  const AssetSkeleton skeleton = readSkeleton(asset);
  const Pose pose = otherPose(asset, skeleton, c.random);
  Asset posed = before.clone();
  writeNodePose(posed, skeleton, pose);

  setRestPose(asset, skeleton, pose);
  checkAsset(asset);
  expectClipsLookTheSame(before, asset);
  const Shown a = show(posed, standing(posed)), b = show(asset, standing(asset));
  expectSame(a.positions, b.positions, "positions");
  expectSame(a.normals, b.normals, "normals");
  EXPECT_TRUE(asset.warnings.empty());

  const AssetSkeleton after = readSkeleton(asset);
  const Pose stance = readNodePose(asset, after);
  for (Index j = 0; j < after.skeleton.jointCount(); ++j) {
    const Affine rest = after.skeleton.joints[j].rest.toAffine(), now = stance.locals[j].toAffine();
    EXPECT_LT((rest.matrix() - now.matrix()).cwiseAbs().maxCoeff(), 1e-5) << j;
  }
}

// The coat was put on in another pose than the body: by the file each vertex goes with its own skin's inverse binds.
TEST(RestPose, ASkinBoundInAnotherPoseIsBroughtToThatOfItsJoints) {
  TwoSkins c = dressedCharacter();
  for (const Index joint : {c.chest, c.hip}) {
    c.bind[joint] = Affine(Eigen::Translation3d(c.random.vector()) * c.random.rotation());
  }
  const Index other = c.scene.addSkin({c.chest, c.hip}, c.inverses({c.chest, c.hip}));
  std::vector<gltf::Skin>& skins = c.scene.asset().document.skins;
  skins[c.coatSkin].inverseBindMatrices = skins[other].inverseBindMatrices;
  skins.pop_back();
  Asset asset = c.scene.build();
  const Asset before = asset.clone();
  const BindPose bind = readBindPose(asset, readSceneGraph(asset.document));
  EXPECT_THAT(skinsBoundElsewhere(asset, bind), ::testing::ElementsAre(c.coatSkin));
  ASSERT_TRUE(joinBindPoses(asset));
  checkAsset(asset);
  expectClipsLookTheSame(before, asset);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "joined-binds");
  EXPECT_FALSE(joinBindPoses(asset));
  EXPECT_FALSE(withJoinedBinds(asset));

  // What collectGeometry shows now is what the joints make of it in the bind pose.
  const BindPose after = readBindPose(asset, readSceneGraph(asset.document));
  std::vector<Transform> locals;
  const SceneGraph graph = readSceneGraph(asset.document);
  for (Index n = 0; n < graph.nodeCount(); ++n) {
    const std::optional<Index> parent = graph.parent[n];
    const Affine above = parent ? after.nodeWorld[*parent] : Affine::Identity();
    locals.push_back(decompose(above.inverse(Eigen::Affine) * after.nodeWorld[n]));
  }
  std::vector<Vec3> collected;
  for (const Vec3f& position : collectGeometry(asset).positions) collected.push_back(position.cast<double>());
  expectSame(show(before, locals).positions, collected, "positions in the bind pose");
}

TEST(RestPose, ASkinWithoutInverseBindsIsBoundByTheIdentity) {
  TwoSkins c;
  const Index mesh = c.rigidMesh(4);
  c.scene.asset().document.skins[c.bodySkin].inverseBindMatrices.reset();
  c.scene.addScene({c.hip, c.scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", c.bodySkin}})});
  c.addTurn(c.chest, 3);
  const Asset before = c.scene.build();
  const std::optional<Asset> joined = withJoinedBinds(before);
  ASSERT_TRUE(joined);
  checkAsset(*joined);
  EXPECT_TRUE(before.warnings.empty());
  expectClipsLookTheSame(before, *joined);
  std::vector<Vec3> collected;
  for (const Vec3f& position : collectGeometry(*joined).positions) collected.push_back(position.cast<double>());
  expectSame(show(before, standing(before)).positions, collected, "positions as the nodes stand");
}

TEST(RestPose, SkinsOfOnePoseStayAsTheyAre) {
  TwoSkins c = dressedCharacter();
  EXPECT_FALSE(withJoinedBinds(c.scene.build()));
}

TEST(RestPose, AMeshThatIsShownWithoutASkinTooStaysAsItIsThere) {
  TwoSkins c;
  const Index mesh = c.rigidMesh(2);
  const Index statue = c.scene.addNode({{"name", "statue"}, {"mesh", mesh}});
  const Index body = c.scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", c.coatSkin}});
  c.scene.addScene({c.hip, statue, body});
  c.addTurn(c.chest, 3);
  Asset asset = c.scene.build();
  const Asset before = asset.clone();
  const AssetSkeleton skeleton = readSkeleton(asset);
  setRestPose(asset, skeleton, otherPose(asset, skeleton, c.random));
  checkAsset(asset);
  expectClipsLookTheSame(before, asset);
  EXPECT_EQ(documentJson(asset)["nodes"][statue], documentJson(before)["nodes"][statue]);
  EXPECT_EQ(asset.document.meshes[mesh].name, before.document.meshes[mesh].name);
  const auto positions = [&](const Asset& of) {
    return readFloats(of, *of.document.meshes[mesh].primitives[0].attributes.find("POSITION"));
  };
  EXPECT_EQ(positions(asset), positions(before));
}

// The middle of an arm that bends: right in the new rest pose, and the file says that clips cannot be kept there.
TEST(RestPose, SharedVerticesAreRightInThePoseAndCounted) {
  TwoSkins c;
  const Index mesh = c.scene.addTetrahedron();
  const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  const std::vector<float> weights = {0.5f, 0.5f, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0};
  c.scene.bind(mesh, joints, weights);
  const Index body = c.scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", c.coatSkin}});
  c.scene.addScene({c.hip, body});
  Asset asset = c.scene.build();
  const AssetSkeleton skeleton = readSkeleton(asset);
  const Pose pose = otherPose(asset, skeleton, c.random);
  Asset posed = asset.clone();
  writeNodePose(posed, skeleton, pose);
  setRestPose(asset, skeleton, pose);
  expectSame(show(posed, standing(posed)).positions, show(asset, standing(asset)).positions, "positions");
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "shared-vertices");
  EXPECT_EQ(asset.warnings.items()[0].count, 3u);
}

// All joints moved alike: then shared vertices keep their clips too.
TEST(RestPose, WhatMovesAsAWholeKeepsItsClips) {
  TwoSkins c;
  const Index mesh = c.scene.addTetrahedron();
  const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  const std::vector<float> weights(16, 0.25f);
  c.scene.bind(mesh, joints, weights);
  const Index body = c.scene.addNode({{"name", "body"}, {"mesh", mesh}, {"skin", c.coatSkin}});
  c.scene.addScene({c.hip, body});
  c.addTurn(c.chest, 4);
  Asset asset = c.scene.build();
  const Asset before = asset.clone();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = restPose(skeleton.skeleton);
  const Affine whole(Eigen::Translation3d(1, 2, 3) * c.random.rotation());
  const Index root = *skeleton.skeleton.find("hip");
  pose.locals[root] = decompose(whole * pose.locals[root].toAffine());
  setRestPose(asset, skeleton, pose);
  expectClipsLookTheSame(before, asset);
  EXPECT_TRUE(asset.warnings.empty());
}

TEST(RestPose, FlatJointsAreRefused) {
  TwoSkins c;
  const Index mesh = c.rigidMesh(2);
  c.scene.addScene({c.hip, c.scene.addNode({{"mesh", mesh}, {"skin", c.coatSkin}})});
  Asset asset = c.scene.build();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Pose pose = readNodePose(asset, skeleton);
  pose.locals[*skeleton.skeleton.find("chest")].scale.setZero();
  EXPECT_THROW(setRestPose(asset, skeleton, pose), Error);
  pose.locals.pop_back();
  EXPECT_THROW(setRestPose(asset, skeleton, pose), Error);
}

}  // namespace
}  // namespace limber
