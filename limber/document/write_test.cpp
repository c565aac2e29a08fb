#include "limber/document/write.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using testing::documentJson;
using testing::everythingModel;
using testing::GltfBuilder;
using testing::pngBytes;
using testing::TemporaryFolder;

// The bytes of every buffer view, in order.
std::vector<Bytes> viewsOf(const Asset& asset) {
  std::vector<Bytes> result;
  for (const gltf::BufferView& view : asset.document.bufferViews) {
    const Bytes& buffer = asset.buffers.at(view.buffer).bytes;
    const auto begin = buffer.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
    result.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength));
  }
  return result;
}

std::set<std::string> filesIn(const TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file()) names.insert(entry.path().lexically_relative(folder.path()).generic_string());
  }
  return names;
}

// A document whose buffer and image were files beside it.
Asset assetBeside(const std::string& bufferUri, const std::string& imageUri) {
  GltfBuilder model = everythingModel();
  model.json["buffers"] = Json::array({{{"byteLength", model.binary.size()}, {"uri", bufferUri}, {"name", "data"}}});
  model.json["images"][0] = {{"uri", imageUri}, {"name", "picture"}};
  return readAsset(asBytes(model.json.dump()), "m.gltf", [&](std::string_view path) -> std::optional<Bytes> {
    return path.substr(path.size() - 3) == "bin" ? model.binary : pngBytes();
  });
}

TEST(WriteGlb, ReadAndWrittenIsTheSameFile) {
  const Bytes file = everythingModel().glb();
  EXPECT_EQ(writeGlb(readAsset(file, "m.glb")), file);
}

TEST(WriteGlb, BuffersBecomeOneAndImagesAreEmbedded) {
  Asset asset = assetBeside("a.bin", "p.png");
  const std::vector<Bytes> views = viewsOf(asset);
  const Index added = addFloatAccessor(asset, std::vector<float>{1, 2, 3}, 3);
  ASSERT_EQ(asset.buffers.size(), 2u);
  const Asset again = readAsset(writeGlb(asset), "m.glb");
  EXPECT_EQ(again.buffers.size(), 1u);
  EXPECT_EQ(documentJson(again)["buffers"][0]["name"], "data");
  EXPECT_FALSE(documentJson(again)["buffers"][0].contains("uri"));
  std::vector<Bytes> after = viewsOf(again);
  ASSERT_EQ(after.size(), views.size() + 2);
  EXPECT_EQ(after.back(), pngBytes());
  after.resize(views.size());
  EXPECT_EQ(after, views);
  EXPECT_EQ(readFloats(again, added), (std::vector<float>{1, 2, 3}));
  const Json image = documentJson(again)["images"][0];
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(image["name"], "picture");
  EXPECT_EQ(image["bufferView"], views.size() + 1);
  EXPECT_FALSE(image.contains("uri"));
}

TEST(WriteGlb, AnImageUsedTwiceIsStoredOnce) {
  Asset asset = assetBeside("a.bin", "p.png");
  asset.document.images.push_back(gltf::Image(asset.document.images[0]));
  const Asset again = readAsset(writeGlb(asset), "m.glb");
  EXPECT_EQ(documentJson(again)["images"][0]["bufferView"], documentJson(again)["images"][1]["bufferView"]);
}

TEST(WriteGlb, DoesNotChangeTheAsset) {
  const Asset asset = assetBeside("a.bin", "p.png");
  const Json before = documentJson(asset);
  EXPECT_EQ(writeGlb(asset), writeGlb(asset));
  EXPECT_EQ(documentJson(asset), before);
}

TEST(WriteGlb, AnAssetWithoutBytesHasNoBinaryChunk) {
  EXPECT_EQ(writeGlb(readAsset(GltfBuilder().glb(), "m.glb")), GltfBuilder().glb());
}

TEST(WriteAsset, GltfKeepsNamesFoldersAndBytes) {
  const TemporaryFolder folder;
  const Asset asset = assetBeside("data/a%20b.bin", "textures/p.png");
  writeAsset(asset, folder.path() / "out.gltf");
  EXPECT_EQ(filesIn(folder), (std::set<std::string>{"data/a b.bin", "out.gltf", "textures/p.png"}));
  const Asset again = readAsset(folder.path() / "out.gltf");
  EXPECT_EQ(documentJson(again), documentJson(asset));
  EXPECT_EQ(again.buffers[0].bytes, asset.buffers[0].bytes);
  EXPECT_EQ(again.sideFiles[0].bytes, pngBytes());
}

TEST(WriteAsset, GlbToGltfAndBackKeepsEveryView) {
  const TemporaryFolder folder;
  const Asset asset = readAsset(everythingModel().glb(), "m.glb");
  writeAsset(asset, folder.path() / "out put.gltf");
  EXPECT_EQ(filesIn(folder), (std::set<std::string>{"out put.bin", "out put.gltf"}));
  const Asset gltf = readAsset(folder.path() / "out put.gltf");
  EXPECT_EQ(gltf.document.buffers[0].uri, "out%20put.bin");
  EXPECT_EQ(viewsOf(gltf), viewsOf(asset));
  writeAsset(gltf, folder.path() / "back.GLB");
  const Asset back = readAsset(folder.path() / "back.GLB");
  EXPECT_EQ(viewsOf(back), viewsOf(asset));
  EXPECT_EQ(documentJson(back), documentJson(asset));
}

TEST(WriteAsset, DataUrisStayInside) {
  const TemporaryFolder folder;
  const std::string text = everythingModel().gltf();
  writeAsset(readAsset(asBytes(text), "m.gltf"), folder.path() / "out.gltf");
  EXPECT_EQ(filesIn(folder), (std::set<std::string>{"out.gltf"}));
  EXPECT_EQ(Json::parse(std::ifstream(folder.path() / "out.gltf")), Json::parse(text));
}

TEST(WriteAsset, BuffersOfOneAssetGetNamesOfTheirOwn) {
  const TemporaryFolder folder;
  Asset asset = assetBeside("out.bin", "out.gltf");  // both names are wanted by others too
  addFloatAccessor(asset, std::vector<float>{1}, 1);
  writeAsset(asset, folder.path() / "out.gltf");
  EXPECT_EQ(filesIn(folder), (std::set<std::string>{"out.bin", "out.gltf", "out_1.bin", "out_out.gltf"}));
  const Asset again = readAsset(folder.path() / "out.gltf");
  EXPECT_EQ(viewsOf(again), viewsOf(asset));
  EXPECT_EQ(again.sideFiles[0].bytes, pngBytes());
}

TEST(WriteAsset, FilesOfOtherModelsAreLeftAlone) {
  const TemporaryFolder folder;
  const Bytes foreign = {1, 2, 3};
  writeFile(folder.path() / "a.bin", foreign);
  writeFile(folder.path() / "p.png", pngBytes());  // the same bytes: shared
  const Asset asset = assetBeside("a.bin", "p.png");
  for (int run = 0; run < 2; ++run) {
    writeAsset(asset, folder.path() / "out.gltf");
    EXPECT_EQ(filesIn(folder), (std::set<std::string>{"a.bin", "out.gltf", "out_a.bin", "p.png"}));
    EXPECT_EQ(readFile(folder.path() / "a.bin"), foreign);
    EXPECT_EQ(viewsOf(readAsset(folder.path() / "out.gltf")), viewsOf(asset));
  }
}

TEST(WriteAsset, FailureLeavesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "a.bin");  // takes the name: ours gets another
  std::filesystem::create_directory(folder.path() / "out_a.bin");
  writeFile(folder.path() / "out_a.bin" / "x", Bytes{1});
  EXPECT_THROW(writeAsset(assetBeside("a.bin", "new/p.png"), folder.path() / "out.gltf"), Error);
  EXPECT_EQ(filesIn(folder), (std::set<std::string>{"out_a.bin/x"}));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new"));
  EXPECT_THROW(writeAsset(assetBeside("a.bin", "p.png"), folder.path() / "none" / "out.glb"), Error);
}

TEST(WriteAsset, OtherExtensionsAreRefused) {
  for (const char* name : {"out.obj", "out", "out.glb.txt"}) {
    try {
      writeAsset(Asset(), name);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    }
  }
}

}  // namespace
}  // namespace limber
