// The socket of a browser (thesis 4.8): packets arrive whole, both ends are identified, nothing blocks.
#include "kernel/os/local_socket.hpp"

#include "tests/kernel/os/folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::os {
namespace {

using What = LocalConnection::Received::What;
using Sent = LocalConnection::Sent;

/// The number of descriptors of this process.
std::ptrdiff_t open_descriptors() {
    std::filesystem::directory_iterator all{"/proc/self/fd"};
    return std::distance(begin(all), end(all));
}

/// A packet with several descriptors of one file, which only a foreign program sends.
bool send_with_descriptors(const LocalConnection& from, std::string_view packet, std::size_t count) {
    const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
    std::array<int, 8> passed{};
    passed.fill(file);
    iovec piece{const_cast<char*>(packet.data()), packet.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof passed)] = {};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = CMSG_SPACE(count * sizeof(int));
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(count * sizeof(int));
    std::memcpy(CMSG_DATA(header), passed.data(), count * sizeof(int));
    const bool sent = sendmsg(from.descriptor(), &message, 0) >= 0;
    close(file);
    return sent;
}

class LocalSocket : public testing::Test {
protected:
    test::Folder folder;
    std::string path = folder.path + "/machine.socket";
    LocalListener listener;
    std::array<char, 256> room{};

    std::string_view text(const LocalConnection::Received& received) const {
        return {room.data(), received.bytes};
    }
};

/// Connects and returns both ends.
struct ConnectedSocket : LocalSocket {
    LocalConnection client, server;

    void SetUp() override {
        ASSERT_TRUE(listener.listen(path, 0600));
        auto made = LocalConnection::connect(path.c_str());
        ASSERT_TRUE(made);
        client = std::move(*made);
        server = listener.accept();
        ASSERT_TRUE(server.open());
    }
};

TEST_F(ConnectedSocket, carries_whole_packets_in_both_directions) {
    EXPECT_EQ(client.send("1 hello"), Sent::sent);
    EXPECT_EQ(client.send("2 map"), Sent::sent);
    EXPECT_EQ(text(server.receive(room)), "1 hello");
    EXPECT_EQ(text(server.receive(room)), "2 map");
    EXPECT_EQ(server.receive(room).what, What::nothing);
    EXPECT_EQ(server.send("{}"), Sent::sent);
    EXPECT_EQ(text(client.receive(room)), "{}");
}

TEST_F(ConnectedSocket, identifies_its_peer) {
    const auto peer = server.peer();
    ASSERT_TRUE(peer);
    EXPECT_EQ(peer->process, getpid());
    EXPECT_EQ(peer->user, geteuid());
    EXPECT_EQ(peer->group, getegid());
    EXPECT_TRUE(peer->is_in(getegid()));
}

TEST_F(ConnectedSocket, passes_a_descriptor) {
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    EXPECT_EQ(server.send("{}", pipe_ends[1]), Sent::sent);
    const auto received = client.receive(room, Passed::one);
    ASSERT_GE(received.passed, 0);
    EXPECT_EQ(write(received.passed, "x", 1), 1);
    EXPECT_EQ(read(pipe_ends[0], room.data(), 1), 1);
    for (const int each : {received.passed, pipe_ends[0], pipe_ends[1]}) close(each);
}

TEST_F(ConnectedSocket, closes_a_descriptor_that_was_not_requested) {
    const auto before = open_descriptors();
    for (const std::size_t count : {1u, 2u, 8u}) {
        ASSERT_TRUE(send_with_descriptors(client, "1 hello", count));
        const auto received = server.receive(room);
        EXPECT_EQ(text(received), "1 hello") << "the packet itself counts";
        EXPECT_EQ(received.passed, -1);
        EXPECT_EQ(open_descriptors(), before) << count;
    }
}

TEST_F(ConnectedSocket, accepts_at_most_one_descriptor) {
    const auto before = open_descriptors();
    for (const std::size_t count : {2u, 8u}) {
        ASSERT_TRUE(send_with_descriptors(server, "{}", count));
        const auto received = client.receive(room, Passed::one);
        EXPECT_EQ(text(received), "{}");
        ASSERT_GE(received.passed, 0);
        close(received.passed);
        EXPECT_EQ(open_descriptors(), before) << count;
    }
    ASSERT_TRUE(send_with_descriptors(server, "", 1));
    EXPECT_EQ(client.receive(room, Passed::one).what, What::closed);
    EXPECT_EQ(open_descriptors(), before) << "what came with an end that is none";
}

TEST_F(ConnectedSocket, reports_a_packet_longer_than_its_buffer) {
    EXPECT_EQ(client.send(std::string(300, 'x')), Sent::sent);
    const auto received = server.receive(room);
    EXPECT_TRUE(received.cut);
    EXPECT_EQ(received.bytes, room.size());
}

TEST_F(ConnectedSocket, blocks_no_sender_when_its_reader_does_not_read) {
    const std::string packet(2000, 'x');
    Sent last = Sent::sent;
    for (int i = 0; i < 100'000 && last == Sent::sent; ++i) last = server.send(packet);
    EXPECT_EQ(last, Sent::full);
}

TEST_F(ConnectedSocket, reports_that_its_peer_has_closed) {
    client.close();
    EXPECT_EQ(server.receive(room).what, What::closed);
    EXPECT_EQ(server.send("{}"), Sent::closed);
}

TEST_F(LocalSocket, has_the_requested_permissions) {
    ASSERT_TRUE(listener.listen(path, 0640));
    struct stat facts{};
    ASSERT_EQ(stat(path.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777u, 0640u);
}

TEST_F(LocalSocket, replaces_the_socket_of_a_killed_machine_and_removes_its_own) {
    ASSERT_TRUE(listener.listen(path, 0600));
    const std::string kept = folder.path + "/kept";
    std::filesystem::rename(path, kept); // so that closing does not remove it, as after a kill
    listener.close();
    std::filesystem::rename(kept, path);
    ASSERT_TRUE(listener.listen(path, 0600));
    listener.close();
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(LocalSocket, keeps_the_socket_of_a_running_machine_and_any_other_file) {
    ASSERT_TRUE(listener.listen(path, 0600));
    LocalListener second;
    const auto refused = second.listen(path, 0600);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().view().find("another machine of this name runs"), std::string_view::npos);
    const std::string file = folder.path + "/notes.txt";
    std::ofstream{file} << "kept";
    EXPECT_FALSE(second.listen(file, 0600));
    EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST_F(LocalSocket, refuses_a_path_that_is_too_long_or_cannot_be_created) {
    const auto too_long = listener.listen(std::string(200, 'x'), 0600);
    ASSERT_FALSE(too_long);
    EXPECT_NE(too_long.error().view().find("107 characters"), std::string_view::npos);
    EXPECT_FALSE(listener.listen("/proc/nowhere/x.socket", 0600));
}

TEST_F(LocalSocket, reports_a_missing_server_with_the_cure) {
    const auto refused = LocalConnection::connect(path.c_str());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().view().find("start the machine"), std::string_view::npos);
}

} // namespace
} // namespace tappet::os
