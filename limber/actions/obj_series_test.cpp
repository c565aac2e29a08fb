#include "limber/actions/obj_series.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/rig/rig_from_animation.h"
#include "limber/core/error.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/mesh/obj_vertices.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

// Two boxes of side 1 that touch at x = 1 and stand `apart` from each other: vertices 0 to 7 and 8 to 15.
std::string touchingBoxes(float apart, const std::string& between = {}, const std::string& behindVertex = {}) {
  std::ostringstream text;
  for (int box = 0; box < 2; ++box) {
    for (int i = 0; i < 8; ++i) {
      const float x = static_cast<float>(box + i % 2) + (box == 0 ? -0.5f : 0.5f) * apart;
      text << "v " << x << " " << i / 2 % 2 << " " << i / 4 << behindVertex << "\n";
    }
  }
  const std::vector<std::vector<int>> faces = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                                               {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (int box = 0; box < 2; ++box) {
    if (box == 1) text << between;
    for (const std::vector<int>& face : faces) {
      text << "f";
      for (const int corner : face) text << " " << 8 * box + corner;
      text << "\n";
    }
  }
  return text.str();
}

class ObjSeriesFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "limber_series_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  static ObjSeries read(const std::vector<std::filesystem::path>& files) {
    Progress progress;
    return readObjSeries(files, 30, progress);
  }

  static std::string refusal(const std::vector<std::filesystem::path>& files) {
    try {
      read(files);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(ObjSeriesFiles, TouchingPiecesMoveEachByItsOwn) {
  for (const std::string between : {"", "o second\n", "usemtl second\n"}) {
    ObjSeries series = read({put("a0.obj", touchingBoxes(0, between)), put("a1.obj", touchingBoxes(1, between)),
                             put("a2.obj", touchingBoxes(2, between))});
    const std::vector<Vec3f> positions = collectGeometry(series.asset).positions;
    ASSERT_EQ(positions.size(), 16u) << between;
    ASSERT_EQ(series.animation.pointOf.size(), 16u);
    EXPECT_EQ(series.animation.sequence.pointCount(), 16u);
    std::vector<int> named(16, 0);
    for (std::size_t v = 0; v < 16; ++v) {
      const Index point = series.animation.pointOf[v];
      ++named[point];
      for (Index f = 0; f < 3; ++f) {
        const float moved = (point < 8 ? -0.5f : 0.5f) * static_cast<float>(f);
        EXPECT_EQ(series.animation.sequence.at(point, f), positions[v] + Vec3f(moved, 0, 0)) << v;
      }
    }
    EXPECT_EQ(named, std::vector<int>(16, 1));
    Progress progress;
    DecompositionOptions options;
    options.bones = 2;
    EXPECT_LT(rigFromAnimation(series.asset, std::move(series.animation), options, progress).error, 1e-5);
  }
}

TEST_F(ObjSeriesFiles, KeepTheColorsThatTheyHaveAndNoOthers) {
  const ObjSeries plain = read({put("a0.obj", touchingBoxes(0)), put("a1.obj", touchingBoxes(1))});
  EXPECT_FALSE(plain.asset.document.meshes[0].primitives[0].attributes.find("COLOR_0"));
  const ObjSeries red = read({put("b0.obj", touchingBoxes(0, "", " 1 0.5 0.25")), put("b1.obj", touchingBoxes(1))});
  const std::optional<Index> accessor = red.asset.document.meshes[0].primitives[0].attributes.find("COLOR_0");
  ASSERT_TRUE(accessor);
  EXPECT_FALSE(red.asset.document.meshes[0].primitives[0].attributes.find("COLOR_1"));
  const std::vector<float> colors = readFloats(red.asset, *accessor);
  ASSERT_EQ(colors.size(), 64u);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    constexpr std::array<float, 4> kLinear = {1, 0.2140411f, 0.0508761f, 1};  // of sRGB
    EXPECT_NEAR(colors[i], kLinear[i % 4], 1e-6) << i;
  }
}

TEST_F(ObjSeriesFiles, FacesMayCountBackwardsAndLinesBeContinued) {
  const std::string absolute = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string relative =
      "  v 0 0 1 # moved\nv 1 0 \\\n 1\r\nv 0 2 2 2\nvn 0 0 1\nf -3//1 -2//1 \\\r\n -1//1 # all\n";
  const ObjSeries series = read({put("a0.obj", absolute), put("a1.obj", relative)});
  EXPECT_EQ(series.animation.sequence.at(0, 1), Vec3f(0, 0, 1));
  EXPECT_EQ(series.animation.sequence.at(1, 1), Vec3f(1, 0, 1));
  EXPECT_EQ(series.animation.sequence.at(2, 1), Vec3f(0, 1, 1)) << "divided by w";
  const ObjSeries turned = read({put("b0.obj", relative), put("b1.obj", absolute)});
  EXPECT_EQ(turned.animation.sequence.at(2, 0), Vec3f(0, 1, 1));
  EXPECT_EQ(turned.animation.sequence.at(2, 1), Vec3f(0, 1, 0));
}

// The model is the first frame's, whether its indices count forwards or backwards: faces, texture coordinates and
// normals are the same.
TEST_F(ObjSeriesFiles, AFirstFrameThatCountsBackwardsIsTheSameModel) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n", uvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  const std::string lifted = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\n", normal = "vn 0 0 1\n";
  const std::vector<std::string> firsts = {
      square + uvs + normal + "f 1/1/1 2/2/1 3/3/1 4/4/1\n",
      square + uvs + normal + "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n",
      square + uvs + normal + "f -4/1/1 2/-3/-1 -2/3/1 4/-1/1 # the square\n",
      square + uvs + normal + "f 1/1/1 \\\n2/2/1 3/3/1\\\r\n 4/4/1#all of it\n",
      square + uvs + "vt 9 9\n" + normal + "vn 1 0 0\nf -4/-5/-2 -3/-4/-2 -2/-3/-2 -1/-2/-2\n"};
  const std::filesystem::path second = put("second.obj", lifted + "f 1 2 3 4\n");
  std::vector<std::vector<float>> seen;
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    const ObjSeries series = read({put("first.obj", firsts[i]), second});
    const Geometry geometry = collectGeometry(series.asset);
    ASSERT_EQ(geometry.positions.size(), 4u) << i;
    EXPECT_EQ(geometry.triangles.size(), 2u) << i;
    const gltf::Attributes& attributes = series.asset.document.meshes[0].primitives[0].attributes;
    std::vector<float> values = readFloats(series.asset, attributes.find("TEXCOORD_0").value());
    for (const float x : readFloats(series.asset, attributes.find("NORMAL").value())) values.push_back(x);
    seen.push_back(std::move(values));
    EXPECT_EQ(seen[i], seen[0]) << i;
    for (std::size_t v = 0; v < 4; ++v) {
      const Vec3f& p = geometry.positions[v];
      EXPECT_EQ(series.animation.sequence.at(series.animation.pointOf[v], 1), Vec3f(p.x(), p.y(), p.y())) << i;
    }
  }
}

TEST_F(ObjSeriesFiles, CornersThatCountBackwardsBeyondTheFirstAreRefused) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::filesystem::path second = put("second.obj", good + "f 1 2 3\n");
  EXPECT_THAT(refusal({put("a.obj", "f -1 -2 -3\n" + good), second}), HasSubstr("a face names a vertex '-1'"));
  EXPECT_THAT(refusal({put("b.obj", good + "f -1 -2 -4 # no\n"), second}), HasSubstr("a face names a vertex '-4'"));
}

TEST_F(ObjSeriesFiles, ThatLieAreRefused) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1 2 3\n";
  const std::filesystem::path first = put("first.obj", good + face);
  const auto refused = [&](const std::string& text) {
    const std::filesystem::path bad = put("bad.obj", text);
    const std::string later = refusal({first, bad}), earlier = refusal({bad, first});
    EXPECT_THAT(later, HasSubstr("bad.obj: "));
    EXPECT_THAT(earlier, HasSubstr("bad.obj"));
    return later;
  };
  EXPECT_THAT(refused(good + "f 1 2 4\n"), HasSubstr("a face names vertex 4 of 3"));
  EXPECT_THAT(refused(good + "f 1 2 -4\n"), HasSubstr("a face names a vertex '-4'"));
  EXPECT_THAT(refused(good + "f 0 1 2\n"), HasSubstr("a face names a vertex '0'"));
  EXPECT_THAT(refused(good + "f 1 2 1e300\n"), HasSubstr("a face names a vertex '1e300'"));
  EXPECT_THAT(refused(good + "f 1 2 99999999999999999999\n"), HasSubstr("a face names a vertex"));
  EXPECT_THAT(refused(good + "f 1 2 1.5\n"), HasSubstr("a face names a vertex '1.5'"));
  EXPECT_THAT(refused(good + "f 1 2 3x\n"), HasSubstr("a face names a vertex '3x'"));
  EXPECT_THAT(refused(good + "f 1 2 nan\n"), HasSubstr("a face names a vertex"));
  EXPECT_THAT(refused(good + "f 1 2 x\n"), HasSubstr("a face names a vertex"));
  EXPECT_THAT(refused(good + "f 1 2"), HasSubstr("other faces than first.obj"));
  EXPECT_THAT(refused(good + "v 1 1 0\n" + face), HasSubstr("has 4 vertices where first.obj has 3"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 0 1"), HasSubstr("vertex 3 is not three finite numbers"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 0 1e300 0\n" + face), HasSubstr("vertex 3 is not three finite numbers"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 0 1 0 0\n" + face), HasSubstr("vertex 3 is not three finite numbers"));
  EXPECT_THAT(refused(""), HasSubstr("bad.obj"));
}

// Coordinates that single precision just holds are read; that they are too far for a rig is said.
TEST_F(ObjSeriesFiles, HugeCoordinatesAreTakenOrRefused) {
  const std::string face = "f 1 2 3\n";
  const std::filesystem::path small = put("a0.obj", "v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\n" + face);
  const std::filesystem::path huge = put("a1.obj", "v 0 0 0\nv 3e38 0 0\nv 0 -3e38 0\n" + face);
  ObjSeries series = read({small, huge});
  EXPECT_EQ(series.animation.sequence.at(1, 1).x(), 3e38f);
  Progress progress;
  EXPECT_THROW(rigFromAnimation(series.asset, std::move(series.animation), {}, progress), Error);
  EXPECT_EQ(read({huge, small}).animation.sequence.at(1, 0).x(), 3e38f);
}

TEST_F(ObjSeriesFiles, BeyondTheLimitAreRefusedBeforeTheyAreRead) {
  const std::filesystem::path first = put("a0.obj", touchingBoxes(0));
  EXPECT_THAT(refusal(std::vector<std::filesystem::path>((1 << 20) + 1, first)), HasSubstr("a0.obj: 1048577 frames"));
}

TEST_F(ObjSeriesFiles, CanBeCancelled) {
  std::vector<std::filesystem::path> files;
  for (int f = 0; f < 6; ++f) files.push_back(put("a" + std::to_string(f) + ".obj", touchingBoxes(float(f))));
  files.push_back(folder_ / "is-not-reached.obj");
  int reported = 0;
  Progress progress([&](std::string_view, double) {
    if (++reported == 5) progress.cancel();
  });
  try {
    readObjSeries(files, 30, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  }
  EXPECT_EQ(reported, 5);
}

}  // namespace
}  // namespace limber
