// Times of each operation between activities while another core does the opposite one without a pause,
// compared with the undisturbed operation (thesis 4.4: bounded in time). A box under load says nothing about
// absolute times, so the test asserts only that both sides met.
#include "kernel/exchange/data_object.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/exchange/ring.hpp"

#include "tests/kernel/exchange/contention.hpp"
#include "tests/kernel/exchange/placed.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <cstdint>
#include <memory>

namespace {

using namespace tappet;
TEST_F(Contention, leaves_a_data_object_intact) {
    auto object = std::make_unique<DataObject<Sealed<160>>>();
    std::uint64_t number = 0;
    std::uint64_t generation = 0;
    Sealed<160> value{};
    const auto write = [&] {
        object->write(Sealed<160>::of(++number));
        return true;
    };
    const auto read = [&] {
        generation = 0; // so that there is a value to copy without a writer
        return object->read(value, generation);
    };
    EXPECT_GT(show("data object, write", write, read), 0u);
    EXPECT_GT(show("data object, read", read, write), 0u);
}

TEST_F(Contention, leaves_a_ring_intact) {
    using Queue = Ring<Sealed<160>>;

    for (const Overflow overflow : {Overflow::reject, Overflow::drop_oldest}) {
        PlacedRing<Queue> placed{16, overflow};
        Queue& ring = placed.ring;
        Sealed<160> in = Sealed<160>::of(1);
        Sealed<160> out{};
        const auto push = [&] { return ring.push(in); };
        const auto pop = [&] { return ring.pop(out); };
        const bool drops = overflow == Overflow::drop_oldest;
        EXPECT_GT(show(drops ? "ring that drops, push" : "ring that rejects, push", push, pop), 0u);
        EXPECT_GT(show(drops ? "ring that drops, pop" : "ring that rejects, pop", pop, push), 0u);
    }
}

TEST_F(Contention, leaves_an_inbox_intact) {
    PlacedInbox placed{8, 2};
    const Message message{};
    const auto post = [&] { return placed.inbox.post(0, message); };
    const auto serve = [&] { return placed.inbox.run_all() != 0; };
    EXPECT_GT(show("inbox, post", post, serve), 0u);
    EXPECT_GT(show("inbox, serve all", serve, post), 0u);
}

} // namespace
