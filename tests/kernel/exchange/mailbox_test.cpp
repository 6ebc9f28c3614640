// Inbox: messages of many senders to one engine, in each sender's order.
#include "kernel/exchange/mailbox.hpp"

#include "tests/kernel/exchange/placed.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

namespace {

using namespace tappet;

static_assert(Mailbox::bytes_for(1) % Mailbox::alignment == 0, "mailboxes lie beside one another");

Message numbered(std::uint32_t id) {
    Message message;
    message.id = id;
    return message;
}

using Ids = std::vector<std::uint32_t>;

/// The ids that are served now.
Ids served(Inbox& inbox) {
    std::array<std::uint32_t, 256> ids{}; // a visitor is real-time
    std::size_t count = 0;
    const auto visit = [&](const Message& message) noexcept
        TAPPET_REALTIME { ids[count++ % ids.size()] = message.id; };
    EXPECT_EQ(inbox.serve(visit), count);
    return {ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(Inbox, is_empty_at_first) {
    PlacedInbox post{4, 3};
    EXPECT_FALSE(post.inbox.pending());
    EXPECT_EQ(served(post.inbox), Ids{});
}

TEST(Inbox, serves_senders_in_their_order_and_keeps_each_senders_order) {
    PlacedInbox post{4, 3};
    for (const std::uint32_t id : {20u, 1u, 21u, 10u, 2u})
        EXPECT_TRUE(post.inbox.post(id / 10, numbered(id))) << id;
    EXPECT_TRUE(post.inbox.pending());
    EXPECT_EQ(served(post.inbox), (Ids{1, 2, 10, 20, 21}));
    EXPECT_FALSE(post.inbox.pending());
}

TEST(Inbox, accepts_at_most_64_senders) {
    PlacedInbox post{1, 65};
    EXPECT_TRUE(post.inbox.post(63, numbered(63)));
    EXPECT_TRUE(post.inbox.post(0, numbered(0)));
    EXPECT_FALSE(post.inbox.post(64, numbered(64)));
    EXPECT_FALSE(post.inbox.post(1000, numbered(64)));
    EXPECT_EQ(served(post.inbox), (Ids{0, 63}));
}

TEST(Inbox, refuses_every_post_without_mailboxes) {
    Inbox inbox;
    EXPECT_FALSE(inbox.post(0, numbered(1)));
    EXPECT_FALSE(inbox.pending());
}

TEST(Inbox, refuses_a_message_when_the_senders_mailbox_is_full_and_counts_it) {
    PlacedInbox post{2, 2};
    EXPECT_TRUE(post.inbox.post(1, numbered(1)));
    EXPECT_TRUE(post.inbox.post(1, numbered(2)));
    EXPECT_FALSE(post.inbox.post(1, numbered(3)));
    EXPECT_TRUE(post.inbox.post(0, numbered(4))) << "the other senders have room of their own";
    EXPECT_EQ(post.mailboxes[1].lost(), 1u);
    EXPECT_EQ(post.mailboxes[0].lost(), 0u);
    EXPECT_EQ(served(post.inbox), (Ids{4, 1, 2}));
}

TEST(Inbox, defers_messages_posted_while_it_serves_their_mailbox) {
    PlacedInbox post{8};
    EXPECT_TRUE(post.inbox.post(0, numbered(1)));
    EXPECT_TRUE(post.inbox.post(0, numbered(2)));
    std::size_t calls = 0;
    const auto answering = [&](const Message& message) noexcept TAPPET_REALTIME {
        ++calls;
        static_cast<void>(post.inbox.post(0, numbered(message.id + 10)));
    };
    EXPECT_EQ(post.inbox.serve(answering), 2u) << "a chain of messages cannot hold the engine";
    EXPECT_TRUE(post.inbox.pending());
    EXPECT_EQ(served(post.inbox), (Ids{11, 12}));
    EXPECT_FALSE(post.inbox.pending());
    EXPECT_EQ(calls, 2u);
}

TEST(Inbox, runs_each_message_with_its_object_and_its_arguments) {
    PlacedInbox post{4};
    double sum = 0;
    Message message;
    message.object = &sum;
    message.run = [](void* object, const std::byte* arguments) noexcept TAPPET_REALTIME {
        double addend = 0;
        __builtin_memcpy(&addend, arguments, sizeof addend);
        *static_cast<double*>(object) += addend;
    };
    for (const double addend : {1.5, 2.0}) {
        std::memcpy(message.arguments.data(), &addend, sizeof addend);
        EXPECT_TRUE(post.inbox.post(0, message));
    }
    EXPECT_TRUE(post.inbox.post(0, Message{})) << "a message without a call is served and does nothing";
    EXPECT_EQ(post.inbox.run_all(), 3u);
    EXPECT_EQ(sum, 3.5);
}

TEST(Message, aligns_its_arguments_for_any_number) {
    EXPECT_EQ(offsetof(Message, arguments) % alignof(std::uint64_t), 0u);
    EXPECT_EQ(Message{}.arguments.size(), 48u);
}

// Several senders and one receiver that sleeps unless pending() is true: no message may be lost.
TEST(Inbox, loses_no_message_and_keeps_each_senders_order_across_threads) {
    constexpr std::size_t senders = 4;
    constexpr std::uint32_t last = 10'000;
    PlacedInbox post{7, senders};
    std::array<std::uint32_t, senders> seen{};
    bool ordered = true;

    std::vector<std::thread> threads;
    for (std::size_t sender = 0; sender < senders; ++sender) {
        threads.emplace_back([&post, sender] {
            Random random{stress_seed() * 100 + sender};
            for (std::uint32_t number = 1; number <= last;) {
                Message message = numbered(number);
                message.arguments.fill(static_cast<std::byte>(number));
                message.arguments[0] = static_cast<std::byte>(sender);
                if (post.inbox.post(sender, message))
                    ++number;
                else
                    rest();
                dither(random);
            }
        });
    }
    Random random{stress_seed()};
    const auto visit = [&](const Message& message) noexcept TAPPET_REALTIME {
        const auto sender = static_cast<std::size_t>(message.arguments[0]);
        for (std::size_t i = 1; i < message.arguments.size(); ++i) {
            ordered = ordered && message.arguments[i] == static_cast<std::byte>(message.id);
        }
        ordered = ordered && message.id == seen[sender] + 1;
        seen[sender] = message.id;
    };
    std::uint64_t served = 0;
    while (served < senders * last) {
        if (post.inbox.pending())
            served += post.inbox.serve(visit);
        else
            rest();
        dither(random);
    }
    for (auto& thread : threads) thread.join();
    EXPECT_TRUE(ordered);
    for (const std::uint32_t number : seen) EXPECT_EQ(number, last);
    // The pending bit may have been set after its message was served.
    EXPECT_EQ(post.inbox.serve(visit), 0u);
    EXPECT_FALSE(post.inbox.pending());
}

} // namespace
