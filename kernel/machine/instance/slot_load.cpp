// The background part of a slot: compiles a script into the spare bank and prepares it to take over.
#include "kernel/machine/slots/behaviour_slot.hpp"

#include "kernel/base/nearest.hpp"
#include "kernel/base/real_text.hpp"
#include "kernel/base/value_text.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/slots/memory.hpp"
#include "kernel/script/load.hpp"

namespace tappet {

void BehaviourSlot::place(const Place& place) {
    place_ = place;
    const MachineView& table = place.machine->machine().table;
    const auto reach = [&](std::size_t c) {
        reachable_[reachable_count_++] = {table.components[c].name, table.components[c].type,
                                          place.machine->machine().index.activity[c] ==
                                              place.machine->machine().index.activity[place.component]};
    };
    reach(place.component);
    for (const std::string_view peer : place.row->slot.peers) reach(find_component(table, peer));
}

Sentence BehaviourSlot::begin() {
    const BehaviourRow& row = *place_.row;
    if (!row.is_driven()) return {};
    const ScriptUnit unit = row.unit();
    static_cast<void>(banks_[0].name.assign(unit.name.substr(0, 48)));
    if (Sentence fault = fill(0, unit, row.code, place_.banks[0]); !fault.empty()) return fault;
    active_.store(0, std::memory_order_relaxed);
    for (SlotTask* task = tasks_; task != nullptr; task = task->next)
        task->exchange(banks_[0].unit, 0, SlotTask::When::take_over);
    set(SlotPhase::steady);
    return {};
}

Sentence BehaviourSlot::fill(std::size_t number, const ScriptUnit& unit, std::span<const BehaviourCode> code,
                             std::span<std::byte> memory) {
    Bank& bank = banks_[number];
    if (Sentence fault = bank.unit.place(unit, code, place_.row->options, memory, place_.events,
                                         *place_.machine, place_.component);
        !fault.empty())
        return Sentence{bank.name.view(), ": ", fault};
    for (SlotTask* task = tasks_; task != nullptr; task = task->next)
        if (Sentence fault = task->fit(unit, number); !fault.empty())
            return Sentence{bank.name.view(), ": ", fault};
    bank.unit.connect_links();
    bank.unit.trace(place_.trace, place_.engine);
    bank.filled = true;
    return {};
}

Sentence BehaviourSlot::may_load() const noexcept {
    // asked_ first: obey() sets the phase before it clears asked_.
    if (asked_.load(std::memory_order_acquire) || phase() == SlotPhase::waiting ||
        phase() == SlotPhase::handing_over)
        return Sentence{"another change of behaviour of \"", place_.row->component,
                        "\" is under way; wait until it is done"};
    if (phase() == SlotPhase::trial)
        return Sentence{"the behaviour of \"", place_.row->component,
                        "\" is on trial, and the old one must be there to come back; let it work until it is "
                        "steady, or roll "
                        "it back"};
    if (!banks_[static_cast<std::size_t>(spare())].unit.is_quiet())
        return Sentence{"a command of the old behaviour of \"", place_.row->component,
                        "\" is still on its way; wait until it has ended"};
    return {};
}

Sentence BehaviourSlot::compile(std::size_t characters, std::string_view name) {
    if (Sentence fault = may_load(); !fault.empty()) return fault;
    const auto number = static_cast<std::size_t>(spare());
    Bank& bank = banks_[number];
    const BehaviourRow& row = *place_.row;
    bank.filled = false;
    if (previous_.load(std::memory_order_relaxed) == spare())
        previous_.store(none, std::memory_order_relaxed);
    if (!bank.name.assign(name.substr(0, 48))) return Sentence{"the script's name is too long"};
    Reach reach;
    reach.components = {reachable_.data(), reachable_count_};
    reach.limited = true;
    reach.operations = {row.slot.operations.data(), row.slot.operations.size()};
    reach.events = {row.slot.events.data(), row.slot.events.size()};
    reach.command_slots = row.slot.command_slots;
    reach.timers = row.slot.timers;
    reach.depth = row.slot.depth;
    reach.statements_per_step = row.options.statements;
    detail::UnitLayout layout{place_.banks[number]};
    const ScriptRoom room = detail::take_script_room(layout, slot_sizes(row.slot));
    layout.take(0, unit_alignment);
    const ScriptOutcome outcome =
        compile_loaded({place_.text.data(), characters}, bank.name.view(), reach, room);
    if (!outcome.good()) return outcome.fault;
    return fill(number, outcome.unit, {}, place_.banks[number].subspan(layout.used()));
}

Sentence BehaviourSlot::parse_moment(std::string_view text, SlotMoment& moment) const {
    moment = {};
    if (text == "now") return {};
    double degrees = 0;
    if (read_real_text(text, degrees) == RealTextFault::none) {
        if (place_.angle == nullptr)
            return Sentence{
                "the slot of \"", place_.row->component,
                "\" has no angle; add angle_of(\"component.output\") to its row, or name an event"};
        if (!(degrees >= 0 && degrees < 360))
            return Sentence{"an angle lies between 0 and 360 degrees; give one of these"};
        moment = {SlotMoment::Kind::angle, 0, degrees};
        return {};
    }
    Nearest nearest{text};
    for (std::size_t e = 0; e < place_.events.size(); ++e) {
        nearest.consider(place_.events[e]);
        if (place_.events[e] != text && !is_named(text, place_.row->component, place_.events[e])) continue;
        moment = {SlotMoment::Kind::event, e, 0};
        return {};
    }
    Sentence sentence{"the slot of \"", place_.row->component, "\" has no event \"",
                      text.substr(0, nearest_max_length), "\""};
    detail::add_suggestion(sentence, nearest, "name an event of its reach, an angle, or now");
    return sentence;
}

Sentence BehaviourSlot::may(Change change) const noexcept {
    const std::string_view name = place_.row->component;
    if (asked_.load(std::memory_order_acquire) || phase() == SlotPhase::handing_over)
        return Sentence{"another change of behaviour of \"", name, "\" is under way; wait until it is done"};
    if (change == Change::unload && active() == nullptr && phase() != SlotPhase::waiting)
        return Sentence{"nothing is loaded in the slot of \"", name, "\"; load a script first"};
    if (change == Change::roll_back && phase() != SlotPhase::waiting &&
        previous_.load(std::memory_order_relaxed) == none)
        return Sentence{"the slot of \"", name, "\" has no earlier behaviour; load one"};
    if (change == Change::take_over && !banks_[static_cast<std::size_t>(spare())].filled)
        return Sentence{"no script was compiled for the slot of \"", name, "\"; load one"};
    return {};
}

bool BehaviourSlot::ask(Change change, const SlotMoment& moment) noexcept {
    if (asked_.load(std::memory_order_acquire)) return false;
    asked_change_ = change;
    asked_moment_ = moment;
    asked_.store(true, std::memory_order_relaxed);
    return true;
}

Sentence BehaviourSlot::describe_roll_back() const {
    switch (why_) {
    case RollBack::none: return {};
    case RollBack::asked: return Sentence{"rolled back: on request"};
    case RollBack::error:
    case RollBack::left_over:
    case RollBack::late:
    case RollBack::too_much: break;
    }
    const Bank& failed = banks_[static_cast<std::size_t>(spare())];
    Sentence text{"rolled back: "};
    text.add(failed.name.view());
    if (why_ == RollBack::left_over)
        return text.add(": its statements of one step exceeded their number or the deadline of its activity; "
                        "let it wait, or allow it more");
    if (why_ == RollBack::late)
        return text.add(": it made its activity miss a deadline; let the script do less in one step");
    if (why_ == RollBack::too_much)
        return text.add(
            ": its activity used more of its processor than its row claims; let it do less in one step, or "
            "raise budget(...)");
    return text.add(": ").add(failed.unit.describe_fault());
}

} // namespace tappet
