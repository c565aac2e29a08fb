#include "limber/document/images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/uri.h"

namespace limber {
namespace {

TEST(Images, AreKnownByTheirFirstBytes) {
  EXPECT_EQ(imageFormat(testing::pngBytes()).mediaType, "image/png");
  EXPECT_EQ(imageFormat(testing::pngBytes()).extension, ".png");
  EXPECT_EQ(imageFormat(Bytes{0xff, 0xd8, 0xff, 0xe0}).extension, ".jpg");
  EXPECT_EQ(imageFormat(Bytes{'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'}).extension, ".webp");
  EXPECT_EQ(imageFormat(Bytes{'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B'}).extension, "");
  EXPECT_EQ(imageFormat(Bytes{}).mediaType, "");
}

TEST(Images, AreFoundWhereverTheyLie) {
  testing::GltfBuilder model;
  const Bytes png = testing::pngBytes();
  model.view(std::vector<std::uint8_t>{1, 2, 3});
  const Index view = model.view(png);
  model.push("images", {{"bufferView", view}, {"mimeType", "image/png"}});
  model.push("images", {{"uri", "data:image/png;base64," + encodeBase64(png)}});
  model.push("images", {{"uri", "beside.png"}});
  model.push("images", {{"uri", "missing.png"}});
  const Asset asset = readAsset(model.glb(), "m.glb", [&](std::string_view path) -> std::optional<Bytes> {
    if (path == "beside.png") return png;
    return std::nullopt;
  });
  for (const Index image : {0, 1, 2}) EXPECT_EQ(imageBytes(asset, image), png) << image;
  EXPECT_FALSE(imageBytes(asset, 3));
}

}  // namespace
}  // namespace limber
