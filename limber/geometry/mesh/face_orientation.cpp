#include "limber/geometry/mesh/face_orientation.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

// How clearly an open patch must enclose its centroid for that to decide: 1 for a sphere, near 0 for a sheet.
constexpr double kClearlyEncloses = 0.2;
constexpr std::size_t kRayFaces = 16;  // of a patch, that rays begin at
constexpr double kRayMargin = 1e-5;    // diagonals of modelBox: what is nearer to a ray's ends does not block it

// Whether two triangles traverse their common edge in opposite directions, as neighbours should.
bool agree(const TriMesh& mesh, Index side, Index other) {
  return mesh.triangles[side / 3][side % 3] != mesh.triangles[other / 3][other % 3];
}

// Twice the area, along the normal.
Vec3 areaNormal(const TriMesh& mesh, Index t) {
  const Triangle& triangle = mesh.triangles[t];
  const Vec3 a = mesh.position(triangle[0]);
  return (mesh.position(triangle[1]) - a).cross(mesh.position(triangle[2]) - a);
}

Vec3 centroid(const TriMesh& mesh, Index t) {
  const Triangle& triangle = mesh.triangles[t];
  return (mesh.position(triangle[0]) + mesh.position(triangle[1]) + mesh.position(triangle[2])) / 3;
}

// Triangles that lead from one to the next across edges of two.
struct Patch {
  std::vector<Index> triangles;
  bool isClosed = true;
};

class FaceReverser {
 public:
  explicit FaceReverser(const TriMesh& mesh) : mesh_(mesh), across_(3 * mesh.triangles.size(), kNoIndex) {
    EdgeGroups(mesh.triangles, mesh.vertexCount()).forEachEdge([&](std::span<const Index> sides) {
      if (sides.size() != 2) return;
      across_[sides[0]] = sides[1];
      across_[sides[1]] = sides[0];
      allAgree_ = allAgree_ && agree(mesh, sides[0], sides[1]);
    });
  }

  // +1 for a triangle that stays as it is, -1 for one to reverse.
  std::vector<int> signs() {
    sign_.assign(mesh_.triangles.size(), 0);
    Patch patch;
    for (Index seed = 0; seed < mesh_.triangleCount(); ++seed) {
      if (sign_[seed] != 0) continue;
      grow(seed, patch);
      if (!facesInwards(patch)) continue;
      for (const Index t : patch.triangles) sign_[t] = -sign_[t];
    }
    return std::move(sign_);
  }

 private:
  void grow(Index seed, Patch& patch) {
    patch.triangles.assign(1, seed);
    patch.isClosed = true;
    sign_[seed] = 1;
    for (std::size_t next = 0; next < patch.triangles.size(); ++next) {
      const Index t = patch.triangles[next];
      for (Index side = 3 * t; side < 3 * t + 3; ++side) {
        const Index other = across_[side];
        if (other == kNoIndex) {
          patch.isClosed = false;
        } else if (sign_[other / 3] == 0) {
          sign_[other / 3] = agree(mesh_, side, other) ? sign_[t] : -sign_[t];
          patch.triangles.push_back(other / 3);
        }
      }
    }
  }

  bool facesInwards(const Patch& patch) {
    double stored = 0, area = 0;
    Vec3 middle = Vec3::Zero();
    for (const Index t : patch.triangles) {
      const double twice = areaNormal(mesh_, t).norm();
      stored += sign_[t] * twice;
      area += twice;
      middle += twice * centroid(mesh_, t);
    }
    if (!(area > 0)) return false;
    middle /= area;
    double outward = 0, all = 0;
    for (const Index t : patch.triangles) {
      const Vec3 normal = areaNormal(mesh_, t), arm = centroid(mesh_, t) - middle;
      outward += sign_[t] * normal.dot(arm);
      all += normal.norm() * arm.norm();
    }
    const double clear = patch.isClosed ? 0 : kClearlyEncloses * all;
    if (std::abs(outward) > clear) return outward < 0;
    const int leaving = allAgree_ ? 0 : raysLeaving(patch);
    return leaving != 0 ? leaving < 0 : stored < 0;
  }

  // How many more rays leave the model from before the patch than from behind it.
  int raysLeaving(const Patch& patch) {
    if (!surface_) {
      surface_ = std::make_unique<Bvh>(mesh_);
      reach_ = 2 * surfaceBox(mesh_).diagonal();
      margin_ = kRayMargin * modelBox(mesh_).diagonal();
    }
    const std::size_t count = std::min(kRayFaces, patch.triangles.size());
    int leaving = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Index t = patch.triangles[i * patch.triangles.size() / count];
      const Vec3 twice = areaNormal(mesh_, t), from = centroid(mesh_, t);
      if (!(twice.norm() > 0)) continue;
      const Vec3 normal = sign_[t] * twice.normalized(), tilt = 0.5 * normal.unitOrthogonal();
      for (const Vec3& lean : {Vec3(Vec3::Zero()), tilt, Vec3(-tilt)}) {
        for (const int side : {1, -1}) {
          const Vec3 ray = reach_ * (side * normal + lean);
          if (!surface_->segmentBlocked(from, from + ray, margin_)) leaving += side;
        }
      }
    }
    return leaving;
  }

  const TriMesh& mesh_;
  std::vector<Index> across_;  // by side: the one across its edge, where exactly two lie there
  bool allAgree_ = true;
  std::vector<int> sign_;
  std::unique_ptr<Bvh> surface_;
  double reach_ = 0, margin_ = 0;  // of rays
};

// By triangle whether an earlier one has the same three vertices, and so the same edges.
std::vector<bool> repeatedFaces(const TriMesh& mesh, bool& allAgreeing) {
  std::vector<bool> repeats(mesh.triangles.size(), false);
  std::vector<std::pair<Index, Index>> apexes;  // the corner opposite to the edge, triangle
  allAgreeing = true;
  const EdgeGroups edges(mesh.triangles, mesh.vertexCount());
  edges.forEachEdge([&](std::span<const Index> sides) {
    if (sides.size() < 2) return;
    if (sides.size() == 2 && !agree(mesh, sides[0], sides[1])) allAgreeing = false;
    apexes.clear();
    for (const Index side : sides) apexes.push_back({edges.corner(nextSide(nextSide(side))), side / 3});
    std::sort(apexes.begin(), apexes.end());
    for (std::size_t i = 1; i < apexes.size(); ++i) {
      if (apexes[i].first == apexes[i - 1].first) repeats[apexes[i].second] = true;
    }
  });
  return repeats;
}

}  // namespace

std::vector<bool> reversedFaces(const TriMesh& mesh) {
  const std::vector<int> signs = FaceReverser(mesh).signs();
  std::vector<bool> reversed(signs.size());
  for (std::size_t t = 0; t < signs.size(); ++t) reversed[t] = signs[t] < 0;
  return reversed;
}

MendedFaces mendFaces(TriMesh& mesh) {
  MendedFaces mended;
  bool allAgreeing = true;
  const std::vector<bool> repeats = repeatedFaces(mesh, allAgreeing);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < repeats.size(); ++t) {
    if (!repeats[t]) mesh.triangles[kept++] = mesh.triangles[t];
  }
  mended.repeated = static_cast<Index>(repeats.size() - kept);
  mesh.triangles.resize(kept);
  // What is left of repeated triangles may have either winding.
  if (allAgreeing && mended.repeated == 0) return mended;
  const std::vector<bool> reversed = reversedFaces(mesh);
  for (std::size_t t = 0; t < reversed.size(); ++t) {
    if (!reversed[t]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++mended.reversed;
  }
  return mended;
}

}  // namespace limber
