// A machine with a slot, and a loader of behaviours.
#pragma once

#include "tests/kernel/machine/behaviour_machine.hpp"

#include <gmock/gmock.h>

#include <string>
#include <string_view>

namespace tappet::bakery {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// clang-format off
inline constexpr auto table = machine("bakery",
    components(component<Oven>("oven"), component<Door>("door"), component<Feeder>("feeder"), component<Onlooker>("watcher")),
    activities(
        activity("fast", every(1ms), budget(50us), runs("oven", "door")),
        activity("slow", every(5ms), budget(50us), runs("feeder")),
        activity("office", every(50ms), not_real_time, stack(256 * 1024), runs("watcher"))),
    connections(), reactions(),
    behaviours(behaviour("oven", slot(nodes(40), data_bytes(512), depth(3), command_slots(1), timers(2), text_bytes(2000),
                                      peers("door", "feeder"), operations("door.push", "feeder.feed"), events("door.moved"),
                                      angle_of("oven.angle_deg"), trial(5)), at_most(30))));
// clang-format on

/// Records its number when it starts and at each tick, and one more than it when it ends.
inline std::string numbered(int number, std::string_view more = {}) {
    const std::string n = std::to_string(number);
    return "StateMachine Numbered {\n"
           "    initial state Begin { entry { do oven.note(" +
           n +
           "); } transition oven.tick() select Ticked }\n"
           "    state Ticked { entry { do oven.note(" +
           n + "0); } " + std::string{more} +
           " transition oven.tick() select Begin }\n"
           "    final state End { entry { do oven.note(" +
           n +
           "1); } }\n"
           "}\n";
}

class BehaviourSlotTest : public testing::Test, protected Rig<table> {
protected:
    BehaviourSlot& slot = *instance.slot_of("oven");
    BehaviourSlotTest() { run(5ms); }

    std::string compile(std::string_view text, std::string_view name = "test.osd") {
        return Rig::compile(slot, text, name);
    }
    std::string request(BehaviourSlot::Change what, std::string_view moment = "now") {
        SlotMoment at;
        if (const Sentence fault = slot.parse_moment(moment, at); !fault.empty())
            return std::string{fault.view()};
        if (const Sentence fault = slot.may(what); !fault.empty()) return std::string{fault.view()};
        change(slot, what, at);
        return {};
    }
    std::string load(std::string_view text, std::string_view moment = "now") {
        const std::string fault = compile(text);
        return fault.empty() ? request(BehaviourSlot::Change::take_over, moment) : fault;
    }
    /// Starts, and receives as many requests as its trial requires.
    void settle() {
        run(2ms);
        for (int i = 0; i < 20 && slot.phase() == SlotPhase::trial; ++i) {
            tick();
        }
    }
    void load_and_settle(std::string_view text) {
        EXPECT_EQ(load(text), "");
        settle();
        EXPECT_EQ(slot.phase(), SlotPhase::steady);
        oven().told.clear();
    }
    std::string state_now() { return slot.active() == nullptr ? "none" : state(*slot.active()); }
    std::uint64_t posted(std::string_view event) {
        const auto& machine = instance.machine();
        std::uint64_t count = 0;
        for (std::size_t s = 0; s < machine.plan.subscriptions.size(); ++s)
            if (machine.plan.subscriptions[s].kind == SubscriberKind::trigger &&
                facet_at(machine.table, machine.plan.subscriptions[s].event).name == event)
                count += instance.observation().counts_of(s).posted;
        return count;
    }
};

} // namespace tappet::bakery
