#include "limber/jobs/job_key.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(JobKey, TellsWhereAPieceEnds) {
  EXPECT_NE(JobKey().add("ab").add("c").hex(), JobKey().add("a").add("bc").hex());
  EXPECT_NE(JobKey().add("").hex(), JobKey().hex());
  EXPECT_EQ(JobKey().add("a").add("b").hex(), JobKey().add("a").add("b").hex());
}

}  // namespace
}  // namespace limber
