// The roles of users who make requests to a machine from outside, and where they ask from. An interface says
// which of its operations, methods and commands are for people, and which of them move something; a board
// assigns roles to users.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

/// The rights of a peer of the machine's socket; each role includes those of the ones before it.
enum class Role : std::uint8_t { observer, machine_operator, engineer };

/// The motion that an operation, a method or a command causes, as its interface states it.
enum class Motion : std::uint8_t {
    none,
    moves,           ///< it makes something move
    moves_while_held ///< it moves something as long as somebody holds a button
};

/// The place that a request comes from. A connection is local unless it says otherwise.
enum class Origin : std::uint8_t { local, panel, network };

/// Rights of the user who makes a request.
struct Rights {
    Role role = Role::engineer;
    Origin origin = Origin::local;
};

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

constexpr std::string_view to_text(Origin origin) noexcept {
    switch (origin) {
    case Origin::local: return "local";
    case Origin::panel: return "panel";
    case Origin::network: return "network";
    }
    return "nowhere";
}

/// The gate for requests over the network: an interface must offer the facet to people, and it must move
/// nothing. An answer that is not empty says why the request is refused.
constexpr Sentence check_origin(std::string_view facet, bool for_people, Motion motion,
                                Origin origin) noexcept {
    if (origin != Origin::network) return {};
    if (!for_people)
        return Sentence{"\"", facet,
                        "\" is not for people, so nobody may ask for it over the network; ask at "
                        "the machine, or add for_people(..) to it in its interface"};
    if (motion == Motion::moves)
        return Sentence{"\"", facet,
                        "\" moves something, so nobody may ask for it over the network; ask at "
                        "the machine"};
    if (motion == Motion::moves_while_held)
        return Sentence{"\"", facet,
                        "\" moves something while it is held, so nobody may ask for it over the "
                        "network; hold it at the machine's panel"};
    return {};
}

} // namespace tappet
