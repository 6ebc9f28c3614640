// The values read from and written to one Modbus server as one constexpr table, checked by the compiler.
#pragma once

#include "drivers/modbus/registers.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <cstddef>
#include <span>

namespace tappet::modbus {

/// Returns the most values of a table in one request (Modbus application protocol 1.1b3, section 6).
constexpr unsigned most_in_request(Table table, bool write) noexcept {
    if (holds_bits(table)) return write ? 1968 : 2000;
    return write ? 123 : 125;
}
inline constexpr unsigned most_words = 125; ///< size of the client's buffers; bits have the same limit

struct Run {
    Table table = Table::holding_registers;
    std::uint32_t address = 0; ///< counted from 0, as on the wire
    std::uint32_t count = 0;
};
/// Bits that are read and written, from this address (counted from 0).
constexpr Run coils(std::uint32_t address, std::uint32_t count) noexcept {
    return {Table::coils, address, count};
}
/// Bits that are only read.
constexpr Run discrete_inputs(std::uint32_t address, std::uint32_t count) noexcept {
    return {Table::discrete_inputs, address, count};
}
/// Words that are only read.
constexpr Run input_registers(std::uint32_t address, std::uint32_t count) noexcept {
    return {Table::input_registers, address, count};
}
/// Words that are read and written.
constexpr Run holding_registers(std::uint32_t address, std::uint32_t count) noexcept {
    return {Table::holding_registers, address, count};
}

/// One request, sent periodically. A written row is also sent at once when one of its values changed.
struct Row : MapRow {
    Run run{};
    bool write = false;
    Duration every{};
    Duration stale_after{}; ///< write: older values are replaced by their safe values, if any; 0: no limit
};

template <std::size_t N> using RowWithRegisters = RowWithValues<Row, Register, N>;

struct Every {
    Duration period{};
};
/// The period of the request.
constexpr Every every(Duration period) noexcept { return {period}; }
struct StaleAfter {
    Duration age{};
};
/// Values older than this are not sent any more. A value that the server never got is replaced by its safe
/// value; in a row that is safe by silence, nothing is sent.
constexpr StaleAfter stale_after(Duration age) noexcept { return {age}; }

/// read("climate", input_registers(0, 4), every(250ms), word("temperature", 0).as_signed().times(0.1), ...)
/// The connection's row that reads a value states its maximum age.
template <class... Registers>
constexpr auto read(std::string_view name, Run run, Every period, const Registers&... registers) noexcept {
    return RowWithRegisters<sizeof...(Registers)>{{{name}, run, false, period.period, {}}, {registers...}};
}
/// write("setpoints", holding_registers(8, 2), every(1s), stale_after(3s), word("temperature", 0).safe(20),
/// ...)
template <class... Registers>
constexpr auto write(std::string_view name, Run run, Every period, StaleAfter age,
                     const Registers&... registers) noexcept {
    return RowWithRegisters<sizeof...(Registers)>{{{name}, run, true, period.period, age.age},
                                                  {registers...}};
}

/// One request that writes safe values: `count` words, from index `first` of the map's words.
struct SafeWrite {
    Run run{};
    std::size_t first = 0;
};
struct SafeWrites {
    std::span<const SafeWrite> requests{};
    std::span<const std::uint16_t> words{};
    std::span<const Row> rows{}; ///< of the map; read by tools
    std::span<const Register> registers{};
};

template <std::size_t R, std::size_t V> struct RegisterMap {
    std::array<Row, R> rows{};
    std::array<Register, V> registers{};
    std::array<std::size_t, V> row_of{};
    std::array<SafeWrite, R> safe{};
    std::array<std::uint16_t, 2 * V> safe_words{};
    std::size_t safe_count = 0;
    Sentence fault{}; ///< empty when the map is correct

    /// The client sends these when it stops; the guardian sends them when the machine's process has ended.
    [[nodiscard]] constexpr SafeWrites safe_writes() const noexcept {
        return {std::span{safe}.first(safe_count), safe_words, rows, registers};
    }

    [[nodiscard]] constexpr MapName name_of(std::size_t v) const noexcept {
        return {rows[row_of[v]].name, registers[v].name};
    }
    /// Finds a register by "row.register".
    [[nodiscard]] constexpr std::size_t value(std::string_view path) const noexcept {
        return index_of(path, V, [this](std::size_t v) { return name_of(v); });
    }
};

namespace detail {

inline constexpr MapWords words{.row = "row", .value = "register", .comes = "read", .goes = "written"};

constexpr Sentence row_fault(const Row& row) noexcept {
    const Sentence who{"row \"", row.name, "\""};
    const unsigned most = std::min(most_in_request(row.run.table, row.write), most_words);
    if (row.name.empty()) return Sentence{"a row has no name: name it"};
    if (row.run.count == 0 || row.run.count > most)
        return Sentence(who, " has ", row.run.count, " ", name_of(row.run.table), ": a row carries 1 to ",
                        most, "; split it");
    if (row.run.address + std::uint64_t{row.run.count} > 65536)
        return Sentence{who, " ends at address ", row.run.address + row.run.count - 1, ": the last is 65535"};
    if (row.write && !writable(row.run.table))
        return Sentence{who, " writes ", name_of(row.run.table),
                        ", which can only be read: write coils or holding registers"};
    if (row.every <= 0ns) return Sentence{who, " has no period: give it one, every(250ms)"};
    if (row.stale_after != 0ns && row.stale_after < row.every)
        return Sentence{who,
                        " is stale before it is due again: choose stale_after at least as long as every"};
    return {};
}

constexpr Sentence register_fault(const Row& row, const Register& r) noexcept {
    const Sentence who{"register \"", row.name, ".", r.name, "\""};
    if ((r.kind == Kind::bit) != holds_bits(row.run.table))
        return Sentence(who, " is a ", r.kind == Kind::bit ? "bit" : "word", " among ",
                        name_of(row.run.table),
                        ": take bit() for coils and discrete inputs, words elsewhere");
    if (r.low_word_first && r.width() == 1)
        return Sentence{who, " is swapped, but has one word; write bytes_swapped(), or take swapped() away"};
    if (r.low_byte_first && r.kind == Kind::bit)
        return Sentence{who, " is a bit and has no bytes to swap; take bytes_swapped() away"};
    if (std::uint32_t{r.at} + r.width() > row.run.count)
        return Sentence{who, " reaches outside its row of ", row.run.count,
                        " ", name_of(row.run.table),         ": move it or lengthen the row"};
    return {};
}

template <std::size_t R, std::size_t V> constexpr Sentence map_fault(const RegisterMap<R, V>& map) noexcept {
    for (std::size_t i = 0; i < R; ++i) {
        const Row& row = map.rows[i];
        if (const Sentence fault = row_fault(row); !fault.empty()) return fault;
        if (const Sentence fault = name_fault(words, map.rows, i); !fault.empty()) return fault;
        std::uint32_t covered = 0;
        for (std::size_t v = row.first; v < row.end(); ++v) {
            const Register& r = map.registers[v];
            if (const Sentence fault = value_fault(words, row, map.registers, v); !fault.empty())
                return fault;
            if (const Sentence fault = register_fault(row, r); !fault.empty()) return fault;
            const Encoded safe = to_words(r, r.safe_value);
            if (const Sentence fault = safe_fault(words, row, r, row.write, !safe.saturated && !safe.refused);
                !fault.empty())
                return fault;
            covered += r.width();
            for (std::size_t other = row.first; other < v; ++other) {
                const Register& o = map.registers[other];
                if (r.at < o.at + o.width() && o.at < r.at + r.width())
                    return Sentence{"register \"",         row.name, ".", r.name, "\" overlaps \"", o.name,
                                    "\": move one of them"};
            }
        }
        if (row.write && covered != row.run.count)
            return Sentence("row \"", row.name, "\" writes ", row.run.count, " ", name_of(row.run.table),
                            " and names ", covered,
                            ": name all, or what is not named would be overwritten with 0");
    }
    return {};
}

} // namespace detail

/// Flattens the rows and checks them: static_assert(map.fault.empty(), map.fault).
template <std::size_t... N> constexpr auto register_map(const RowWithRegisters<N>&... rows) noexcept {
    RegisterMap<sizeof...(N), (N + ... + 0)> map;
    flatten(map.rows, map.registers, rows...);
    for (std::size_t r = 0; r < map.rows.size(); ++r)
        for (std::size_t v = map.rows[r].first; v < map.rows[r].end(); ++v) map.row_of[v] = r;
    map.fault = detail::map_fault(map);
    std::size_t used = 0;
    for (const Row& row : map.rows) {
        if (!map.fault.empty() || !row.write || row.silence_is_safe) continue;
        map.safe[map.safe_count++] = {row.run, used};
        for (const Register& one : std::span{map.registers}.subspan(row.first, row.values)) {
            const Encoded value = to_words(one, one.safe_value);
            for (unsigned w = 0; w < one.width(); ++w) map.safe_words[used + one.at + w] = value.words[w];
        }
        used += row.run.count;
    }
    return map;
}

} // namespace tappet::modbus
