// The one place where the compiler accepts the applications' tables.
#include "tests/figures/experiments/applications.hpp"
#include "kernel/machine/accept.hpp"

namespace tappet::experiments {

std::span<const Application> applications() {
    static constexpr std::array<Application, 4> all{{
        {minimal.name, &AtRunTime<minimal, one_processor>::machine},
        {small.name, &AtRunTime<small, one_processor>::machine},
        {concurrent.name, &AtRunTime<concurrent, one_processor>::machine},
        {large.name, &AtRunTime<large, one_processor>::machine},
    }};
    return all;
}

} // namespace tappet::experiments
