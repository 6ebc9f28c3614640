// How a limited port handles each value, and how it is wired.
#include "kernel/limits/limits.hpp"

#include "kernel/base/decimal.hpp"
#include "kernel/base/number.hpp"

#include <cstring>
#include <new>

namespace tappet {

namespace limits_detail {

namespace {

template <class T>
double read_as(const void* value) noexcept TAPPET_REALTIME {
    return static_cast<double>(*static_cast<const T*>(value));
}
template <class T>
void write_as(void* value, double number) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<T>) number = std::nearbyint(number);
    *static_cast<T*>(value) = static_cast<T>(number);
}
template <class T>
constexpr Conversion conversion{&read_as<T>, &write_as<T>};

/// Returns the conversion of a type that the check accepts.
Conversion conversion_of(const TypeTag& type) noexcept {
    if (type.kind == ValueKind::real) return type.size == 8 ? conversion<double> : conversion<float>;
    const bool is_signed = type.kind == ValueKind::integer;
    if (type.size == 1) return is_signed ? conversion<std::int8_t> : conversion<std::uint8_t>;
    if (type.size == 2) return is_signed ? conversion<std::int16_t> : conversion<std::uint16_t>;
    return is_signed ? conversion<std::int32_t> : conversion<std::uint32_t>;
}

/// Returns the value that replaces NaN or infinity.
double without_number(const LimitRow& row, const Limited& port) noexcept TAPPET_REALTIME {
    if (port.has_last) return port.last;
    return row.is_rate ? 0.0 : std::clamp(0.0, row.low, row.high);
}

/// Returns the value nearest to `wanted` that a row allows: always a number.
double allowed(const LimitRow& row, const Limited& port, double wanted, Time stamp) noexcept TAPPET_REALTIME {
    if (!is_number(wanted)) return without_number(row, port);
    if (!row.is_rate) return wanted > row.high ? row.high : wanted < row.low ? row.low : wanted;
    if (!port.has_last) return wanted;
    const double step =
        row.per_second * static_cast<double>(std::max(stamp - port.at, Duration{}).count()) * 1e-9;
    if (std::abs(wanted - port.last) <= step) return wanted;
    return wanted > port.last ? port.last + step : port.last - step;
}

void pass(PortFilter& self, void* value, Time stamp) noexcept TAPPET_REALTIME {
    auto& port = static_cast<Limited&>(self);
    double number = port.convert.read(value);
    // The rows limit values in operation. The safe value of a stop passes, if it is a number.
    const ComponentState state = port.machine->life().state_of(port.component);
    const bool is_left = state != ComponentState::running && state != ComponentState::starting;
    if (is_left) port.has_last = false;
    if (is_left && is_number(number)) return;
    // The range first: the value that the rate then allows lies between two values of the range.
    std::array<std::size_t, 2> order{port.row, port.other};
    if (port.other != nowhere && port.rows[port.row].is_rate) std::swap(order[0], order[1]);
    bool changed = false;
    for (const std::size_t i : order) {
        if (i == nowhere) continue;
        const LimitRow& row = port.rows[i];
        const double good = allowed(row, port, number, stamp);
        if (good == number) continue;
        port.count_of(i).fetch_add(1, std::memory_order_relaxed);
        if (row.on_breach == OnBreach::stop) port.machine->ask_section_stop(port.section, i, port.engine);
        if (row.on_breach == OnBreach::count && is_number(number)) continue;
        number = good;
        changed = true;
    }
    port.last = number;
    port.at = stamp;
    port.has_last = is_number(number) && !is_left;
    if (changed) port.convert.write(value, number);
}

} // namespace

void connect(std::span<const LimitRow> rows, MachineInstance& machine, std::size_t section,
             std::span<std::byte> memory) {
    const AcceptedMachine& accepted = machine.machine();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        auto* places = reinterpret_cast<Limited*>(memory.data());
        auto* port = new (places + i) Limited{};
        port->row = i;
        port->rows = rows;
        std::size_t first = 0;
        while (!same_text(rows[first].output, rows[i].output)) ++first;
        if (first != i) { // one filter for both rows of a port
            places[first].other = i;
            continue;
        }
        End end;
        static_cast<void>(
            resolve(accepted.table, rows[i].output, FacetKind::output, end).empty()); // was checked
        const Facet& facet = facet_at(accepted.table, end);
        port->pass = &pass;
        port->machine = &machine;
        port->section = section;
        port->engine = &machine.engines()[accepted.index.activity[end.component]];
        port->component = end.component;
        port->convert = conversion_of(*facet.type);
        facet.port->set_filter(machine.place_of(end), port);
    }
}

Sentence describe(const LimitRow& row) {
    if (row.is_rate)
        return Sentence{"\"", row.output, "\" would have changed by more than ", decimal(row.per_second),
                        " per second"};
    return Sentence{"\"",   row.output,       "\" would have left its range from ", decimal(row.low),
                    " to ", decimal(row.high)};
}

SectionCount counted(std::span<const LimitRow> rows, std::span<const std::byte> memory,
                     std::size_t row) noexcept {
    if (row >= rows.size()) return {};
    const auto* ports = reinterpret_cast<const Limited*>(memory.data());
    return {rows[row].output, ports[row].breaches.load(std::memory_order_relaxed)};
}

} // namespace limits_detail

} // namespace tappet
