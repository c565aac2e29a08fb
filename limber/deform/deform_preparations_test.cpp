#include "limber/deform/deform_preparations.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/deform/testing/bent_tube.h"

namespace limber {
namespace {

testing::BoundMesh smallTube() {
  return testing::bentTube(8, 9, 0.2, Quat(Eigen::AngleAxisd(1.0, Vec3::UnitZ())));
}

TEST(DeformPreparations, EachIsMadeOnce) {
  const testing::BoundMesh bound = smallTube();
  DeformPreparations preparations;
  std::size_t needed = 0;
  for (const Deformer& deformer : deformers()) {
    const auto first = preparations.of(deformer, bound.surface(), bound.jointCount());
    EXPECT_EQ(first != nullptr, deformer.prepare != nullptr) << deformer.name;
    EXPECT_EQ(preparations.of(deformer, bound.surface(), bound.jointCount()), first) << deformer.name;
    needed += deformer.prepare != nullptr;
    EXPECT_EQ(bound.deformed(deformer, first.get()), bound.deformed(deformer.name)) << deformer.name;
  }
  EXPECT_EQ(preparations.size(), needed);
}

TEST(DeformPreparations, WhatIsForgottenIsMadeAgainAndLivesOnWhereItIsUsed) {
  const testing::BoundMesh bound = smallTube();
  const Deformer& deformer = findDeformer("delta-mush");
  DeformPreparations preparations;
  const auto before = preparations.of(deformer, bound.surface(), bound.jointCount());
  preparations.forget();
  EXPECT_EQ(preparations.size(), 0u);
  const auto after = preparations.of(deformer, bound.surface(), bound.jointCount());
  EXPECT_NE(after, before);
  EXPECT_EQ(bound.deformed(deformer, before.get()), bound.deformed(deformer, after.get()));
}

TEST(DeformPreparations, ThreadsThatAskAtOnceGetTheSameOne) {
  const testing::BoundMesh bound = smallTube();
  const Deformer& deformer = findDeformer("centers-of-rotation");
  DeformPreparations preparations;
  std::vector<std::shared_ptr<const DeformPreparation>> given(16);
  setThreadCount(4);
  parallelFor(given.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      given[i] = preparations.of(deformer, bound.surface(), bound.jointCount());
    }
  });
  setThreadCount(0);
  for (const auto& one : given) EXPECT_EQ(one, given.front());
}

TEST(DeformPreparations, WhatFailsIsNotKept) {
  const testing::BoundMesh bound = smallTube();
  DeformPreparations preparations;
  EXPECT_THROW(preparations.of(findDeformer("delta-mush"), bound.surface(), 1), Error);
  EXPECT_EQ(preparations.size(), 0u);
}

}  // namespace
}  // namespace limber
