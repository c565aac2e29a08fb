#include "limber/rigging/templates/pose_search.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

TEST(PoseSearch, LeavesWhatStandsAlone) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplateEmbedder embedder(skeleton, person.body, person.frame, TemplatePins(skeleton.jointCount()));
  std::vector<TemplateFit> fits = fitVariants({{skeleton, 0}}, embedder);
  const std::vector<Vec3> before = fits.front().embedding.positions;
  searchPose(embedder, fits.front());
  EXPECT_FALSE(fits.front().skeleton.bent());
  EXPECT_EQ(fits.front().embedding.positions, before);
}

}  // namespace limber
