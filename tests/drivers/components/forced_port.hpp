// A port of a machine that a test forces.
#pragma once

#include "kernel/machine/worlds/virtual_world.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace tappet::test {

class ForcedPort {
public:
    ForcedPort(MachineInstance& instance, std::string_view name, FacetKind kind)
        : instance_{&instance}, is_input_{kind == FacetKind::input} {
        const Sentence fault = resolve(instance.machine().table, name, kind, end_);
        if (!fault.empty()) throw std::runtime_error{std::string{fault.view()}};
    }
    template <class T> void to(const T& value) {
        EXPECT_TRUE(
            port().force(instance_->place_of(end_), is_input_, reinterpret_cast<const std::byte*>(&value)));
    }
    void release() { port().release(instance_->place_of(end_), is_input_); }

private:
    [[nodiscard]] const PortOperations& port() const {
        return *facet_at(instance_->machine().table, end_).port;
    }

    MachineInstance* instance_;
    bool is_input_;
    End end_{};
};

} // namespace tappet::test
