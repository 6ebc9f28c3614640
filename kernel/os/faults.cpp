// Page faults as getrusage counts them.
#include "kernel/os/faults.hpp"

#include <sys/resource.h>

namespace tappet::os {

namespace {

PageFaults faults_of(int who) noexcept TAPPET_REALTIME {
    rusage usage{};
    TAPPET_ESCAPE("reads counters of the kernel; never blocks", getrusage(who, &usage));
    return {static_cast<std::uint64_t>(usage.ru_minflt), static_cast<std::uint64_t>(usage.ru_majflt)};
}

} // namespace

PageFaults page_faults_of_this_thread() noexcept TAPPET_REALTIME { return faults_of(RUSAGE_THREAD); }
PageFaults page_faults_of_this_process() noexcept TAPPET_REALTIME { return faults_of(RUSAGE_SELF); }

} // namespace tappet::os
