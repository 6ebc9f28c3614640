// A machine under virtual time, for the rigs of tests.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace tappet::test {

inline constexpr Board box{.name = "box", .memory_budget_bytes = 4'000'000};

struct VirtualRig {
    explicit VirtualRig(const AcceptedMachine& machine) : instance{machine, clock} {}

    /// Configuring makes the components anew.
    void start(const std::function<void()>& once_configured = [] {}) {
        const auto configured = instance.configure({});
        EXPECT_TRUE(configured) << (configured ? "" : configured.error().view());
        once_configured();
        EXPECT_EQ(world.start().view(), "");
    }
    bool run(Duration time) { return world.run_until(clock.now() + time); }
    template <class T> T& part(std::string_view name) { return *instance.find<T>(name); }
    LifeTicket change(std::string_view name, LifeChange how) {
        return instance.life().ask_component(find_component(instance.machine().table, name), how);
    }

    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance;
    VirtualWorld world{instance};
};

} // namespace tappet::test
