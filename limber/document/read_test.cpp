#include "limber/document/read.h"

#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "temporary_folder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::documentJson;
using ::testing::ElementsAre;
using testing::everythingModel;
using testing::GltfBuilder;
using ::testing::HasSubstr;
using testing::pngBytes;
using testing::TemporaryFolder;
using testing::warningKinds;

struct Failure {
  ErrorCode code;
  std::string line;
};

Failure failureOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return {error.code(), error.what()};
  }
  ADD_FAILURE() << "no error";
  return {};
}

Failure failureOf(std::string_view text, std::string_view name = "m.gltf", const Resolver& resolver = {}) {
  return failureOf([&] { readAsset(asBytes(text), name, resolver); });
}

// The everything model with its buffer and image in files of these names.
GltfBuilder modelBeside(const std::string& bufferUri, const std::string& imageUri) {
  GltfBuilder model = everythingModel();
  model.json["buffers"] = Json::array({{{"byteLength", model.binary.size()}, {"uri", bufferUri}}});
  model.json["images"][0] = {{"uri", imageUri}};
  return model;
}

TEST(ReadAsset, GlbAndGltfHoldTheSame) {
  const GltfBuilder model = everythingModel();
  const Asset glb = readAsset(model.glb(), "a.glb"), gltf = readAsset(asBytes(model.gltf()), "a.gltf");
  EXPECT_EQ(glb.format, "glb");
  EXPECT_EQ(gltf.format, "gltf");
  EXPECT_EQ(glb.name, "a.glb");
  EXPECT_EQ(glb.buffers[0].bytes, model.binary);
  EXPECT_EQ(gltf.buffers[0].bytes, model.binary);
  EXPECT_EQ(glb.buffers[0].uri, "");
  EXPECT_EQ(gltf.buffers[0].uri, "data:application/octet-stream;base64,");
  EXPECT_TRUE(glb.warnings.empty());
  EXPECT_EQ(documentJson(glb)["nodes"], model.json["nodes"]);
  EXPECT_EQ(glb.document.nodes[3].extras->at("large").get<std::uint64_t>(), 9007199254740993u);
  EXPECT_THAT(readFloats(glb, 1), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1));
  EXPECT_THAT(readFloats(glb, 8), ElementsAre(0, 0, 0, 1, 2, 3, 0, 0, 0, 4, 5, 6));
}

TEST(ReadAsset, FormatIsToldFromTheContent) {
  EXPECT_EQ(readAsset(everythingModel().glb(), "standard input").format, "glb");
  EXPECT_EQ(readAsset(everythingModel().glb(), "named.obj").format, "glb");
  EXPECT_EQ(readAsset(asBytes("\xef\xbb\xbf \n{\"asset\":{\"version\":\"2.0\"}}"), "x.stl").format, "gltf");
  EXPECT_THAT(failureOf("", "x.glb").line, HasSubstr("x.glb: is empty"));
  EXPECT_THAT(failureOf("solid x", "x.glb").line, HasSubstr("no GLB"));
  EXPECT_THAT(failureOf("[]", "x.gltf").line, HasSubstr("no glTF"));
}

TEST(ReadAsset, VersionsOtherThanTwoAreRefused) {
  EXPECT_EQ(failureOf(R"({"asset":{"version":"1.0"}})").code, ErrorCode::kUnsupported);
  EXPECT_EQ(failureOf(R"({"asset":{"version":"2.1","minVersion":"2.1"}})").code, ErrorCode::kUnsupported);
  EXPECT_EQ(failureOf(R"({"asset":{"version":"3.0"}})").code, ErrorCode::kUnsupported);
  EXPECT_EQ(failureOf(R"({"asset":{"version":"two"}})").code, ErrorCode::kBadData);
  EXPECT_EQ(failureOf(R"({"asset":{"version":2.0}})").code, ErrorCode::kBadData);
  EXPECT_EQ(failureOf(R"({"asset":{}})").code, ErrorCode::kBadData);
  EXPECT_EQ(failureOf(R"({"meshes":{}})").code, ErrorCode::kBadData);
  EXPECT_NO_THROW(readAsset(asBytes(R"({"asset":{"version":"2.1","minVersion":"2.0"}})"), "m"));
}

TEST(ReadAsset, ResolverGetsDecodedPaths) {
  const GltfBuilder model = modelBeside("my%20data/a.bin", "pic.png");
  const std::map<std::string, Bytes, std::less<>> files = {{"my data/a.bin", model.binary}, {"pic.png", pngBytes()}};
  const Asset asset =
      readAsset(asBytes(model.json.dump()), "m.gltf", [&](std::string_view path) -> std::optional<Bytes> {
        const auto file = files.find(path);
        return file == files.end() ? std::nullopt : std::optional(file->second);
      });
  EXPECT_EQ(asset.buffers[0].bytes, model.binary);
  EXPECT_EQ(asset.buffers[0].uri, "my%20data/a.bin");
  ASSERT_EQ(asset.sideFiles.size(), 1u);
  EXPECT_EQ(asset.sideFiles[0].uri, "pic.png");
  EXPECT_EQ(asset.sideFiles[0].bytes, pngBytes());
}

TEST(ReadAsset, MissingBuffersAreErrors) {
  const std::string text = modelBeside("a.bin", "p.png").json.dump();
  const Failure failure = failureOf(text);
  EXPECT_EQ(failure.code, ErrorCode::kFile);
  EXPECT_THAT(failure.line, HasSubstr("m.gltf: buffers[0]: its file \"a.bin\" is not there"));
  const Resolver tooShort = [](std::string_view) { return Bytes(3); };
  EXPECT_EQ(failureOf(text, "m.gltf", tooShort).code, ErrorCode::kBadData);
  EXPECT_EQ(failureOf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]})").code, ErrorCode::kBadData);
}

TEST(ReadAsset, BuffersOutsideTheFolderAreErrors) {
  for (const char* uri : {"../a.bin", "/a.bin", "http://host/a.bin", "file:///a.bin", "%2e%2e/a.bin"}) {
    bool asked = false;
    const Resolver resolver = [&](std::string_view) {
      asked = true;
      return Bytes(100000);
    };
    EXPECT_EQ(failureOf(modelBeside(uri, "p.png").json.dump(), "m.gltf", resolver).code, ErrorCode::kBadData);
    EXPECT_FALSE(asked) << uri;
  }
}

TEST(ReadAsset, MissingOrForeignImagesStayReferences) {
  for (const char* uri : {"lost.png", "../p.png", "http://host/p.png", "C:\\art\\p.png", "notes.txt"}) {
    const GltfBuilder model = modelBeside("a.bin", uri);
    const Asset asset =
        readAsset(asBytes(model.json.dump()), "m.gltf", [&](std::string_view path) -> std::optional<Bytes> {
          if (path == "a.bin") return model.binary;
          return path == "notes.txt" ? std::optional(Bytes{'s', 'e', 'c', 'r', 'e', 't'}) : std::nullopt;
        });
    EXPECT_TRUE(asset.sideFiles.empty()) << uri;
    EXPECT_EQ(asset.document.images[0].uri, uri);
    EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("missing-images"));
  }
}

TEST(ReadAsset, AFileThatManyBuffersNameIsRefused) {
  Json json = {{"asset", {{"version", "2.0"}}}};
  for (const char* uri : {"a.bin", "./a.bin", "%61.bin", "a.bin"}) {
    json["buffers"].push_back({{"byteLength", 4}, {"uri", uri}});
  }
  int reads = 0;
  const Resolver resolver = [&](std::string_view) {
    ++reads;
    return Bytes(std::size_t{24} << 20);
  };
  const Failure failure = failureOf(json.dump(), "m.gltf", resolver);
  EXPECT_EQ(failure.code, ErrorCode::kLimit);
  EXPECT_THAT(failure.line, HasSubstr("m.gltf: buffers[3]: its file \"a.bin\" was named before"));
  EXPECT_EQ(reads, 3);
  json["buffers"].erase(3);
  EXPECT_NO_THROW(readAsset(asBytes(json.dump()), "m.gltf", resolver));
}

TEST(ReadAsset, PicturesOfAFileThatIsNamedTooOftenStayReferences) {
  const std::vector<std::string> uris = {"a.png", "./a.png", "%61.png", "a.png", "a%2Epng", "%61%2Epng"};
  Json json = {{"asset", {{"version", "2.0"}}}};
  for (const std::string& uri : uris) json["images"].push_back({{"uri", uri}});
  int reads = 0;
  const Resolver resolver = [&](std::string_view) {
    ++reads;
    Bytes picture = pngBytes();
    picture.resize(std::size_t{24} << 20);
    return picture;
  };
  const Asset asset = readAsset(asBytes(json.dump()), "m.gltf", resolver);
  EXPECT_EQ(reads, 3);
  ASSERT_EQ(asset.sideFiles.size(), 3u) << "48 MB more than once; another would make it 72";
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(asset.sideFiles[i].uri, uris[i]);
  for (std::size_t i = 0; i < uris.size(); ++i) EXPECT_EQ(asset.document.images[i].uri, uris[i]);
  ASSERT_THAT(warningKinds(asset.warnings), ElementsAre("missing-images"));
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
  EXPECT_THAT(asset.warnings.items()[0].message, HasSubstr("files named again come to more than 64 MB"));
}

TEST(ReadAsset, AnImageThatCannotBeReadIsLookedForOnce) {
  const Json image = {{"uri", "notes.txt"}};
  const Json json = {{"asset", {{"version", "2.0"}}}, {"images", std::vector<Json>(50, image)}};
  int reads = 0;
  const Resolver resolver = [&](std::string_view) {
    ++reads;
    return Bytes(100);
  };
  const Asset asset = readAsset(asBytes(json.dump()), "m.gltf", resolver);
  EXPECT_EQ(reads, 1);
  EXPECT_EQ(asset.warnings.items().at(0).count, 50u);
}

TEST(ReadAsset, ErrorsQuoteAShortPieceOfTheText) {
  const std::string digits(1 << 20, '1');
  EXPECT_LT(failureOf("{\"a\":" + digits + "e999999}").line.size(), 300u);
  EXPECT_LT(failureOf("{\"a\":\"" + digits + "\n\"}").line.size(), 300u);
  EXPECT_LT(failureOf("{\"asset\":{\"version\":\"1." + digits + "\"}}").line.size(), 300u);
  EXPECT_LT(failureOf("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":1,\"uri\":\"" + digits + "\"}]}")
                .line.size(),
            300u);
}

TEST(ReadAsset, FromDiskWithFilesBeside) {
  const TemporaryFolder folder;
  const GltfBuilder model = modelBeside("data/a%20b.bin", "p.png");
  std::filesystem::create_directory(folder.path() / "data");
  writeFile(folder.path() / "data" / "a b.bin", model.binary);
  writeFile(folder.path() / "p.png", pngBytes());
  writeFile(folder.path() / "m.gltf", asBytes(model.json.dump()));
  const Asset asset = readAsset(folder.path() / "m.gltf");
  EXPECT_EQ(asset.name, "m.gltf");
  EXPECT_EQ(asset.buffers[0].bytes, model.binary);
  EXPECT_EQ(asset.sideFiles.size(), 1u);
  EXPECT_TRUE(asset.warnings.empty());
  std::filesystem::remove(folder.path() / "data" / "a b.bin");
  std::filesystem::create_directory(folder.path() / "data" / "a b.bin");  // no file
  EXPECT_EQ(failureOf([&] { readAsset(folder.path() / "m.gltf"); }).code, ErrorCode::kFile);
  EXPECT_EQ(failureOf([&] { readAsset(folder.path() / "none.gltf"); }).code, ErrorCode::kFile);
}

TEST(ReadAsset, TexturesOfAPlyOutsideTheFolderStayOut) {
  const TemporaryFolder folder;
  const auto put = [&](const char* name, std::string_view text) { writeFile(folder.path() / name, asBytes(text)); };
  std::filesystem::create_directory(folder.path() / "model");
  writeFile(folder.path() / "secret.png", pngBytes());
  put("model/a.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile ../secret.png\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
  const auto images = [&](const char* name) {
    return readAsset(folder.path() / "model" / name).document.images.size();
  };
  EXPECT_EQ(images("a.ply"), 0u);
  // Its name alone is looked for beside the model.
  writeFile(folder.path() / "model/secret.png", pngBytes());
  EXPECT_EQ(images("a.ply"), 1u);
}

TEST(ReadAsset, FolderResolverOpensNothingOutsideItsFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "model");
  for (const char* name : {"secret", "model/own"}) writeFile(folder.path() / name, asBytes("x"));
  const Resolver resolver = folderResolver(folder.path() / "model");
  EXPECT_TRUE(resolver("own"));
  EXPECT_TRUE(resolver("./own"));
  EXPECT_FALSE(resolver("none"));
  for (const std::string& path : {std::string("../secret"), std::string("a/../../secret"), std::string("..\\secret"),
                                  (folder.path() / "secret").string(), std::string("C:secret")}) {
    EXPECT_THROW(resolver(path), Error) << path;
  }
}

TEST(ReadAsset, BinaryChunkMayBeLongerThanTheBuffer) {
  GltfBuilder model = everythingModel();
  model.json["buffers"] = Json::array({{{"byteLength", model.binary.size()}}});
  Bytes chunk = model.binary;
  chunk.resize(chunk.size() + 40);
  const Asset asset = readAsset(GltfBuilder::glbOf(model.json.dump(), chunk), "m.glb");
  EXPECT_EQ(asset.buffers[0].bytes, model.binary);
  chunk.resize(model.binary.size() - 8);
  EXPECT_THROW(readAsset(GltfBuilder::glbOf(model.json.dump(), chunk), "m.glb"), Error);
}

TEST(ReadAsset, BytesBehindABuffersEndAreLeftOut) {
  const GltfBuilder model = modelBeside("a.bin", "p.png");
  const Asset asset = readAsset(asBytes(model.json.dump()), "m.gltf", [&](std::string_view path) {
    Bytes longer = path == "a.bin" ? model.binary : pngBytes();
    longer.resize(longer.size() + 100);
    return longer;
  });
  EXPECT_EQ(asset.buffers[0].bytes, model.binary);
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("trailing-bytes"));
  EXPECT_EQ(asset.warnings.items()[0].count, 100u);
}

TEST(ReadAsset, OnlyTheFirstBufferIsTheBinaryChunk) {
  GltfBuilder model = everythingModel();
  model.json["buffers"] = Json::array({{{"byteLength", model.binary.size()}}, {{"byteLength", 4}}});
  EXPECT_THROW(readAsset(GltfBuilder::glbOf(model.json.dump(), model.binary), "m.glb"), Error);
}

TEST(ReadAsset, TextInUtf16IsToldApart) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const bool bigEndian : {false, true}) {
    for (const bool marked : {false, true}) {
      Bytes bytes;
      const auto put = [&](std::uint8_t low, std::uint8_t high) {
        bytes.push_back(bigEndian ? high : low);
        bytes.push_back(bigEndian ? low : high);
      };
      if (marked) put(0xff, 0xfe);
      for (const char c : text) put(static_cast<std::uint8_t>(c), 0);
      for (const char* name : {"model.obj", "model.gltf", "standard input"}) {
        try {
          readAsset(bytes, name);
          FAIL() << "read UTF-16 as " << name;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
          EXPECT_EQ(error.message(), "is text in UTF-16");
        }
      }
    }
  }
}

// As an exporter of Maya writes it.
TEST(ReadAsset, AnInterpolationThatIsNoNameIsLinear) {
  GltfBuilder model = everythingModel();
  model.json["animations"][0]["samplers"][0]["interpolation"] = 0;
  const Asset asset = readAsset(model.glb(), "m.glb");
  EXPECT_EQ(asset.document.animations.at(0).samplers.at(0).interpolation, Interpolation::kLinear);
}

TEST(ReadAsset, ARotationOfLengthZeroIsNone) {
  GltfBuilder model = everythingModel();
  model.json["nodes"][1]["rotation"] = {0, 0, 0, 0};
  const Asset asset = readAsset(model.glb(), "m.glb");
  EXPECT_FALSE(asset.document.nodes[1].rotation);
  ASSERT_EQ(asset.warnings.items().size(), 1u);
  EXPECT_EQ(asset.warnings.items()[0].kind, "invalid-rotations");
}

TEST(ReadAsset, UnknownRequiredExtensionsAreKept) {
  GltfBuilder model = everythingModel();
  model.json["extensionsUsed"] = model.json["extensionsRequired"] = {"EXT_never_heard_of"};
  model.json["materials"][0]["extensions"]["EXT_never_heard_of"] = {{"texture", 77}};
  const Asset asset = readAsset(model.glb(), "m.glb");
  EXPECT_EQ(documentJson(asset)["extensionsRequired"], model.json["extensionsRequired"]);
  const Warning& warning = asset.warnings.items().back();
  EXPECT_EQ(warning.kind, "unknown-extensions");
  EXPECT_EQ(warning.where, "EXT_never_heard_of");
  EXPECT_EQ(warning.count, 1u);
  EXPECT_EQ(documentJson(asset)["materials"], model.json["materials"]);
}

}  // namespace
}  // namespace limber
