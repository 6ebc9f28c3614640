// The cost of rows across a CAN wire: a value sent and received, and an event with its answer, beside a
// program that does the same by hand on the same device.
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/wire/bare.hpp"
#include "tests/figures/wire/ends.hpp"

#include <cmath>
#include <iostream>

namespace tappet::figures {

namespace {

constexpr std::size_t batch = 32;
constexpr const char* activity_row = "the wire's activity: bus, timers and its end of the wire";
constexpr const char* end_row = "of it, the end of the wire alone";
constexpr const char* bare_row = "bare: packed by hand, checksum, device";
constexpr const char* empty_row = "an engine's cycle in which nothing is due";

// ---- the bare program's two ends

Memory bare_from, bare_to;
std::int64_t bare_sum = 0;
[[gnu::noinline]] void take_bare(std::int32_t number) { bare_sum += number; }
bare::Sender sender;
bare::Receiver receiver;
void set_up_bare() {
    static_cast<bare::Identifiers&>(sender) = static_cast<bare::Identifiers&>(receiver) = ends().identifiers;
    sender.device = &bare_from, receiver.device = &bare_to;
    receiver.take = &take_bare;
}

// ---- sending a value

void forget(Memory& memory) {
    for (can::Frame frame; memory.fetch(frame);) keep(frame);
}
void set_level() {
    static double level = 0;
    level += 0.1;
    const RunsActivity here{ends().telling};
    ends().teller->level.write(level);
    sender.level = level;
}
/// Each end processes all pending frames of the other.
void prepare(std::size_t) {
    set_level();
    ends().exchange();
    forget(bare_from);
}
void tell_by_activity(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        ends().advance(value_period);
        ends().sends->run(true);
    }
}
void tell_by_end(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        ends().advance(value_period);
        ends().end_sends();
    }
}
void tell_bare(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        ends().advance(value_period);
        bare::send_level(sender, ends().now());
    }
}
/// The cost of a pass without work on the same machine.
void tell_nothing(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) ends().sends->run(true);
}

// ---- receiving a value

std::array<can::Frame, batch> told, bare_told;
/// Prepares that many frames with a value each; all other frames go to the other machine.
void prepare_hear(std::size_t times) {
    prepare(times);
    for (std::size_t i = 0; i < times; ++i) {
        set_level();
        ends().advance(value_period);
        ends().sends->run(true);
        bare::send_level(sender, ends().now());
        for (can::Frame frame; ends().from->fetch(frame);)
            if (frame.id == ends().identifiers.level_frame)
                told[i] = frame;
            else
                ends().to->arrive(frame);
        static_cast<void>(bare_from.fetch(bare_told[i]));
    }
    ends().exchange();
}
void hear_by_activity(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        ends().to->arrive(told[i]);
        ends().receives->run(true);
    }
}
void hear_by_end(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) ends().end_receives(told[i]);
}
void hear_bare(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        bare_to.arrive(bare_told[i]);
        bare::serve(receiver, ends().now());
        keep(receiver.level);
    }
}

// ---- an event, from its emission to its answer

void event_by_activities(std::size_t times) {
    const Ends& all = ends();
    for (std::size_t i = 0; i < times; ++i) {
        all.advance(event_period);
        {
            const RunsActivity here{all.telling};
            all.teller->full.emit(7);
        }
        all.sends->run(true);
        all.from->bring_to(*all.to);
        all.receives->run(true);
        all.hears->run(true);
        all.to->bring_to(*all.from);
        all.sends->run(true);
        keep(all.hearer->sum);
    }
}
void event_bare(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        ends().advance(event_period);
        bare::send_full(sender, 7, ends().now());
        bare_from.bring_to(bare_to);
        bare::serve(receiver, ends().now());
        bare_to.bring_to(bare_from);
        bare::serve(sender, ends().now());
        keep(bare_sum);
    }
}

/// Returns a failure of either or a difference between both, with which nothing is measured; null: there is
/// none.
const char* fault() {
    const Ends& all = ends();
    prepare_hear(2);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t length = told[i].length;
        if (length == 0 || length != bare_told[i].length || told[i].id != bare_told[i].id)
            return "the frames of a value differ";
        // The checksum and the counter change; the valid bit and the value follow them.
        for (std::size_t byte = 2; byte < length; ++byte)
            if (told[i].data[byte] != bare_told[i].data[byte]) return "a value stands otherwise in a frame";
    }
    hear_by_activity(2);
    hear_bare(2);
    if (std::abs(all.hearer_level() - sender.level) > 0.01 || std::abs(receiver.level - sender.level) > 0.01)
        return "a value was not heard";
    const std::int64_t heard = all.hearer->sum, heard_bare = bare_sum, delivered = sender.delivered;
    prepare(0);
    event_by_activities(3);
    event_bare(3);
    if (all.hearer->sum != heard + 21 || bare_sum != heard_bare + 21 || sender.delivered != delivered + 3)
        return "an event was not heard, or not answered";
    return all.are_all_answered() ? nullptr : "an event was not answered";
}

std::vector<Group> groups() {
    return {{"wire.value.tell",
             "a value that another machine hears: taken, packed, protected, given to the device",
             "thesis 2.4",
             batch,
             {{activity_row, Standing::ours, &tell_by_activity, &prepare},
              {end_row, Standing::ours, &tell_by_end, &prepare},
              {empty_row, Standing::floor, &tell_nothing, &prepare},
              {bare_row, Standing::floor, &tell_bare, &prepare}},
             {{"a value told <= twice an empty cycle and the bare program together",
               activity_row,
               2.0,
               {empty_row, bare_row}}}},
            {"wire.value.hear",
             "a value of another machine: taken from the device, checked, unpacked, written",
             "thesis 2.4",
             batch,
             {{activity_row, Standing::ours, &hear_by_activity, &prepare_hear},
              {end_row, Standing::ours, &hear_by_end, &prepare_hear},
              {empty_row, Standing::floor, &tell_nothing, &prepare},
              {bare_row, Standing::floor, &hear_bare, &prepare_hear}},
             {{"a value heard <= twice an empty cycle and the bare program together",
               activity_row,
               2.0,
               {empty_row, bare_row}}}},
            {"wire.event",
             "an event to another machine, from its emission to its answer: five cycles in three activities",
             "thesis 2.4",
             batch,
             {{activity_row, Standing::ours, &event_by_activities, &prepare},
              {bare_row, Standing::floor, &event_bare, &prepare}},
             {{"an event with its answer <= 5 times the bare program", activity_row, 5.0, {bare_row}}}}};
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "wire"};
    set_up_bare();
    if (const char* const what = fault(); what != nullptr) {
        std::cerr << "figures-wire: " << what << '\n';
        return 2;
    }
    run_candidates(options, argv, groups(), result);
    return finish(options, result);
}
