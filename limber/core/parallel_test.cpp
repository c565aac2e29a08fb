#include "limber/core/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace limber {
namespace {

class ParallelFor : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { setThreadCount(GetParam()); }
  void TearDown() override { setThreadCount(0); }
};

TEST_P(ParallelFor, CoversEveryElementOnceInRangesNoLongerThanTheGrain) {
  for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 1000u}) {
    std::vector<std::atomic<int>> seen(count);
    std::atomic<bool> tooLong{false};
    parallelFor(count, 8, [&](std::size_t begin, std::size_t end) {
      if (end - begin > 8) tooLong = true;
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_FALSE(tooLong);
    for (const std::atomic<int>& times : seen) EXPECT_EQ(times, 1);
  }
}

TEST_P(ParallelFor, HandsOnAnException) {
  EXPECT_THROW(parallelFor(100, 1,
                           [](std::size_t begin, std::size_t) {
                             if (begin == 42) throw std::runtime_error("42");
                           }),
               std::runtime_error);
}

TEST_P(ParallelFor, InvokeRunsBoth) {
  int first = 0, second = 0;
  parallelInvoke([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first + second, 3);
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, ::testing::Values(0, 1, 2));

TEST(ThreadCount, IsWhatWasSet) {
  setThreadCount(1);
  EXPECT_EQ(threadCount(), 1);
  setThreadCount(0);
  EXPECT_GE(threadCount(), 1);
}

}  // namespace
}  // namespace limber
