// An output and an input, linked as start-up links them, in one activity or across two.
#pragma once

#include "kernel/component/facet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace tappet {

template <class T> struct LinkedPorts {
    static constexpr const PortOperations& port = PortAccess::data<T>;

    explicit LinkedPorts(bool is_across) : across{is_across} {
        port.set_clock(&output, false, &now);
        port.set_clock(&input, true, &now);
        EXPECT_LE(port.shared_bytes, sizeof memory);
        if (across) port.place_shared(&output, memory.data());
        link(nullptr);
    }
    void link(const Stops* writer) {
        if (across)
            port.link_shared(&input, &output, writer);
        else
            port.link_local(&input, &output, writer);
    }
    /// The flow of the input's value, and the value.
    std::pair<Flow, T> read() {
        T value{};
        const Flow flow = input.read(value);
        return {flow, value};
    }
    const bool across;
    Output<T> output;
    Input<T> input;
    Time now = at_ns(0); ///< time of both ports
    alignas(512) std::array<std::byte, 8192> memory{};
};

/// Both topologies behave alike; only the memory between them differs.
struct PortsOfEachTopology : testing::TestWithParam<bool>, LinkedPorts<double> {
    using Read = std::pair<Flow, double>;
    double value = -1;

    PortsOfEachTopology() : LinkedPorts{GetParam()} {}
};
inline std::string topology(const testing::TestParamInfo<bool>& is_across) {
    return is_across.param ? "across_activities" : "inside_one_activity";
}

} // namespace tappet
