#include "limber/document/smpl/smpl_motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gmock/gmock.h>

#include "limber/core/text/numbers.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/smpl/smpl_skeleton.h"
#include "limber/document/stored_archive.h"
#include "limber/document/testing/npy_bytes.h"
#include "limber/document/testing/stored_zip.h"
#include "shared_data.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::npyDoubles;
using testing::npyHeader;
using testing::npyOf;

Bytes npyNumber(double value) {
  return npyOf(npyHeader("<f8", "()"), testing::rawBytes<double>({value}));
}

// An axis times an angle by the trace and the skew part of the matrix, not by quaternions as the reader goes.
Vec3 axisAngleOf(const Mat3& rotation) {
  const Vec3 skew(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0), rotation(1, 0) - rotation(0, 1));
  const double angle = std::atan2(0.5 * skew.norm(), 0.5 * (rotation.trace() - 1));
  if (angle < 1e-9) return 0.5 * skew;
  if (angle < 3) return angle / skew.norm() * skew;
  const Mat3 twice = rotation + Mat3::Identity();  // near half a turn its columns lie along the axis
  Eigen::Index longest = 0;
  twice.colwise().squaredNorm().maxCoeff(&longest);
  const Vec3 axis = twice.col(longest).normalized();
  return (skew.dot(axis) < 0 ? -angle : angle) * axis;
}

double degreesBetween(const Mat3& a, const Mat3& b) {
  return axisAngleOf(a * b.transpose()).norm() / kDegree;
}

// The joints' world rotations from the rest pose.
std::vector<Mat3> turnsAt(const Motion& motion, double seconds) {
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips.at(0), seconds, pose);
  const std::vector<Affine> globals = poseGlobals(motion.skeleton, pose), rest = restGlobals(motion.skeleton);
  std::vector<Mat3> turns;
  for (std::size_t j = 0; j < globals.size(); ++j) turns.push_back(globals[j].linear() * rest[j].linear().inverse());
  return turns;
}

std::vector<Vec3> positionsAt(const Motion& motion, double seconds) {
  Pose pose = restPose(motion.skeleton);
  sampleClip(motion.clips.at(0), seconds, pose);
  return posePositions(motion.skeleton, pose);
}

// Frames of a person standing with that axis up, who rotates all joints a little, each differently.
std::vector<double> swayingPoses(std::size_t frames, std::size_t joints, UpAxis up) {
  const Mat3 upright = uprightTurn(up).conjugate().toRotationMatrix();
  std::vector<double> values;
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t j = 0; j < joints; ++j) {
      const auto t = static_cast<double>(f), k = static_cast<double>(j + 1);
      Vec3 turn(0.3 * std::sin(0.2 * t + k), 0.4 * std::cos(0.1 * t * k), 0.2 * std::sin(0.3 * t - k));
      if (j == 0) turn = axisAngleOf(upright * Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix());
      values.insert(values.end(), turn.data(), turn.data() + 3);
    }
  }
  return values;
}

NpzFiles swaying(std::size_t joints, UpAxis up = UpAxis::kY, std::size_t frames = 8) {
  NpzFiles files;
  files["poses.npy"] = npyDoubles({frames, 3 * joints}, swayingPoses(frames, joints, up));
  std::vector<double> trans;
  for (std::size_t f = 0; f < frames; ++f) {
    const auto along = 0.1 * static_cast<double>(f);
    const Vec3 at = uprightTurn(up).conjugate() * Vec3(along, 0.9, 0);
    trans.insert(trans.end(), at.data(), at.data() + 3);
  }
  files["trans.npy"] = npyDoubles({frames, 3}, trans);
  files["mocap_framerate.npy"] = npyNumber(120);
  files["gender.npy"] = npyOf(npyHeader("<U4", "()"), Bytes(16, 0));
  files["labels.npy"] = npyOf(npyHeader("|O", "(1,)"), {0x80, 4});
  return files;
}

TEST(SmplMotion, TurnsEachJointFromItsParent) {
  for (const std::size_t joints : {22, 24, 52, 55}) {
    const Motion motion = readSmplMotion(swaying(joints), "folder/sway.npz");
    EXPECT_EQ(motion.name, "sway");
    EXPECT_EQ(motion.framesPerSecond, 120);
    EXPECT_TRUE(motion.warnings.empty());
    ASSERT_EQ(motion.skeleton.joints.size(), joints);
    const std::vector<double> poses = swayingPoses(8, joints, UpAxis::kY);
    for (const std::size_t frame : {0, 3, 7}) {
      const std::vector<Mat3> turns = turnsAt(motion, static_cast<double>(frame) / 120);
      std::vector<Mat3> wanted(joints);
      for (std::size_t j = 0; j < joints; ++j) {
        const Vec3 turn(poses.data() + 3 * (frame * joints + j));
        wanted[j] = Eigen::AngleAxisd(turn.norm(), turn.normalized());
        const std::optional<Index> parent = motion.skeleton.joints[j].parent;
        if (parent) wanted[j] = wanted[*parent] * wanted[j];
        EXPECT_LT(degreesBetween(turns[j], wanted[j]), 1e-4) << motion.skeleton.joints[j].name;
      }
    }
  }
}

TEST(SmplMotion, TellsWhichAxisPointsUp) {
  const Motion upright = readSmplMotion(swaying(22), "y.npz");
  const Motion turned = readSmplMotion(swaying(22, UpAxis::kZ), "z.npz");
  EXPECT_THAT(testing::warningKinds(turned.warnings), ElementsAre("converted-axes"));
  for (const double seconds : {0.0, 0.03}) {
    const std::vector<Mat3> a = turnsAt(upright, seconds), b = turnsAt(turned, seconds);
    const std::vector<Vec3> at = positionsAt(upright, seconds), also = positionsAt(turned, seconds);
    for (std::size_t j = 0; j < a.size(); ++j) {
      EXPECT_LT(degreesBetween(a[j], b[j]), 1e-4);
      EXPECT_LT((at[j] - also[j]).norm(), 1e-5);
    }
  }
  SmplOptions options;
  options.up = UpAxis::kY;
  EXPECT_TRUE(readSmplMotion(swaying(22, UpAxis::kZ), "z.npz", options).warnings.empty());
}

TEST(SmplMotion, FramesUpsideDownAreReportedAndTurnedOnRequest) {
  const Motion upright = readSmplMotion(swaying(22), "y.npz");
  EXPECT_THAT(testing::warningKinds(readSmplMotion(swaying(22, UpAxis::kMinusY), "down.npz").warnings),
              ElementsAre("upside-down"));
  for (const UpAxis up : {UpAxis::kMinusY, UpAxis::kMinusZ}) {
    SmplOptions options;
    options.up = up;
    const Motion turned = readSmplMotion(swaying(22, up), "turned.npz", options);
    EXPECT_THAT(testing::warningKinds(turned.warnings), ElementsAre("converted-axes"));
    const std::vector<Vec3> at = positionsAt(upright, 0.03), also = positionsAt(turned, 0.03);
    for (std::size_t j = 0; j < at.size(); ++j) EXPECT_LT((at[j] - also[j]).norm(), 1e-5);
  }
}

// The lowest joint of all frames is as high as the toes at rest; the displacement over the ground is trans's.
TEST(SmplMotion, StandsOnTheGround) {
  const Motion motion = readSmplMotion(swaying(22), "sway.npz");
  double lowest = 1e9;
  for (int f = 0; f < 8; ++f) {
    for (const Vec3& joint : positionsAt(motion, f / 120.0)) lowest = std::min(lowest, joint.y());
  }
  EXPECT_NEAR(lowest, 0.02, 1e-6);
  EXPECT_NEAR(positionsAt(motion, 7 / 120.0)[0].x() - positionsAt(motion, 0)[0].x(), 0.7, 1e-6);
}

// As one of SMPL-X's arrays for each part of the body, under both of their names.
TEST(SmplMotion, TakesPartsOfTheBody) {
  constexpr std::size_t kFrames = 8, kJoints = 55;
  const std::vector<double> poses = swayingPoses(kFrames, kJoints, UpAxis::kY);
  const auto part = [&](std::size_t first, std::size_t count) {
    std::vector<double> values;
    for (std::size_t f = 0; f < kFrames; ++f) {
      const double* const from = poses.data() + 3 * (f * kJoints + first);
      values.insert(values.end(), from, from + 3 * count);
    }
    return npyDoubles({kFrames, 3 * count}, values);
  };
  const Motion whole = readSmplMotion(swaying(kJoints), "x.npz");
  NpzFiles amass = swaying(kJoints), library = swaying(kJoints);
  amass.erase("poses.npy");
  library.erase("poses.npy");
  amass["root_orient.npy"] = library["global_orient.npy"] = part(0, 1);
  amass["pose_body.npy"] = library["body_pose.npy"] = part(1, 21);
  amass["pose_jaw.npy"] = library["jaw_pose.npy"] = part(22, 1);
  amass["pose_eye.npy"] = part(23, 2);
  library["leye_pose.npy"] = part(23, 1);
  library["reye_pose.npy"] = part(24, 1);
  amass["pose_hand.npy"] = part(25, 30);
  library["left_hand_pose.npy"] = part(25, 15);
  library["right_hand_pose.npy"] = part(40, 15);
  for (const NpzFiles& files : {amass, library}) {
    const Motion motion = readSmplMotion(files, "x.npz");
    ASSERT_EQ(motion.skeleton.joints.size(), kJoints);
    EXPECT_TRUE(motion.warnings.empty());
    const std::vector<Mat3> a = turnsAt(whole, 0.05), b = turnsAt(motion, 0.05);
    for (std::size_t j = 0; j < kJoints; ++j) EXPECT_EQ(a[j], b[j]) << j;
  }
  library["left_hand_pose.npy"] = npyDoubles({kFrames, 12}, std::vector<double>(kFrames * 12, 1));
  EXPECT_THAT(testing::warningKinds(readSmplMotion(library, "x.npz").warnings), ElementsAre("hand-components"));
  amass.erase("pose_hand.npy");
  amass["pose_jaw.npy"] = npyDoubles({3}, {0, 0.1, 0});  // one row for all frames
  EXPECT_EQ(readSmplMotion(amass, "x.npz").clips[0].duration(), whole.clips[0].duration());
  for (const char* name : {"pose_jaw.npy", "pose_eye.npy"}) amass.erase(name);
  EXPECT_EQ(readSmplMotion(amass, "x.npz").skeleton.joints.size(), 22u);
}

TEST(SmplMotion, MendsNumbersAndRates) {
  NpzFiles files = swaying(22);
  std::vector<double> poses = swayingPoses(8, 22, UpAxis::kY);
  poses[66 + 5] = std::nan("");
  poses[0] = 1e300;
  files["poses.npy"] = npyDoubles({8, 22, 3}, poses);
  files["mocap_framerate.npy"] = npyNumber(0);
  const Motion motion = readSmplMotion(files, "bad.npz");
  EXPECT_EQ(testing::countOf(motion.warnings, "bad-numbers"), 2u);
  EXPECT_THAT(motion.warnings.items(),
              ::testing::Contains(::testing::Field(&Warning::message, HasSubstr("too large"))));
  EXPECT_EQ(testing::countOf(motion.warnings, "frame-rate"), 1u);
  EXPECT_EQ(motion.framesPerSecond, 30);
  files.erase("mocap_framerate.npy");
  files["fps.npy"] = npyOf(npyHeader("<i8", "(1,)"), testing::rawBytes<std::int64_t>({25}));
  EXPECT_EQ(readSmplMotion(files, "bad.npz").framesPerSecond, 25);
}

std::string refusalOf(const NpzFiles& files) {
  try {
    readSmplMotion(files, "a.npz");
  } catch (const Error& error) {
    EXPECT_THAT(error.where(), ::testing::StartsWith("a.npz"));
    return error.what();
  }
  ADD_FAILURE() << "took it";
  return {};
}

TEST(SmplMotion, RefusesWhatIsNoMotion) {
  const auto with = [](const char* name, Bytes bytes) {
    NpzFiles files = swaying(22);
    files[name] = std::move(bytes);
    return files;
  };
  EXPECT_THAT(refusalOf({}), HasSubstr("holds no motion"));
  EXPECT_THAT(refusalOf({{"v_template.npy", npyDoubles({1, 3}, {0, 0, 0})}}), HasSubstr("--body"));
  EXPECT_THAT(refusalOf(with("poses.npy", npyDoubles({2, 60}, std::vector<double>(120)))), HasSubstr("60 numbers"));
  EXPECT_THAT(refusalOf(with("poses.npy", npyDoubles({0, 66}, {}))), HasSubstr("holds no frame"));
  EXPECT_THAT(refusalOf(with("poses.npy", npyDoubles({9, 66}, std::vector<double>(594)))), HasSubstr("8 rows for 9"));
  EXPECT_THAT(refusalOf(with("trans.npy", npyDoubles({8, 4}, std::vector<double>(32)))), HasSubstr("trans.npy"));
  EXPECT_THAT(refusalOf(with("poses.npy", npyOf(npyHeader("|O", "(2, 66)"), {0x80}))), HasSubstr("Python objects"));
  NpzFiles parts = {{"pose_body.npy", npyDoubles({4, 63}, std::vector<double>(252))},
                    {"root_orient.npy", npyDoubles({3, 3}, std::vector<double>(9))}};
  EXPECT_THAT(refusalOf(parts), HasSubstr("root_orient.npy: has 3 rows for 4"));
  parts["root_orient.npy"] = npyDoubles({4, 9}, std::vector<double>(36));
  EXPECT_THAT(refusalOf(parts), HasSubstr("rows of 9 numbers, not of 3"));
}

// The shape is looked at first: no numbers are there, and none are asked for.
TEST(SmplMotion, RefusesTooManyFramesByTheirShape) {
  for (const char* shape : {"(4194305, 66)", "(1, 2000000000)", "(2000000000,)"}) {
    EXPECT_THAT(refusalOf({{"poses.npy", npyOf(npyHeader("|u1", shape), {})}}), HasSubstr("more than 4194304 frames"));
  }
}

// The joints of three vertices on a line, a chain of 24; the first shape makes it twice as long.
std::shared_ptr<const NpzFiles> lineBody(std::size_t joints) {
  NpzFiles files;
  files["v_template.npy"] = npyDoubles({2, 3}, {0, 0.5, 0, 0, 1.5, 0});
  files["shapedirs.npy"] = npyDoubles({2, 3, 1}, {0, 0, 0, 0, 1, 0});
  std::vector<double> regressor, tree;
  for (std::size_t j = 0; j < joints; ++j) {
    const double along = static_cast<double>(j) / 100;
    regressor.insert(regressor.end(), {1 - along, along});
  }
  for (const Joint& joint : smplSkeleton(joints).joints) tree.push_back(joint.parent ? *joint.parent : -1.0);
  for (std::size_t j = 0; j < joints; ++j) tree.push_back(static_cast<double>(j));
  files["J_regressor.npy"] = npyDoubles({joints, 2}, regressor);
  files["kintree_table.npy"] = npyDoubles({2, joints}, tree);
  return std::make_shared<const NpzFiles>(files);
}

TEST(SmplMotion, TakesTheJointsOfABody) {
  NpzFiles files = swaying(24);
  SmplOptions options;
  options.up = UpAxis::kY;
  options.body = lineBody(24);
  const auto kneeOf = [](const Motion& motion) { return restPositions(motion.skeleton)[4]; };
  EXPECT_LT((kneeOf(readSmplMotion(files, "a.npz", options)) - Vec3(0, 0.54, 0)).norm(), 1e-9);
  files["betas.npy"] = npyDoubles({2, 3}, {1, 9, 9, 7, 7, 7});
  const Motion shaped = readSmplMotion(files, "a.npz", options);
  EXPECT_LT((kneeOf(shaped) - Vec3(0, 0.58, 0)).norm(), 1e-9);
  EXPECT_LT((positionsAt(shaped, 0)[0] - Vec3(0, 0.5 + 0.9, 0)).norm(), 1e-6);  // the pelvis at rest, and trans
  options.body = lineBody(52);
  EXPECT_LT((kneeOf(readSmplMotion(files, "a.npz", options)) - Vec3(0, 0.58, 0)).norm(), 1e-9);
  EXPECT_EQ(readSmplMotion(files, "a.npz", options).skeleton.joints.size(), 24u);
}

// A walk of CMU's recordings, written as AMASS would have it, Z up: the joints that both have turn as in the BVH.
TEST(SmplMotion, MovesAsTheBvhThatItWasMadeOf) {
  const auto folder = testing::sharedDataFolder();
  if (!folder) GTEST_SKIP() << testing::kNoSharedData;
  const Motion bvh = readMotion(*folder / "motions" / "cmu_mb_12_01_walk.bvh");
  const std::map<std::string, std::string> names = {{"pelvis", "Hips"},
                                                    {"left_hip", "LeftUpLeg"},
                                                    {"right_hip", "RightUpLeg"},
                                                    {"spine1", "LowerBack"},
                                                    {"left_knee", "LeftLeg"},
                                                    {"right_knee", "RightLeg"},
                                                    {"spine2", "Spine"},
                                                    {"left_ankle", "LeftFoot"},
                                                    {"right_ankle", "RightFoot"},
                                                    {"spine3", "Spine1"},
                                                    {"left_foot", "LeftToeBase"},
                                                    {"right_foot", "RightToeBase"},
                                                    {"neck", "Neck"},
                                                    {"left_collar", "LeftShoulder"},
                                                    {"right_collar", "RightShoulder"},
                                                    {"head", "Head"},
                                                    {"left_shoulder", "LeftArm"},
                                                    {"right_shoulder", "RightArm"},
                                                    {"left_elbow", "LeftForeArm"},
                                                    {"right_elbow", "RightForeArm"},
                                                    {"left_wrist", "LeftHand"},
                                                    {"right_wrist", "RightHand"}};
  const Skeleton smpl = smplSkeleton(52);
  const Index frames = frameCount(bvh.clips[0], bvh.framesPerSecond);
  const Mat3 upright = Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix();
  std::vector<double> poses, trans;
  for (Index f = 0; f < frames; ++f) {
    const double seconds = f / bvh.framesPerSecond;
    const std::vector<Mat3> turns = turnsAt(bvh, seconds);
    std::vector<Mat3> globals;
    for (const Joint& joint : smpl.joints) {
      const auto known = names.find(joint.name);
      const Mat3 above = joint.parent ? globals[*joint.parent] : Mat3::Identity();
      globals.push_back(known == names.end() ? above : Mat3(upright * turns[*bvh.skeleton.find(known->second)]));
      const Vec3 local = axisAngleOf(above.transpose() * globals.back());
      poses.insert(poses.end(), local.data(), local.data() + 3);
    }
    const Vec3 root = upright * positionsAt(bvh, seconds)[0];
    trans.insert(trans.end(), root.data(), root.data() + 3);
  }
  NpzFiles files;
  files["poses.npy"] = npyDoubles({frames, 156}, poses);
  files["trans.npy"] = npyDoubles({frames, 3}, trans);
  files["mocap_framerate.npy"] = npyNumber(bvh.framesPerSecond);
  const Motion read = readSmplMotion(files, "walk.npz");
  EXPECT_THAT(testing::warningKinds(read.warnings), ElementsAre("converted-axes"));
  double farthest = 0;
  for (Index f = 0; f < frames; ++f) {
    const std::vector<Mat3> wanted = turnsAt(bvh, f / bvh.framesPerSecond);
    const std::vector<Mat3> found = turnsAt(read, f / bvh.framesPerSecond);
    for (const auto& [joint, source] : names) {
      farthest =
          std::max(farthest, degreesBetween(found[*read.skeleton.find(joint)], wanted[*bvh.skeleton.find(source)]));
    }
  }
  RecordProperty("farthest_degrees", std::to_string(farthest));
  EXPECT_LT(farthest, 1e-3);
}

// Each byte replaced and each length: a motion that keeps its rules, or an error.
TEST(SmplMotion, TakesNoHarmFromBrokenFiles) {
  const NpzFiles files = swaying(22, UpAxis::kY, 2);
  std::size_t refused = 0;
  for (const char* name : {"poses.npy", "trans.npy", "mocap_framerate.npy"}) {
    for (std::size_t at = 0; at < files.at(name).size(); at += 5) {
      NpzFiles patched = files, cut = files;
      patched[name][at] ^= 0xff;
      cut[name].resize(at);
      EXPECT_THROW(readSmplMotion(cut, "a.npz"), Error);
      try {
        checkMotion(readSmplMotion(patched, "a.npz"));
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 30u);
}

TEST(SmplMotion, IsReadOutOfItsArchive) {
  std::vector<std::pair<std::string, std::string>> stored;
  for (const auto& [path, bytes] : swaying(22)) stored.emplace_back(path, std::string(bytes.begin(), bytes.end()));
  const Bytes archive = testing::storedZip(stored);
  EXPECT_TRUE(looksLikeNpz(archive));
  EXPECT_FALSE(looksLikeNpz(testing::storedZip({{"model.usda", "#usda 1.0"}})));
  const Motion motion = readMotion(archive, "sway");
  EXPECT_EQ(motion.skeleton.joints.size(), 22u);
  const Asset asset = readAsset(archive, "sway.npz");
  EXPECT_EQ(asset.format, "npz");
  EXPECT_EQ(motionOf(asset).clips.at(0).name, "sway");
  EXPECT_THROW(readAsset(asBytes(std::string("numbers")), "sway.npz"), Error);
}

TEST(SmplMotion, ArraysThatNobodyAsksForAreNotUnpacked) {
  std::vector<std::pair<std::string, std::string>> stored;
  for (const auto& [path, bytes] : swaying(22)) stored.emplace_back(path, std::string(bytes.begin(), bytes.end()));
  const std::string extra = "nobody asks for this";
  stored.emplace_back("extra.npy", extra);
  Bytes archive = testing::storedZip(stored);
  const auto index = std::search(archive.begin(), archive.end(), extra.begin(), extra.end());
  ASSERT_NE(index, archive.end());
  *index ^= 1;  // its checksum tells
  EXPECT_THROW(readZipArchive(archive, "sway.npz"), Error);
  const Motion motion = readSmplMotion(archive, "sway.npz"), wanted = readSmplMotion(swaying(22), "sway.npz");
  EXPECT_EQ(positionsAt(motion, 0.03), positionsAt(wanted, 0.03));
  EXPECT_EQ(readMotion(archive, "sway").skeleton.joints.size(), 22u);
  EXPECT_EQ(motionOf(readAsset(archive, "sway.npz")).clips.size(), 1u);

  const Bytes poses = swaying(22).at("poses.npy");
  const auto asked = std::search(archive.begin(), archive.end(), poses.begin(), poses.end());
  ASSERT_NE(asked, archive.end());
  asked[static_cast<std::ptrdiff_t>(poses.size()) - 1] ^= 1;
  EXPECT_THROW(readSmplMotion(archive, "sway.npz"), Error) << "of what is asked for";
}

}  // namespace
}  // namespace limber
