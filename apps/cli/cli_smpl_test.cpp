// Motions in SMPL's form, through the program itself.
#include <string>

#include "limber/core/types.h"
#include "limber/document/testing/npy_bytes.h"
#include "limber/document/testing/stored_zip.h"
#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

class CliSmpl : public Cli {
 protected:
  // Three frames of a person who lifts the left arm; `up` is where its head is.
  void putMotion(const char* name, const Vec3& up) {
    std::vector<double> poses;
    for (int frame = 0; frame < 3; ++frame) {
      std::vector<double> row(66, 0.0);
      if (up.z() > 0) row[0] = 1.5707963267948966;
      row[3 * 16 + 2] = 0.4 * frame;
      poses.insert(poses.end(), row.begin(), row.end());
    }
    putArchive(name, {{"poses.npy", testing::npyDoubles({3, 66}, poses)},
                      {"mocap_framerate.npy", testing::npyDoubles({1}, {20})}});
  }
  void putArchive(const char* name, const std::vector<std::pair<std::string, Bytes>>& arrays) {
    std::vector<std::pair<std::string, std::string>> files;
    for (const auto& [path, bytes] : arrays) files.emplace_back(path, std::string(bytes.begin(), bytes.end()));
    const Bytes archive = testing::storedZip(files);
    put(name, std::string(archive.begin(), archive.end()));
  }
};

TEST_F(CliSmpl, ConvertsToABvh) {
  putMotion("z.npz", Vec3::UnitZ());
  putMotion("y.npz", Vec3::UnitY());
  const Result turned = run({"convert", "z.npz", "z.bvh"});
  EXPECT_EQ(turned.code, 0) << turned.error;
  EXPECT_THAT(turned.error, HasSubstr("Z up"));
  EXPECT_EQ(run({"convert", "y.npz", "y.bvh", "-q"}).code, 0);
  EXPECT_THAT(content("y.bvh"), HasSubstr("ROOT pelvis"));
  EXPECT_THAT(content("y.bvh"), HasSubstr("Frames: 3\nFrame Time: 0.05"));
  EXPECT_EQ(run({"convert", "z.npz", "lying.bvh", "-q", "--up", "y"}).code, 0);
  EXPECT_NE(content("lying.bvh"), content("z.bvh"));
  EXPECT_THAT(run({"info", "y.npz"}).out, HasSubstr("npz"));
}

TEST_F(CliSmpl, GoesOntoACharacter) {
  putMotion("lift.npz", Vec3::UnitY());
  run({"sample", "biped", "-o", "person.glb", "-q"});
  const Result result = run({"animate", "person.glb", "lift.npz", "-o", "lifts.glb"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("3 frames at 20 a second"));
  keep("lifts.glb");
}

TEST_F(CliSmpl, TellsWhatIsWrong) {
  putMotion("lift.npz", Vec3::UnitY());
  putArchive("body.npz", {{"v_template.npy", testing::npyDoubles({1, 3}, {0, 0, 0})}});
  const Result none = run({"convert", "body.npz", "out.bvh"});
  expectOneLine(none, 1);
  EXPECT_THAT(none.error, HasSubstr("--body"));
  const Result half = run({"convert", "lift.npz", "out.bvh", "--body", "body.npz"});
  expectOneLine(half, 1);
  EXPECT_THAT(half.error, HasSubstr("body.npz: holds no array 'kintree_table'"));
}

}  // namespace
}  // namespace limber
