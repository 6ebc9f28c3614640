// The object code of functions as objdump prints it: instructions, their successors, and their calls, in the
// words of x86-64; aarch64 is translated into those.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::waitfree {

inline constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] bool begins_with_any(std::string_view text, std::initializer_list<std::string_view> beginnings);
/// The value of "-0x10" or "+0x8"; without 0x it has the given base.
[[nodiscard]] std::optional<std::int64_t> as_number(std::string_view text, int base = 16);
/// "-0x10"
[[nodiscard]] std::string in_words(std::int64_t number);

struct Instruction {
    std::uint64_t address = 0;
    std::string mnemonic; ///< prefixes such as lock and rep stand before it, with a blank
    std::vector<std::string> operands;
    std::string symbol; ///< target of a call or of a jump out of the function; empty: a computed address

    std::uint64_t reckoned = 0; ///< the address that it makes, reads or calls, by objdump; 0: none

    /// Within the function: index of the jump's target. none: no jump, or one that leaves.
    std::size_t target = none;

    bool keeps_flags = false; ///< whatever its name says

    [[nodiscard]] bool is(std::string_view name) const { return mnemonic == name; }
    [[nodiscard]] bool is_call() const { return mnemonic == "call"; }
    [[nodiscard]] bool is_jump() const { return mnemonic == "jmp"; }
    [[nodiscard]] bool is_conditional() const {
        return mnemonic.size() > 1 && mnemonic[0] == 'j' && !is_jump();
    }
    /// Control never continues after this instruction in the function.
    [[nodiscard]] bool ends() const {
        return mnemonic == "ret" || mnemonic == "ud2" || mnemonic == "hlt" || (is_jump() && target == none);
    }
};

struct Function {
    std::string name;
    std::vector<Instruction> code;

    /// The instructions that may come directly after `at`.
    [[nodiscard]] std::vector<std::size_t> successors(std::size_t at) const;
};

using Program = std::map<std::string, Function>;

/// An instruction of aarch64, as `objdump -M no-aliases` prints it.
std::vector<Instruction> of_aarch64(std::uint64_t address, std::string_view text);

/// Reads the output of objdump for one object; a function met in several objects is taken once. When an
/// object has several functions of one name, each but the first has its address after an @.
void add_disassembly(Program& into, std::string_view text);

/// Runs objdump over the objects. Empty when it cannot be run.
Program disassemble(const std::vector<std::string>& objects);

} // namespace tappet::waitfree
