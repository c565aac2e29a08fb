// Every truncation and many patches of good files: each read must end in an Error or in an Asset that holds together,
// in bounded memory.
#include <random>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "limber/core/sanitizers.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using testing::everythingModel;
using testing::GltfBuilder;

struct Tally {
  int errors = 0, assets = 0;
};

// Reads, and where that works uses everything, writes, and reads what was written.
void tryBytes(ByteSpan bytes, Tally& tally) {
  Asset asset;
  try {
    asset = readAsset(bytes, "hostile");
  } catch (const Error& error) {
    ++tally.errors;
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_EQ(error.where().substr(0, 7), "hostile");
    return;
  }
  ++tally.assets;
  checkAsset(asset);
  for (Index i = 0; i < asset.document.accessors.size(); ++i) {
    const AccessorInfo info = accessorInfo(asset, i);
    EXPECT_EQ(readFloats(asset, i).size(), std::size_t{info.count} * info.components);
  }
  const Bytes written = writeGlb(asset);
  const Asset again = readAsset(written, "again");
  EXPECT_EQ(writeGlb(again), written);
}

Bytes bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

class HostileFiles : public ::testing::TestWithParam<Bytes> {
 protected:
  void TearDown() override {
    if (kAddressSanitizer) return;  // which keeps freed memory for a while
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 300 * 1024);  // KiB; the files have a few
  }
};

TEST_P(HostileFiles, EveryTruncation) {
  const Bytes& file = GetParam();
  Tally tally;
  for (std::size_t length = 0; length < file.size(); ++length) tryBytes(ByteSpan(file).first(length), tally);
  EXPECT_EQ(tally.assets, 0);
}

TEST_P(HostileFiles, PatchedBytes) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
  constexpr std::uint8_t kTelling[] = {0x00, 0x01, 0x7f, 0x80, 0xff, '0', '9', '-', '"', '}', ']', '[', ','};
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    Bytes file = GetParam();
    for (std::size_t patches = 1 + below(3); patches > 0; --patches) {
      std::uint8_t& byte = file[below(file.size())];
      byte = below(2) == 0 ? static_cast<std::uint8_t>(byte ^ (1 + below(255))) : kTelling[below(sizeof(kTelling))];
    }
    tryBytes(file, tally);
  }
  EXPECT_GT(tally.errors, 100);
  EXPECT_GT(tally.assets, 100);
}

TEST_P(HostileFiles, PiecesCutOutAndDoubled) {
  std::mt19937 random(11);
  Tally tally;
  for (int i = 0; i < 1000; ++i) {
    Bytes file = GetParam();
    const auto at = static_cast<std::ptrdiff_t>(random() % file.size());
    const auto end = std::min<std::ptrdiff_t>(at + 1 + static_cast<std::ptrdiff_t>(random() % 64),
                                              static_cast<std::ptrdiff_t>(file.size()));
    if (random() % 2 == 0) {
      file.erase(file.begin() + at, file.begin() + end);
    } else {
      const Bytes piece(file.begin() + at, file.begin() + end);
      file.insert(file.begin() + at, piece.begin(), piece.end());
    }
    tryBytes(file, tally);
  }
  EXPECT_GT(tally.errors, 100);
}

INSTANTIATE_TEST_SUITE_P(Files, HostileFiles,
                         ::testing::Values(everythingModel().glb(), bytesOf(everythingModel().gltf())),
                         [](const auto& file) { return file.index == 0 ? "Glb" : "Gltf"; });

// Each value of the document, one after the other, replaced by each of these.
TEST(HostileJson, EveryValueReplaced) {
  const GltfBuilder model = everythingModel();
  const Json values = Json::parse(
      R"([-1, 0, 1, 2, 5, 255, 65536, 4294967295, 4294967296, 18446744073709551615, 1e300, 0.5, "", "x", null, true, [], {}, [0], [[[]]], {"a": 1}])");
  Tally tally;
  const Json flat = model.json.flatten();
  for (const auto& [pointer, leaf] : flat.items()) {
    // The leaf itself and what it lies in.
    for (Json::json_pointer location(pointer); !location.empty(); location = location.parent_pointer()) {
      for (const Json& value : values) {
        GltfBuilder changed = model;
        changed.json[location] = value;
        tryBytes(changed.glb(), tally);
      }
      if (location.back() != "0") break;  // parents once, by their first child
    }
  }
  EXPECT_GT(tally.errors, 1000);
  EXPECT_GT(tally.assets, 100);
}

TEST(HostileJson, EveryMemberTakenOut) {
  const GltfBuilder model = everythingModel();
  Tally tally;
  const Json flat = model.json.flatten();
  for (const auto& [pointer, leaf] : flat.items()) {
    for (Json::json_pointer location(pointer); !location.empty(); location = location.parent_pointer()) {
      GltfBuilder changed = model;
      Json& parent = changed.json[location.parent_pointer()];
      if (parent.is_object()) {
        parent.erase(location.back());
      } else {
        parent.erase(std::stoul(location.back()));
      }
      tryBytes(changed.glb(), tally);
    }
  }
  EXPECT_GT(tally.errors, 100);
  EXPECT_GT(tally.assets, 50);
}

// A kilobyte that speaks of gigabytes.
TEST(HostileJson, ClaimsOfSizeAreNotBelieved) {
  const char* const kClaims[] = {
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":9007199254740991}]})",
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4000000000,"uri":"data:;base64,AAAA"}]})",
      R"({"asset":{"version":"2.0"},"accessors":[{"count":4294967294,"componentType":5126,"type":"MAT4"}]})",
      R"({"asset":{"version":"2.0"},"accessors":[{"count":4000000000,"componentType":5121,"type":"SCALAR",
          "sparse":{"count":4000000000,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}}]})",
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4000000000,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],
          "bufferViews":[{"buffer":0,"byteLength":4000000000,"extensions":{"EXT_meshopt_compression":
          {"buffer":0,"byteLength":0,"byteStride":4,"count":1000000000,"mode":"ATTRIBUTES"}}}]})"};
  for (const char* text : kClaims) {
    Tally tally;
    tryBytes(asBytes(text), tally);
    EXPECT_EQ(tally.errors, 1) << text;
  }
}

}  // namespace
}  // namespace limber
