// The studio's server in a process of its own, asked as a hostile page would ask it.
#include "server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

namespace limber::cli {

// Instead of a built page.
std::span<const StudioFile> studioFiles() {
  static const std::string large(1 << 20, 'x');
  static const StudioFile files[] = {{"/index.html", "<!doctype html>page"}, {"/large.bin", large}};
  return files;
}

namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class StudioServer : public ::testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    server_ = fork();
    if (server_ == 0) {
      ServeOptions options;
      options.port = 0;
      ServeEvents events;
      events.listening = [&](const ServeEvents::Listening& now) {
        const std::string text = now.address;
        if (write(ends[1], text.data(), text.size()) < 0) _exit(1);
        close(ends[1]);
      };
      serveStudio(options, events);
      _exit(0);
    }
    close(ends[1]);
    std::string address;
    char byte = 0;
    while (read(ends[0], &byte, 1) == 1) address += byte;
    close(ends[0]);
    port_ = std::atoi(address.c_str() + address.rfind(':') + 1);
    ASSERT_GT(port_, 0);
  }
  void TearDown() override {
    kill(server_, SIGKILL);
    waitpid(server_, nullptr, 0);
  }

  std::string host() const { return fmt::format("127.0.0.1:{}", port_); }

  // All that comes until the server hangs up; it has two seconds between two pieces.
  std::string answerTo(const std::string& request) const {
    const int asking = socket(AF_INET, SOCK_STREAM, 0);
    const timeval patience{2, 0};
    setsockopt(asking, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    EXPECT_EQ(connect(asking, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(send(asking, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
    std::string answer;
    char buffer[4096];
    ssize_t count = 0;
    while ((count = recv(asking, buffer, sizeof buffer, 0)) > 0) answer.append(buffer, static_cast<std::size_t>(count));
    EXPECT_EQ(count, 0) << "not hung up after " << answer.substr(0, 200);
    close(asking);
    return answer;
  }
  std::string get(const std::string& path, const std::string& headers = "") const {
    return answerTo(fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n{}Connection: close\r\n\r\n", path, host(), headers));
  }

  pid_t server_ = 0;
  int port_ = 0;
};

int answersIn(const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find("HTTP/1.1 "); at != text.npos; at = text.find("HTTP/1.1 ", at + 1)) ++count;
  return count;
}

TEST_F(StudioServer, ServesItsFilesAndKeepsTheConnection) {
  EXPECT_THAT(get("/"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("page")));
  const std::string two = fmt::format(
      "GET / HTTP/1.1\r\nHost: {0}\r\n\r\nGET / HTTP/1.1\r\nHost: {0}\r\nConnection: close\r\n\r\n", host());
  EXPECT_EQ(answersIn(answerTo(two)), 2);
}

// A refused request's body is never the next request.
TEST_F(StudioServer, ABodyIsNoRequest) {
  const std::string inner = fmt::format("GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", host());
  const std::string own = fmt::format("Host: {}\r\nContent-Length: {}\r\n", host(), inner.size());
  const std::string chunked = fmt::format("Host: {}\r\nTransfer-Encoding: chunked\r\n", host());
  struct Case {
    std::string request, status;
  };
  for (const Case& one : std::vector<Case>{
           {"POST / HTTP/1.1\r\n" + own + "Origin: http://evil.example\r\n\r\n", "405"},
           {fmt::format("GET / HTTP/1.1\r\nHost: evil.example\r\nContent-Length: {}\r\n\r\n", inner.size()), "40"},
           {fmt::format("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "403"},
           {"GET /" + std::string(8200, 'a') + " HTTP/1.1\r\n" + own + "\r\n", "414"},
           {"GET / HTTP/9.9\r\n" + own + "\r\n", "400"},
           {"GET / HTTP/1.1\r\n" + own + "Range: bytes=x\r\n\r\n", "4"},
           {"GET / HTTP/1.1\r\n" + own + "\r\n", "400"},
           {"GET / HTTP/1.1\r\n" + chunked + "\r\n", "400"},
           {"GET / HTTP/1.1\r\n" + own + "Content-Length: 0\r\n\r\n", "400"},
           {fmt::format("GET / HTTP/1.1\r\nHost: {}\r\nExpect: 100-continue\r\n\r\n", host()), "100"},
           {fmt::format("GET /none HTTP/1.1\r\nHost: {}\r\n\r\n", host()), "404"}}) {
    const std::string answer = answerTo(one.request + inner);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 " + one.status)) << one.request.substr(0, 200);
    EXPECT_THAT(answer, Not(HasSubstr("HTTP/1.1 2"))) << one.request.substr(0, 200);
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << one.request.substr(0, 200);
    EXPECT_EQ(answersIn(answer), one.status == "100" ? 2 : 1) << one.request.substr(0, 200);
  }
}

TEST_F(StudioServer, RangesAreNotLookedAt) {
  std::string many = "Range: bytes=0-";
  for (int i = 0; i < 60; ++i) many += ",0-";
  const std::string answer = get("/large.bin", many + "\r\n");
  EXPECT_THAT(answer.substr(0, 2000), StartsWith("HTTP/1.1 200"));
  EXPECT_LT(answer.size(), std::size_t{2} << 20);
}

TEST_F(StudioServer, OnlyADocumentForAModelOfAnotherSiteReachesThat) {
  EXPECT_THAT(get("/"), HasSubstr("connect-src 'self' data: blob:;"));
  EXPECT_THAT(get("/index.html?sample=biped"), HasSubstr("connect-src 'self' data: blob:;"));
  EXPECT_THAT(get("/large.bin?model=x"), HasSubstr("connect-src 'self' data: blob:;"));
  EXPECT_THAT(get("/none"), HasSubstr("connect-src 'self' data: blob:;"));
  const std::string widened = get("/?model=https%3A%2F%2Fmodels.example%2Fa.glb");
  EXPECT_THAT(widened, HasSubstr("connect-src 'self' http: https: data: blob:;"));
  EXPECT_THAT(widened, Not(HasSubstr("connect-src 'self' data:")));
}

}  // namespace
}  // namespace limber::cli
