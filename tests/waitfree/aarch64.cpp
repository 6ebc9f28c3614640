// Translates an instruction of aarch64 into the words of x86-64 in which the loop check works (registers,
// frame and flags): one instruction becomes one to four, at the same address. An instruction without such
// words makes its results unknown. Input is `objdump -d -r -M no-aliases`.
#include "tests/waitfree/disassembly.hpp"

#include <algorithm>
#include <utility>

namespace tappet::waitfree {

namespace {

using Texts = std::vector<std::string>;

bool is_any(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, name) != names.end();
}

/// "x0, [x1, #8]!, lsl #2" split at the commas outside of brackets.
Texts parts_of(std::string_view text) {
    Texts parts;
    std::size_t begin = 0;
    int depth = 0;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        if (i < text.size() && (text[i] == '[' || text[i] == '{')) ++depth;
        if (i < text.size() && (text[i] == ']' || text[i] == '}')) --depth;
        if (i != text.size() && (text[i] != ',' || depth != 0)) continue;
        if (const auto part = trimmed(text.substr(begin, i - begin)); !part.empty()) parts.emplace_back(part);
        begin = i + 1;
    }
    return parts;
}

/// "#0x10" or "#-16".
std::optional<std::int64_t> immediate(std::string_view text) {
    return text.starts_with('#') ? as_number(text.substr(1), 10) : std::nullopt;
}

bool is_zero(std::string_view name) { return name == "xzr" || name == "wzr"; }
bool is_general(std::string_view name) {
    if (is_any(name, {"sp", "wsp"})) return true;
    return name.size() >= 2 && name.size() <= 3 && (name[0] == 'x' || name[0] == 'w') &&
           std::ranges::all_of(name.substr(1), [](char c) { return c >= '0' && c <= '9'; });
}

/// The source operand; anything but a general register or a number is unknown.
std::string source(std::string_view name) {
    if (name == "sp") return "rsp";
    if (name == "wsp") return "esp";
    if (is_zero(name)) return "0x0";
    if (const auto value = immediate(name)) return in_words(*value);
    return is_general(name) ? std::string{name} : "?";
}

std::string sum(std::string_view left, std::int64_t right) {
    const std::string number = in_words(right);
    return "[" + std::string{left} + (right < 0 ? "" : "+") + number + "]";
}

/// An access to memory: the address, and how its base changes.
struct Memory {
    std::string address; ///< "[x0+0x8]"
    std::string base;
    std::optional<std::int64_t> before{}, after{}; ///< added to the base
    bool base_is_lost = false;
};

Memory memory_of(const Texts& operands, std::size_t at) {
    const std::string_view text = operands[at];
    const std::size_t close = text.find(']');
    const Texts inside = parts_of(text.substr(1, close - 1));
    Memory memory;
    memory.base = source(inside[0]);
    std::int64_t offset = 0;
    bool is_known = inside.size() == 1;
    if (inside.size() == 2)
        if (const auto number = immediate(inside[1])) offset = *number, is_known = true;
    if (text.ends_with("]!")) {
        memory.before = offset;
        offset = 0;
    }
    memory.address = is_known ? sum(memory.base, offset) : "[?]";
    if (at + 1 < operands.size()) {
        memory.after = immediate(operands[at + 1]);
        memory.base_is_lost = !memory.after;
    }
    return memory;
}

class Saying {
public:
    Saying(std::uint64_t address, std::string name, Texts operands)
        : address_{address}, name_{std::move(name)}, operands_{std::move(operands)} {}

    std::vector<Instruction> said() && {
        const auto memory =
            std::ranges::find_if(operands_, [](const auto& each) { return each.starts_with('['); });
        if (goes()) return std::move(said_);
        if (memory != operands_.end())
            accesses(static_cast<std::size_t>(memory - operands_.begin()));
        else if (!computes())
            unknown(0);
        if (said_.empty()) say("nop");
        return std::move(said_);
    }

private:
    void say(std::string name, Texts operands = {}, bool keeps_flags = false) {
        Instruction one;
        one.address = address_;
        one.mnemonic = std::move(name);
        one.operands = std::move(operands);
        one.keeps_flags = keeps_flags;
        said_.push_back(std::move(one));
    }
    void unknown(std::size_t operand) {
        if (operand < operands_.size() && is_general(operands_[operand]))
            say(name_, {source(operands_[operand])}, true);
    }
    /// Flags with unknown contents.
    void flags() { say("bt", {"?"}); }

    /// Jumps and calls.
    bool goes() {
        static const std::map<std::string_view, std::string_view> conditions{
            {"eq", "je"}, {"ne", "jne"}, {"cs", "jae"}, {"hs", "jae"}, {"cc", "jb"}, {"lo", "jb"},
            {"hi", "ja"}, {"ls", "jbe"}, {"ge", "jge"}, {"lt", "jl"},  {"gt", "jg"}, {"le", "jle"},
            {"mi", "js"}, {"pl", "jns"}, {"vs", "jo"},  {"vc", "jno"}};
        if (name_.starts_with("b.")) {
            const auto found = conditions.find(std::string_view{name_}.substr(2, 2));
            say(std::string{found == conditions.end() ? "jmp" : found->second}, {operands_[0]});
        } else if (is_any(name_, {"udf", "hlt", "brk"})) {
            say("ud2");
        } else if (name_ == "b" || name_.starts_with("br")) {
            say("jmp", {operands_[0]});
        } else if (name_.starts_with("bl")) {
            say("call", {operands_[0]});
        } else if (name_.starts_with("ret")) {
            say("ret");
        } else if (is_any(name_, {"cbz", "cbnz"})) {
            say("test", {source(operands_[0]), source(operands_[0])});
            say(name_ == "cbz" ? "je" : "jne", {operands_[1]});
            say("cmc"); // the flags are unchanged, and must not count as this comparison's
        } else if (is_any(name_, {"tbz", "tbnz"})) {
            flags();
            say(name_ == "tbz" ? "je" : "jne", {operands_[2]});
        } else if (name_ == "svc") {
            say("syscall");
        } else {
            return false;
        }
        return true;
    }

    void accesses(std::size_t at) {
        const Memory memory = memory_of(operands_, at);
        const auto add = [&](std::int64_t number) { say("lea", {memory.base, sum(memory.base, number)}); };
        if (memory.before) add(*memory.before);
        // One or two registers, as they lie in memory.
        const bool is_pair = at == 2 && begins_with_any(name_, {"ldp", "ldnp", "stp", "stnp"});
        const bool loads =
            is_pair ? name_[0] == 'l'
                    : at == 1 && begins_with_any(name_, {"ldr", "ldur", "ldar", "ldapr", "ldapur", "ldlar"});
        const bool stores =
            is_pair ? name_[0] == 's'
                    : at == 1 && begins_with_any(name_, {"str", "stur", "stlr", "stlur", "stllr"});
        const bool is_narrow = name_.ends_with('b') || name_.ends_with('h') || name_.ends_with("sw");
        if (loads || stores) {
            // The base register of the address is loaded last.
            const std::size_t first = is_pair && source(operands_[0]) == memory.base ? 1 : 0;
            for (std::size_t k = 0; k < at; ++k) {
                const std::size_t i = k ^ first;
                const std::string& name = operands_[i];
                const bool is_vector = !is_general(name) && !is_zero(name);
                const std::int64_t bytes = is_narrow                               ? 1
                                           : name[0] == 'q'                        ? 16
                                           : is_any(name.substr(0, 1), {"x", "d"}) ? 8
                                                                                   : 4;
                std::string place = memory.address;
                if (i == 1) place.insert(place.size() - 1, "+" + in_words(bytes));
                place = (bytes == 16  ? "XMMWORD"
                         : bytes == 8 ? "QWORD"
                         : bytes == 4 ? "DWORD"
                                      : "WORD") +
                        (" PTR " + place);
                if (stores)
                    say("mov", {place, is_vector ? "?" : source(name)});
                else if (bytes == 8 && !is_vector && !is_zero(name))
                    say("mov", {source(name), place});
                else
                    unknown(i);
            }
        } else if (begins_with_any(name_, {"ldadd", "ldclr", "ldset", "ldeor", "ldsm", "ldum", "swp"})) {
            unknown(1); // the previous contents
        } else {
            unknown(0);
            if (begins_with_any(name_, {"casp", "ldxp", "ldaxp"})) unknown(1);
        }
        if (memory.after) add(*memory.after);
        if (memory.base_is_lost) say(name_, {memory.base}, true);
    }

    /// Between registers; false: only the change of the first operand is known.
    bool computes() {
        const std::size_t count = operands_.size();
        const auto is_register = [&](std::size_t i) {
            return is_general(operands_[i]) || is_zero(operands_[i]);
        };
        if (begins_with_any(name_, {"ccmp", "ccmn", "fcmp", "fccmp", "msr"})) {
            flags();
        } else if (begins_with_any(name_,
                                   {"dmb", "dsb", "isb", "hint", "nop", "prfm", "clrex", "dc", "sys"})) {
            say("nop");
        } else if (is_any(name_, {"add", "sub", "adds", "subs"}) && count >= 3) {
            auto number = immediate(operands_[2]);
            if (number && count > 3) *number <<= 12; // the only possible shift
            const bool adds = name_.starts_with("add"), sets_flags = name_.ends_with('s');
            const bool is_plain = number || (count == 3 && is_register(2) && !adds);
            if (sets_flags && is_plain && !(adds && number == 0))
                say("cmp", {source(operands_[1]),
                            number ? in_words(adds ? -*number : *number) : source(operands_[2])});
            else if (sets_flags)
                flags();
            if (number)
                into_first(sum(source(operands_[1]), adds ? *number : -*number));
            else if (adds && !sets_flags && count == 3 && !is_zero(operands_[1]) && !is_zero(operands_[2]))
                into_first("[" + source(operands_[1]) + "+" + source(operands_[2]) + "]");
            else
                unknown(0);
        } else if (is_any(name_, {"ands", "bics", "adcs", "sbcs"})) {
            if (name_ == "ands" && count == 3 && operands_[1] == operands_[2]) {
                say("test", {source(operands_[1]), source(operands_[1])});
                if (is_general(operands_[0])) say("mov", {source(operands_[0]), source(operands_[1])});
            } else {
                flags();
                unknown(0);
            }
        } else if (name_ == "orr" && count == 3 && is_zero(operands_[1]) && is_general(operands_[0])) {
            say("mov", {source(operands_[0]), source(operands_[2])});
        } else if (name_ == "movz" && is_general(operands_[0])) {
            auto number = immediate(operands_[1]).value_or(0);
            if (count > 2)
                number <<= immediate("#" + operands_[2].substr(operands_[2].find('#') + 1)).value_or(0);
            say("mov", {source(operands_[0]), in_words(number)});
        } else if (name_ == "and" && operands_[0] == "sp") {
            say("and", {"rsp", "?"}, true);
        } else {
            return false;
        }
        return true;
    }
    void into_first(const std::string& address) {
        if (is_general(operands_[0])) say("lea", {source(operands_[0]), address});
    }

    std::uint64_t address_;
    std::string name_;
    Texts operands_;
    std::vector<Instruction> said_{};
};

} // namespace

std::vector<Instruction> of_aarch64(std::uint64_t address, std::string_view text) {
    text = trimmed(text.substr(0, text.find("//"))); // the rest is objdump's own computation
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    return Saying{address, std::string{text.substr(0, end)}, parts_of(text.substr(end))}.said();
}

} // namespace tappet::waitfree
