// Lines in a machine with threads: they run in different activities in turn, all of which send to the same
// engine through the same mailbox; some are aborted.
#include "tests/kernel/machine/parts.hpp"
#include "tests/kernel/machine/real_rig.hpp"
#include "tests/kernel/services/interpreter/line_machine.hpp"

namespace tappet::press {
namespace {

/// Types one line after the other, and aborts every third after some polls.
struct Typist : Onlooker {
    static constexpr std::size_t wanted = 200;
    static constexpr std::string_view lines[] = {
        "gauge.force + gauge.target", "var int n; do ram.move_to(gauge.target + 1, n) timeout 100ms",
        "var int n; do ram.move_to(table.height / 2, n) timeout 100ms",
        "set gauge.target = 20; do gauge.zero(); yield", "table.height * 2"};
    std::atomic<std::size_t> ended{0}, done{0};

    void work(const Cycle&) {
        auto& interpreter = *machine->find<CommandInterpreter>("interpreter");
        const LineFunctions& functions = CommandInterpreter::line_functions;
        if (is_at_work_) {
            const LineEnd* const end = functions.end(&interpreter);
            if (end == nullptr && (typed_ % 3 != 0 || looks_++ < typed_ % 4)) return;
            if (end != nullptr && end->state == CommandState::done) ++done;
            functions.let_go(&interpreter);
            ++ended;
        }
        LineRefusal refusal{};
        is_at_work_ =
            functions.begin(&interpreter, lines[typed_ % std::size(lines)], Rights{}, refusal).empty();
        if (is_at_work_) ++typed_;
        looks_ = 0;
    }

private:
    bool is_at_work_ = false;
    std::size_t typed_ = 0, looks_ = 0;
};

// clang-format off
constexpr auto threads = machine("press",
    components(component<Ram>("ram"), component<Table>("table"), component<Gauge>("gauge"),
               component<CommandInterpreter>("interpreter"), component<Typist>("typist")),
    activities(
        activity("motion", every(1ms), not_real_time, runs("ram", "gauge")),
        activity("slow",   every(1ms), not_real_time, runs("table")),
        activity("hall",   every(1ms), not_real_time, stack(256 * 1024), runs("interpreter", "typist"))),
    connections(data("table.height", "ram.limit", stale_after(1s), hold), data("table.height", "gauge.height")),
    reactions(), behaviours());
// clang-format on

TEST(LinesInThreads, end_in_order_whichever_thread_runs_them) {
    RealRig<threads> rig;
    ASSERT_TRUE(rig.runs());
    const Typist& typist = rig.the<Typist>("typist");
    while (typist.ended < Typist::wanted) ASSERT_TRUE(rig.world.supervise(20ms));
    EXPECT_EQ(rig.world.stop(), 0);
    EXPECT_GT(typist.done, 0u);
    EXPECT_GT(rig.the<Gauge>("gauge").zeroed, 0);
    EXPECT_GT(rig.the<Ram>("ram").strokes, 0);
}

} // namespace
} // namespace tappet::press
