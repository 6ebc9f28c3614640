// Each operation that is claimed to be wait-free as a function of its own, so that its object code can be
// checked: the containers (thesis 4.4), emission, posting and waking (thesis 4.6, 4.2.3).
#include "kernel/activity/command_processor.hpp"
#include "kernel/activity/cycle_tape.hpp"
#include "kernel/component/buffer_port.hpp"
#include "kernel/component/command.hpp"
#include "kernel/component/event.hpp"
#include "kernel/component/event_handle.hpp"
#include "kernel/component/life.hpp"
#include "kernel/exchange/data_object.hpp"
#include "kernel/exchange/latest_message.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/exchange/ring.hpp"
#include "kernel/os/waiter.hpp"
#include "kernel/services/reporting/layout.hpp"

#include <array>

using namespace tappet;

namespace tappet::waitfree {

/// A value that is copied in a loop. It has external linkage: for functions known only to this file, the
/// compiler also knows which registers they preserve, and their callers follow no convention.
struct Frame {
    std::array<std::uint64_t, 40> words;
};

} // namespace tappet::waitfree

using tappet::waitfree::Frame;

extern "C" {

void data_object_write_number(DataObject<double>& object, const double& value) noexcept {
    object.write(value);
}
bool data_object_read_number(const DataObject<double>& object, double& into,
                             std::uint64_t& generation) noexcept {
    return object.read(into, generation);
}
void data_object_write_frame(DataObject<Frame>& object, const Frame& value) noexcept { object.write(value); }
bool data_object_read_frame(const DataObject<Frame>& object, Frame& into,
                            std::uint64_t& generation) noexcept {
    return object.read(into, generation);
}

bool ring_push_number(Ring<double>& ring, const double& value) noexcept { return ring.push(value); }
bool ring_pop_number(Ring<double>& ring, double& into) noexcept { return ring.pop(into); }
bool ring_push_frame(Ring<Frame>& ring, const Frame& value) noexcept { return ring.push(value); }
bool ring_pop_frame(Ring<Frame>& ring, Frame& into) noexcept { return ring.pop(into); }
std::uint64_t ring_lost(const Ring<Frame>& ring) noexcept { return ring.lost(); }

bool inbox_post(Inbox& inbox, std::size_t sender, const Message& message) noexcept {
    return inbox.post(sender, message);
}
bool inbox_pending(const Inbox& inbox) noexcept { return inbox.pending(); }
std::size_t inbox_serve(Inbox& inbox) noexcept { return inbox.run_all(); }

void waiter_wake(os::Waiter& waiter) noexcept { waiter.wake(); }
bool waiter_take(os::Waiter& waiter) noexcept { return waiter.take(); }

void output_write(Output<Frame>& output, const Frame& value) noexcept { output.write(value, Time{}); }
Flow input_read(Input<Frame>& input, Frame& into) noexcept { return input.read(into); }
bool buffer_push(BufferOutput<Frame>& output, const Frame& value) noexcept { return output.push(value); }
bool buffer_pop(BufferInput<Frame>& input, Frame& into) noexcept { return input.pop(into); }

void event_emit(Event<int, double>& event, int first, double second) noexcept { event.emit(first, second); }
void event_post(void* reaction, int first, double second) noexcept {
    detail::post<int, double>(reaction, first, second);
}

void event_connect(const EventHandle& handle) noexcept { handle.connect(); }
void event_disconnect(const EventHandle& handle) noexcept { handle.disconnect(); }
bool latest_put(LatestMessage& latest, const Message& message) noexcept { return latest.put(message); }
const Message* latest_take(LatestMessage& latest) noexcept { return latest.take(); }

bool command_send(CommandCall<double, int&>& command, const double& goal) noexcept {
    return command.send(goal);
}
CommandState command_state(const CommandCall<double, int&>& command) noexcept { return command.state(); }
bool command_reset(CommandCall<double, int&>& command) noexcept { return command.reset(); }
bool command_begin(CommandSlot& slot) noexcept { return slot.begin(); }
CommandState command_follow(CommandSlot& slot) noexcept { return slot.follow(); }
CommandState command_take_up(CommandProcessor& processor, CommandSlot& slot) noexcept {
    return processor.take_up(slot);
}
void command_fail_all(CommandProcessor& processor) noexcept { processor.fail(0); }
void command_reject_all(CommandProcessor& processor) noexcept { processor.reject_sent(); }

void tape_mark(CycleTape& tape, std::uint32_t function, std::int64_t end) noexcept {
    tape.mark(function, end);
}
void tape_end(CycleTape& tape, std::int64_t begin, std::int64_t end) noexcept { tape.end(begin, begin, end); }
bool tape_read(const CycleTape& tape, std::uint64_t after, TapeCycle& cycle) noexcept {
    return tape.cycle_before(after, cycle);
}

void values_record(recorded::ValueTape& tape, std::span<const std::uint64_t> words,
                   std::int64_t at) noexcept {
    auto pen = tape.begin();
    for (const std::uint64_t word : words) pen.put(word);
    tape.end(pen, at);
}
bool values_read(const recorded::ValueTape& tape, std::uint64_t after, recorded::Moment& moment) noexcept {
    return tape.moment_before(after, moment);
}

std::uint32_t life_ask(LifeRequests& requests) noexcept { return requests.ask(LifeChange::stop).number; }
bool life_take(LifeRequests& requests, LifeTicket& ticket, LifeChange& change) noexcept {
    return requests.take(ticket, change);
}
void life_answer(LifeRequests& requests, LifeTicket ticket) noexcept { requests.answer(ticket, {}); }

} // extern "C"
