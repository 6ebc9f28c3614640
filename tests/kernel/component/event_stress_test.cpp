// Storms of connect and disconnect, by threads of their own and from reactions, while two activities emit and
// a third serves (thesis 4.6.1: self and cross unsubscription from any concurrent activity). TAPPET_SEED
// determines the schedules.
#include "tests/kernel/component/event_rig.hpp"
#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace {

using namespace tappet;

using Argument = Sealed<48>; // as large as a message carries
using LargeArgument = Sealed<160>;
constexpr std::size_t emitters = 2;
constexpr std::uint64_t emissions = 20'000; // of each kind

/// One controller connects and disconnects some rows, and publishes its phase: 0 disconnected, 1 connecting,
/// 2 connected, 3 disconnecting, and on from 4. An emission that began and ended in one phase lay in it.
using Phase = std::uint32_t;
constexpr Phase never_served = ~Phase{0};

/// The fate of the emissions of one emitter.
struct Emissions {
    std::vector<Phase> begun = std::vector<Phase>(emissions), ended = std::vector<Phase>(emissions);
};

/// A reaction that records the phase in which each emission arrived.
template <class Argument>
struct Witness {
    std::array<std::vector<Phase>, emitters> heard{std::vector<Phase>(emissions, never_served),
                                                   std::vector<Phase>(emissions, never_served)};
    std::array<std::uint64_t, emitters> last{};
    std::atomic<std::uint64_t> torn{0}, disordered{0}; // both emitters run a synchronous one
    const Phase* serving = nullptr;                    ///< asynchronous row: the phase before it was served
    void hear(Argument argument) noexcept TAPPET_REALTIME {
        if (!argument.whole()) {
            ++torn;
            return;
        }
        const std::uint64_t emitter = argument.number() >> 32, number = argument.number() & 0xffffffffu;
        if (last[emitter] > number) ++disordered;
        last[emitter] = number;
        heard[emitter][number] = serving != nullptr ? *serving : 0;
    }
};
template <class Argument>
inline constexpr const OperationOperations& witness = detail::operation_of<&Witness<Argument>::hear>;

/// A reaction that disconnects itself and connects or disconnects others.
template <class Argument>
struct Rebel {
    std::array<EventHandle, 4> handles{};
    std::size_t own = 0;
    std::uint64_t salt = 0;
    std::atomic<std::uint64_t> torn{0}, calls{0};
    void hear(Argument argument) noexcept TAPPET_REALTIME {
        if (!argument.whole()) ++torn;
        ++calls;
        const std::uint64_t dice = (argument.number() * 0x9e3779b97f4a7c15u + salt) >> 40;
        const EventHandle& other = handles[dice % handles.size()];
        switch ((dice >> 8) % 4) {
        case 0: handles[own].disconnect(); break;
        case 1: other.disconnect(); break;
        default: other.connect(); break;
        }
    }
};
template <class Argument>
inline constexpr const OperationOperations& rebel = detail::operation_of<&Rebel<Argument>::hear>;

template <class Argument>
struct Storm {
    EmitterOf<Argument> emitter;
    Receiver receiver{32, emitters};
    Witness<Argument> queued, latest, called;
    std::array<Rebel<Argument>, 4> rebels;
    static constexpr std::size_t bytes = sizeof(Argument);
    Row queued_row{receiver, witness<Argument>, &queued, 8, false, bytes};
    Row latest_row{receiver, witness<Argument>, &latest, 1, true, bytes};
    Row rebel_row{receiver, rebel<Argument>, &rebels[2], 8, false, bytes};
    Row other_rebel_row{receiver, rebel<Argument>, &rebels[3], 1, true, bytes};
    std::vector<EventHandle> watched;
    std::atomic<Phase> phase{0};
    Phase serving = 0;
    std::atomic<std::size_t> emitting{emitters};
    std::atomic<std::size_t> heard_once{0};
    std::array<Emissions, emitters> log;
    const std::uint64_t seed = stress_seed();

    Storm() {
        queued.serving = latest.serving = &serving;
        watched = {emitter.call(witness<Argument>, &called), emitter.tell(queued_row.row),
                   emitter.tell(latest_row.row)};
        for (const EventHandle& handle : watched) handle.disconnect();
        const std::array<EventHandle, 4> all{emitter.call(rebel<Argument>, &rebels[0]),
                                             emitter.call(rebel<Argument>, &rebels[1]),
                                             emitter.tell(rebel_row.row), emitter.tell(other_rebel_row.row)};
        for (std::size_t i = 0; i < rebels.size(); ++i) {
            rebels[i].handles = all;
            rebels[i].own = i;
            rebels[i].salt = seed + i;
        }
    }
    void emit(std::uint32_t own) {
        const RunsActivity here{own};
        Random random{seed * 7 + own};
        while (phase.load() < 2) std::this_thread::yield();
        for (std::uint64_t n = 0; n < emissions; ++n) {
            log[own].begun[n] = phase.load();
            emitter.event(Argument::of((std::uint64_t{own} << 32) | n));
            log[own].ended[n] = phase.load();
            if (n == 0) ++heard_once;
            dither(random);
        }
        --emitting;
    }
    void serve() {
        Random random{seed * 11};
        for (bool last = false; !last;) {
            last = emitting.load() == 0; // and once more after the last emission
            serving = phase.load();
            receiver.inbox.run_all();
            dither(random);
        }
    }
    void control() {
        Random random{seed * 13};
        while (emitting.load() != 0) {
            ++phase;
            for (const EventHandle& handle : watched) handle.connect();
            ++phase;
            // Wait for one emission of each emitter, however the scheduler treats them.
            while (heard_once.load() < emitters) std::this_thread::yield();
            dither(random);
            ++phase;
            for (const EventHandle& handle : watched) handle.disconnect();
            ++phase;
            dither(random);
        }
    }
    void storm(std::uint64_t number) {
        Random random{seed * 17 + number};
        while (emitting.load() != 0) {
            const EventHandle& handle = rebels[0].handles[random.below(rebels.size())];
            if (random.one_in(3)) {
                const ScopedEventHandle scope{handle};
                dither(random);
            } else if (random.one_in(2)) {
                handle.connect();
            } else {
                handle.disconnect();
            }
            dither(random);
        }
    }

    void rages() {
        std::vector<std::thread> threads;
        for (std::uint32_t own = 0; own < emitters; ++own) threads.emplace_back([this, own] { emit(own); });
        threads.emplace_back([this] { serve(); });
        threads.emplace_back([this] { control(); });
        threads.emplace_back([this] { storm(1); });
        threads.emplace_back([this] { storm(2); });
        for (std::thread& thread : threads) thread.join();

        std::uint64_t inside = 0, late = 0, heard = 0;
        const auto judge = [&](const Witness<Argument>& one, bool synchronous) {
            for (std::size_t e = 0; e < emitters; ++e)
                for (std::uint64_t n = 0; n < emissions; ++n) {
                    if (one.heard[e][n] == never_served) continue;
                    ++heard;
                    const Phase begun = log[e].begun[n];
                    if (begun != log[e].ended[n]) continue;
                    if (begun % 4 == 0) ++inside; // entirely while disconnected
                    if (!synchronous && begun % 4 == 2 && one.heard[e][n] >= begun + 2)
                        ++late; // queued before the disconnection
                }
            EXPECT_EQ(one.torn, 0u);
            EXPECT_EQ(one.disordered, 0u) << "an emitter's own order is kept";
        };
        judge(called, true);
        judge(queued, false);
        judge(latest, false);
        EXPECT_EQ(inside, 0u) << "emissions begun after disconnect returned";
        EXPECT_EQ(late, 0u) << "emissions served after disconnect returned";
        EXPECT_GT(heard, 0u);

        std::uint64_t outdated = 0;
        for (const Row* row : {&queued_row, &latest_row, &rebel_row, &other_rebel_row}) {
            const SubscriptionCounts counts = row->row.counts();
            EXPECT_EQ(counts.posted, counts.served);
            EXPECT_EQ(counts.stray, 0u);
            outdated += counts.outdated;
        }
        for (const Rebel<Argument>& each : rebels) EXPECT_EQ(each.torn, 0u);
        EXPECT_EQ(rebels[2].calls + rebels[3].calls + rebel_row.row.counts().outdated +
                      other_rebel_row.row.counts().outdated,
                  rebel_row.row.counts().served + other_rebel_row.row.counts().served)
            << "what was served was run or is counted";
        std::cout << heard << " heard, " << outdated << " outdated and dropped, "
                  << queued_row.row.counts().lost << " lost, "
                  << rebels[0].calls + rebels[1].calls + rebels[2].calls + rebels[3].calls << " rebellions\n";
    }

    void abates() {
        std::vector<std::thread> threads;
        std::atomic<bool> over{false};
        for (std::uint64_t number : {1u, 2u, 3u})
            threads.emplace_back([&, number] {
                Random random{seed * 19 + number};
                while (!over.load()) {
                    const EventHandle& handle = watched[random.below(watched.size())];
                    random.one_in(2) ? handle.connect() : handle.disconnect();
                    dither(random);
                }
            });
        std::this_thread::sleep_for(20ms);
        over.store(true);
        for (std::thread& thread : threads) thread.join();
        for (const EventHandle& handle : watched) handle.connect();
        const RunsActivity here{0};
        emitter.event(Argument::of(7));
        receiver.inbox.run_all();
        for (const Witness<Argument>* one : {&called, &queued, &latest})
            EXPECT_NE(one->heard[0][7], never_served);
    }
};

TEST(AStorm, reaches_no_disconnected_row_and_counts_every_loss) {
    std::make_unique<Storm<Argument>>()->rages();
    std::make_unique<Storm<LargeArgument>>()->rages();
}

TEST(AStorm, leaves_working_rows_unchanged) {
    std::make_unique<Storm<Argument>>()->abates();
    std::make_unique<Storm<LargeArgument>>()->abates();
}

} // namespace
