// Limits of a component's outputs (thesis 4.4.2: a connector may constrain the flow of data in value and in
// bandwidth): a section of the machine table.
//     limits(limit("warp.target", 0.0, 40.0), rate("main.target", 500.0, stop_on_breach))
#pragma once

#include "kernel/base/compare.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace tappet {

/// Handling of a value that its row does not allow; each is counted.
enum class OnBreach : std::uint8_t {
    clamp, ///< sends the nearest allowed value
    count, ///< sends the value unchanged
    stop   ///< sends the nearest allowed value and stops the machine
};
/// Sends the nearest allowed value. The default.
inline constexpr OnBreach clamp_on_breach = OnBreach::clamp;
/// Sends the value unchanged.
inline constexpr OnBreach count_on_breach = OnBreach::count;
/// Sends the nearest allowed value and stops the machine.
inline constexpr OnBreach stop_on_breach = OnBreach::stop;

struct LimitRow {
    std::string_view output; ///< "component.output", of a number
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double per_second = 0.0; ///< of a rate: maximum change, up or down
    bool is_rate = false;
    OnBreach on_breach = OnBreach::clamp;
};

/// Limits the value to `low`..`high`, both included, in the port's unit.
constexpr LimitRow limit(std::string_view output, double low, double high,
                         OnBreach on_breach = clamp_on_breach) noexcept {
    return {.output = output, .low = low, .high = high, .on_breach = on_breach};
}
/// Limits the change to `per_second` of the port's unit, from write to write by their stamps. The first value
/// after a start is not limited.
constexpr LimitRow rate(std::string_view output, double per_second,
                        OnBreach on_breach = clamp_on_breach) noexcept {
    return {.output = output, .per_second = per_second, .is_rate = true, .on_breach = on_breach};
}

namespace limits_detail {

/// Returns whether a port of that type can hold the number exactly; otherwise it cannot be a bound.
constexpr bool holds(const TypeTag& type, double number) noexcept {
    if (type.kind == ValueKind::real) {
        constexpr double most = std::numeric_limits<float>::max();
        return type.size == sizeof(double) || (number >= -most && number <= most &&
                                               static_cast<double>(static_cast<float>(number)) == number);
    }
    const bool is_signed = type.kind == ValueKind::integer;
    const double top = static_cast<double>(std::uint64_t{1} << (8 * type.size - (is_signed ? 1 : 0)));
    return number >= (is_signed ? -top : 0.0) && number < top &&
           static_cast<double>(static_cast<std::int64_t>(number)) == number;
}

/// Converts between a port's value and a double, which holds every value of these types.
struct Conversion {
    double (*read)(const void* value) noexcept TAPPET_REALTIME = nullptr;
    void (*write)(void* value, double number) noexcept TAPPET_REALTIME = nullptr;
};

/// The limits in effect of the ports that rows name. In the machine's memory.
struct Limited : PortFilter {
    MachineInstance* machine = nullptr;
    std::size_t section = 0;
    const Engine* engine = nullptr;
    std::span<const LimitRow> rows;
    std::size_t row = 0;         ///< the first that names the port
    std::size_t other = nowhere; ///< the second, of the other kind
    std::size_t component = 0;
    Conversion convert{};
    bool has_last = false;
    double last = 0.0; ///< last value sent, before conversion to an integer
    Time at{};
    std::atomic<std::uint64_t> breaches{0}; ///< of the row with the same place

    /// Places are in the order of the rows.
    [[nodiscard]] std::atomic<std::uint64_t>& count_of(std::size_t i) noexcept TAPPET_REALTIME {
        return (this - row + i)->breaches;
    }
};

void connect(std::span<const LimitRow> rows, MachineInstance& machine, std::size_t section,
             std::span<std::byte> memory);
Sentence describe(const LimitRow& row);
SectionCount counted(std::span<const LimitRow> rows, std::span<const std::byte> memory,
                     std::size_t row) noexcept;

constexpr Sentence check_row(const LimitRow& row, const MachineView& m, const TableIndexView& r) {
    End end;
    if (const Sentence fault = resolve(m, r.by_name, row.output, FacetKind::output, end); !fault.empty())
        return fault;
    const Facet& facet = facet_at(m, end);
    if (facet.kind != FacetKind::output)
        return Sentence{to_text(facet.kind), " has no limits; name an output"};
    const ValueKind kind = facet.type->kind;
    const bool is_integer = kind == ValueKind::integer || kind == ValueKind::natural;
    if (!facet.type->arithmetic || !(kind == ValueKind::real || (is_integer && facet.type->size <= 4)))
        return Sentence{"its type ", facet.type->name,
                        " cannot be limited, only numbers that a double holds; limit where one is written"};
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (row.is_rate) {
        if (row.per_second > 0.0 && row.per_second < infinity) return {};
        return Sentence{"its rate is not a finite number above 0; give one in its unit per second"};
    }
    if (!(row.low < row.high))
        return Sentence{"its least value is not below its greatest; write the smaller one first"};
    if (row.low == -infinity && row.high == infinity)
        return Sentence{"it limits nothing; give it a bound, or leave it out"};
    if ((row.low != -infinity && !holds(*facet.type, row.low)) ||
        (row.high != infinity && !holds(*facet.type, row.high)))
        return Sentence{"one of its bounds is not a value of ", facet.type->name,
                        "; give one that the port can have"};
    return {};
}

} // namespace limits_detail

template <std::size_t N>
struct Limits final : ExtraSection {
    std::array<LimitRow, N> rows{};

    constexpr explicit Limits(const std::array<LimitRow, N>& r) : rows{r} {}

    [[nodiscard]] constexpr Sentence check(const MachineView& m, const TableIndexView& r) const override {
        for (std::size_t i = 0; i < N; ++i) {
            const auto said = [&](const Sentence& fault) {
                return Sentence{rows[i].is_rate ? "rate \"" : "limit \"", rows[i].output, "\": ", fault};
            };
            if (const Sentence fault = limits_detail::check_row(rows[i], m, r); !fault.empty())
                return said(fault);
            for (std::size_t j = 0; j < i; ++j)
                if (same_text(rows[j].output, rows[i].output) && rows[j].is_rate == rows[i].is_rate)
                    return said(Sentence{"it appears twice; keep one"});
        }
        return {};
    }
    [[nodiscard]] constexpr std::size_t bytes(const MachineView&) const override {
        return N * sizeof(limits_detail::Limited);
    }
    void connect(MachineInstance& machine, std::size_t number, std::span<std::byte> memory) const override {
        limits_detail::connect(rows, machine, number, memory);
    }
    [[nodiscard]] Sentence describe_stop(std::size_t row) const override {
        return limits_detail::describe(rows[row]);
    }
    [[nodiscard]] SectionCount counted(std::span<const std::byte> memory,
                                       std::size_t row) const noexcept override {
        return limits_detail::counted(rows, memory, row);
    }
};

/// The section: rows of limit(..) and rate(..). Not limited: the safe values that a component leaves behind
/// when it stops, and forced values.
template <class... Rows>
constexpr Limits<sizeof...(Rows)> limits(const Rows&... rows) {
    static_assert(sizeof...(Rows) != 0, "limits() without a row limits nothing; leave the section out");
    return Limits<sizeof...(Rows)>{{rows...}};
}

} // namespace tappet
