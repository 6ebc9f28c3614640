// LatestMessage: the newest of what one thread posts to one other (thesis 4.6.2: save only the last event
// data).
#include "kernel/exchange/latest_message.hpp"

#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>

#include <thread>

namespace {

using namespace tappet;

/// The number determines every byte.
Message numbered(std::uint32_t number) {
    Message message;
    message.id = message.epoch = number;
    message.arguments.fill(static_cast<std::byte>(number * 37));
    return message;
}
bool whole(const Message& message) {
    return message.epoch == message.id && message.arguments == numbered(message.id).arguments;
}

TEST(LatestMessage, is_empty_at_first_and_returns_each_message_once) {
    LatestMessage latest;
    EXPECT_EQ(latest.take(), nullptr);
    EXPECT_TRUE(latest.put(numbered(1)));
    const Message* const taken = latest.take();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->id, 1u);
    EXPECT_EQ(latest.take(), nullptr);
}

TEST(LatestMessage, replaces_an_unread_message_and_reports_it) {
    LatestMessage latest;
    EXPECT_TRUE(latest.put(numbered(1))) << "the receiver is to be told";
    EXPECT_FALSE(latest.put(numbered(2))) << "it is told already";
    EXPECT_FALSE(latest.put(numbered(3)));
    const Message* const taken = latest.take();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->id, 3u);
    EXPECT_TRUE(latest.put(numbered(4))) << "it took the one before";
}

TEST(LatestMessage, keeps_a_read_message_unchanged_until_the_next_read) {
    LatestMessage latest;
    EXPECT_TRUE(latest.put(numbered(1)));
    const Message* const taken = latest.take();
    ASSERT_NE(taken, nullptr);
    for (std::uint32_t number = 2; number < 9; ++number) static_cast<void>(latest.put(numbered(number)));
    EXPECT_EQ(taken->id, 1u);
    EXPECT_TRUE(whole(*taken));
}

// The receiver reads only when notified; the sender notifies it when put() says so.
TEST(LatestMessage, never_tears_a_message_or_loses_the_newest_across_threads) {
    constexpr std::uint32_t last = 200'000;
    for (std::uint64_t seed = stress_seed(); seed < stress_seed() + 3; ++seed) {
        LatestMessage latest;
        std::atomic<std::uint32_t> told{0};
        std::uint32_t replaced = 0;
        std::thread sender([&] {
            Random random{seed};
            for (std::uint32_t number = 1; number <= last; ++number) {
                if (latest.put(numbered(number)))
                    told.fetch_add(1);
                else
                    ++replaced;
                dither(random);
            }
        });
        Random random{seed + 100};
        std::uint32_t taken = 0;
        std::uint32_t before = 0;
        bool good = true;
        while (before != last) {
            if (told.load() == taken) {
                rest();
                continue;
            }
            ASSERT_EQ(told.load(), taken + 1) << "one notice is on its way at most; seed " << seed;
            const Message* const message = latest.take();
            ASSERT_NE(message, nullptr) << "a notice without a message; seed " << seed;
            dither(random);
            good = good && whole(*message) && message->id > before;
            before = message->id;
            ++taken;
        }
        sender.join();
        EXPECT_TRUE(good) << "seed " << seed;
        EXPECT_EQ(taken + replaced, last) << "seed " << seed;
    }
}

} // namespace
