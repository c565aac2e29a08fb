#include "limber/document/smpl/npz.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/document/testing/npy_bytes.h"

namespace limber {

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::npyHeader;
using testing::npyOf;
using testing::rawBytes;

std::string refusalOf(const Bytes& bytes, ErrorCode code) {
  try {
    readNpy(bytes, "a.npy");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_EQ(error.where(), "a.npy");
    return error.what();
  }
  ADD_FAILURE() << "took it";
  return {};
}

// As NumPy 1.26 writes np.array([[1, 2, 3], [4, 5, 6]], '<i2').
TEST(NpzTest, ReadsTheBytesOfNumPy) {
  const std::string text(
      "\x93NUMPY\x01\x00\x76\x00{'descr': '<i2', 'fortran_order': False, 'shape': (2, 3), }"
      "                                                          \n\1\0\2\0\3\0\4\0\5\0\6\0",
      140);
  const NpyArray array = readNpy(asBytes(text), "a.npy");
  EXPECT_THAT(array.shape, ElementsAre(2u, 3u));
  EXPECT_THAT(array.values, ElementsAre(1, 2, 3, 4, 5, 6));
}

template <typename T>
void expectRead(const char* type, const std::vector<T>& values) {
  for (const int version : {1, 2, 3}) {
    const NpyArray array =
        readNpy(npyOf(npyHeader(type, testing::shapeText({values.size()})), rawBytes(values), version), "a.npy");
    ASSERT_EQ(array.values.size(), values.size()) << type;
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(array.values[i], static_cast<double>(values[i])) << type;
  }
}

TEST(NpzTest, ReadsEveryTypeInEveryVersion) {
  expectRead<double>("<f8", {0, -1.5, 1e300, std::numeric_limits<double>::infinity()});
  expectRead<float>("<f4", {0, -1.5f, 1e-30f});
  expectRead<std::int64_t>("<i8", {0, -1, 1LL << 52});
  expectRead<std::uint64_t>("<u8", {0, ~0ULL});
  expectRead<std::int32_t>("<i4", {0, -1, INT32_MIN});
  expectRead<std::uint32_t>("<u4", {0, 0xffffffffu});
  expectRead<std::int16_t>("<i2", {0, -1, INT16_MIN});
  expectRead<std::uint16_t>("<u2", {0, 0xffff});
  expectRead<std::int8_t>("|i1", {0, -1, INT8_MIN});
  expectRead<std::uint8_t>("|u1", {0, 255});
}

TEST(NpzTest, PutsFortransOrderIntoRows) {
  // values[i][j][k] = 100 i + 10 j + k, the first index fastest in the file.
  std::vector<double> stored, wanted;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 2; ++i) stored.push_back(100 * i + 10 * j + k);
    }
  }
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 4; ++k) wanted.push_back(100 * i + 10 * j + k);
    }
  }
  const NpyArray array = readNpy(npyOf(npyHeader("<f8", "(2, 3, 4)", true), rawBytes(stored)), "a.npy");
  EXPECT_EQ(array.values, wanted);
  EXPECT_TRUE(array.hasShape(std::vector<std::size_t>{2, 3, 4}));
  EXPECT_FALSE(array.hasShape(std::vector<std::size_t>{2, 3}));
}

TEST(NpzTest, ReadsSingleNumbersAndNone) {
  const NpyArray number = readNpy(npyOf(npyHeader("<f8", "()"), rawBytes<double>({7})), "a.npy");
  EXPECT_THAT(number.shape, IsEmpty());
  EXPECT_THAT(number.values, ElementsAre(7));
  const NpyArray none = readNpy(npyOf(npyHeader("<f8", "(0, 99999999999)", true), {}), "a.npy");
  EXPECT_THAT(none.values, IsEmpty());
}

TEST(NpzTest, RefusesWhatIsNoPlainNumbers) {
  const Bytes data(16, 0);
  const ErrorCode unsupported = ErrorCode::kUnsupported;
  EXPECT_THAT(refusalOf(npyOf(npyHeader("|O", "(2,)"), data), unsupported), HasSubstr("Python objects"));
  EXPECT_THAT(refusalOf(npyOf(npyHeader(">f8", "(2,)"), data), unsupported), HasSubstr("big-endian"));
  for (const char* type : {"<U2", "<c16", "<f2", "<M8[s]", "", "<", "f8", "|f8", "=f8", "|b1"}) {
    EXPECT_THAT(refusalOf(npyOf(npyHeader(type, "(2,)"), data), unsupported), HasSubstr("not read")) << type;
  }
  const std::string records = "{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2,), }";
  EXPECT_THAT(refusalOf(npyOf(records, data), unsupported), HasSubstr("records"));
  EXPECT_THAT(refusalOf(npyOf(npyHeader("<f8", "(2,)"), data, 4), unsupported), HasSubstr("version"));
}

TEST(NpzTest, RefusesHeadersThatAreNoNumPys) {
  const Bytes data(16, 0);
  for (const char* header :
       {"", "{}", "{'descr': '<f8'}", "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), 'more': 1}",
        "{'descr': '<f8', 'fortran_order': 0, 'shape': (2,)}", "{'descr': '<f8', 'fortran_order': False, 'shape': 2}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-2,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2", "{'descr': '<f8",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (2,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2,)} x",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999999999,)}"}) {
    EXPECT_THAT(refusalOf(npyOf(header, data), ErrorCode::kBadData), HasSubstr("no NumPy array's")) << header;
  }
}

TEST(NpzTest, RefusesShapesThatTheFileCannotHold) {
  const Bytes data(16, 0);
  for (const char* shape : {"(3,)", "(4294967296, 4294967296)", "(1000000000000000000, 8)", "(2, 2)"}) {
    EXPECT_THAT(refusalOf(npyOf(npyHeader("<f8", shape), data), ErrorCode::kBadData), HasSubstr("is cut off")) << shape;
  }
  for (const char* shape : {"(1,)", "()", "(0,)"}) {
    EXPECT_THAT(refusalOf(npyOf(npyHeader("<f8", shape), data), ErrorCode::kBadData), HasSubstr("longer")) << shape;
  }
}

TEST(NpzTest, RefusesEveryTruncatedLength) {
  for (const int version : {1, 2}) {
    const Bytes whole = npyOf(npyHeader("<f4", "(2, 2)"), rawBytes<float>({1, 2, 3, 4}), version);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_THROW(readNpy(ByteSpan(whole).first(length), "a.npy"), Error) << length;
    }
  }
}

// Each byte replaced: an array of as many values as the shape says, or an error.
TEST(NpzTest, TakesNoHarmFromPatchedBytes) {
  const Bytes whole = npyOf(npyHeader("<u2", "(2, 2)", true), rawBytes<std::uint16_t>({1, 2, 3, 4}));
  std::size_t taken = 0, refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const std::uint8_t value : std::string("\0\1\x09 '(),09>fO\x7f\xff", 15)) {
      Bytes patched = whole;
      patched[at] = value;
      try {
        const NpyArray array = readNpy(patched, "a.npy");
        std::size_t count = 1;
        for (const std::size_t length : array.shape) count *= length;
        EXPECT_EQ(array.values.size(), count);
        ++taken;
      } catch (const Error&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(taken, 100u);
  EXPECT_GT(refused, 500u);
}

TEST(NpzTest, FindsArraysByTheirNames) {
  NpzFiles files;
  files["weights.npy"] = testing::npyDoubles({2}, {1, 2});
  files["objects.npy"] = npyOf(npyHeader("|O", "(2,)"), {0x80, 4});
  ASSERT_TRUE(npzArray(files, "weights"));
  EXPECT_THAT(npzArray(files, "weights")->values, ElementsAre(1, 2));
  EXPECT_FALSE(npzArray(files, "weight"));
  EXPECT_THROW(npzArray(files, "objects"), Error);
}

}  // namespace

}  // namespace limber
