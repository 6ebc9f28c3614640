// Datagrams arrive as they were sent, at the twin and at a socket of this box; a socket that cannot be opened
// says why.
#include "drivers/udp/sender.hpp"
#include "drivers/udp/socket.hpp"
#include "tests/drivers/loopback.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <string>

#include <unistd.h>

namespace tappet::udp {
namespace {

using testing::HasSubstr;

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span{text}); }
std::string received(Device& from, std::size_t room = most_bytes) {
    std::array<std::byte, most_bytes> bytes;
    const std::size_t size = from.receive(std::span{bytes}.first(room));
    return {reinterpret_cast<const char*>(bytes.data()), std::min(size, room)};
}
/// The datagram that comes within two seconds.
std::string awaited(Device& at) {
    std::string got;
    for (int i = 0; i < 2000 && got.empty(); ++i, ::usleep(1000)) got = received(at);
    return got;
}

TEST(Twin, returns_datagrams_in_order_and_nothing_when_empty) {
    Twin twin;
    EXPECT_EQ(received(twin), "");
    EXPECT_TRUE(twin.tell(bytes_of("one")));
    EXPECT_TRUE(twin.tell(bytes_of("two")));
    EXPECT_EQ(received(twin), "one");
    EXPECT_EQ(received(twin), "two");
    EXPECT_EQ(received(twin), "");
}

TEST(Twin, passes_datagrams_of_the_machine_to_the_plant) {
    Twin twin;
    ASSERT_TRUE(twin.send(bytes_of("asked")));
    EXPECT_EQ(received(twin), "") << "it does not hear itself";
    std::array<std::byte, most_bytes> bytes;
    ASSERT_EQ(twin.hear(bytes), 5u);
    EXPECT_EQ(std::memcmp(bytes.data(), "asked", 5), 0);
    EXPECT_EQ(twin.hear(bytes), 0u);
}

TEST(Twin, drops_datagrams_when_full_and_refuses_oversized_ones) {
    Twin twin;
    int taken = 0;
    while (twin.tell(bytes_of("x")) && taken < 1000) ++taken;
    EXPECT_EQ(taken, 32);
    EXPECT_FALSE(Twin{}.tell(bytes_of(std::string(most_bytes + 1, 'x'))));
}

TEST(Twin, returns_the_full_size_of_a_datagram_that_does_not_fit) {
    Twin twin;
    ASSERT_TRUE(twin.tell(bytes_of("a long one")));
    std::array<std::byte, 4> small;
    EXPECT_EQ(twin.receive(small), 10u);
}

TEST(Socket, receives_datagrams_sent_to_its_port) {
    const std::uint16_t port = free_port(SOCK_DGRAM);
    Socket socket;
    ASSERT_TRUE(socket.open("127.0.0.1", port).has_value());
    EXPECT_EQ(received(socket), "") << "it does not wait";
    Sender sender;
    ASSERT_TRUE(sender.open("0.0.0.0", port).has_value()) << "each address of this box";
    ASSERT_TRUE(sender.tell(bytes_of("measured")));
    EXPECT_EQ(awaited(socket), "measured");
    ASSERT_TRUE(sender.tell(bytes_of("a long one")));
    std::array<std::byte, 4> small;
    std::size_t size = 0;
    for (int i = 0; i < 2000 && size == 0; ++i, ::usleep(1000)) size = socket.receive(small);
    EXPECT_EQ(size, 10u);
}

TEST(Socket, receives_the_answer_to_its_request) {
    const std::uint16_t port = free_port(SOCK_DGRAM);
    Socket answers, asks, other;
    ASSERT_TRUE(answers.open("127.0.0.1", port).has_value());
    EXPECT_FALSE(answers.send(bytes_of("to whom?"))) << "nobody has asked";
    ASSERT_TRUE(asks.ask("127.0.0.1", port).has_value());
    ASSERT_TRUE(other.ask("127.0.0.1", port).has_value());
    for (Socket* each : {&asks, &other, &asks}) {
        ASSERT_TRUE(each->send(bytes_of("what time is it")));
        EXPECT_EQ(awaited(answers), "what time is it");
        ASSERT_TRUE(answers.send(bytes_of("noon")));
        EXPECT_EQ(awaited(*each), "noon");
    }
    const auto wrong = Socket{}.ask("the clock", port);
    ASSERT_FALSE(wrong);
    EXPECT_THAT(std::string{wrong.error().view()}, HasSubstr("\"the clock\" is not an IPv4 address"));
}

TEST(Socket, reports_why_it_cannot_be_opened) {
    Socket first, second, nowhere;
    const std::uint16_t port = free_port(SOCK_DGRAM);
    ASSERT_TRUE(first.open("127.0.0.1", port).has_value());
    const auto taken = second.open("127.0.0.1", port);
    ASSERT_FALSE(taken);
    EXPECT_THAT(std::string{taken.error().view()},
                HasSubstr("; it must be an address of this box, and its port be free"));
    const auto wrong = nowhere.open("the camera", port);
    ASSERT_FALSE(wrong);
    EXPECT_THAT(std::string{wrong.error().view()},
                HasSubstr("\"the camera\" is not an IPv4 address; write it as 192.168.7.1"));
}

} // namespace
} // namespace tappet::udp
