// The peer at an address may be no box, or a compromised one: the engineer's side takes no harm.
#include "toolchain/tools/image/remote.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::image {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Sends the same text to the first client, whatever it asks, until the client closes.
class Stranger {
public:
    explicit Stranger(std::string says) : says_{std::move(says)} {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), length) != 0 ||
            ::listen(listener_, 1) != 0 ||
            ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) != 0)
            throw Fault("no port is left");
        address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
        thread_ = std::thread{[this] {
            const int client = ::accept(listener_, nullptr, nullptr);
            std::string_view left = says_;
            for (ssize_t n = 1; n > 0 && !left.empty();
                 left.remove_prefix(static_cast<std::size_t>(n > 0 ? n : 0)))
                n = ::send(client, left.data(), left.size(), MSG_NOSIGNAL);
            ::close(client);
        }};
    }
    ~Stranger() {
        thread_.join();
        ::close(listener_);
    }
    Stranger(const Stranger&) = delete;
    Stranger& operator=(const Stranger&) = delete;
    [[nodiscard]] const std::string& address() const { return address_; }

private:
    std::string says_, address_{};
    int listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    std::thread thread_{};
};

const std::string greeting = "tappet-box 1 carpet-loom bench 0123\n";

TEST(Remote, shows_what_a_box_says) {
    const Stranger box{greeting + "ok\nmachine carpet-loom\n"};
    const Answer answer = ask_status(box.address());
    EXPECT_TRUE(answer.is_accepted);
    EXPECT_EQ(answer.text, "machine carpet-loom\n");
}

TEST(Remote, shows_no_control_characters) {
    const Stranger box{greeting + "refused\n\x1b]0;mine\x07\x9b" + "2Jtext\tmore\r\n"};
    const Answer answer = ask_status(box.address());
    EXPECT_FALSE(answer.is_accepted);
    EXPECT_EQ(answer.text, "?]0;mine??2Jtext\tmore?\n");
}

TEST(Remote, refuses_a_peer_without_the_greeting_of_a_box) {
    for (const auto& [says, why] :
         {std::pair{"tappet-box 1 \n", "another version of the protocol"},
          {"tappet-box 1 carpet-loom bench\n", "another version of the protocol"},
          {"220 mail\n", "is not a box"},
          {"", "is not a box"},
          {"tappet-box 1 carpet-loom bench 0123\n", "closed the connection without an answer"}}) {
        const Stranger box{says};
        EXPECT_THAT([&] { static_cast<void>(ask_status(box.address())); },
                    ThrowsMessage<Fault>(HasSubstr(why)))
            << says;
    }
}

TEST(Remote, limits_the_bytes_that_it_reads_from_a_peer) {
    const std::string much(16 * 1024 * 1024, 'x');
    const Stranger greets{much};
    EXPECT_THAT([&] { static_cast<void>(ask_status(greets.address())); },
                ThrowsMessage<Fault>(HasSubstr("is not a box")));
    const Stranger answers{greeting + "ok\n" + much};
    EXPECT_LT(ask_status(answers.address()).text.size(), 1024u * 1024u);
}

} // namespace
} // namespace tappet::image
