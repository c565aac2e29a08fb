// A rigged model as the text of an FBX file, Y up, in metres; as much of the format as programs need.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber::testing {

inline std::string fbxArray(std::string_view name, const std::vector<double>& values) {
  return fmt::format("{}: *{} {{\na: {}\n}}\n", name, values.size(), fmt::join(values, ","));
}

inline std::string fbxMatrix(std::string_view name, const Affine& map) {
  std::vector<double> values;
  for (int i = 0; i < 16; ++i) values.push_back(map.matrix()(i % 4, i / 4));
  return fbxArray(name, values);
}

inline std::string fbxGeometry(const TriMesh& mesh) {
  std::vector<double> positions, corners;
  for (const Vec3f& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<double>(p[k]));
  }
  for (const Triangle& t : mesh.triangles) {
    corners.insert(corners.end(), {double(t[0]), double(t[1]), -double(t[2]) - 1});
  }
  return "Geometry: 100, \"Geometry::Body\", \"Mesh\" {\n" + fbxArray("Vertices", positions) +
         fbxArray("PolygonVertexIndex", corners) + "}\n";
}

// The skeleton has no rotations.
inline std::string fbxText(const TriMesh& mesh, const Skeleton& skeleton, const SkinWeights& weights) {
  constexpr int kModel = 1000, kCluster = 2000;
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::string objects = fbxGeometry(mesh) + "Model: 200, \"Model::Body\", \"Mesh\" {\nVersion: 232\n}\n" +
                        "Deformer: 300, \"Deformer::Skin\", \"Skin\" {\nVersion: 101\n}\n";
  std::string links = "C: \"OO\",200,0\nC: \"OO\",100,200\nC: \"OO\",300,100\n";
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const Vec3& at = joint.rest.translation;
    objects += fmt::format("Model: {}, \"Model::{}\", \"LimbNode\" {{\nVersion: 232\nProperties70:  {{\n", kModel + j,
                           joint.name) +
               fmt::format("P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",{},{},{}\n}}\n}}\n", at.x(),
                           at.y(), at.z());
    links += fmt::format("C: \"OO\",{},{}\n", kModel + j, joint.parent ? kModel + int(*joint.parent) : 0);
    std::vector<double> vertices, fractions;
    for (Index v = 0; v < weights.vertexCount(); ++v) {
      for (Index slot = 0; slot < weights.slots; ++slot) {
        if (weights.jointsOf(v)[slot] != j || !(weights.weightsOf(v)[slot] > 0)) continue;
        vertices.push_back(v);
        fractions.push_back(static_cast<double>(weights.weightsOf(v)[slot]));
      }
    }
    if (vertices.empty()) continue;
    objects +=
        fmt::format("Deformer: {}, \"SubDeformer::{}\", \"Cluster\" {{\nVersion: 100\n", kCluster + j, joint.name) +
        fbxArray("Indexes", vertices) + fbxArray("Weights", fractions) + fbxMatrix("Transform", globals[j].inverse()) +
        fbxMatrix("TransformLink", globals[j]) + "}\n";
    links += fmt::format("C: \"OO\",{},300\nC: \"OO\",{},{}\n", kCluster + j, kModel + j, kCluster + j);
  }
  return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
         "GlobalSettings:  {\nVersion: 1000\nProperties70:  {\n"
         "P: \"UpAxis\", \"int\", \"Integer\", \"\",1\nP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "P: \"FrontAxis\", \"int\", \"Integer\", \"\",2\nP: \"FrontAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "P: \"CoordAxis\", \"int\", \"Integer\", \"\",0\nP: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n"
         "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n}\n}\n"
         "Objects:  {\n" +
         objects + "}\nConnections:  {\n" + links + "}\n";
}

}  // namespace limber::testing
