// The contents of registers and stack slots at each instruction, as far as they are "a constant" or "the
// earlier contents of a place, plus a constant": enough to know a counter and its bound.
#pragma once

#include "tests/waitfree/disassembly.hpp"

#include <compare>
#include <cstdint>
#include <map>

#include <set>

namespace tappet::waitfree {

/// A general register, or eight bytes of the frame.
struct Place {
    enum class Kind : std::uint8_t { number, stack, aligned_stack } kind = Kind::number;
    std::int64_t at = 0; ///< the register's number in the instruction set, or the offset in the frame
    auto operator<=>(const Place&) const = default;
};
[[nodiscard]] std::string to_string(const Place& place);

struct Value {
    enum class Kind : std::uint8_t {
        unknown,
        constant,
        at_entry,  ///< the contents of `of` when the function began, plus `offset`
        at_header, ///< the contents of `of` when this pass of the loop began, plus `offset`
        aligned,   ///< the stack pointer after its alignment, plus `offset`
    } kind = Kind::unknown;
    Place of{};
    std::int64_t offset = 0;

    bool operator==(const Value&) const = default;
    [[nodiscard]] bool known() const { return kind != Kind::unknown; }
    [[nodiscard]] bool same_base(const Value& other) const {
        return known() && kind == other.kind && of == other.of;
    }
    [[nodiscard]] Value plus(std::int64_t more) const;
};

/// An unlisted place still has its contents from the function's beginning.
using State = std::map<Place, Value>;

[[nodiscard]] Value value_of(const State& state, const Place& place);
/// The value of an operand as objdump writes it: a register, a number, or memory of the frame. Other memory
/// is unknown: any thread may write it.
[[nodiscard]] Value value_of(const State& state, const std::string& operand);
[[nodiscard]] bool writes_flags(const Instruction& one);
void execute(const Instruction& one, State& state);

/// The state before each instruction of `within` that holds on every path from `from`, where it is `first`;
/// paths back to `from` end there.
using States = std::map<std::size_t, State>;
[[nodiscard]] States follow(const Function& function, const std::set<std::size_t>& within, std::size_t from,
                            const State& first);

/// The facts on which two paths agree.
[[nodiscard]] State meet(const State& a, const State& b);

} // namespace tappet::waitfree
