// Symbolic execution of the few instructions that count; every other one makes what it writes unknown.
#include "tests/waitfree/values.hpp"

#include <algorithm>
#include <array>

#include <deque>

namespace tappet::waitfree {

namespace {

constexpr std::array wide{"rax", "rcx", "rdx", "rbx", "rsp", "rbp", "rsi", "rdi",
                          "r8",  "r9",  "r10", "r11", "r12", "r13", "r14", "r15"};
constexpr std::array half{"eax", "ecx", "edx",  "ebx",  "esp",  "ebp",  "esi",  "edi",
                          "r8d", "r9d", "r10d", "r11d", "r12d", "r13d", "r14d", "r15d"};
constexpr std::array word{"ax",  "cx",  "dx",   "bx",   "sp",   "bp",   "si",   "di",
                          "r8w", "r9w", "r10w", "r11w", "r12w", "r13w", "r14w", "r15w"};
constexpr std::array low{"al",  "cl",  "dl",   "bl",   "spl",  "bpl",  "sil",  "dil",
                         "r8b", "r9b", "r10b", "r11b", "r12b", "r13b", "r14b", "r15b"};
constexpr std::array high{"ah", "ch", "dh", "bh"};
constexpr std::int64_t rax = 0, rcx = 1, rdx = 2, rbx = 3, rsp = 4, rbp = 5, rsi = 6, rdi = 7, x0 = 32;
constexpr std::int64_t word_bytes = 8;

Place number(std::int64_t index) { return {Place::Kind::number, index}; }

struct Register {
    std::int64_t index;
    int bytes;
};

std::optional<Register> as_register(std::string_view name) {
    const auto in = [&](const auto& names, int bytes) -> std::optional<Register> {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) return std::nullopt;
        return Register{found - names.begin(), bytes};
    };
    if (const auto found = in(wide, 8)) return found;
    if (const auto found = in(half, 4)) return found;
    if (const auto found = in(word, 2)) return found;
    if (const auto found = in(low, 1)) return found;
    if (const auto found = in(high, 1)) return found;
    // The registers of aarch64 follow those; its stack pointer has the other's name.
    if (name.size() < 2 || (name[0] != 'x' && name[0] != 'w')) return std::nullopt;
    const auto index = as_number(name.substr(1), 10);
    if (!index || *index < 0 || *index > 30) return std::nullopt;
    return Register{x0 + *index, name[0] == 'x' ? 8 : 4};
}

Value constant(std::int64_t offset) { return {Value::Kind::constant, {}, offset}; }

/// The address of "[rsp+rax*1+0x8]".
Value address(const State& state, std::string_view operand) {
    const std::size_t open = operand.find('[');
    if (operand.substr(0, open).contains(':')) return {}; // relative to a segment
    std::string_view inside = operand.substr(open + 1, operand.find(']') - open - 1);
    Value sum = constant(0);
    bool negative = false;
    while (!inside.empty()) {
        const std::size_t end = std::min(inside.find_first_of("+-"), inside.size());
        const std::string_view term = inside.substr(0, end);
        const std::size_t times = term.find('*');
        Value value;
        if (const auto found = as_register(term.substr(0, times))) {
            value = value_of(state, number(found->index));
            const std::int64_t scale = times == term.npos ? 1 : as_number(term.substr(times + 1)).value_or(0);
            if (scale != 1) {
                if (value.kind != Value::Kind::constant) return {};
                value.offset *= scale;
            }
        } else if (const auto displacement = as_number(term)) {
            value = constant(negative ? -*displacement : *displacement);
        }
        if (!value.known()) return {};
        if (sum.kind == Value::Kind::constant)
            sum = value.plus(sum.offset);
        else if (value.kind == Value::Kind::constant)
            sum = sum.plus(value.offset);
        else
            return {};
        negative = end < inside.size() && inside[end] == '-';
        inside = end < inside.size() ? inside.substr(end + 1) : "";
    }
    return sum;
}

/// The eight bytes of the frame that begin at this address.
std::optional<Place> slot(const Value& address) {
    if (address.kind == Value::Kind::aligned) return Place{Place::Kind::aligned_stack, address.offset};
    if (address.kind == Value::Kind::at_entry && address.of == number(rsp))
        return Place{Place::Kind::stack, address.offset};
    return std::nullopt;
}

std::int64_t bytes_of(std::string_view operand) {
    static constexpr std::array<std::pair<std::string_view, int>, 6> sizes{
        {{"XMMWORD", 16}, {"QWORD", 8}, {"DWORD", 4}, {"WORD", 2}, {"BYTE", 1}, {"YMMWORD", 32}}};
    for (const auto& [name, bytes] : sizes)
        if (operand.starts_with(name)) return bytes;
    return 16;
}

void write(State& state, const std::string& operand, const Value& value) {
    if (const auto found = as_register(operand)) {
        state[number(found->index)] = found->bytes >= 4 ? value : Value{};
        return;
    }
    if (!operand.contains('[')) return;
    const auto place = slot(address(state, operand));
    if (!place) return; // the compiler writes a spill slot only by its own address
    const std::int64_t bytes = bytes_of(operand);
    for (auto& [other, held] : state)
        if (other.kind == place->kind && other.at > place->at - word_bytes && other.at < place->at + bytes)
            held = Value{};
    for (std::int64_t at = place->at; at < place->at + bytes; at += word_bytes)
        state[{place->kind, at}] = bytes == word_bytes ? value : Value{};
}

void forget(State& state, std::initializer_list<std::int64_t> registers) {
    for (const std::int64_t each : registers) state[number(each)] = Value{};
}

void move_stack(State& state, std::int64_t by) { state[number(rsp)] = value_of(state, number(rsp)).plus(by); }

} // namespace

std::string to_string(const Place& place) {
    if (place.kind == Place::Kind::number)
        return place.at >= x0 ? "x" + std::to_string(place.at - x0)
                              : wide[static_cast<std::size_t>(place.at)];
    return "frame[" + std::to_string(place.at) + "]";
}

Value Value::plus(std::int64_t more) const {
    Value sum = *this;
    // Registers wrap: the sum is the machine's.
    if (known())
        sum.offset =
            static_cast<std::int64_t>(static_cast<std::uint64_t>(offset) + static_cast<std::uint64_t>(more));
    return sum;
}

Value value_of(const State& state, const Place& place) {
    const auto found = state.find(place);
    if (found != state.end()) return found->second;
    if (place.kind != Place::Kind::number)
        for (const auto& [other, held] : state)
            if (other.kind == place.kind && other.at > place.at - word_bytes &&
                other.at < place.at + word_bytes)
                return {}; // a part of it was written
    return {Value::Kind::at_entry, place, 0};
}

Value value_of(const State& state, const std::string& operand) {
    if (const auto found = as_register(operand))
        return found->bytes >= 4 ? value_of(state, number(found->index)) : Value{};
    if (operand.contains('[')) {
        const auto place = slot(address(state, operand));
        return place && bytes_of(operand) == word_bytes ? value_of(state, *place) : Value{};
    }
    if (const auto number = as_number(operand)) return constant(*number);
    return {};
}

bool writes_flags(const Instruction& one) {
    if (one.is_call()) return true;
    if (one.keeps_flags) return false;
    return !begins_with_any(one.mnemonic,
                            {"mov", "lea", "nop", "push", "pop", "cmov", "set", "j", "xchg", "prefetch",
                             "not", "bswap", "cdq", "cqo", "cvt", "pxor", "punpck", "pshuf"});
}

void execute(const Instruction& one, State& state) {
    const std::string& name = one.mnemonic;
    const auto operand = [&](std::size_t i) -> const std::string& { return one.operands[i]; };
    const std::size_t count = one.operands.size();
    if (one.is_call()) {
        forget(state, {rax, rcx, rdx, rsi, rdi, 8, 9, 10, 11, x0 + 30});
        for (std::int64_t i = 0; i < 19; ++i) forget(state, {x0 + i});
    } else if (begins_with_any(name,
                               {"cmp", "test", "j", "nop", "ret", "prefetch", "ud2", "endbr", "xchg"}) &&
               name != "cmpxchg" && name != "xchg") {
        return;
    } else if (name == "bt" || begins_with_any(name, {"ucomis", "comis"})) {
        return;
    } else if ((name == "mov" || name == "movabs" || name == "movsxd") && count == 2) {
        write(state, operand(0), value_of(state, operand(1)));
    } else if (name == "lea" && count == 2) {
        write(state, operand(0), address(state, operand(1)));
    } else if ((name == "add" || name == "sub") && count == 2) {
        const Value left = value_of(state, operand(0));
        const Value right = value_of(state, operand(1));
        Value sum;
        if (right.kind == Value::Kind::constant)
            sum = left.plus(name == "add" ? right.offset : -right.offset);
        else if (name == "add" && left.kind == Value::Kind::constant)
            sum = right.plus(left.offset);
        write(state, operand(0), sum);
    } else if (name == "inc" || name == "dec") {
        write(state, operand(0), value_of(state, operand(0)).plus(name == "inc" ? 1 : -1));
    } else if ((name == "xor" || name == "sub") && count == 2 && operand(0) == operand(1)) {
        write(state, operand(0), constant(0));
    } else if (name == "push") {
        const Value value = value_of(state, operand(0));
        move_stack(state, -word_bytes);
        write(state, "QWORD PTR [rsp]", value);
    } else if (name == "pop") {
        const Value value = value_of(state, std::string{"QWORD PTR [rsp]"});
        move_stack(state, word_bytes);
        write(state, operand(0), value);
    } else if (name == "and" && operand(0) == "rsp") {
        state[number(rsp)] = {Value::Kind::aligned, {}, 0};
    } else if (name == "leave") {
        state[number(rsp)] = value_of(state, number(rbp)).plus(word_bytes);
        state[number(rbp)] = Value{};
    } else {
        // Any other instruction makes everything that it may write unknown.
        if (begins_with_any(name, {"mul", "div", "idiv"}) || (name == "imul" && count == 1) ||
            name.ends_with("cmpxchg") ||
            begins_with_any(name, {"cqo", "cdq", "cwd", "cpuid", "rdtsc", "syscall"}))
            forget(state, {rax, rcx, rdx, rbx, 11});
        if (name.starts_with("rep")) forget(state, {rcx, rsi, rdi});
        if (count > 0) write(state, operand(0), Value{});
        if (count > 1 && (name.ends_with("xchg") || name.ends_with("xadd")))
            write(state, operand(1), Value{});
    }
}

State meet(const State& a, const State& b) {
    State both = a;
    for (auto& [place, value] : both)
        if (value_of(b, place) != value) value = Value{};
    for (const auto& [place, value] : b)
        if (!a.contains(place)) both[place] = value_of(a, place) == value ? value : Value{};
    return both;
}

States follow(const Function& function, const std::set<std::size_t>& within, std::size_t from,
              const State& first) {
    States states{{from, first}};
    std::deque<std::size_t> open{from};
    while (!open.empty()) {
        const std::size_t at = open.front();
        open.pop_front();
        State after = states[at];
        execute(function.code[at], after);
        for (const std::size_t next : function.successors(at)) {
            if (next == from || !within.contains(next)) continue;
            const auto found = states.find(next);
            if (found == states.end()) {
                states[next] = after;
            } else {
                State both = meet(found->second, after);
                if (both == found->second) continue;
                found->second = std::move(both);
            }
            open.push_back(next);
        }
    }
    return states;
}

} // namespace tappet::waitfree
