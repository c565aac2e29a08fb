#include "limber/reading/weights_file.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/reading/testing/made_weights.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

ErrorCode codeOf(ByteSpan file) {
  try {
    readReadingWeights(file);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::kCancelled;  // nothing thrown
}

std::string problemOf(const testing::MadeWeights& made) {
  try {
    readReadingWeights(made.file());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(WeightsFile, GivesNamesCalibrationAndNumbers) {
  const testing::MadeWeights made = testing::madeWeights();
  const ReadingWeights weights = readReadingWeights(made.file());
  EXPECT_THAT(weights.roles, ::testing::ElementsAre("trunk_0", "fore_end.L", "fore_end.R", "ear.R", "ear.L"));
  EXPECT_THAT(weights.mirrorRole, ::testing::ElementsAre(0, 2, 1, 4, 3));
  EXPECT_THAT(weights.mirrorPart, ::testing::ElementsAre(0, 2, 1, 3));
  EXPECT_EQ(weights.calibration.errorFactor, 1.25);
  EXPECT_EQ(weights.sampleCount(), testing::kMadeSamples);
  EXPECT_EQ(weights.card, "{\"seed\":1}");
  const std::vector<double>& expected = made.tensors.at("reading.layers.1.qkv.weight").values;
  const std::vector<float>& values = weights.reading.trunk.layers[1].queryKeyValue.weight.values;
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], expected[i]);
}

TEST(WeightsFile, WidensEveryKindOfNumber) {
  testing::MadeWeights made = testing::madeWeights();
  std::vector<std::uint16_t>& halves = made.halves[0].second;
  const std::vector<std::pair<std::uint16_t, float>> known = {
      {0x0000, 0},        {0x8000, 0}, {0x0001, 0x1p-24f}, {0x83ff, -1023 * 0x1p-24f},
      {0x0400, 0x1p-14f}, {0x3c00, 1}, {0xc000, -2},       {0x3555, 0x1.554p-2f},
      {0x7bff, 65504}};
  for (std::size_t i = 0; i < known.size(); ++i) halves[i] = known[i].first;
  const ReadingWeights weights = readReadingWeights(made.file());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(weights.reading.trunk.embedFirst.weight.values[i], known[i].second);
  }
  halves[3] = 0x7c00;
  EXPECT_THAT(problemOf(made), HasSubstr("reading.e1.weight: it has a number that is not finite"));
}

TEST(WeightsFile, RefusesEveryTruncatedLength) {
  const Bytes file = testing::madeWeights().file();
  EXPECT_EQ(codeOf({}), ErrorCode::kUnsupported);
  for (std::size_t length = 1; length < file.size(); length += length < 64 || length + 64 > file.size() ? 1 : 97) {
    ASSERT_EQ(codeOf(ByteSpan(file).first(length)), ErrorCode::kBadData) << length;
  }
}

TEST(WeightsFile, RefusesOtherFiles) {
  Bytes file = testing::madeWeights().file();
  EXPECT_EQ(codeOf(asBytes("glTF, or something else")), ErrorCode::kUnsupported);
  file.resize(file.size() + 4);
  EXPECT_EQ(codeOf(file), ErrorCode::kBadData);
  file.resize((16 << 20) + 4);
  EXPECT_EQ(codeOf(file), ErrorCode::kLimit);
  file = testing::madeWeights().file();
  file[3] = '2';
  EXPECT_EQ(codeOf(file), ErrorCode::kUnsupported);
}

TEST(WeightsFile, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::function<void(testing::MadeWeights&)>>> faults = {
      {"lacks 'roles'", [](auto& made) { made.description.erase("roles"); }},
      {"'parts' has 'tail' twice", [](auto& made) { made.description["parts"][0] = "tail"; }},
      {"'ear.R' has none on the other side", [](auto& made) { made.description["roles"][4] = "ear"; }},
      {"'plan_temperature' is no number", [](auto& made) { made.description["calibration"]["plan_temperature"] = 0; }},
      {"lacks 'stance'", [](auto& made) { made.description["networks"].erase("stance"); }},
      {"'networks.reading.layers' is no number from 1 to 64",
       [](auto& made) { made.description["networks"]["reading"]["layers"] = -3; }},
      {"do not divide", [](auto& made) { made.description["networks"]["reading"]["heads"] = 3; }},
      {"more samples than the other", [](auto& made) { made.description["networks"]["stance"]["tokens"] = 41; }},
      {"reading.layers.2.n1.weight: a tensor is missing",
       [](auto& made) { made.description["networks"]["reading"]["layers"] = 3; }},
      {"reading.plan.weight: its shape is 8 x 3 in place of 8 x 4",
       [](auto& made) { made.description["plans"].push_back("bird"); }},
      {"reading.e1.bias: a tensor is listed twice",
       [](auto& made) { made.description["tensors"][3]["name"] = "reading.e1.bias"; }},
      {"no network has",
       [](auto& made) {
         made.description["tensors"].push_back({{"name", "more"}, {"shape", nlohmann::json::array({2})}});
         made.halves.push_back({"more", {0, 0}});
       }},
      {"'tensors' is no list", [](auto& made) { made.description["tensors"] = 1; }},
      {"nested too deeply",
       [](auto& made) {
         nlohmann::json deep = 1;
         for (int i = 0; i < 40; ++i) deep = nlohmann::json::array({deep});
         made.description["card"] = deep;
       }},
  };
  for (const auto& [expected, spoil] : faults) {
    testing::MadeWeights made = testing::madeWeights();
    spoil(made);
    EXPECT_THAT(problemOf(made), HasSubstr(expected));
  }
}

// Whatever bytes are patched, reading gives weights or an Error.
TEST(WeightsFile, SurvivesPatchedBytes) {
  const Bytes file = testing::madeWeights().file();
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    Bytes patched = file;
    for (int patch = 0; patch < 3; ++patch) {
      patched[random.below(4200)] = static_cast<std::uint8_t>(random.bits());
    }
    try {
      EXPECT_FALSE(readReadingWeights(patched).roles.empty());
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace limber
