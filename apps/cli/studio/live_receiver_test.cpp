#include "live_receiver.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <future>

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/document/testing/osc_bytes.h"

namespace limber::cli {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A socket to a port of this machine.
class Sender {
 public:
  Sender(int type, int port) : socket_(socket(AF_INET, type, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Sender() { close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(ByteSpan bytes) const { ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  void send(const std::string& text) const { send(asBytes(text)); }
  // Whether the other side has hung up within a second.
  bool isOver() const {
    timeval second{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &second, sizeof second);
    char byte = 0;
    return recv(socket_, &byte, 1, 0) == 0 || errno == ECONNRESET;
  }

 private:
  int socket_;
};

Bytes bone(const std::string& name, double height) {
  return testing::vmcMessage("/VMC/Ext/Bone/Pos", name, Vec3(0, height, 0), Quat::Identity());
}

// What comes until it holds `what`: a skeleton and its frame may come together or apart; two seconds at most for each.
std::string eventsUntil(const std::string& what, LiveFeed& feed, LiveFeed::Seen& seen) {
  std::string events;
  while (events.find(what) == std::string::npos) {
    const std::string next = feed.next(seen, 2000ms);
    if (next.empty()) break;
    events += next;
  }
  return events;
}

TEST(LiveFeed, GivesTheLatestOnce) {
  LiveFeed feed;
  LiveFeed::Seen page, late;
  EXPECT_EQ(feed.next(page, 1ms), "");
  feed.putSkeleton("{}");
  feed.putFrame("[1]");
  EXPECT_EQ(feed.next(page, 1ms), "event: skeleton\ndata: {}\n\nevent: frame\ndata: [1]\n\n");
  EXPECT_EQ(feed.next(page, 1ms), "");
  feed.putFrame("[2]");
  feed.putFrame("[3]");
  EXPECT_EQ(feed.next(page, 1ms), "event: frame\ndata: [3]\n\n");
  EXPECT_EQ(feed.next(late, 1ms), "event: skeleton\ndata: {}\n\nevent: frame\ndata: [3]\n\n");
  feed.putSkeleton("{1}");
  EXPECT_EQ(feed.next(page, 1ms), "event: skeleton\ndata: {1}\n\n");
}

TEST(LiveFeed, HasRoomForAFewPages) {
  LiveFeed feed;
  std::vector<LiveFeed::Listener> listeners;
  while (auto listener = feed.enter()) listeners.push_back(std::move(*listener));
  EXPECT_EQ(listeners.size(), 4u);
  listeners.pop_back();
  EXPECT_TRUE(feed.enter());
}

TEST(LiveReceiver, HandsOnVmcsPackets) {
  LiveFeed feed;
  const LiveReceiver receiver({0, 0}, feed, nullptr);
  const Sender sender(SOCK_DGRAM, receiver.ports().vmc);
  LiveFeed::Seen seen;
  // The skeleton comes once no bone has been new for a while.
  std::string events;
  for (int i = 0; i < 100 && events.empty(); ++i) {
    sender.send(testing::oscBundle({bone("Hips", 1), bone("Head", 0.5)}));
    events = feed.next(seen, 20ms);
  }
  EXPECT_THAT(events,
              AllOf(HasSubstr("event: skeleton\ndata: {\"joints\":[{\"name\":\"Hips\""), HasSubstr("\"Head\"")));
  sender.send(Bytes(17 * 1024, 'x'));
  sender.send(Bytes(100, 'x'));
  while (!feed.next(seen, 100ms).empty()) continue;  // what was in transit
  sender.send(bone("Hips", 1.25));
  EXPECT_THAT(eventsUntil(",0,1.25,0,", feed, seen), AllOf(HasSubstr(",0,1.25,0,"), Not(HasSubstr("skeleton"))));
}

const std::string kBvh =
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\n0 1.5 0 0 0 0\n";

TEST(LiveReceiver, HandsOnABvh) {
  LiveFeed feed;
  std::promise<std::string> reported;
  const LiveReceiver receiver({0, 0}, feed, [&](const std::string& what) { reported.set_value(what); });
  LiveFeed::Seen seen;
  {
    const Sender sender(SOCK_STREAM, receiver.ports().bvh);
    sender.send(kBvh);
    EXPECT_THAT(eventsUntil(",0,1.5,0,", feed, seen), AllOf(HasSubstr("Hips_end"), HasSubstr(",0,1.5,0,")));
    sender.send(std::string("0 1.75 0 0 0 0\n"));
    EXPECT_THAT(eventsUntil(",0,1.75,0,", feed, seen), HasSubstr(",0,1.75,0,"));
  }
  const Sender page(SOCK_STREAM, receiver.ports().bvh);  // the next one, which is none
  page.send(std::string("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n") + kBvh);
  EXPECT_TRUE(page.isOver());
  EXPECT_THAT(reported.get_future().get(), HasSubstr("line 1"));
  EXPECT_EQ(feed.next(seen, 20ms), "");
}

TEST(LiveReceiver, TellsOfAPortThatIsTaken) {
  LiveFeed feed;
  const LiveReceiver receiver({0, 0}, feed, nullptr);
  for (const LivePorts ports : {LivePorts{receiver.ports().vmc, 0}, LivePorts{0, receiver.ports().bvh}}) {
    EXPECT_THROW(LiveReceiver(ports, feed, nullptr), Error);
  }
}

}  // namespace
}  // namespace limber::cli
