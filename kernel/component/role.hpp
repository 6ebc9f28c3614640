// The roles of users who make requests to a machine from outside. An interface says which of its operations,
// methods and commands are for people at the machine; a board assigns roles to users.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

/// The rights of a peer of the machine's socket; each role includes those of the ones before it.
enum class Role : std::uint8_t { observer, machine_operator, engineer };

/// Returns how many of `of` places a user of this role must leave free for higher roles: half of them are for
/// higher roles than observer, a quarter for engineers. So no lower role can block a higher one.
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
