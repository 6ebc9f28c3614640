// Times of emitting, connecting and disconnecting while another core does the opposite (thesis 4.6: events in
// real time), compared with the undisturbed case. The figures are for reading; the test asserts only that
// both sides met.
#include "kernel/component/current.hpp"

#include "tests/kernel/component/event_rig.hpp"
#include "tests/kernel/exchange/contention.hpp"

namespace {

using namespace tappet;

struct Listener {
    double sum = 0;
    void hear(double value) noexcept TAPPET_REALTIME { sum += value; }
};

inline constexpr const OperationOperations& hear = detail::operation_of<&Listener::hear>;

TEST_F(Contention, leaves_an_event_intact_while_its_row_connects_and_disconnects) {
    for (const bool latest : {false, true}) {
        Emitter emitter;
        Receiver receiver{16};
        Listener listener;
        Row row{receiver, hear, &listener, 16, latest};
        const EventHandle handle = emitter.tell(row.row);
        const auto emit = [&] {
            const RunsActivity activity{0};
            emitter.event.emit(1.0);
            return true;
        };
        const auto change = [&] {
            handle.disconnect();
            handle.connect();
            return true;
        };
        const auto serve = [&] { return receiver.inbox.run_all() != 0; };
        EXPECT_GT(show(latest ? "emit latest, row changes" : "emit, row comes and goes", emit, change), 0u);
        EXPECT_GT(show(latest ? "change row, emit latest" : "disconnect and connect", change, emit), 0u);
        EXPECT_GT(show(latest ? "emit latest, served" : "emit, served", emit, serve), 0u);
    }
}

} // namespace
