// The one place where the compiler accepts the applications' tables.
#include "tests/figures/experiments/applications.hpp"

namespace tappet::experiments {

std::span<const Application> applications() {
    static constexpr std::array<Application, 4> all{{
        {minimal.name, &Firmware<minimal, one_processor>::machine},
        {small.name, &Firmware<small, one_processor>::machine},
        {concurrent.name, &Firmware<concurrent, one_processor>::machine},
        {large.name, &Firmware<large, one_processor>::machine},
    }};
    return all;
}

} // namespace tappet::experiments
