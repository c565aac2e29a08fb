#include "limber/document/bvh/bvh_stream.h"

#include <string>

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/document/live/live_text.h"

namespace limber {
namespace {

std::string person(const std::string& height, const std::string& depth) {
  return "HIERARCHY\r\nROOT Hips\r\n{\r\nOFFSET 0 0 0\r\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
         "Yrotation\r\nJOINT Head\r\n{\r\nOFFSET 0 " +
         height + " " + depth +
         "\r\nCHANNELS 3 Zrotation Xrotation Yrotation\r\nEnd Site\r\n{\r\nOFFSET 0 0 0.1\r\n}\r\n}\r\nJOINT "
         "LeftFoot\r\n{\r\nOFFSET 0 -" +
         height + " -" + depth + "\r\nCHANNELS 3 Zrotation Xrotation Yrotation\r\n}\r\n}\r\nMOTION\r\n";
}

const std::string kRows[] = {"0 1 0 10 0 0 5 0 0 0 0 7\n", "0.5 1 2 20 30 0 0 40 0 1 2 3\n"};

// Row by row, in pieces of any size, the joints stand where they do in the file.
TEST(BvhStream, MovesAsTheFileDoes) {
  for (const std::string& header : {person("0.8", "0"), person("0", "0.8")}) {  // the second has Z up
    const std::string text = header + "Frames: 2\nFrame Time: 0.1\n" + kRows[0] + kRows[1];
    const Motion file = readBvh(asBytes(text), "a.bvh");
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, text.size()}) {
      BvhStream stream;
      std::size_t seen = 0;
      for (std::size_t at = 0; at < text.size(); at += piece) {
        stream.take(std::string_view(text).substr(at, piece));
        if (stream.rows() == seen) continue;
        seen = stream.rows();
        Pose pose = restPose(file.skeleton);
        sampleClip(file.clips[0], 0.1 * static_cast<double>(seen - 1), pose);
        const std::vector<Vec3> wanted = posePositions(file.skeleton, pose);
        const std::vector<Vec3> found = posePositions(*stream.skeleton(), stream.pose());
        for (std::size_t j = 0; j < wanted.size(); ++j) EXPECT_LT((wanted[j] - found[j]).norm(), 1e-6) << j;
      }
      EXPECT_EQ(seen, 2u);
    }
  }
}

// With Z up: what has no channel is turned once, not with every row.
TEST(BvhStream, RootsMayLackChannels) {
  for (const char* channels : {"3 Xposition Yposition Zposition", "3 Zrotation Xrotation Yrotation"}) {
    std::string header = person("0", "0.8");
    const std::string all = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";
    header.replace(header.find(all), all.size(), channels);
    header.replace(header.find("OFFSET 0 0 0"), 12, "OFFSET 0 1 2");
    BvhStream stream;
    stream.take(header);
    const std::string row = "0.1 0.2 0.3 0 0 5 0 0 0\n";
    stream.take(row);
    const Pose once = stream.pose();
    stream.take(row);
    for (std::size_t j = 0; j < once.locals.size(); ++j) {
      EXPECT_LT((once.locals[j].translation - stream.pose().locals[j].translation).norm(), 1e-9) << j;
      EXPECT_LT(once.locals[j].rotation.angularDistance(stream.pose().locals[j].rotation), 1e-9) << j;
    }
    EXPECT_GT(posePositions(*stream.skeleton(), once)[1].y(), 0.7) << "heads are up";
  }
}

TEST(BvhStream, NeedsNoCountOfFrames) {
  BvhStream stream;
  stream.take(person("0.8", "0"));
  ASSERT_NE(stream.skeleton(), nullptr);
  EXPECT_EQ(stream.rows(), 0u);
  stream.take(kRows[0]);
  EXPECT_EQ(stream.rows(), 1u);
}

TEST(BvhStream, RefusesWhatIsNone) {
  EXPECT_THROW(BvhStream().take("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n"), Error);
  EXPECT_THROW(BvhStream().take(std::string(70000, ' ')), Error);
  for (const char* row : {"1 2 3\n", "0 1 0 10 0 0 5 0 0 0 0 7 8\n", "0 1 0 nan 0 0 5 0 0 0 0 7\n", "a b c\n"}) {
    BvhStream stream;
    stream.take(person("0.8", "0"));
    EXPECT_THROW(stream.take(row), Error) << row;
  }
}

TEST(LiveText, KeepsSkeletons) {
  BvhStream stream;
  stream.take(person("0", "0.8"));
  const Skeleton read = liveSkeletonFrom(liveSkeletonText(*stream.skeleton()));
  ASSERT_EQ(read.joints.size(), 4u);
  for (std::size_t j = 0; j < 4; ++j) {
    const Joint &a = stream.skeleton()->joints[j], &b = read.joints[j];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.rest.translation, b.rest.translation);
    EXPECT_LT(a.rest.rotation.angularDistance(b.rest.rotation), 1e-12);
  }
  EXPECT_EQ(liveFrameText(restPose(Skeleton{{{"a", {}, {}, 0}}}), 1.5), "[1.5000,0,0,0,0,0,0,1]");
}

TEST(LiveText, RefusesWhatIsNoSkeleton) {
  const auto with = [](const std::string& joint) { return "{\"joints\": [" + joint + "]}"; };
  for (const std::string& text : {std::string("{}"), std::string("[]"), with(""),
                                  with("{\"name\": \"a\", \"parent\": null, \"rest\": [0, 0, 0]}"),
                                  with("{\"name\": \"a\", \"parent\": 0, \"rest\": [0, 0, 0, 0, 0, 0, 1]}"),
                                  with("{\"name\": \"a\", \"parent\": null, \"rest\": [0, 0, 0, 0, 0, 0, 2]}")}) {
    EXPECT_THROW(liveSkeletonFrom(text), Error) << text;
  }
}

}  // namespace
}  // namespace limber
