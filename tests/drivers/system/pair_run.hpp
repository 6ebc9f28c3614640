// Two machines on one wire, from a test's beginning to its end.
#pragma once

#include "tests/drivers/system/pair.hpp"
#include "toolchain/machine/system_run.hpp"

#include <gtest/gtest.h>

namespace tappet {

template <class A, class B> struct OnOneWire {
    explicit OnOneWire(const SystemView& system, std::uint64_t seed = 1) : run{system, machines, {}, seed} {}
    OnOneWire(const OnOneWire&) = delete;
    OnOneWire& operator=(const OnOneWire&) = delete;
    ~OnOneWire() { run.stop(); }
    void start(Duration time = 300ms) {
        const auto started = run.start();
        ASSERT_TRUE(started) << started.error().view();
        run.run_for(time);
    }
    const std::array<AcceptedMachine, 2> machines{A::machine(), B::machine()};
    SystemRun run;
};

namespace pair {

template <class A = GiverFirmware, class B = TakerFirmware> struct PairRun : OnOneWire<A, B> {
    explicit PairRun(std::uint64_t seed = 1, const SystemView& system = pair.view())
        : OnOneWire<A, B>{system, seed} {}
    Giver& giver() { return *this->run.instance(0).template find<Giver>("giver"); }
    Taker& taker() { return *this->run.instance(1).template find<Taker>("taker"); }
};

} // namespace pair
} // namespace tappet
