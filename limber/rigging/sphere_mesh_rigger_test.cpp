#include "limber/rigging/sphere_mesh_rigger.h"

#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/surface/testing/shape_meshes.h"
#include "shared_data.h"

namespace limber {

namespace {

AutoRig rigged(const TriMesh& mesh, std::optional<Index> handles) {
  Progress progress;
  return rigWithSphereMesh(mesh, {handles}, progress);
}

TEST(SphereMeshRigger, MakesASoundSkeletonOfTheCountAskedFor) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    for (const Index count : {1u, 2u, 3u, 6u, 20u, 100u}) {
      if (count > mesh.vertexCount()) continue;
      const Skeleton skeleton = rigged(mesh, count).skeleton;
      EXPECT_EQ(skeleton.jointCount(), count);
      EXPECT_EQ(skeleton.boneShape, BoneShape::kSphere);
      EXPECT_NO_THROW(checkSkeleton(skeleton));
      for (const Joint& joint : skeleton.joints) {
        EXPECT_TRUE(joint.rest.rotation.isApprox(Quat::Identity()));
        EXPECT_EQ(joint.rest.scale, Vec3(Vec3::Ones()));
      }
    }
  }
}

TEST(SphereMeshRigger, WhatIsRememberedGivesTheSame) {
  const TriMesh mesh = testing::blockBiped(1);
  RigOptions options;
  options.memory = std::make_shared<RigMemory>();
  for (const Index count : {20u, 7u, 20u, 33u}) {
    options.handles = count;
    Progress progress;
    const Skeleton known = rigWithSphereMesh(mesh, options, progress).skeleton, fresh = rigged(mesh, count).skeleton;
    ASSERT_EQ(known.jointCount(), fresh.jointCount());
    for (Index j = 0; j < known.jointCount(); ++j) {
      EXPECT_EQ(known.joints[j].name, fresh.joints[j].name);
      EXPECT_EQ(known.joints[j].rest.translation, fresh.joints[j].rest.translation);
    }
  }
  ASSERT_TRUE(options.memory->spheres);
  EXPECT_EQ(options.memory->spheres->vertexCount(), mesh.vertexCount());
}

TEST(SphereMeshRigger, JointsStandAtTheSpheres) {
  const TriMesh mesh = testing::blockBiped(1);
  Progress progress;
  const SphereMesh spheres = SphereMesh::build(mesh, progress);
  const SphereMeshLevel level = spheres.level(17);
  const Skeleton skeleton = handleSkeleton(spheres, 17);
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::set<std::size_t> met;
  for (std::size_t j = 0; j < 17; ++j) {
    std::size_t nearest = 0;
    const auto distance = [&](std::size_t h) { return (level.spheres[h].center - globals[j].translation()).norm(); };
    for (std::size_t h = 1; h < 17; ++h) {
      if (distance(h) < distance(nearest)) nearest = h;
    }
    EXPECT_LT(distance(nearest), 1e-9);
    EXPECT_EQ(skeleton.joints[j].radius, level.spheres[nearest].radius);
    met.insert(nearest);
  }
  EXPECT_EQ(met.size(), 17u);
}

TEST(SphereMeshRigger, TheRegionOfAJointIsWhatItsSphereRepresents) {
  const TriMesh mesh = testing::blockBiped(1);
  const AutoRig rig = rigged(mesh, 17);
  const std::vector<Affine> globals = restGlobals(rig.skeleton);
  Progress progress;
  const SphereMesh spheres = SphereMesh::build(mesh, progress);
  const SphereMeshLevel level = spheres.level(17);
  const std::vector<Index> sphereOf = spheres.vertexHandles(17);
  ASSERT_EQ(rig.jointOf.size(), sphereOf.size());
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((globals[rig.jointOf[v]].translation() - level.spheres[sphereOf[v]].center).norm(), 1e-9);
  }
}

TEST(SphereMeshRigger, NamesTellTheSides) {
  const Skeleton skeleton = rigged(testing::blockBiped(1), 21).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  EXPECT_EQ(skeleton.joints[0].name, "handle_00");
  std::size_t pairs = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::string& name = skeleton.joints[j].name;
    const double x = globals[j].translation().x();
    const std::string side = name.size() > 9 ? name.substr(9) : "";
    EXPECT_EQ(side, x > 0 ? ".L" : x < 0 ? ".R" : "") << name;
    if (side != ".L") continue;
    ++pairs;
    const std::optional<Index> image = skeleton.find(name.substr(0, 9) + ".R");
    ASSERT_TRUE(image);
    const Vec3 p = globals[j].translation(), q = globals[*image].translation();
    EXPECT_EQ(Vec3(-p.x(), p.y(), p.z()), q);
  }
  EXPECT_GE(pairs, 6u);
}

TEST(SphereMeshRigger, NumbersAreAsWideAsTheLargestNeeds) {
  EXPECT_EQ(rigged(testing::jittered(testing::ball(2), 0.1f), 66).skeleton.joints[65].name, "handle_65");
  const Skeleton large = rigged(testing::jittered(testing::ball(3), 0.1f), 101).skeleton;
  EXPECT_EQ(large.joints[0].name, "handle_000");
  EXPECT_EQ(large.joints[100].name, "handle_100");
}

TEST(SphereMeshRigger, SuggestionsAreCountsThatItCanGiveBestFirst) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    const AutoRig rig = rigged(mesh, std::nullopt);
    ASSERT_FALSE(rig.suggestions.empty());
    EXPECT_EQ(rig.skeleton.jointCount(), rig.suggestions[0].handles);
    std::set<Index> counts;
    for (std::size_t i = 0; i < rig.suggestions.size(); ++i) {
      const HandleSuggestion& s = rig.suggestions[i];
      EXPECT_GE(s.handles, 1u);
      EXPECT_LE(s.handles, mesh.vertexCount());
      EXPECT_GE(s.score, 0);
      EXPECT_LE(s.score, 1);
      EXPECT_LE(s.score, rig.suggestions[i > 0 ? i - 1 : 0].score);
      EXPECT_TRUE(counts.insert(s.handles).second);
    }
  }
}

TEST(SphereMeshRigger, RefusesMoreHandlesThanVertices) {
  for (const Index count : {0u, 7u}) {
    try {
      rigged(testing::octahedron(), count);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
      EXPECT_NE(std::string(error.what()).find("1 to 6"), std::string::npos);
    }
  }
}

TEST(SphereMeshRigger, IsInTheTable) {
  EXPECT_EQ(findRigger("sphere-mesh").name, "sphere-mesh");
  EXPECT_THROW(findRigger("nonesuch"), Error);
}

// Positions and faces alone.
TriMesh readObj(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3f p;
      words >> p.x() >> p.y() >> p.z();
      positions.push_back(p);
    } else if (kind == "f") {
      std::vector<Index> corners;
      for (std::string corner; words >> corner;) corners.push_back(static_cast<Index>(std::stoul(corner)) - 1);
      for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  return prepareMesh(positions, triangles).mesh;
}

TEST(SphereMeshRigger, SharedModelsAreMirroredAtEveryCount) {
  const auto folder = testing::sharedDataFolder();
  if (!folder) GTEST_SKIP() << testing::kNoSharedData;
  for (const char* name : {"makehuman_body_quads.obj", "spot_control_mesh.obj", "fish_control_mesh.obj", "wuson.obj"}) {
    SCOPED_TRACE(name);
    const TriMesh mesh = readObj(*folder / "meshes" / name);
    Progress progress;
    const SphereMesh spheres = SphereMesh::build(mesh, progress);
    ASSERT_TRUE(spheres.mirror());
    for (Index count = 1; count <= std::min<Index>(100, mesh.vertexCount()); ++count) {
      const SphereMeshLevel level = spheres.level(count);
      ASSERT_EQ(level.spheres.size(), count);
      for (Index h = 0; h < count; ++h) {
        Vec3 mirrored = level.spheres[h].center;
        mirrored.x() = -mirrored.x();
        ASSERT_EQ(level.spheres[level.images[h]].center, mirrored);
      }
    }
  }
}

}  // namespace

}  // namespace limber
