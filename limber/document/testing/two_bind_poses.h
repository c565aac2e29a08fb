// A model whose two skins share joints and may be bound in different poses, for tests.
#pragma once

#include <vector>

#include "limber/document/testing/scene_builder.h"

namespace limber::testing {

// Two tetrahedra, each following one of two joints, whose nodes are where the first's skin is bound. The second's skin
// has its mesh `off` that position; at (0, 0, -3) its inverse binds are the identity, as which no binds are read.
inline Asset partsInTwoBindPoses(const Vec3f& off, bool hasBinds = true) {
  SceneBuilder scene;
  const Index left = scene.addNode({{"name", "left"}});
  const Index right = scene.addNode({{"name", "right"}, {"translation", {0, 0, 3}}});
  const Affine toRight = translation(0, 0, -3);
  const Affine elsewhere = toRight * translation(-off.x(), -off.y(), -off.z());
  std::vector<Affine> binds = {Affine::Identity(), toRight}, others = {Affine::Identity(), elsewhere};
  if (!hasBinds) others.clear();
  const Index skins[] = {scene.addSkin({left, right}, binds), scene.addSkin({left, right}, others)};
  std::vector<Index> roots = {left, right};
  for (std::uint8_t part = 0; part < 2; ++part) {
    const Vec3f corner(2.0f * part, 0, 0);
    const Index mesh = scene.addTetrahedron(part == 1 ? Vec3f(corner + off) : corner);
    scene.bindRigidly(mesh, std::vector<std::uint8_t>(4, part));
    roots.push_back(scene.addNode({{"mesh", mesh}, {"skin", skins[part]}}));
  }
  scene.asset().document.scene = scene.addScene(roots);
  return scene.build();
}

}  // namespace limber::testing
