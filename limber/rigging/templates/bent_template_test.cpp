#include "limber/rigging/templates/bent_template.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace limber {

TEST(BentTemplate, HasNoPosesWithoutPins) {
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  EXPECT_TRUE(bentToPins(skeleton, TemplatePins(skeleton.jointCount())).empty());
}

TEST(BentTemplate, BringsJointsToTheirPins) {
  for (const char* name : {"humanoid", "quadruped"}) {
    const TemplateSkeleton& skeleton = findTemplate(name);
    TemplatePins pins(skeleton.jointCount());
    const Index head = skeleton.find("head").value(), hips = skeleton.find("hips").value();
    pins[head] = Vec3(0.1, 0.6, 0.3);
    pins[hips] = Vec3(0, 0.5, -0.1);
    double nearest = 1;
    for (const TemplateVariant& variant : bentToPins(skeleton, pins)) {
      EXPECT_TRUE(variant.skeleton.bent());
      const double off = (variant.skeleton.joints[head].position - *pins[head]).norm() +
                         (variant.skeleton.joints[hips].position - *pins[hips]).norm();
      nearest = std::min(nearest, off);
    }
    EXPECT_LT(nearest, 0.01) << name;
  }
}

}  // namespace limber
