// Figures in poses, and the bodies that they would have. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/figure/figure.h"

namespace limber::testing {

// Upright, 1 high on y = 0, facing +Z, its left at +X; arms hang a little outwards.
inline Figure standingFigure() {
  Figure figure;
  figure.head = {0, 0.93, 0};
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    FigureLimb& bones = figure.limbs[limb];
    const double out = sideOf(limb) * (isLeg(limb) ? 0.1 : 0.35);
    bones.upper = bones.lower = bones.end = Vec3(out, -1, 0).normalized();
    if (isLeg(limb)) bones.end = Vec3(0, -0.3, 1).normalized();
  }
  return figure;
}

// Bent over, on the right knee, the left foot before it, the right hand on the ground: no side like the other.
inline Figure crouchingFigure() {
  Figure figure = standingFigure();
  const auto turned = [](double nod, double turn) {
    return (Eigen::AngleAxisd(turn, Vec3::UnitY()) * Eigen::AngleAxisd(nod, Vec3::UnitX())).toRotationMatrix();
  };
  figure.head = {0.03, 0.62, 0.2};
  figure.neck = Vec3(-0.1, -0.8, -0.6).normalized();
  figure.chest = turned(0.7, 0.25);
  figure.pelvis = turned(0.2, 0);
  const auto hold = [&](int limb, const Vec3& upper, const Vec3& lower, const Vec3& end) {
    figure.limbs[limb] = {upper.normalized(), lower.normalized(), end.normalized()};
  };
  hold(0, {1, -0.2, 0.25}, {0.3, -0.3, 1}, {0.3, -0.3, 1});
  hold(1, {-0.5, -1, 0.35}, {-0.1, -1, 0.3}, {-0.1, -1, 0.3});
  hold(2, {0.35, 0.1, 1}, {0.05, -1, -0.15}, {0, -0.2, 1});
  hold(3, {-0.35, -0.9, 0.35}, {0, -0.2, -1}, {0, -0.75, -0.6});
  return figure;
}

// A cross-section of a part: an ellipse with these half axes.
struct Ring {
  Vec3 middle, across, deep;
};

// A closed surface through rings, along their order.
inline void addTube(TriMesh& mesh, const std::vector<Ring>& rings) {
  constexpr Index kAround = 16;
  const Index first = mesh.vertexCount();
  const auto add = [&](const Vec3& p) { mesh.positions.push_back(p.cast<float>()); };
  for (const Ring& ring : rings) {
    for (Index i = 0; i < kAround; ++i) {
      const double angle = 2 * M_PI * i / kAround;
      add(ring.middle + std::cos(angle) * ring.across + std::sin(angle) * ring.deep);
    }
  }
  add(rings.front().middle);
  add(rings.back().middle);
  const Index begin = mesh.vertexCount() - 2, end = begin + 1;
  const auto at = [&](std::size_t ring, Index i) { return first + static_cast<Index>(ring) * kAround + i % kAround; };
  for (Index i = 0; i < kAround; ++i) {
    mesh.triangles.push_back({begin, at(0, i + 1), at(0, i)});
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
      mesh.triangles.push_back({at(r, i), at(r, i + 1), at(r + 1, i)});
      mesh.triangles.push_back({at(r + 1, i), at(r, i + 1), at(r + 1, i + 1)});
    }
    mesh.triangles.push_back({end, at(rings.size() - 1, i), at(rings.size() - 1, i + 1)});
  }
}

inline Ring roundRing(const Vec3& middle, const Vec3& along, double radius) {
  const Vec3 across = along.unitOrthogonal();
  return {middle, radius * across, radius * along.cross(across)};
}

// The head, the neck and the trunk in one, limbs that begin in it: surfaces inside a body would make it shallow.
inline TriMesh figureBody(const Figure& figure) {
  TriMesh mesh;
  const double size = figure.stature;
  std::vector<Ring> trunk;
  constexpr int kBands = 6;
  for (int i = 0; i < kBands; ++i) {  // down to where the neck is as wide
    const double angle = (i + 0.2) / kBands * 0.82 * M_PI;
    trunk.push_back(roundRing(figure.head - std::cos(angle) * figure.headRadius * figure.neck, figure.neck,
                              std::sin(angle) * figure.headRadius));
  }
  const auto oval = [&](const Vec3& middle, const Mat3& axes, double width, double depth) {
    trunk.push_back({middle, -width * size * axes.col(0), depth * size * axes.col(2)});
  };
  const Vec3 neck = figure.neckBase(), waist = figure.waist(), down = figure.hips() - waist;
  const auto chest = [&](double part, double width, double depth) {
    oval(neck + part * (waist - neck), figure.chest, width, depth);
  };
  // Round rings begin anywhere; from the neck on all begin at the left.
  for (Ring& ring : trunk) {
    const double radius = ring.across.norm();
    const Vec3 left = figure.chest.col(0) - figure.chest.col(0).dot(figure.neck) * figure.neck;
    ring.across = -radius * left.normalized();
    ring.deep = ring.across.cross(figure.neck);
  }
  chest(-0.1, 0.033, 0.033);
  chest(0.05, 0.06, 0.045);
  chest(0.35, 0.085, 0.055);
  chest(0.7, 0.082, 0.06);
  chest(1, 0.075, 0.055);
  oval(waist + 0.4 * down, figure.pelvis, 0.075, 0.055);
  oval(waist + 0.85 * down, figure.pelvis, 0.09, 0.062);
  oval(waist + 1.15 * down, figure.pelvis, 0.085, 0.055);
  oval(waist + 1.3 * down, figure.pelvis, 0.05, 0.03);
  addTube(mesh, trunk);
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    const LimbPositions positions = figure.positions(limb);
    const FigureLimb& bones = figure.limbs[limb];
    const bool leg = isLeg(limb);
    const double upper = leg ? 0.046 : 0.029, lower = leg ? 0.03 : 0.023;
    const Vec3 start = positions.root + (leg ? 0.3 : 0.0) * (positions.middle - positions.root);
    if (!leg) {
      const Vec3 inside = figure.chest.col(0) * sideOf(limb);
      testing::addCapsule(mesh, positions.root - 0.03 * size * inside, positions.root, 0.036 * size);
    }
    testing::addCapsule(mesh, start, positions.middle, upper * size);
    testing::addCapsule(mesh, positions.middle, positions.ankle, lower * size);
    testing::addCapsule(mesh, positions.ankle, positions.tip - 0.02 * size * bones.end, 0.02 * size);
  }
  return mesh;
}

// The body with a block below it that its feet go into, as statues stand.
inline TriMesh statueOf(const Figure& figure) {
  TriMesh mesh = figureBody(figure);
  double low = 1e9;
  for (const Vec3f& position : mesh.positions) low = std::min(low, static_cast<double>(position.y()));
  for (const double x : {-0.2, -0.07, 0.07, 0.2}) {
    addCapsule(mesh, {x, low, -0.25}, {x, low, 0.35}, 0.06);
  }
  return mesh;
}

}  // namespace limber::testing
