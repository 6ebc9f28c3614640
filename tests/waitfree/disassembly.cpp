// Reads objdump's lines: a heading for each function, an instruction or a relocation on each line below it.
#include "tests/waitfree/disassembly.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <iterator>
#include <set>
#include <sstream>
#include <utility>

namespace tappet::waitfree {

namespace {

bool hexadecimal(std::string_view text, std::uint64_t& value) {
    const auto number = as_number(text);
    if (number) value = static_cast<std::uint64_t>(*number);
    return number.has_value();
}

/// A function while its lines are read: jumps are kept by address until it is complete.
struct Open {
    Function function;
    std::string section;
    std::uint64_t begin = 0;
};

Instruction instruction(std::uint64_t address, std::string_view text) {
    static constexpr std::array prefixes{"lock", "rep", "repz", "repnz", "notrack", "bnd", "data16", "cs"};
    Instruction one;
    one.address = address;
    // The text after a comment mark is objdump's own computation.
    const std::size_t mark = std::min(text.find('#'), text.size());
    if (mark != text.size()) {
        const std::string_view note = trimmed(text.substr(mark + 1));
        static_cast<void>(hexadecimal(note.substr(0, note.find(' ')), one.reckoned));
    }
    text = trimmed(text.substr(0, mark));
    for (bool more = true; more;) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        more = std::ranges::find(prefixes, word) != prefixes.end();
        one.mnemonic += (one.mnemonic.empty() ? "" : " ") + std::string(word);
        text = trimmed(text.substr(end));
    }
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        one.operands.emplace_back(trimmed(text.substr(0, comma)));
        text = comma == text.size() ? "" : text.substr(comma + 1);
    }
    if (one.is("mov") && one.operands.size() == 2 && one.operands[1].starts_with("0x"))
        static_cast<void>(hexadecimal(one.operands[1], one.reckoned));
    return one;
}

/// "memcpy-0x4" is memcpy: the call's own displacement counts from its end.
void relocate(Instruction& call, std::string_view symbol) {
    const std::size_t end = symbol.rfind("-0x");
    call.symbol = symbol.substr(0, end);
}

/// "30 <f+0x30>": the address, and the function's name for one that lies outside.
void resolve(std::vector<Open>& open) {
    std::map<std::pair<std::string_view, std::uint64_t>, std::string_view> begins;
    // The sections of an object all begin at 0; those of a program follow one another.
    const bool is_linked = std::ranges::none_of(open, [](const Open& each) { return each.begin == 0; });
    for (const Open& each : open)
        begins.try_emplace({is_linked ? std::string_view{} : each.section, each.begin}, each.function.name);
    for (Open& each : open) {
        const std::uint64_t end = each.function.code.empty() ? each.begin : each.function.code.back().address;
        for (Instruction& one : each.function.code) {
            if (!one.symbol.empty() || one.operands.empty() ||
                !(one.is_jump() || one.is_conditional() || one.is_call()))
                continue;
            std::uint64_t to = 0;
            const std::string_view operand = one.operands[0];
            if (!hexadecimal(operand.substr(0, operand.find(' ')), to)) continue; // computed
            if (!one.is_call() && to >= each.begin && to <= end) {
                const auto found = std::ranges::find(each.function.code, to, &Instruction::address);
                if (found != each.function.code.end()) {
                    one.target = static_cast<std::size_t>(found - each.function.code.begin());
                    continue;
                }
            }
            one.symbol = "(the middle of a function)";
            const auto other = begins.find({is_linked ? std::string_view{} : each.section, to});
            if (other != begins.end())
                one.symbol = other->second;
            else
                one.reckoned = to;
        }
    }
}

} // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}
bool begins_with_any(std::string_view text, std::initializer_list<std::string_view> beginnings) {
    return std::ranges::any_of(beginnings, [&](auto each) { return text.starts_with(each); });
}
std::optional<std::int64_t> as_number(std::string_view text, int base) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    const bool is_hexadecimal = text.starts_with("0x");
    if (is_hexadecimal) text.remove_prefix(2);
    std::uint64_t value = 0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, is_hexadecimal ? 16 : base);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return static_cast<std::int64_t>(negative ? 0 - value : value);
}
std::string in_words(std::int64_t number) {
    std::ostringstream text;
    if (number < 0) text << '-';
    const auto size = static_cast<std::uint64_t>(number);
    text << "0x" << std::hex << (number < 0 ? 0 - size : size);
    return std::move(text).str();
}

std::vector<std::size_t> Function::successors(std::size_t at) const {
    const Instruction& one = code[at];
    std::vector<std::size_t> next;
    if (one.target != none) next.push_back(one.target);
    if (!one.ends() && !one.is_jump() && at + 1 < code.size()) next.push_back(at + 1);
    return next;
}

void add_disassembly(Program& into, std::string_view text) {
    std::vector<Open> open;
    std::set<std::string> known;
    std::string section;
    bool is_aarch64 = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text = text.substr(std::min(end + 1, text.size()));
        static constexpr std::string_view heading = "Disassembly of section ";
        if (line.contains("file format ")) {
            is_aarch64 = line.ends_with("aarch64");
        } else if (line.starts_with(heading)) {
            section = line.substr(heading.size());
        } else if (line.ends_with(">:")) {
            const std::size_t name = line.find('<');
            Open next{{}, section, 0};
            if (!hexadecimal(line.substr(0, line.find(' ')), next.begin)) continue;
            next.function.name = line.substr(name + 1, line.size() - name - 3);
            if (!known.insert(next.function.name).second)
                next.function.name += "@" + std::string{line.substr(0, line.find(' '))};
            open.push_back(next);
        } else if (const std::size_t colon = line.find(':'); colon != line.npos && !open.empty()) {
            std::uint64_t address = 0;
            if (!hexadecimal(trimmed(line.substr(0, colon)), address)) continue;
            auto& code = open.back().function.code;
            const std::string_view rest = trimmed(line.substr(colon + 1));
            if (rest.starts_with("R_AARCH64_") || rest.starts_with("R_X86_64_")) {
                if (!code.empty() && (code.back().is_call() || code.back().mnemonic[0] == 'j'))
                    relocate(code.back(),
                             trimmed(rest.substr(std::min(rest.find_first_of(" \t"), rest.size()))));
            } else if (is_aarch64) {
                std::ranges::move(of_aarch64(address, rest), std::back_inserter(code));
            } else {
                code.push_back(instruction(address, rest));
            }
        }
    }
    resolve(open);
    for (Open& each : open) into.try_emplace(each.function.name, std::move(each.function));
}

Program disassemble(const std::vector<std::string>& objects) {
    Program program;
    for (const std::string& object : objects) {
        const std::string command = TAPPET_OBJDUMP " -d -r --no-show-raw-insn '" + object + "'";
        std::FILE* const pipe =
            popen(command.c_str(), "r"); // NOLINT: the command is made of the build's own names
        if (pipe == nullptr) return {};
        std::string text;
        std::array<char, 65536> part{};
        for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) != 0;)
            text.append(part.data(), n);
        if (pclose(pipe) != 0) return {};
        add_disassembly(program, text);
    }
    return program;
}

} // namespace tappet::waitfree
