#include "limber/document/smpl/smpl_body.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/actions/transfer/transfer_asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/blend_shapes.h"
#include "limber/document/testing/npy_bytes.h"
#include "limber/rigging/transfer/testing/capsule_person.h"
#include "warning_kinds.h"

namespace limber {

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::npyDoubles;
using testing::npyHeader;
using testing::npyOf;
using testing::rawBytes;

// The body's own arrays. Joints that no row of vertices gives: as J.
NpzFiles arraysOf(const RiggedBody& body) {
  const std::size_t vertices = body.mesh.vertexCount(), joints = body.skeleton.jointCount();
  std::vector<double> positions, coordinates;
  for (const Vec3f& p : body.mesh.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
  for (const Vec3& p : testing::jointPositions(body.skeleton))
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : body.mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::vector<double> weights(vertices * joints, 0);
  for (Index v = 0; v < vertices; ++v) {
    for (Index slot = 0; slot < body.weights.slots; ++slot) {
      weights[v * joints + body.weights.jointsOf(v)[slot]] += body.weights.weightsOf(v)[slot];
    }
  }
  std::vector<std::int64_t> tree;
  for (const Joint& joint : body.skeleton.joints) tree.push_back(joint.parent ? std::int64_t{*joint.parent} : -1);
  for (std::size_t j = 0; j < joints; ++j) tree.push_back(static_cast<std::int64_t>(j));
  NpzFiles files;
  files["v_template.npy"] = npyDoubles({vertices, 3}, positions);
  files["f.npy"] = npyOf(npyHeader("<u4", testing::shapeText({corners.size() / 3, 3})), rawBytes(corners));
  files["weights.npy"] = npyDoubles({vertices, joints}, weights);
  files["kintree_table.npy"] = npyOf(npyHeader("<i8", testing::shapeText({2, joints})), rawBytes(tree));
  files["J.npy"] = npyDoubles({joints, 3}, coordinates);
  return files;
}

// A square in two triangles on two joints.
NpzFiles smallBody() {
  NpzFiles files;
  files["v_template.npy"] = npyDoubles({4, 3}, {0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0});
  files["f.npy"] = npyOf(npyHeader("<u4", "(2, 3)"), rawBytes<std::uint32_t>({0, 1, 2, 0, 2, 3}));
  files["weights.npy"] = npyDoubles({4, 2}, {1, 0, 1, 0, 0.25, 0.75, 0, 1});
  files["kintree_table.npy"] = npyOf(npyHeader("<u4", "(2, 2)"), rawBytes<std::uint32_t>({0xffffffffu, 0, 0, 1}));
  files["J_regressor.npy"] = npyDoubles({2, 4}, {0.5, 0.5, 0, 0, 0, 0, 0.5, 0.5});
  return files;
}

TEST(SmplBodyTest, JointsAndWeightsAreThoseOfTheArrays) {
  const Asset asset = smplBody(smallBody(), "small.npz");
  const AssetSkeleton skeleton = readSkeleton(asset);
  ASSERT_EQ(skeleton.skeleton.jointCount(), 2u);
  EXPECT_EQ(skeleton.skeleton.joints[0].name, "joint_00");
  EXPECT_EQ(skeleton.skeleton.joints[1].parent, Index{0});
  const std::vector<Vec3> positions = testing::jointPositions(skeleton.skeleton);
  EXPECT_LT((positions[0] - Vec3(0.5, 0, 0)).norm(), 1e-6);  // the middle of the lower edge, and of the upper one
  EXPECT_LT((positions[1] - Vec3(0.5, 2, 0)).norm(), 1e-6);
  const Geometry geometry = collectGeometry(asset);
  EXPECT_EQ(geometry.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  const SkinWeights weights = readWeights(asset, geometry, skeleton);
  EXPECT_EQ(weights.jointsOf(2)[0], 1u);
  EXPECT_FLOAT_EQ(weights.weightsOf(2)[0], 0.75f);
  EXPECT_FLOAT_EQ(weights.weightsOf(2)[1], 0.25f);
  EXPECT_FLOAT_EQ(weights.weightsOf(0)[0], 1);
  EXPECT_TRUE(asset.warnings.empty());
}

TEST(SmplBodyTest, ShapesBecomeBlendShapesTenAtMost) {
  NpzFiles files = smallBody();
  std::vector<double> shapes(4 * 3 * 12);
  for (std::size_t i = 0; i < shapes.size(); ++i) shapes[i] = 0.01 * static_cast<double>(i + 1);
  files["shapedirs.npy"] = npyDoubles({4, 3, 12}, shapes);
  files["posedirs.npy"] = npyOf(npyHeader("|O", "(1,)"), {0x80});  // is not looked into
  const Asset asset = smplBody(files, "small.npz");
  const std::vector<BlendShape> found = readBlendShapes(asset, collectGeometry(asset));
  ASSERT_EQ(found.size(), 10u);
  EXPECT_EQ(found[9].name, "shape_09");
  for (std::size_t s = 0; s < found.size(); ++s) {
    for (std::size_t v = 0; v < 4; ++v) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_FLOAT_EQ(found[s].offsets[v][static_cast<Eigen::Index>(axis)],
                        static_cast<float>(shapes[(3 * v + axis) * 12 + s]));
      }
    }
  }
  EXPECT_THAT(testing::warningKinds(asset.warnings), ElementsAre("pose-shapes"));
}

TEST(SmplBodyTest, TwentyFourJointsAreSmpls) {
  NpzFiles files = smallBody();
  std::vector<double> weights(4 * 24, 1.0 / 24), positions(24 * 3, 0.5);
  std::vector<std::int32_t> tree;
  for (int j = 0; j < 24; ++j) tree.push_back(j - 1);
  for (int j = 0; j < 24; ++j) tree.push_back(j);
  files.erase("J_regressor.npy");
  files["weights.npy"] = npyDoubles({4, 24}, weights);
  files["J.npy"] = npyDoubles({24, 3}, positions);
  files["kintree_table.npy"] = npyOf(npyHeader("<i4", "(2, 24)"), rawBytes(tree));
  const Asset asset = smplBody(files, "small.npz");
  const AssetSkeleton skeleton = readSkeleton(asset);
  EXPECT_EQ(skeleton.skeleton.joints[0].name, "pelvis");
  EXPECT_EQ(skeleton.skeleton.joints[15].name, "head");
  EXPECT_EQ(skeleton.skeleton.joints[21].name, "right_wrist");
  const SkinWeights read = readWeights(asset, collectGeometry(asset), skeleton);
  EXPECT_EQ(read.slots, 8u);
  EXPECT_FLOAT_EQ(read.weightsOf(0)[7], 0.125f);
}

void expectRefusal(const NpzFiles& files, const std::string& what) {
  try {
    smplBody(files, "small.npz");
    ADD_FAILURE() << "took it, not: " << what;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(what));
    EXPECT_THAT(error.where(), ::testing::StartsWith("small.npz"));
  }
}

TEST(SmplBodyTest, NamesTheArrayThatIsMissing) {
  for (const char* name : {"v_template", "f", "weights", "kintree_table"}) {
    NpzFiles files = smallBody();
    files.erase(std::string(name) + ".npy");
    expectRefusal(files, std::string("holds no array '") + name + "'");
  }
  NpzFiles files = smallBody();
  files.erase("J_regressor.npy");
  expectRefusal(files, "holds no array 'J'");
  expectRefusal({}, "holds no array 'v_template'");
}

TEST(SmplBodyTest, RefusesArraysThatDoNotGoTogether) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto with = [](const char* name, Bytes bytes) {
    NpzFiles files = smallBody();
    files[name] = std::move(bytes);
    return files;
  };
  expectRefusal(with("v_template.npy", npyDoubles({12}, std::vector<double>(12))), "(12), not rows of three");
  expectRefusal(with("v_template.npy", npyDoubles({0, 3}, {})), "not rows of three");
  expectRefusal(with("v_template.npy", npyDoubles({3, 3}, std::vector<double>(9))), "f.npy: triangle 1");
  expectRefusal(with("v_template.npy", npyDoubles({4, 3}, std::vector<double>(12, 1e300))), "row 0 is not finite");
  expectRefusal(with("f.npy", npyDoubles({1, 3}, {0, 1, 1.5})), "corner that is no vertex");
  expectRefusal(with("f.npy", npyDoubles({1, 3}, {0, 1, -1})), "corner that is no vertex");
  expectRefusal(with("f.npy", npyDoubles({1, 4}, {0, 1, 2, 3})), "not rows of three");
  expectRefusal(with("weights.npy", npyDoubles({2, 4}, std::vector<double>(8, 1))), "(2, 4), not (4, 4)");
  expectRefusal(with("weights.npy", npyDoubles({4, 2}, {1, 0, 0, 0, 1, 0, 1, 0})), "row 1 has no weight");
  expectRefusal(with("weights.npy", npyDoubles({4, 2}, {1, 0, 1, inf, 1, 0, 1, 0})), "row 1 is not finite");
  expectRefusal(with("kintree_table.npy", npyDoubles({2, 3}, std::vector<double>(6))), "(2, 4), not (3, 4)");
  expectRefusal(with("kintree_table.npy", npyDoubles({2, 2}, {-1, 1, 0, 1})), "does not come before");
  expectRefusal(with("kintree_table.npy", npyDoubles({2, 2}, {-1, 0.5, 0, 1})), "does not come before");
  expectRefusal(with("kintree_table.npy", npyDoubles({2, 2}, {-1, 0, 0, 2})), "joint 1 has another number");
  expectRefusal(with("J_regressor.npy", npyDoubles({2, 3}, std::vector<double>(6))), "(2, 3), not (2, 4)");
  expectRefusal(with("J_regressor.npy", npyDoubles({2, 4}, std::vector<double>(8, inf))), "is not finite");
  expectRefusal(with("shapedirs.npy", npyDoubles({4, 3}, std::vector<double>(12))), "shapedirs.npy: has the shape");
  expectRefusal(with("shapedirs.npy", npyDoubles({4, 3, 1}, std::vector<double>(12, inf))), "is not finite");
  expectRefusal(with("weights.npy", npyOf(npyHeader("|O", "(4, 2)"), {0x80, 4})), "weights.npy: holds Python objects");
}

// What a broken array gives is a valid document or an error, never harm.
TEST(SmplBodyTest, TakesNoHarmFromBrokenArrays) {
  std::size_t refused = 0;
  for (const auto& [name, whole] : smallBody()) {
    for (std::size_t at = 0; at < whole.size(); ++at) {
      NpzFiles cut = smallBody(), patched = smallBody();
      cut[name].resize(at);
      EXPECT_THROW(smplBody(cut, "small.npz"), Error);
      patched[name][at] ^= 0xff;
      try {
        smplBody(patched, "small.npz");
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 500u);
}

TEST(SmplBodyTest, ItsRigGoesOntoAnotherBody) {
  const RiggedBody person = testing::riggedCapsulePerson();
  const Asset source = smplBody(arraysOf(person), "person.npz");
  RiggedBody other = person;
  for (Vec3f& p : other.mesh.positions) p *= 1.3f;
  for (Joint& joint : other.skeleton.joints) joint.rest.translation *= 1.3;
  Asset target = smplBody(arraysOf(other), "other.npz");
  TransferAssetOptions options;
  options.rig.registration.reaches = {0.05, 0.02};
  options.rig.registration.rounds = 1;
  Progress progress;
  transferOnto(source, target, options, progress);
  const std::vector<Vec3> wanted = testing::jointPositions(other.skeleton);
  const std::vector<Vec3> found = testing::jointPositions(readSkeleton(target).skeleton);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t j = 0; j < wanted.size(); ++j) EXPECT_LT((found[j] - wanted[j]).norm(), 0.005) << j;
}

}  // namespace

}  // namespace limber
