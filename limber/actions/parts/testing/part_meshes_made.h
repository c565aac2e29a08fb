// Surfaces whose parts are known, made in code for tests. Not installed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// A closed surface of revolution about the x axis from 0 to `length`: `radius` at each x, closed by fans.
inline TriMesh revolved(double length, int rings, int around, const std::function<double(double)>& radius) {
  TriMesh mesh;
  for (int ring = 0; ring < rings; ++ring) {
    const double x = length * ring / (rings - 1);
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * kPi * i / around;
      mesh.positions.push_back(Vec3(x, radius(x) * std::cos(angle), radius(x) * std::sin(angle)).cast<float>());
    }
  }
  const auto at = [&](int ring, int i) { return static_cast<Index>(ring * around + i % around); };
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  const Index first = mesh.vertexCount(), last = first + 1;
  mesh.positions.push_back({0, 0, 0});
  mesh.positions.push_back({static_cast<float>(length), 0, 0});
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({first, at(0, i + 1), at(0, i)});
    mesh.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  return mesh;
}

// Two balls of radius 1 about x = 1 and x = 3.2 with a neck of radius 0.3 between them, at x = 2.1.
inline TriMesh dumbbell(int rings = 43, int around = 24) {
  return revolved(4.2, rings, around, [](double x) {
    const double t = x <= 2.1 ? x - 1 : x - 3.2;
    const double ball = std::sqrt(std::max(0.0, 1 - t * t));
    return x < 0.2 || x > 4 ? std::max(ball, 0.2) : std::max(ball, 0.3);
  });
}

inline double middleX(const TriMesh& mesh, Index triangle) {
  double sum = 0;
  for (const Index v : mesh.triangles[triangle]) sum += mesh.position(v).x();
  return sum / 3;
}

// A person of blocks, welded and closed: a trunk with four limbs and a head that are all thinner than it. Part
// numbers of its triangles: 0 trunk, 1 to 5 the limbs and the head.
struct BlockPerson {
  TriMesh mesh;
  std::vector<Index> partOf;
};

inline BlockPerson blockPerson() {
  struct Block {
    int part;
    Eigen::Vector3i from, to;
  };
  const std::vector<Block> blocks = {{0, {-4, 0, -2}, {4, 12, 2}}, {1, {-4, -16, -1}, {-1, 0, 1}},
                                     {2, {1, -16, -1}, {4, 0, 1}}, {3, {-16, 9, -1}, {-4, 11, 1}},
                                     {4, {4, 9, -1}, {16, 11, 1}}, {5, {-2, 12, -1}, {2, 18, 1}}};
  const auto blockAt = [&](const Eigen::Vector3i& cell) {
    for (const Block& block : blocks) {
      if ((cell.array() >= block.from.array()).all() && (cell.array() < block.to.array()).all()) return block.part;
    }
    return -1;
  };
  BlockPerson person;
  std::map<std::array<int, 3>, Index> known;
  const auto vertex = [&](const Eigen::Vector3i& at) {
    const auto [entry, fresh] = known.try_emplace({at.x(), at.y(), at.z()}, person.mesh.vertexCount());
    if (fresh) person.mesh.positions.push_back(0.1f * at.cast<float>());
    return entry->second;
  };
  for (const Block& block : blocks) {
    for (int x = block.from.x(); x < block.to.x(); ++x) {
      for (int y = block.from.y(); y < block.to.y(); ++y) {
        for (int z = block.from.z(); z < block.to.z(); ++z) {
          for (int side = 0; side < 6; ++side) {
            Eigen::Vector3i step = Eigen::Vector3i::Zero(), u = step, v = step, cell(x, y, z);
            step[side / 2] = side % 2 ? 1 : -1;
            if (blockAt(cell + step) >= 0) continue;
            u[(side / 2 + 1) % 3] = 1;
            v[(side / 2 + 2) % 3] = 1;
            if (side % 2 == 0) std::swap(u, v);
            const Eigen::Vector3i corner = side % 2 ? Eigen::Vector3i(cell + step) : cell;
            const Index a = vertex(corner), b = vertex(corner + u), c = vertex(corner + u + v), d = vertex(corner + v);
            person.mesh.triangles.push_back({a, b, c});
            person.mesh.triangles.push_back({a, c, d});
            person.partOf.insert(person.partOf.end(), 2, static_cast<Index>(block.part));
          }
        }
      }
    }
  }
  return person;
}

// The mesh as a document with one node; with vertices of its own for each triangle where `unwelded`.
inline Asset assetOf(const TriMesh& mesh, bool unwelded = false) {
  SceneBuilder builder;
  std::vector<Vec3f> positions = mesh.positions;
  std::vector<Triangle> triangles = mesh.triangles;
  if (unwelded) {
    positions.clear();
    for (Triangle& t : triangles) {
      for (Index& v : t) {
        positions.push_back(mesh.positions[v]);
        v = static_cast<Index>(positions.size() - 1);
      }
    }
  }
  Json primitives = Json::array({builder.primitive(positions, triangles)});
  const Index made = builder.addMesh(std::move(primitives), "body");
  builder.addNode({{"name", "body"}, {"mesh", made}, {"translation", {1, 2, 3}}});
  builder.addScene({0});
  return std::move(builder.asset());
}

// Two joints along x, at 0 and at `bend`; the second takes over linearly within `width` of the bend.
inline Skeleton twoJoints(double bend) {
  Skeleton skeleton;
  for (Index j = 0; j < 2; ++j) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = j == 0 ? "lower" : "upper";
    if (j > 0) joint.parent = 0;
    joint.rest.translation = Vec3(j == 0 ? 0 : bend, 0, 0);
  }
  return skeleton;
}

inline SkinWeights twoJointWeights(std::span<const Vec3f> positions, double bend, double width, double offset = 0) {
  SkinWeights weights;
  weights.slots = 2;
  for (const Vec3f& p : positions) {
    const double t = std::clamp((static_cast<double>(p.x()) - offset - bend) / width + 0.5, 0.0, 1.0);
    const bool upper = t > 0.5;
    weights.joints.insert(weights.joints.end(), {upper ? 1u : 0u, upper ? 0u : 1u});
    weights.weights.push_back(static_cast<float>(std::max(t, 1 - t)));
    weights.weights.push_back(static_cast<float>(std::min(t, 1 - t)));
  }
  return weights;
}

}  // namespace limber::testing
