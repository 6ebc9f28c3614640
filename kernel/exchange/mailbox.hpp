// Messages into an engine: one ring and one bit for each activity that sends to it. So each sender's order is
// kept, senders are served in order of priority, and the rows bound what arrives (thesis 4.4.4, 4.2.3).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/exchange/ring.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace tappet {

/// A call for the receiver to make, with a copy of its arguments.
struct Message {
    using Run = void (*)(void* object, const std::byte* arguments) noexcept TAPPET_REALTIME;

    Run run = nullptr;
    void* object = nullptr;
    std::uint32_t id = 0;    ///< for the receiver: a row, a command slot
    std::uint32_t epoch = 0; ///< of the subscription through which it was posted: an older one is dropped
    Time cause{};            ///< the time stamp of its cause; the epoch: no cause
    alignas(8) std::array<std::byte, 48> arguments{};
};
static_assert(std::is_standard_layout_v<Message>);
static_assert(sizeof(Message) == 80,
              "with its number in the ring a message takes 88 bytes, two lines and no third");

/// Returns the message whose Message::Run is being called: the arguments are passed in place.
inline const Message& message_of(const std::byte* arguments) noexcept TAPPET_REALTIME {
    return *reinterpret_cast<const Message*>(arguments - offsetof(Message, arguments));
}

using Mailbox = Ring<Message>;

/// A notice of a sent command: its slot holds everything else.
struct CommandNotice {
    void* slot = nullptr;
    std::uint64_t part = 0; ///< number of the component in the receiving engine
};
using CommandMailbox = Ring<CommandNotice>;

/// The receiving end of up to 64 mailboxes, each with one sending activity: index 0 is served first. Posting
/// is one push and one atomic OR; the activity wakes the receiver's thread.
template <class Item>
class InboxOf {
public:
    static constexpr std::size_t max_senders = 64;
    static_assert(max_senders == 8 * sizeof(std::uint64_t), "one bit for each sender in one atomic word");

    using Mailbox = Ring<Item>;

    constexpr InboxOf() = default;
    /// The mailboxes must be placed with Overflow::reject and outlive the inbox; those beyond max_senders are
    /// not used.
    explicit constexpr InboxOf(std::span<Mailbox> mailboxes) noexcept { place(mailboxes); }
    InboxOf(const InboxOf&) = delete;
    InboxOf& operator=(const InboxOf&) = delete;

    /// As the constructor; before anybody posts.
    constexpr void place(std::span<Mailbox> mailboxes) noexcept {
        mailboxes_ = mailboxes.first(mailboxes.size() < max_senders ? mailboxes.size() : max_senders);
    }

    /// Posts a message. The sending activity's thread only, real-time. Returns false when there is no such
    /// sender, or when its mailbox is full, which counts the loss.
    [[nodiscard]] bool post(std::size_t sender, const Item& message) noexcept TAPPET_REALTIME {
        if (sender >= mailboxes_.size()) return false;
        if (!mailboxes_[sender].push(message)) return false; // inbox.push
        // The result stays unused: with it both compilers would emit a compare-and-exchange loop. In one
        // seq_cst order with Waiter::wake_after_post(), which checks whether the receiver is woken already.
        pending_.fetch_or(std::uint64_t{1} << sender, std::memory_order_seq_cst); // inbox.bit
        return true;
    }

    /// Returns the number of the sender's messages not yet taken. The sending activity's thread only,
    /// real-time.
    [[nodiscard]] std::size_t waiting(std::size_t sender) const noexcept TAPPET_REALTIME {
        return mailboxes_[sender].size();
    }

    /// Returns whether serve() would find something. Any thread, real-time.
    [[nodiscard]] bool pending() const noexcept TAPPET_REALTIME {
        return pending_.load(std::memory_order_seq_cst) != 0; // inbox.pending
    }

    /// Serves from each mailbox the messages that it holds when its turn comes. Returns their number. A
    /// message posted by a visited one may wait for the next call; then pending() is true. The receiver's
    /// thread only, real-time if visit(const Item&) is.
    template <class Visit> std::size_t serve(Visit&& visit) noexcept TAPPET_REALTIME {
        std::uint64_t waiting = pending_.exchange(0, std::memory_order_seq_cst); // inbox.take_bits
        std::uint64_t left = 0;
        std::size_t served = 0;
        for (std::size_t turn = 0; turn < max_senders && waiting != 0; ++turn) {
            const auto sender = static_cast<std::size_t>(std::countr_zero(waiting));
            waiting &= waiting - 1;
            Mailbox& mailbox = mailboxes_[sender];
            const std::size_t batch = mailbox.size(); // inbox.size
            for (std::size_t i = 0; i < batch; ++i) {
                Item message;
                if (!mailbox.pop_next(message)) break; // inbox.pop
                visit(static_cast<const Item&>(message));
                ++served;
            }
            if (!mailbox.empty()) left |= std::uint64_t{1} << sender; // inbox.left
        }
        if (left != 0) pending_.fetch_or(left, std::memory_order_relaxed); // inbox.put_back
        return served;
    }

    /// Takes one message, of the first sender that has any. Returns false when there is none. For a receiver
    /// that uses nothing else of the inbox. The receiver's thread only, real-time.
    [[nodiscard]] bool take(Item& into) noexcept TAPPET_REALTIME {
        const std::size_t senders = mailboxes_.size();
        for (std::size_t sender = 0; sender < senders; ++sender)
            if (mailboxes_[sender].pop_next(into)) return true;
        return false;
    }

    /// As serve(); each message makes its call.
    std::size_t run_all() noexcept TAPPET_REALTIME
        requires std::is_same_v<Item, Message>
    {
        return serve([](const Message& message) noexcept TAPPET_REALTIME {
            if (message.run != nullptr) message.run(message.object, message.arguments.data());
        });
    }

private:
    std::span<Mailbox> mailboxes_{};
    alignas(line_pair_bytes) std::atomic<std::uint64_t> pending_{};
};
using Inbox = InboxOf<Message>;
using CommandInbox = InboxOf<CommandNotice>;

} // namespace tappet
