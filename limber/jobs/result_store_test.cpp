#include "limber/jobs/result_store.h"

#include <gtest/gtest.h>

#include <fstream>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

TEST(ResultStore, KeepsTextsByKey) {
  const testing::TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "deep" / "results";
  {
    ResultStore store(folder);
    EXPECT_FALSE(store.find("a"));
    store.keep("a", "first");
    store.keep("a", "second");
    store.keep("b", "");
    EXPECT_EQ(store.find("a"), "second");
    EXPECT_EQ(store.find("b"), "");
  }
  ResultStore again(folder);
  EXPECT_EQ(again.find("a"), "second");
}

TEST(ResultStore, HalfWrittenTextsAreNoResults) {
  const testing::TemporaryFolder temporary;
  std::ofstream(temporary.path() / "a.json.limber-part") << "{\"half";
  const ResultStore store(temporary.path());
  EXPECT_FALSE(store.find("a"));
  EXPECT_FALSE(fs::exists(temporary.path() / "a.json.limber-part"));
}

TEST(ResultStore, OneStoreAtATimeIsOpen) {
  const testing::TemporaryFolder temporary;
  {
    const ResultStore store(temporary.path());
    EXPECT_THROW(ResultStore{temporary.path()}, Error);
  }
  EXPECT_NO_THROW(ResultStore{temporary.path()});
  std::ofstream(temporary.path() / "file") << "";
  EXPECT_THROW(ResultStore(temporary.path() / "file"), Error);
}

}  // namespace
}  // namespace limber
