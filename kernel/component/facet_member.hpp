// The base of every class whose members are facets: while a machine is constructed, each member of a
// component is looked up in its interface(), so that none is forgotten there.
#pragma once

#include <string_view>

namespace tappet {

/// The kind of such a member in a refusal: "has a port that interface() does not list, so that no row can
/// connect it; list it, input<..> or output<..>, or remove it".
struct MemberKind {
    std::string_view name{};
    std::string_view effect{}; ///< of its absence
    std::string_view word{};   ///< that lists it
};

/// Is told each facet member that is constructed while it is the current one.
struct MemberCensus {
    void (*count)(void* context, const void* member, const MemberKind& kind) noexcept = nullptr;
    void* context = nullptr;
    inline static const MemberCensus* current =
        nullptr; ///< set at start-up, by one thread; null: nobody counts
};

template <const MemberKind& kind> class FacetMember {
public:
    constexpr FacetMember() noexcept {
        if consteval {
        } else {
            if (const MemberCensus* const census = MemberCensus::current; census != nullptr) [[unlikely]]
                census->count(census->context, this, kind);
        }
    }
    // A copy is no new member.
    constexpr FacetMember(const FacetMember&) noexcept = default;
    constexpr FacetMember& operator=(const FacetMember&) noexcept = default;
};

namespace member {
inline constexpr MemberKind port{"a port", "no row can connect it", "input<..> or output<..>"};
inline constexpr MemberKind event{"an event", "nobody can hear it", "event<..>"};
inline constexpr MemberKind property{"a property", "no row, file or person can set it", "property<..>"};
inline constexpr MemberKind timer{"a timer", "it never fires", "timer<..>"};
inline constexpr MemberKind method_call{"a method call", "no row can say what it calls", "calls<..>"};
inline constexpr MemberKind command_call{"a command call", "no row can say what it sends", "sends<..>"};
inline constexpr MemberKind handle{"an event handle", "no row can be connected by it", "handle<..>"};
inline constexpr MemberKind wait{"an event wait", "no row can say what it waits for", "awaits<..>"};
} // namespace member

} // namespace tappet
