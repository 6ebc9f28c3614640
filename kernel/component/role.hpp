// Who asks something of a machine from outside. An interface says which of its operations, methods and
// commands are for people at the machine; a board says who is what.
#pragma once

#include <cstdint>
#include <string_view>

namespace tappet {

/// What a peer of the machine's socket may do; each role may do all that the ones before it may.
enum class Role : std::uint8_t { observer, machine_operator, engineer };

constexpr std::string_view to_text(Role role) noexcept {
    switch (role) {
    case Role::observer: return "observer";
    case Role::machine_operator: return "operator";
    case Role::engineer: return "engineer";
    }
    return "nobody";
}

} // namespace tappet
