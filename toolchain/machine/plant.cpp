// The one object file with the code of a machine's plant and of its hooks on the host.
#include TAPPET_PLANT_HEADER
#ifdef TAPPET_HOST_HOOKS_HEADER
#include TAPPET_HOST_HOOKS_HEADER
#endif

#include "toolchain/machine/on_host.hpp"

namespace TAPPET_NAMESPACE {

std::unique_ptr<tappet::Plant> make_plant(std::uint64_t seed) { return std::make_unique<Plant>(seed); }

tappet::HostHooks hooks_on_host() {
#ifdef TAPPET_HOST_HOOKS_HEADER
    return host_hooks;
#else
    return {};
#endif
}

} // namespace TAPPET_NAMESPACE
