// Memory for objects that are placed in foreign memory, as start-up gives it: rings, and the mailboxes of an
// inbox.
#pragma once

#include "kernel/exchange/mailbox.hpp"

#include <cstddef>
#include <vector>

namespace tappet {

class LineMemory {
public:
    explicit LineMemory(std::size_t bytes) : lines_(bytes / sizeof(Line) + 1) {}
    [[nodiscard]] std::byte* data() { return lines_.front().bytes; }

private:
    struct alignas(128) Line {
        std::byte bytes[128];
    };
    std::vector<Line> lines_;
};

template <class Queue>
struct PlacedRing {
    static_assert(Queue::alignment <= 128);
    PlacedRing(std::size_t capacity, Overflow overflow)
        : memory{Queue::bytes_for(capacity)}, ring{memory.data(), capacity, overflow} {}

    LineMemory memory;
    Queue ring;
};

/// With room for `capacity` messages of each sender.
template <class Mailbox>
struct PlacedMailboxes {
    explicit PlacedMailboxes(std::size_t capacity, std::size_t senders = 1)
        : memory{senders * Mailbox::bytes_for(capacity)}, mailboxes(senders) {
        for (std::size_t i = 0; i < senders; ++i)
            mailboxes[i].place(memory.data() + i * Mailbox::bytes_for(capacity), capacity, Overflow::reject);
    }
    LineMemory memory;
    std::vector<Mailbox> mailboxes;
};

struct PlacedInbox : PlacedMailboxes<Mailbox> {
    explicit PlacedInbox(std::size_t capacity, std::size_t senders = 1) : PlacedMailboxes{capacity, senders} {
        inbox.place(mailboxes);
    }
    Inbox inbox;
};

} // namespace tappet
