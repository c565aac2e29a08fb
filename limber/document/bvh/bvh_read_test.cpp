#include "limber/document/bvh/bvh_read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "shared_data.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

Motion read(const std::string& text, const BvhOptions& options = {}) {
  return readBvh(asBytes(text), "test.bvh", options);
}

std::vector<std::string> kinds(const Motion& motion) {
  std::vector<std::string> result;
  for (const Warning& warning : motion.warnings.items()) result.push_back(warning.kind);
  return result;
}

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A skeleton with channels, and what its frames mean by rotation matrices: the format by the letter.
struct Model {
  struct Part {
    std::string name;
    int parent = -1;
    Vec3 offset = Vec3::Zero();
    std::vector<std::string> channels;
    bool endSite = false;
  };
  std::vector<Part> parts;
  std::vector<std::vector<double>> rows;
  double frameTime = 0.025;

  std::vector<int> childrenOf(int part) const {
    std::vector<int> result;
    for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
      if (parts[static_cast<std::size_t>(i)].parent == part) result.push_back(i);
    }
    return result;
  }

  void writePart(int index, std::string& text) const {
    const Part& part = parts[static_cast<std::size_t>(index)];
    text += part.endSite ? "End Site" : (part.parent < 0 ? "ROOT " : "JOINT ") + part.name;
    text += fmt::format("\n{{\nOFFSET {:.9g} {:.9g} {:.9g}\n", part.offset.x(), part.offset.y(), part.offset.z());
    if (!part.endSite) text += fmt::format("CHANNELS {} {}\n", part.channels.size(), fmt::join(part.channels, " "));
    for (const int child : childrenOf(index)) writePart(child, text);
    text += "}\n";
  }

  std::string text() const {
    std::string result = "HIERARCHY\n";
    for (const int root : childrenOf(-1)) writePart(root, result);
    result += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", rows.size(), frameTime);
    for (const std::vector<double>& row : rows) result += fmt::format("{:.9g}\n", fmt::join(row, " "));
    return result;
  }

  std::vector<Affine> globalsAt(std::size_t frame) const {
    std::vector<Affine> globals;
    std::size_t next = 0;
    for (const Part& part : parts) {
      Affine local = Affine::Identity();
      Vec3 position = part.offset;
      Mat3 rotation = Mat3::Identity();
      for (const std::string& channel : part.channels) {
        const double value = rows[frame][next++];
        const int axis = channel[0] - 'X';
        if (channel.substr(1) == "position") {
          position[axis] = value;
        } else {
          rotation *= Eigen::AngleAxisd(value * std::numbers::pi / 180, Vec3::Unit(axis)).toRotationMatrix();
        }
      }
      local.linear() = rotation;
      local.translation() = position;
      globals.push_back(part.parent < 0 ? local : globals[static_cast<std::size_t>(part.parent)] * local);
    }
    return globals;
  }
};

// Parts in depth-first order, which is the file's. Positions of joints below the root stay near their offsets.
Model randomModel(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> length(-30, 30), angle(-200, 200), wobble(-3, 3);
  Model model;
  const std::vector<std::string> rotations = {"Xrotation", "Yrotation", "Zrotation"};
  const int count = 2 + static_cast<int>(random() % 12);
  std::vector<int> path;
  for (int i = 0; i < count; ++i) {
    Model::Part part;
    part.name = fmt::format("part {}", i);
    path.resize(i == 0 ? 0 : 1 + random() % path.size());
    part.parent = i == 0 ? -1 : path.back();
    part.offset = Vec3(length(random), length(random), length(random));
    part.endSite = i > 0 && random() % 4 == 0;
    if (!part.endSite) {
      std::vector<std::string> channels = rotations;
      if (i == 0 || random() % 3 == 0) channels.insert(channels.end(), {"Xposition", "Yposition", "Zposition"});
      std::shuffle(channels.begin(), channels.end(), random);
      if (i > 0 && random() % 5 == 0) channels.resize(random() % 3);
      part.channels = channels;
      path.push_back(i);
    }
    model.parts.push_back(part);
  }
  for (int frame = 0; frame < 5; ++frame) {
    std::vector<double> row;
    for (const Model::Part& part : model.parts) {
      for (const std::string& channel : part.channels) {
        const int axis = channel[0] - 'X';
        row.push_back(channel.substr(1) == "rotation" ? angle(random) : part.offset[axis] + wobble(random));
      }
    }
    model.rows.push_back(row);
  }
  return model;
}

double largestError(const Model& model, const Motion& motion) {
  double largest = 0;
  for (std::size_t frame = 0; frame < model.rows.size(); ++frame) {
    Pose pose = restPose(motion.skeleton);
    sampleClip(motion.clips.at(0), static_cast<double>(frame) * model.frameTime, pose);
    const std::vector<Affine> globals = poseGlobals(motion.skeleton, pose), wanted = model.globalsAt(frame);
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      largest = std::max(largest, (globals[j].matrix() - wanted[j].matrix()).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

TEST(ReadBvh, PutsEveryJointWhereRotationMatricesPutIt) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Model model = randomModel(seed);
    const Motion motion = read(model.text());
    ASSERT_EQ(motion.skeleton.joints.size(), model.parts.size());
    EXPECT_LT(largestError(model, motion), 1e-3) << seed;  // single precision over chains of hundreds of units
    EXPECT_NO_THROW(checkMotion(motion));
    EXPECT_TRUE(motion.warnings.empty()) << seed;
    EXPECT_DOUBLE_EQ(motion.framesPerSecond, 40);
    EXPECT_EQ(motion.name, "test");
    EXPECT_EQ(motion.clips[0].name, "test");
  }
}

std::string replaced(const std::string& text, const std::string& from, const std::string& to) {
  std::string result;
  std::size_t begin = 0;
  for (std::size_t at = 0; (at = text.find(from, begin)) != std::string::npos; begin = at + from.size()) {
    result.append(text, begin, at - begin).append(to);
  }
  return result.append(text, begin);
}

TEST(ReadBvh, TakesEveryLayoutForTheSame) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Model model = randomModel(seed);
    const std::string text = model.text();
    const std::vector<std::string> layouts = {
        replaced(text, "\n", "\r\n"),
        replaced(text, "\n", "\r"),
        replaced(text, "\n", "\n \t\n"),
        replaced(text, "\n", " \t \n"),
        replaced(text, "\n{", " {"),
        replaced(replaced(text, "\n{\n", "{ "), "OFFSET", "offset"),
        replaced(replaced(text, "Xrotation", "XROTATION"), "JOINT", "Joint"),
        replaced(replaced(text, "Frames:", "Frames :"), "Frame Time:", "FRAME TIME:\t"),
        "\xef\xbb\xbf" + text,
        text.substr(0, text.size() - 1),
        text + "\n\n",
    };
    for (std::size_t i = 0; i < layouts.size(); ++i) {
      const Motion motion = read(layouts[i]);
      EXPECT_TRUE(motion.warnings.empty()) << "layout " << i;
      EXPECT_LT(largestError(model, motion), 1e-3) << "layout " << i;
      EXPECT_EQ(motion.skeleton.joints[0].name, "part 0") << "layout " << i;
    }
  }
}

TEST(ReadBvh, GivesEndSitesTheNameOfTheirBone) {
  const Motion motion = read(
      "HIERARCHY\nROOT Hip {\nOFFSET 0 0 0\nCHANNELS 0\nJOINT Hand {\nOFFSET 1 0 0\nCHANNELS 0\nEnd Site {\nOFFSET 0 2 "
      "0\n} } End Site\n{\nOFFSET 0 0 3\n}\n}\nMOTION\nFrames: 0\nFrame Time: 0.1\n");
  ASSERT_EQ(motion.skeleton.joints.size(), 4u);
  EXPECT_EQ(motion.skeleton.joints[2].name, "Hand_end");
  EXPECT_EQ(motion.skeleton.joints[2].parent, Index{1});
  EXPECT_EQ(motion.skeleton.joints[2].rest.translation, Vec3(0, 2, 0));
  EXPECT_EQ(motion.skeleton.joints[3].name, "Hip_end");
  EXPECT_TRUE(motion.clips.empty());
  EXPECT_TRUE(motion.warnings.empty());
}

// A root with one child that has positions.
std::string twoJoints(const std::string& rows, int frames = 2, const std::string& frameTime = "0.1") {
  return fmt::format(
      "HIERARCHY\nROOT a\n{{\nOFFSET 5 6 7\nCHANNELS 3 Xposition Yposition Zposition\nJOINT b\n{{\nOFFSET 1 2 "
      "3\nCHANNELS 3 Zposition Xposition Yposition\n}}\n}}\nMOTION\nFrames: {}\nFrame Time: {}\n{}",
      frames, frameTime, rows);
}

TEST(ReadBvh, TellsAddedPositionsFromReplacingOnes) {
  const Motion replacing = read(twoJoints("0 0 0 3.1 1 2\n1 1 1 3 1.1 2.1\n"));
  EXPECT_TRUE(replacing.warnings.empty());
  EXPECT_EQ(replacing.clips[0].translations[0].values[0], Vec3f(0, 0, 0)) << "a root's always replace";
  EXPECT_EQ(replacing.clips[0].translations[1].values[0], Vec3f(1, 2, 3.1f));

  const Motion added = read(twoJoints("0 0 0 0.5 0 0\n1 1 1 0 0.25 0\n"));
  EXPECT_THAT(kinds(added), ::testing::ElementsAre("relative-positions"));
  EXPECT_EQ(added.clips[0].translations[0].values[0], Vec3f(0, 0, 0));
  EXPECT_EQ(added.clips[0].translations[1].values[0], Vec3f(1, 2, 3.5f));
  EXPECT_EQ(added.clips[0].translations[1].values[1], Vec3f(1.25f, 2, 3));
}

TEST(ReadBvh, GivesConstantTracksOneKey) {
  const Motion motion = read(twoJoints("0 0 0 3 1 2\n0 4 0 3 1 2\n0 5 0 3 1 2\n", 3));
  EXPECT_EQ(motion.clips[0].translations[0].times.size(), 3u);
  EXPECT_EQ(motion.clips[0].translations[1].times.size(), 1u);
}

TEST(ReadBvh, AHeldPoseLastsAsLongAsItsFrames) {
  const Motion motion = read(twoJoints("0 4 0 3 1 2\n0 4 0 3 1 2\n0 4 0 3 1 2\n", 3));
  EXPECT_FLOAT_EQ(static_cast<float>(motion.clips[0].duration()), 0.2f);
  EXPECT_NEAR(frameRateOf(motion, 0), 10, 1e-4);
  EXPECT_EQ(frameCount(motion.clips[0], 10), 3u);
}

TEST(ReadBvh, TakesRoundedFrameTimesForWhatTheyMean) {
  const auto rate = [](const std::string& frameTime) {
    return read(twoJoints("0 0 0 3 1 2\n1 0 0 3 1 2\n", 2, frameTime)).framesPerSecond;
  };
  for (const auto& [frameTime, meant] : std::map<std::string, double>{{"0.033333", 30},
                                                                      {"0.0333333", 30},
                                                                      {"0.008333", 120},
                                                                      {"0.016667", 60},
                                                                      {"0.041667", 24},
                                                                      {"0.025", 40},
                                                                      {"2", 0.5}}) {
    EXPECT_EQ(rate(frameTime), meant) << frameTime;
  }
  EXPECT_DOUBLE_EQ(rate("0.041708"), 24000.0 / 1001);
  EXPECT_DOUBLE_EQ(rate("0.033367"), 30000.0 / 1001);
  EXPECT_DOUBLE_EQ(rate("0.0333"), 1 / 0.0333) << "not within six digits";
  EXPECT_DOUBLE_EQ(rate("0.00071"), 1 / 0.00071) << "rounding that says little";
}

TEST(ReadBvh, ScalesToTheUnitAndStandsUp) {
  const std::string text =
      "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 90\nCHANNELS 6 Xposition Yposition Zposition Xrotation Yrotation "
      "Zrotation\nJOINT Head\n{\nOFFSET 1 2 70\n}\nJOINT LeftFoot\n{\nOFFSET 10 0 -90\n}\n}\nMOTION\nFrames: 2\nFrame "
      "Time: 1\n1 2 90 0 0 0\n1 2 90 10 20 30\n";
  const Motion stood = read(text, {0.01, std::nullopt}), asIs = read(text, {0.01, UpAxis::kY});
  EXPECT_THAT(kinds(stood), ::testing::ElementsAre("converted-axes"));
  EXPECT_TRUE(asIs.warnings.empty());
  Affine upright = Affine::Identity();
  upright.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (const double seconds : {0.0, 0.4, 1.0}) {
    Pose pose = restPose(stood.skeleton), pose2 = restPose(asIs.skeleton);
    sampleClip(stood.clips[0], seconds, pose);
    sampleClip(asIs.clips[0], seconds, pose2);
    const std::vector<Affine> a = poseGlobals(stood.skeleton, pose), b = poseGlobals(asIs.skeleton, pose2);
    for (std::size_t j = 0; j < a.size(); ++j) {
      EXPECT_TRUE(a[j].matrix().isApprox((upright * b[j] * upright.inverse()).matrix(), 1e-6));
    }
  }
  EXPECT_NEAR(stood.skeleton.joints[0].rest.translation.y(), 0.9, 1e-12);
  EXPECT_THAT(kinds(read(text, {1, UpAxis::kZ})), ::testing::ElementsAre("converted-axes"));
  EXPECT_THROW(read(text, {0, {}}), Error);
  EXPECT_THROW(read(text, {std::nan(""), {}}), Error);
}

TEST(ReadBvh, NamesTheLineOfAnError) {
  const std::string good = randomModel(3).text();
  EXPECT_THAT(errorOf(""), HasSubstr("line 1"));
  EXPECT_THAT(errorOf("solid"), HasSubstr("test.bvh: line 1: is no BVH"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nOFFSET 0 x 0"), HasSubstr("line 4: \"x\" is no number"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nOFFSET 0 nan 0"), HasSubstr("line 4: a number is not finite"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\nOFFSET 0 0 0"), HasSubstr("line 3: an opening brace is wanted"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 Xrotation"), HasSubstr("line 5: 2 channels"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nCHANNELS 1 Wrotation"), HasSubstr("line 4: \"Wrotation\" is no channel"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nCHANNELS 1e9 Xrotation"), HasSubstr("line 4"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\n"), HasSubstr("inside 'a'"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nMOTION\nFrames: 1\n"), HasSubstr("line 4: the hierarchy ends inside 'a'"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\n}\n}\n"), HasSubstr("line 5"));
  EXPECT_THAT(errorOf("HIERARCHY\nJOINT a\n{\n}\n"), HasSubstr("line 2"));
  EXPECT_THAT(errorOf("HIERARCHY\nROOT a\n{\nEnd Site\n{\nJOINT b\n{\n}\n}\n}\n"), HasSubstr("line 6"));
  EXPECT_THAT(errorOf("HIERARCHY\nMOTION\n"), HasSubstr("the file has no joint"));
  EXPECT_THAT(errorOf(twoJoints("0 0 0 0 0\n0 0 0 0 0 0\n")), HasSubstr("line 15: has 5 of the 6 numbers"));
  EXPECT_THAT(errorOf(twoJoints("0 0 0 0 0 0\n0 0 0 0 0 0 0\n")), HasSubstr("line 16: has more than the 6 numbers"));
  EXPECT_THAT(errorOf(twoJoints("0 0 0 0 zero 0\n")), HasSubstr("line 15: \"zero\" is no number"));
  EXPECT_THAT(errorOf(replaced(twoJoints(""), "Frames", "Fames")), HasSubstr("line 13: \"Frames:\" is wanted"));
  EXPECT_THAT(errorOf(replaced(twoJoints(""), "Time", "Tim")), HasSubstr("line 14: \"Frame Time:\" is wanted"));
  EXPECT_THAT(errorOf(replaced(twoJoints(""), "Frames: 2", "Frames: -2")), HasSubstr("line 13"));
  EXPECT_EQ(errorOf(good), "no error");
}

TEST(ReadBvh, RepairsWhatWindowsProgramsWriteForNoNumber) {
  for (const char* number : {"nan", "-nan(ind)", "-1.#IND00", "1.#QNAN", "1.#INF00"}) {
    const Motion motion = read(twoJoints(fmt::format("0 0 0 3 1 2\n1 {} 0 3 1 2\n", number)));
    EXPECT_THAT(kinds(motion), ::testing::ElementsAre("bad-numbers")) << number;
    EXPECT_EQ(motion.clips[0].translations[0].values[1], Vec3f(1, 0, 0)) << number;
  }
}

TEST(ReadBvh, CountsWhatItRepairs) {
  const std::string row = "0 0 0 3 1 2\n";
  const auto warned = [&](const std::string& text) { return kinds(read(text)); };
  using ::testing::ElementsAre;
  EXPECT_THAT(warned(twoJoints(row)), ElementsAre("frame-count"));
  EXPECT_THAT(warned(twoJoints(row + row + row)), ElementsAre("frame-count"));
  EXPECT_THAT(warned(twoJoints(row + row + "0 0 0")), ElementsAre("cut-frame"));
  EXPECT_THAT(warned(twoJoints(row + row, 2, "0")), ElementsAre("frame-time"));
  EXPECT_THAT(warned(twoJoints(row + row, 2, "-0.1")), ElementsAre("frame-time"));
  EXPECT_THAT(warned(twoJoints(row + row, 2, "nan")), ElementsAre("frame-time"));
  EXPECT_THAT(warned(twoJoints(row + row + "the end\nreally\n")), ElementsAre("trailing-text"));
  EXPECT_THAT(warned(replaced(twoJoints(row + row), "JOINT b", "JOINT a")), ElementsAre("duplicate-names"));
  EXPECT_THAT(warned(replaced(twoJoints(row + row), "OFFSET 1 2 3", "OFFSET 1,0 2,0 3,0")),
              ElementsAre("decimal-commas"));
  const std::string text = twoJoints(row);
  EXPECT_THAT(warned(text.substr(0, text.find("MOTION"))), ElementsAre("no-motion"));

  const Motion repaired = read(twoJoints("0 0 0 3 1 2\n0 nan 8 3 inf 2\n"));
  EXPECT_THAT(kinds(repaired), ElementsAre("bad-numbers"));
  EXPECT_EQ(repaired.warnings.items()[0].count, 2u);
  EXPECT_EQ(repaired.warnings.items()[0].where, "line 16");
  EXPECT_EQ(repaired.clips[0].translations[0].values[1], Vec3f(0, 0, 8));
}

TEST(ReadBvh, ReadsOrRefusesEveryTruncation) {
  for (const unsigned seed : {1u, 5u}) {
    const std::string text = randomModel(seed).text();
    std::size_t readable = 0;
    for (std::size_t length = 0; length < text.size(); ++length) {
      try {
        checkMotion(read(text.substr(0, length)));
        ++readable;
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("test.bvh: line ")) << length;
      }
    }
    EXPECT_GT(readable, 0u);
    EXPECT_LT(readable, text.size());
  }
}

TEST(ReadBvh, SurvivesEveryByteChanged) {
  const std::string text = randomModel(8).text();
  std::mt19937 random(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char byte : {'\0', '{', '}', ' ', '\n', '9', '-', static_cast<char>(random() % 256)}) {
      std::string changed = text;
      changed[i] = byte;
      try {
        checkMotion(read(changed));
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("test.bvh: line "));
      }
    }
  }
}

TEST(ReadBvh, ReadsAFileInPiecesAsItReadsBytes) {
  Model model = randomModel(4);
  model.rows.resize(1);
  while (model.rows.size() < 20000) model.rows.push_back(model.rows.back());
  for (std::size_t k = 0; k < model.rows.size(); ++k) model.rows[k][0] = static_cast<double>(k % 360);
  const std::string text = replaced(model.text(), "\n", "\r\n");
  ASSERT_GT(text.size(), std::size_t{1} << 20);  // more than one piece
  const limber::testing::TemporaryFolder folder;
  writeFile(folder.path() / "test.bvh", asBytes(text));
  const Motion a = readBvh(folder.path() / "test.bvh"), b = read(text);
  EXPECT_TRUE(a.warnings.empty());
  ASSERT_EQ(a.clips[0].rotations.size(), b.clips[0].rotations.size());
  for (std::size_t t = 0; t < a.clips[0].rotations.size(); ++t) {
    const auto &x = a.clips[0].rotations[t], &y = b.clips[0].rotations[t];
    EXPECT_EQ(x.times, y.times);
    ASSERT_EQ(x.values.size(), y.values.size());
    for (std::size_t k = 0; k < x.values.size(); ++k) ASSERT_EQ(x.values[k].coeffs(), y.values[k].coeffs());
  }
  EXPECT_EQ(frameCount(a.clips[0], a.framesPerSecond), 20000u);
  EXPECT_THROW(readBvh(folder.path() / "none.bvh"), Error);
}

TEST(ReadBvh, ReadsADeepChain) {
  constexpr int kDepth = 20000;
  std::string text = "HIERARCHY\nROOT a0\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 1; i < kDepth; ++i) text += fmt::format("JOINT a{}\n{{\nOFFSET 0 1e-3 0\nCHANNELS 0\n", i);
  text += std::string(kDepth, '}') + "\nMOTION\nFrames: 1\nFrame Time: 1\n5\n";
  EXPECT_EQ(read(text).skeleton.joints.size(), std::size_t{kDepth});
}

TEST(ReadBvh, KnowsABvhByItsBeginning) {
  EXPECT_TRUE(looksLikeBvh(asBytes("HIERARCHY\n")));
  EXPECT_TRUE(looksLikeBvh(asBytes("\xef\xbb\xbf \r\nhierarchy")));
  EXPECT_FALSE(looksLikeBvh(asBytes("HIERARCH")));
  EXPECT_FALSE(looksLikeBvh(asBytes("")));
  EXPECT_FALSE(looksLikeBvh(asBytes("solid HIERARCHY")));
}

TEST(ReadBvh, ReadsEverySharedMotion) {
  const std::optional<fs::path> data = limber::testing::sharedDataFolder();
  if (!data) GTEST_SKIP() << limber::testing::kNoSharedData;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(*data / "motions")) {
    if (entry.path().extension() != ".bvh") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Motion motion = readBvh(entry.path());
    EXPECT_NO_THROW(checkMotion(motion));
    ASSERT_EQ(motion.clips.size(), 1u);
    ++count;
    // Whatever the convention was: heads are above feet, and bones keep their lengths.
    Pose pose = restPose(motion.skeleton);
    sampleClip(motion.clips[0], 0.5 * motion.clips[0].duration(), pose);
    double total = 0, stretched = 0;
    for (std::size_t j = 0; j < pose.locals.size(); ++j) {
      if (!motion.skeleton.joints[j].parent) continue;
      const double rest = motion.skeleton.joints[j].rest.translation.norm();
      total += rest;
      stretched += std::abs(pose.locals[j].translation.norm() - rest);
    }
    EXPECT_LT(stretched, 0.05 * total);
  }
  EXPECT_GE(count, 25u);
}

}  // namespace
}  // namespace limber
