#include "limber/jobs/pipe.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace limber {
namespace {

TEST(Pipe, IsInheritedByNoProgramAndEndsWithItsWriter) {
  Pipe pipe;
  for (const int end : {pipe.reading(), pipe.writing()}) {
    EXPECT_GT(end, STDERR_FILENO);
    EXPECT_EQ(fcntl(end, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  }
  char got = 0;
  ASSERT_EQ(write(pipe.writing(), "a", 1), 1);
  ASSERT_EQ(read(pipe.reading(), &got, 1), 1);
  EXPECT_EQ(got, 'a');
  pipe.closeWriting();
  EXPECT_EQ(pipe.writing(), -1);
  EXPECT_EQ(read(pipe.reading(), &got, 1), 0);
}

TEST(Pipe, AnEndThatIsTakenStaysOpen) {
  int reading = -1;
  {
    Pipe pipe;
    reading = pipe.takeReading();
  }
  EXPECT_NE(fcntl(reading, F_GETFD), -1);
  closeEnd(reading);
  EXPECT_EQ(reading, -1);
}

}  // namespace
}  // namespace limber
