// How long each operation between activities takes while another core does the opposite one without a pause,
// beside the same operation undisturbed (thesis 4.4: bounded in time). Figures to read: a box under load says
// nothing about absolute times, so none is asserted; that both sides really met is.
#include "kernel/exchange/data_object.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/exchange/ring.hpp"

#include "tests/kernel/exchange/contention.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

namespace {

using namespace tappet;
TEST_F(Contention, of_a_data_object) {
    auto object = std::make_unique<DataObject<Sealed<160>>>();
    std::uint64_t number = 0;
    std::uint64_t generation = 0;
    Sealed<160> value{};
    const auto write = [&] {
        object->write(Sealed<160>::of(++number));
        return true;
    };
    const auto read = [&] {
        generation = 0; // so that there is a value to copy although nobody writes
        return object->read(value, generation);
    };
    EXPECT_GT(show("data object, write", write, read), 0u);
    EXPECT_GT(show("data object, read", read, write), 0u);
}

template <std::size_t Bytes> struct Storage {
    alignas(128) std::array<std::byte, Bytes> bytes;
};

TEST_F(Contention, of_a_ring) {
    using Queue = Ring<Sealed<160>>;
    auto storage = std::make_unique<Storage<Queue::bytes_for(16)>>();
    for (const Overflow overflow : {Overflow::reject, Overflow::drop_oldest}) {
        Queue ring{storage->bytes.data(), 16, overflow};
        Sealed<160> in = Sealed<160>::of(1);
        Sealed<160> out{};
        const auto push = [&] { return ring.push(in); };
        const auto pop = [&] { return ring.pop(out); };
        const bool drops = overflow == Overflow::drop_oldest;
        EXPECT_GT(show(drops ? "ring that drops, push" : "ring that rejects, push", push, pop), 0u);
        EXPECT_GT(show(drops ? "ring that drops, pop" : "ring that rejects, pop", pop, push), 0u);
    }
}

TEST_F(Contention, of_an_inbox) {
    auto storage = std::make_unique<std::array<Storage<Mailbox::bytes_for(8)>, 2>>();
    std::array<Mailbox, 2> mailboxes;
    for (std::size_t i = 0; i < 2; ++i) mailboxes[i].place((*storage)[i].bytes.data(), 8, Overflow::reject);
    Inbox inbox{mailboxes};
    const Message message{};
    const auto post = [&] { return inbox.post(0, message); };
    const auto serve = [&] { return inbox.run_all() != 0; };
    EXPECT_GT(show("inbox, post", post, serve), 0u);
    EXPECT_GT(show("inbox, serve all", serve, post), 0u);
}

} // namespace
