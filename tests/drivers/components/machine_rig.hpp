// A small machine in the virtual world, and what a test does with it.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"
#include "tests/drivers/components/board.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace tappet::test {

/// On the box of these tests, or on another one that the binding names.
template <const auto& table, const auto& box = board, const auto&... binding>
struct MachineRig : testing::Test {
    template <class Interface> void configure(std::string_view name, Interface& device) {
        const ProvidedDevice provided{type_id<Interface>, name, &device};
        const auto configured = instance.configure({&provided, 1});
        ASSERT_TRUE(configured) << configured.error().view();
    }
    /// Moves the plant; returns the time of its next move.
    virtual Time carry(Time) { return never; }
    /// Runs to `end`, counted from the start.
    void run_until(Duration end) {
        if (!std::exchange(started_, true)) {
            world.add({this, [](void* self) { return static_cast<MachineRig*>(self)->next_; },
                       [](void* self, Time now) {
                           auto& rig = *static_cast<MachineRig*>(self);
                           rig.next_ = rig.carry(now);
                       }});
            EXPECT_EQ(std::string{world.start().view()}, "");
        }
        EXPECT_TRUE(world.run_until(Time{end}));
    }
    void run(Duration time) { run_until(clock.now().time_since_epoch() + time); }
    /// Changes the activity of this row.
    void change(std::size_t activity, LifeChange change) {
        const Sentence refusal = world.change_activity(activity, change);
        EXPECT_TRUE(refusal.empty()) << refusal.view();
    }
    /// Stops the activity of row 0, which runs `driver`, while its device is silent, and expects the refusal
    /// that says so.
    void stop_unheard(std::string_view driver) {
        EXPECT_EQ(world.change_activity(0, LifeChange::stop).view(),
                  (Sentence{"component \"", driver,
                            "\" has stopped, but its safe values did not reach its device; see that the "
                            "device answers, then start and stop it, or stop the machine: its guardian "
                            "writes them too"}
                       .view()));
        EXPECT_EQ(instance.life().left_unsafe(), driver);
    }
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<table, box, binding...>::machine(), clock};
    VirtualWorld world{instance};

private:
    bool started_ = false;
    Time next_{};
};

} // namespace tappet::test
