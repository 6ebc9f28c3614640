// SPDX-License-Identifier: Apache-2.0
// Watches, decides, acts, and reports what it did.
#include "toolchain/machine/guardian.hpp"

#include "kernel/machine/worlds/life_watch.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/notify.hpp"
#include "kernel/os/output_latch.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/os/watchdog.hpp"
#include "toolchain/machine/black_box.hpp"
#include "toolchain/machine/firmware.hpp"
#include "toolchain/machine/safe_ending.hpp"

#include <algorithm>
#include <cstdlib>

namespace tappet {

namespace {

// An activity may already have hung for this long between two looks: its limit is exceeded by no more.
constexpr Duration look_every = 4ms;
// After a gap this long between two looks the whole box was frozen, not only the machine. The supervisor then
// gets time to recover.
constexpr Duration frozen_after = 250ms, frozen_grace = 2s;
// From one look at a live machine to the next, with margin for the guardian's own delays.
constexpr Duration look_within = 1s;

/// The machine's process, as the guard knows it.
class GuardedProcess final : public EndedProcess {
public:
    explicit GuardedProcess(os::Guard& guard) : guard_{guard} {}
    void kill() noexcept override { guard_.kill(); }
    bool await_end(Duration time) noexcept override { return guard_.await_end(time); }

private:
    os::Guard& guard_;
};

class Guardian {
public:
    Guardian(os::Guard& guard, GuardedDevices& devices, MachineInstance& instance,
             std::string_view black_boxes)
        : black_boxes_{black_boxes},
          guard_{guard},
          devices_{devices},
          instance_{instance},
          watch_{instance, instance.machine().board->life_sign_within} {}

    bool get_ready() {
        const auto kept = devices_.kept_by_guardian();
        if (!guard_.become_guardian({kept.begin(), kept.size()}))
            return refuse(Sentence{
                "it cannot get a priority above the machine's threads; run as root or grant CAP_SYS_NICE"});
        if (auto prepared = devices_.prepare_safe_ending(); !prepared) return refuse(prepared.error());
        static_cast<void>(watch_.look(os::Clock::monotonic()));
        const Board& board = *instance_.machine().board;
        if (board.watchdog != nullptr)
            if (auto opened = watchdog_.open(board.watchdog, board.watchdog_within); !opened)
                return refuse(opened.error());
        guard_.stay_in_memory();
        guard_.be_ready();
        return true;
    }

    int live() {
        looked_ = os::Clock::monotonic();
        for (;;) {
            const Look look = watch();
            if (look.must_act) {
                const bool is_safe = act(look.reason);
                const int code = code_handed_on(exit_code());
                return code == 0 && !is_safe ? static_cast<int>(Ending::stopped_by_fault) : code;
            }
            if (!look.ended) {
                const Time now = os::Clock::monotonic();
                static_cast<void>(outputs_.drive(now + look_within)); // never after it acted
                watchdog_.kick(now);
                continue;
            }
            outputs_.guardian_says_safe(); // the machine's supervisor made them safe before it ended
            stand_down();
            if (const Sentence& fault = guard_.block().fault; !fault.empty()) keep(fault, {});
            return guard_.exit_code();
        }
    }

private:
    struct Look {
        bool must_act = false;
        bool ended = false;
        Sentence reason{}; ///< empty: derive the reason from the process's end
    };

    /// Stops the watchdog; when the outputs are safe, the box's init may take it back without a reset.
    void stand_down() {
        watchdog_.stand_down();
        if (outputs_.is_safe()) os::notify_starter(os::outputs_are_safe_notice);
    }

    bool refuse(const Sentence& why) {
        guard_.refuse(why);
        return false;
    }

    Look watch() {
        const os::GuardBlock& block = guard_.block();
        const auto stops = [&] {
            return instance_.stop_asked() && !block.has_stopped.load(std::memory_order_acquire);
        };
        const auto runs = [&] { return block.activities_run.load(std::memory_order_acquire); };
        const auto seen = guard_.look(runs() || stops() ? look_every : 50ms);
        if (seen == os::Guard::Seen::crash) return {true, false, {}};
        if (seen == os::Guard::Seen::dying || seen == os::Guard::Seen::end)
            return {!block.ended_well.load(std::memory_order_acquire), seen == os::Guard::Seen::end, {}};
        const Time now = os::Clock::monotonic();
        if (now - looked_ > frozen_after) forgiven_until_ = now + frozen_grace;
        looked_ = now;
        const std::int64_t back_by = block.back_by_ns.load(std::memory_order_acquire);
        if (back_by != 0 && to_ns(now) > back_by && now > forgiven_until_)
            return {true, false, Sentence{"its supervisor shows no life"}};
        if (block.is_left.load(std::memory_order_acquire)) return {true, false, {}};
        // The board bounds the stop, whatever delays the supervisor or a component's thread.
        if (back_by == 0) moves_since_ = now; // it is still arming
        if (stops() && now > forgiven_until_) {
            const Board& board = *instance_.machine().board;
            const Time asked = std::max(instance_.stop_asked_at(), moves_since_);
            if (now > asked + board.stop_within)
                return {true, false,
                        Sentence{"its stop did not end within ", board.stop_within / 1ms, " ms"}};
            if (runs() && now > asked + board.stop_begins_within())
                return {true, false,
                        Sentence{"its stop did not begin within ", board.stop_begins_within() / 1ms, " ms"}};
        }
        if (!runs()) return {};
        if (const std::size_t a = watch_.look(now); a != LifeWatch::all_live)
            return {true, false,
                    Sentence{"activity \"", instance_.machine().table.activities[a].name,
                             "\" shows no life for ", watch_.limit(a).count() / 1'000'000, " ms"}};
        return {};
    }

    /// Returns the exit code; for a crash its own signal, although the process was killed because of it.
    [[nodiscard]] int exit_code() const {
        const os::CrashNote& crash = guard_.block().crash;
        return crash.is_complete() ? 128 + crash.signal : guard_.exit_code();
    }
    Sentence why_it_ended() const {
        const int code = guard_.exit_code();
        if (const Sentence& fault = guard_.block().fault; !fault.empty()) return fault;
        return code > 128 ? Sentence{os::signal_name(code - 128), " ended it (signal ", code - 128, ")"}
                          : Sentence{"it ended with code ", code, " in the middle of its work"};
    }

    /// Returns false when a line is not safe.
    bool act(Sentence reason) {
        const SafeEnding done = end_safely(process_, devices_, outputs_, watchdog_);
        stand_down(); // otherwise the box's reset follows
        if (guard_.block().crash.is_complete())
            reason = guard_.block().crash.describe();
        else if (!reason.empty() && instance_.stop_asked())
            reason.add("; before that: ").add(instance_.describe_stop().view());
        if (reason.empty()) reason = why_it_ended();
        Sentence said{instance_.machine().table.name,
                      ": ",
                      reason,
                      "; the guardian wrote the lines in ",
                      done.written.count() / 1000,
                      " us and sent the frames in ",
                      done.confirmed.count() / 1000,
                      " us"};
        if (!done.ended) said.add("; the process does not end");
        if (done.chips != 0) said.add("; GPIO chips that refused their safe values: ").add(done.chips);
        if (done.frames != 0) said.add("; frames without confirmation: ").add(done.frames);
        if (done.servers != 0) said.add("; servers that did not answer: ").add(done.servers);
        static_cast<void>(os::write_all(2, Sentence{said, "\n"}.view()));
        keep(reason, said);
        return done.outputs_are_safe();
    }

    void keep(const Sentence& reason, const Sentence& done) {
        const AcceptedMachine& machine = instance_.machine();
        const os::CrashNote& crash = guard_.block().crash;
        const auto memory = instance_.observation().shared_memory();
        map::black_box::Record record;
        record.magic = map::black_box::magic;
        record.version = map::black_box::version;
        record.exit_code = exit_code();
        record.memory_bytes = memory.size();
        record.wall_ns = os::wall_clock_ns();
        record.machine_ns = to_ns(os::Clock::monotonic());
        if (crash.is_complete()) {
            record.signal = crash.signal;
            record.thread = crash.thread;
            record.instruction = crash.instruction;
            record.address = crash.address;
            record.thread_name = crash.thread_name;
            record.returns = crash.returns;
        }
        const auto put = [](std::string_view text, std::span<char> into) {
            std::copy_n(text.data(), std::min(text.size(), into.size() - 1), into.data());
        };
        put(machine.table.name, record.machine);
        put(machine.board->name, record.board);
        put(os::build_id().view(), record.build_id);
        put(reason.view(), record.reason);
        put(done.view(), record.done);
        const Sentence file = keep_black_box(black_boxes_, record, memory);
        if (!file.empty()) {
            const bool answered = guard_.try_apart(1s, [&] { add_answers(file, instance_); });
            static_cast<void>(os::write_all(
                2, Sentence{machine.table.name, ": the black box is ", file,
                            answered ? "\n" : ", without its behaviours: its memory is damaged\n"}
                       .view()));
        } else if (!black_boxes_.empty())
            static_cast<void>(os::write_all(
                2, Sentence{machine.table.name, ": no black box can be written in \"", black_boxes_, "\"\n"}
                       .view()));
    }

    std::string_view black_boxes_;
    os::OutputLatch outputs_{};
    os::Watchdog watchdog_{outputs_};
    Time looked_{};
    Time forgiven_until_{};
    Time moves_since_{};
    os::Guard& guard_;
    GuardedProcess process_{guard_};
    GuardedDevices& devices_;
    MachineInstance& instance_;
    LifeWatch watch_;
};

} // namespace

void be_guardian(os::Guard& guard, GuardedDevices& devices, MachineInstance& instance,
                 std::string_view black_boxes) {
    static Guardian guardian{guard, devices, instance, black_boxes};
    // Without a watchdog the machine refuses to arm, and its end reports that.
    static_cast<void>(guardian.get_ready());
    // Does not return through main: its destructors would destroy copies of objects that the machine's
    // process has destroyed or still needs.
    std::_Exit(guardian.live());
}

} // namespace tappet
