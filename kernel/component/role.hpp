// Who asks something of a machine from outside. An interface says which of its operations, methods and
// commands are for people at the machine; a board says who is what.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

/// What a peer of the machine's socket may do; each role may do all that the ones before it may.
enum class Role : std::uint8_t { observer, machine_operator, engineer };

/// How many of `of` places somebody of this role leaves free for higher ones: half of them are for those who
/// are more than observers, a quarter for engineers. Nobody keeps a higher role from being served.
constexpr std::size_t kept_from(Role role, std::size_t of) noexcept {
    return role == Role::observer ? of / 2 : role == Role::machine_operator ? of / 4 : 0;
}

constexpr std::string_view to_text(Role role) noexcept {
    switch (role) {
    case Role::observer: return "observer";
    case Role::machine_operator: return "operator";
    case Role::engineer: return "engineer";
    }
    return "nobody";
}

} // namespace tappet
