// A client without a valid signature cannot block the box, whatever it sends and however slowly. The sockets
// are real; the test controls the time.
#include "board/box/reception.hpp"

#include "tests/toolchain/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include <sys/socket.h>
#include <unistd.h>

namespace tappet::box {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t engineers = 1, strangers = 2;
constexpr const char* greeted_and_told = "tappet-box 1 loom ipc 0123\nok\n";

struct Receptions : testing::Test {
    Receptions() {
        std::filesystem::create_directory(folder / offers_folder);
        std::filesystem::current_path(folder);
        init::write_text(status_file, "");
    }
    ~Receptions() override {
        for (const int each : ends) ::close(each);
        std::filesystem::current_path(before);
    }
    /// Returns the client's end, after the greeting.
    int come(std::uint32_t address) {
        std::array<int, 2> pair{-1, -1};
        EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()), 0);
        reception.greet(pair[0], address, now);
        return ends.emplace_back(pair[1]);
    }
    void say(int client, std::string_view text) {
        while (!text.empty()) {
            const ssize_t n = ::send(client, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (n < 0 && errno != EAGAIN) return;
            text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
            reception.hear(now);
        }
        for (int n = 0; n < 100; ++n) reception.hear(now); // piece by piece
    }
    static std::string heard(int client) {
        std::array<char, 4096> text{};
        const ssize_t n = ::recv(client, text.data(), text.size(), MSG_DONTWAIT);
        return {text.data(), static_cast<std::size_t>(n > 0 ? n : 0)};
    }
    static bool is_hung_up(int client) {
        char byte = 0;
        return ::send(client, &byte, 1, MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno == EPIPE;
    }
    void pass(std::chrono::seconds time) {
        now += time;
        reception.hear(now);
    }
    static Update update(std::uint32_t version, std::size_t bytes) {
        return {{"loom", "ipc", "a", version, 0}, std::string(bytes, 'k'), ""};
    }
    [[nodiscard]] std::string signed_update(std::uint32_t version, std::size_t bytes = 300'000) const {
        return "update\n" + encode(update(version, bytes), keys.secret);
    }
    /// Sends no more than the beginning of an update.
    int begin(const std::string& whole, std::size_t bytes = 10'000) {
        const int client = come(engineers);
        say(client, std::string_view{whole}.substr(0, bytes));
        return client;
    }

    std::filesystem::path before = std::filesystem::current_path();
    test::Folder folder;
    KeyPair keys = new_keys();
    ServiceFacts facts{.key = keys.open, .own = {"loom", "ipc", "a", 1, 0}, .nonce = "0123"};
    Reception::Time now{};
    std::list<int> ends{};
    Reception reception{facts};
};

TEST_F(Receptions, answer_others_while_a_stranger_sends_bytes_now_and_then) {
    const int stranger = come(strangers);
    say(stranger, "update\n" + header_of(update(2, 9'000'000), nullptr) + "kkk");
    const int engineer = come(engineers);
    say(engineer, "status\n");
    EXPECT_EQ(heard(engineer), greeted_and_told);
    const int second = come(engineers);
    say(second, signed_update(2));
    EXPECT_THAT(heard(second), HasSubstr("ok\nversion 2 is received and its signature is valid; press"));
    EXPECT_TRUE(decode(init::read_text(offered_update), keys.open));
}

TEST_F(Receptions, refuse_an_unsigned_header_before_reading_more) {
    for (const std::string& header :
         {header_of(update(2, 9'000'000), nullptr), encode(update(2, 0), new_keys().secret),
          std::string(update_header_bytes, 'x')}) {
        const int stranger = come(strangers);
        say(stranger, "update\n" + header);
        EXPECT_THAT(heard(stranger), HasSubstr("refused\nit"));
        pass(3s);
        EXPECT_TRUE(is_hung_up(stranger));
    }
}

TEST_F(Receptions, keep_one_address_from_turning_others_away) {
    const int engineer = come(engineers);
    std::vector<int> many(100);
    for (int& each : many) each = come(strangers);
    say(engineer, "status\n");
    EXPECT_EQ(heard(engineer), greeted_and_told);
    const int later = come(engineers);
    say(later, "status\n");
    EXPECT_EQ(heard(later), greeted_and_told);
    EXPECT_EQ(std::ranges::count_if(many, is_hung_up), 100 - 14);
}

TEST_F(Receptions, keep_receiving_an_update_while_others_connect) {
    const std::string whole = signed_update(2);
    const int engineer = begin(whole);
    for (std::uint32_t address = 10; address < 60; ++address) come(address);
    say(engineer, std::string_view{whole}.substr(10'000));
    EXPECT_THAT(heard(engineer), HasSubstr("ok\nversion 2 is received"));
}

TEST_F(Receptions, drop_silent_clients_and_refuse_pausing_ones) {
    const int silent = come(strangers), pausing = begin(signed_update(2)),
              in_header = begin(signed_update(2), 99);
    for (int n = 0; n < 11; ++n) {
        say(silent, "s");
        pass(1s);
    }
    EXPECT_TRUE(is_hung_up(silent));
    EXPECT_THAT(heard(pausing), HasSubstr("refused\nit paused for too long"));
    EXPECT_THAT(heard(in_header), HasSubstr("refused\nits header came too slowly"));
}

TEST_F(Receptions, take_an_update_over_a_slow_line) {
    const std::string whole = signed_update(2, 400'000);
    const int engineer = begin(whole, 5'000);
    for (std::size_t at = 5'000; at < whole.size(); at += 1'000) { // six minutes and more
        pass(1s);
        say(engineer, std::string_view{whole}.substr(at, 1'000));
    }
    EXPECT_THAT(heard(engineer), HasSubstr("ok\nversion 2 is received"));
}

TEST_F(Receptions, accept_one_update_at_a_time_the_newer_or_the_faster_one) {
    const std::string second = signed_update(2), third = signed_update(3);
    const int slow = begin(second);
    const int other = begin(second);
    EXPECT_THAT(heard(other), HasSubstr("refused\nversion 2 is on its way already"));
    pass(5s);
    const int again = begin(second);
    EXPECT_THAT(heard(slow), HasSubstr("refused\nanother update took its place"));
    const int newer = begin(third);
    EXPECT_THAT(heard(again), HasSubstr("refused\nanother update took its place"));
    pass(5s);
    EXPECT_THAT(heard(begin(second)), HasSubstr("refused\nversion 3 is on its way already"));
    say(newer, std::string_view{third}.substr(10'000));
    EXPECT_THAT(heard(newer), HasSubstr("ok\nversion 3 is received"));
    EXPECT_THAT(heard(begin(second)), HasSubstr("refused\nit is version 2, and version 3 waits"));
}

TEST_F(Receptions, report_what_is_wrong_with_a_request) {
    std::string changed = signed_update(2);
    changed[changed.size() / 2] ^= 1;
    const std::string order = "roll-back " + sign({"roll-back", "loom", "ipc", "0123"}, keys.secret);
    for (const auto& [said, answer] :
         {std::pair<std::string, std::string>{"weave\n", "refused\nunknown request; known are status"},
          {changed, "refused\nits signature does not match"},
          {"order " + order + "\n", "ok\nroll-back; press"},
          {"order " + order + "0\n", "refused\nits signature does not match"}}) {
        const int client = come(engineers);
        say(client, said);
        EXPECT_THAT(heard(client), HasSubstr(answer));
    }
    const int cut = begin(signed_update(2));
    ::shutdown(cut, SHUT_WR);
    reception.hear(now);
    EXPECT_THAT(heard(cut), HasSubstr("refused\nit is incomplete"));
    const int endless = come(strangers);
    say(endless, std::string(600, 'x'));
    EXPECT_TRUE(is_hung_up(endless));
}

} // namespace
} // namespace tappet::box
