// A machine in virtual time, as most tests of machines use it.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "tests/kernel/machine/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>

namespace tappet {

inline constexpr Board test_board{.name = "test", .world = "host", .memory_budget_bytes = 8 * 1024 * 1024};

struct VirtualRig {
    explicit VirtualRig(const AcceptedMachine& machine) : instance{machine, clock} {}

    void configure() {
        const auto configured = instance.configure({});
        EXPECT_TRUE(configured) << (configured ? "" : configured.error().view());
    }
    /// `once_configured` runs after configure() has created the components.
    void start(const std::function<void()>& once_configured = [] {}) {
        configure();
        once_configured();
        EXPECT_EQ(world.start().view(), "");
    }
    /// Returns false when the machine stopped meanwhile.
    bool run(Duration time) { return world.run_until(clock.now() + time); }
    template <class C> C& the(std::string_view name) { return *instance.find<C>(name); }
    LifeTicket change(std::string_view name, LifeChange how) {
        return instance.life().ask_component(find_component(instance.machine().table, name), how);
    }

    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance;
    VirtualWorld world{instance};
};

/// A placed machine.
template <const auto& table, const Board& board = test_board> struct PlacedRig : VirtualRig {
    PlacedRig() : VirtualRig{AtRunTime<table, board>::machine()} {}

    /// Runs it for so long.
    void pass(Duration time) { ASSERT_TRUE(run(time)); }
    template <class T> T& property(std::string_view component, std::string_view name) {
        const MachineView& of = instance.machine().table;
        const std::size_t c = find_component(of, component);
        return *static_cast<T*>(instance.facet({c, find_facet(of.components[c], name)}));
    }
    /// The slot's reason to refuse a script; empty: the script may take over.
    static std::string compile(BehaviourSlot& slot, std::string_view text, std::string_view name) {
        if (text.size() > slot.text().size()) return "too long for the text";
        std::ranges::copy(text, slot.text().begin());
        return std::string{slot.compile(text.size(), name).view()};
    }
    /// The answer within the time.
    LifeAnswer change(std::size_t component, LifeChange change, Duration within) {
        const LifeTicket ticket = instance.life().ask_component(component, change);
        EXPECT_TRUE(run(within));
        return instance.life().answer_of_component(component, ticket);
    }
    void change(BehaviourSlot& slot, BehaviourSlot::Change what, const SlotMoment& at = {}) {
        EXPECT_EQ(slot.may(what).view(), "");
        EXPECT_TRUE(slot.ask(what, at));
        EXPECT_TRUE(instance.requests().post_change(slot));
    }
};
/// A configured machine.
template <const auto& table, const Board& board = test_board> struct ConfiguredRig : PlacedRig<table, board> {
    ConfiguredRig() { this->configure(); }
};
/// A running machine.
template <const auto& table, const Board& board = test_board> struct RunningRig
    : ConfiguredRig<table, board> {
    RunningRig() { EXPECT_EQ(this->world.start().view(), ""); }
};

} // namespace tappet
