#include "limber/document/import/import_sandbox.h"
#include "limber/core/sanitizers.h"

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::HasSubstr;

Error errorOf(const std::function<Bytes()>& work, const SandboxLimits& limits = {}) {
  try {
    runIsolated(work, limits);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return Error(ErrorCode::kCancelled, "");
}

TEST(RunIsolated, GivesTheBytesBackWhateverTheirLength) {
  for (const std::size_t size : {0u, 1u, 70'000u, 3'000'000u}) {
    Bytes expected(size);
    for (std::size_t i = 0; i < size; ++i) expected[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
    EXPECT_EQ(runIsolated([&] { return expected; }, {}), expected);
  }
}

TEST(RunIsolated, ChangesNothingHere) {
  int value = 1;
  runIsolated(
      [&] {
        value = 2;
        return Bytes();
      },
      {});
  EXPECT_EQ(value, 1);
}

TEST(RunIsolated, AnErrorArrivesWhole) {
  const Error error = errorOf([]() -> Bytes { throw Error(ErrorCode::kUnsupported, "message", "where", "remedy"); });
  EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
  EXPECT_EQ(error.message(), "message");
  EXPECT_EQ(error.where(), "where");
  EXPECT_EQ(error.remedy(), "remedy");
}

TEST(RunIsolated, AnotherExceptionIsBadData) {
  const Error error = errorOf([]() -> Bytes { throw std::runtime_error("odd"); });
  EXPECT_EQ(error.code(), ErrorCode::kBadData);
  EXPECT_EQ(error.message(), "odd");
}

TEST(RunIsolated, ACrashEndsTheChildOnly) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
    const Error error = errorOf([signal]() -> Bytes {
      std::signal(signal, SIG_DFL);
      std::raise(signal);
      return {};
    });
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    EXPECT_THAT(error.message(), HasSubstr("crash"));
  }
  EXPECT_THAT(errorOf([]() -> Bytes { _exit(3); }).message(), HasSubstr("crash"));
}

TEST(RunIsolated, WorkWithoutEndIsEnded) {
  SandboxLimits limits;
  limits.seconds = 0.02;
  const Error error = errorOf(
      []() -> Bytes {
        while (true) pause();
      },
      limits);
  EXPECT_THAT(error.message(), HasSubstr("too long"));
}

TEST(RunIsolated, MemoryBeyondTheLimitIsRefused) {
  if (kAddressSanitizer) GTEST_SKIP() << "the address sanitizer takes address space without end";
  SandboxLimits limits;
  limits.memory = std::size_t{64} << 20;
  const auto take = [](std::size_t megabytes) {
    return [megabytes] { return Bytes(1, static_cast<std::uint8_t>(Bytes(megabytes << 20, 1).back())); };
  };
  EXPECT_EQ(runIsolated(take(16), limits), Bytes(1, 1));
  EXPECT_EQ(errorOf(take(256), limits).code(), ErrorCode::kLimit);
}

TEST(RunIsolated, WorkMayAllowItselfMoreMemory) {
  SandboxLimits limits;
  limits.memory = std::size_t{64} << 20;
  const Bytes more = runIsolated(
      [] {
        allowMemory(std::size_t{256} << 20);
        return Bytes(1, static_cast<std::uint8_t>(Bytes(std::size_t{256} << 20, 1).back()));
      },
      limits);
  EXPECT_EQ(more, Bytes(1, 1));
}

}  // namespace
}  // namespace limber
