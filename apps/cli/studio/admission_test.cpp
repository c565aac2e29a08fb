#include "admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace limber::cli {
namespace {

using ::testing::MatchesRegex;

const Site kSite{"https", {"192.168.1.20", "localhost", "[fd00::5]"}};

TEST(SiteTest, AnswersToItsNamesOnAnyPort) {
  for (const char* host : {"192.168.1.20:8080", "192.168.1.20", "LocalHost:9", "[fd00::5]:8080", "[fd00::5]"}) {
    EXPECT_TRUE(isForSite(kSite, host, "")) << host;
  }
}

TEST(SiteTest, RefusesOtherNames) {
  for (const char* host :
       {"", ":", ":8080", "evil.example", "evil.example:8080", "192.168.1.20.evil.example", "192.168.1.2", "127.0.0.1",
        "localhost.", "localhost@evil.example", "192.168.1.20:80:80", "192.168.1.20:x", "[fd00::5", "[fd00::6]:8080",
        "[fd00::5]x:8080", "fd00::5", "user@192.168.1.20"}) {
    EXPECT_FALSE(isForSite(kSite, host, "")) << host;
  }
}

TEST(SiteTest, AnswersPagesOfItsOwnOnly) {
  const char* host = "192.168.1.20:8080";
  EXPECT_TRUE(isForSite(kSite, host, "https://192.168.1.20:8080"));
  for (const char* origin : {"null", "http://192.168.1.20:8080", "https://192.168.1.20", "https://192.168.1.20:8081",
                             "https://localhost:8080", "https://evil.example", "192.168.1.20:8080"}) {
    EXPECT_FALSE(isForSite(kSite, host, origin)) << origin;
  }
}

TEST(SecretTest, HasAllItsBytesAndIsNeverTheSame) {
  EXPECT_EQ(makeSecret(0), "");
  EXPECT_EQ(makeSecret(1).size(), 2u);
  EXPECT_EQ(makeSecret(3).size(), 4u);
  EXPECT_EQ(makeSecret(16).size(), 22u);
  std::set<std::string> seen;
  std::set<char> letters;
  for (int i = 0; i < 1000; ++i) {
    const std::string secret = makeSecret(16);
    EXPECT_THAT(secret, MatchesRegex("[A-Za-z0-9_-]+"));
    seen.insert(secret);
    letters.insert(secret.begin(), secret.end());
  }
  EXPECT_EQ(seen.size(), 1000u);
  EXPECT_EQ(letters.size(), 64u);
}

TEST(CookieTest, IsFoundByItsWholeName) {
  EXPECT_EQ(cookieValue("key=abc", "key"), "abc");
  EXPECT_EQ(cookieValue("a=1; key=abc; b=2", "key"), "abc");
  EXPECT_EQ(cookieValue("a=1;key=a=c", "key"), "a=c");
  for (const char* header : {"", ";", "key", "keys=abc", "mykey=abc", "a=key=abc", "  ", "; ;"}) {
    EXPECT_EQ(cookieValue(header, "key"), "") << header;
  }
}

TEST(AdmissionTest, TakesItsTokenOnce) {
  Admission admission(1);
  EXPECT_FALSE(admission.exchange(""));
  EXPECT_FALSE(admission.exchange(admission.token() + "x"));
  EXPECT_FALSE(admission.exchange(makeSecret(16)));
  const auto key = admission.exchange(admission.token());
  ASSERT_TRUE(key);
  EXPECT_EQ(key->device, 1);
  EXPECT_FALSE(admission.exchange(admission.token()));
  EXPECT_TRUE(admission.knows(key->value));
  EXPECT_FALSE(admission.knows(""));
  EXPECT_FALSE(admission.knows(admission.token()));
}

TEST(AdmissionTest, GivesEachDeviceAKeyOfItsOwn) {
  Admission admission(2);
  const auto first = admission.exchange(admission.token()), second = admission.exchange(admission.token());
  ASSERT_TRUE(first && second);
  EXPECT_NE(first->value, second->value);
  EXPECT_EQ(second->device, 2);
  EXPECT_TRUE(admission.knows(first->value) && admission.knows(second->value));
  EXPECT_FALSE(admission.exchange(admission.token()));
}

}  // namespace
}  // namespace limber::cli
