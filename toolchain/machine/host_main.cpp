// main of every machine's program on the host: one table with its plant, as tappet_machine() of CMake named
// them.
#include TAPPET_PLANT_HEADER
#ifdef TAPPET_HOST_HOOKS_HEADER
#include TAPPET_HOST_HOOKS_HEADER
#endif

#include "toolchain/machine/host.hpp"
#include "toolchain/machine/on_host.hpp"

int main(int count, char** words) {
#ifdef TAPPET_HOST_HOOKS_HEADER
    constexpr tappet::HostHooks hooks = TAPPET_NAMESPACE::host_hooks;
#else
    constexpr tappet::HostHooks hooks;
#endif
    return tappet::run_host(
        TAPPET_NAMESPACE::on_host(),
        [](std::uint64_t seed) -> std::unique_ptr<tappet::Plant> {
            return std::make_unique<TAPPET_NAMESPACE::Plant>(seed);
        },
        count, words, hooks);
}
