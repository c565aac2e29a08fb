#include "limber/preview/part_scene.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "limber/preview/image/palette.h"
#include "limber/preview/render.h"

namespace limber {
namespace {

Scene squareOfFour() {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0}};
  scene.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return scene;
}

TEST(PartScene, EachTriangleHasTheColourOfItsPartAtAllCorners) {
  const Scene scene = squareOfFour();
  const std::vector<Index> partOf = {0, 0, 1, 2};
  const Scene colored = coloredByParts(scene, partOf);
  ASSERT_EQ(colored.colors.size(), colored.positions.size());
  for (std::size_t t = 0; t < partOf.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(colored.colors[colored.triangles[t][c]], jointColor(partOf[t]));
      EXPECT_EQ(colored.positions[colored.triangles[t][c]], scene.positions[scene.triangles[t][c]]);
    }
  }
  // The middle is there for each of three parts, corners between two parts twice.
  EXPECT_EQ(colored.positions.size(), 5u + 2 + 3);
}

TEST(PartScene, OtherNumbersOfPartsAreRefused) {
  const std::vector<Index> partOf = {0, 1};
  EXPECT_THROW(coloredByParts(squareOfFour(), partOf), Error);
  PreviewOptions options;
  options.show = PreviewShow::kParts;
  EXPECT_THROW(render(squareOfFour(), options), Error);
  EXPECT_EQ(parsePreviewShow("parts"), PreviewShow::kParts);
}

}  // namespace
}  // namespace limber
