// The peer that needs a daemon: iceoryx, with its RouDi inside this process.
#pragma once

#include "tests/figures/exchange/machine.hpp"
#include "tests/figures/measure/candidates.hpp"

#include <string>

namespace tappet::figures {

/// Call once, before anything else of iceoryx. Empty: it runs; else the reason why it does not.
std::string start_iceoryx();
void stop_iceoryx();

template <std::size_t bytes, bool queue>
struct Iceoryx {
    static constexpr const char* name = queue ? "iceoryx, 16 places" : "iceoryx, the newest";
    static constexpr Standing role = Standing::peer;
    static bool give(const Packet<bytes>& value) noexcept;
    static bool take(Packet<bytes>& into) noexcept;
};

} // namespace tappet::figures
