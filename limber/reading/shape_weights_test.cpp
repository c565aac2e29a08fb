#include "limber/reading/shape_weights.h"

#include <algorithm>
#include <future>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/reading/testing/made_weights.h"
#include "limber/reading/weights_file.h"
#include "source_folder.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::size_t kMaxShippedBytes = 1'500'000;  // what a page fetches for its first template

TEST(ShapeWeights, AreThoseOfTheRepository) {
  const std::shared_ptr<const ReadingWeights> weights = shapeWeights();
  EXPECT_THAT(weights->roles, AllOf(Contains("fore_end.L"), Contains("fore_end.R")));
  EXPECT_FALSE(weights->parts.empty() || weights->plans.empty());
  const Bytes file = readFile(testing::sourceFolder() / "limber/reading/data/shapes.lrd");
  EXPECT_LT(file.size(), kMaxShippedBytes);
  EXPECT_EQ(readReadingWeights(file).card, weights->card);
}

TEST(ShapeWeights, AreParsedOnceForAllThreads) {
  std::vector<std::future<std::shared_ptr<const ReadingWeights>>> calls;
  for (int i = 0; i < 4; ++i) calls.push_back(std::async(std::launch::async, shapeWeights));
  for (auto& call : calls) EXPECT_EQ(call.get(), shapeWeights());
}

TEST(ShapeWeights, GiveWayToOthers) {
  const std::shared_ptr<const ReadingWeights> before = shapeWeights();
  EXPECT_THROW(setShapeWeights(asBytes("LRD1")), Error);
  EXPECT_EQ(shapeWeights(), before);
  setShapeWeights(testing::madeWeights().file());
  EXPECT_EQ(shapeWeights()->sampleCount(), testing::kMadeSamples);
  setShapeWeights(readFile(testing::sourceFolder() / "limber/reading/data/shapes.lrd"));
  EXPECT_EQ(shapeWeights()->card, before->card);
}

TEST(ShapeWeights, OfAFileNameItInErrors) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "own.lrd";
  EXPECT_THROW(readShapeWeights(path), Error);
  Bytes file = testing::madeWeights().file();
  writeFile(path, file);
  EXPECT_EQ(readShapeWeights(path)->sampleCount(), testing::kMadeSamples);
  file.resize(file.size() / 2);
  writeFile(path, file);
  try {
    readShapeWeights(path);
    ADD_FAILURE() << "nothing is refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    EXPECT_THAT(error.where(), HasSubstr("own.lrd"));
  }
}

}  // namespace
}  // namespace limber
