// The other end of a Modbus client: the server in a machine's register map.
#pragma once

#include "drivers/modbus/register_map.hpp"
#include "drivers/twin/far_end.hpp"
#include "kernel/base/array_of.hpp"

#include <array>
#include <atomic>
#include <mutex>

namespace tappet::modbus {

/// The tables of a server, seen from inside. A client's requests may come from another thread. Not real-time.
class ServerTables {
public:
    static constexpr std::size_t size = 1024; ///< each table has addresses 0..1023
    /// Returns whether the server accepts a value that a client writes.
    using Accepts = bool (*)(Table table, std::size_t address, std::uint16_t value) noexcept;

    ServerTables() = default;
    ServerTables(const ServerTables&) = delete;
    ServerTables& operator=(const ServerTables&) = delete;

    /// Locks the tables for a request, or for a plant's value of two words, so that nobody sees half of it.
    [[nodiscard]] std::unique_lock<std::mutex> whole() const { return std::unique_lock{requests_}; }
    /// Sets a value; addresses are below `size`.
    void set(Table table, std::size_t address, std::uint16_t value) noexcept {
        words_[static_cast<std::size_t>(table)][address].store(value, std::memory_order_relaxed);
        changes_.fetch_add(1, std::memory_order_release);
    }
    /// Returns a counter that rises with each value set, by either side.
    [[nodiscard]] std::uint32_t changes() const noexcept { return changes_.load(std::memory_order_acquire); }
    [[nodiscard]] std::uint16_t get(Table table, std::size_t address) const noexcept {
        return words_[static_cast<std::size_t>(table)][address].load(std::memory_order_relaxed);
    }
    /// States that a table has at least this many addresses; a map states its own. Before the first request.
    void have(Table table, std::size_t count) noexcept {
        std::size_t& of = counts_[static_cast<std::size_t>(table)];
        of = count > of ? count : of;
    }
    [[nodiscard]] std::size_t count(Table table) const noexcept {
        return counts_[static_cast<std::size_t>(table)];
    }
    /// Lets the server answer other values with the exception "illegal data value". Before the first request.
    void accept_only(Accepts check) noexcept { accepts_ = check; }
    [[nodiscard]] bool accepts(Table table, std::size_t address, std::uint16_t value) const noexcept {
        return accepts_ == nullptr || accepts_(table, address, value);
    }

private:
    std::array<std::array<std::atomic<std::uint16_t>, size>, 4> words_{};
    std::array<std::size_t, 4> counts_{};
    std::atomic<std::uint32_t> changes_{0};
    Accepts accepts_ = nullptr;
    mutable std::mutex requests_{};
};

/// Access by the names of the map, which the compiler checks:
///     server.get("pump.on")               the last value the machine wrote
///     server.set("unit.oil_pressure", 2.5)
template <const auto& map>
class FarEnd final : public FarEndOf<ServerTables> {
    TAPPET_ACCEPTED(map.fault);
    static constexpr Sentence out_of_reach = [] {
        for (const Row& row : map.rows)
            if (row.run.address + row.run.count > ServerTables::size)
                return Sentence("row \"", row.name, "\" ends at address ",
                                row.run.address + row.run.count - 1, ": a simulated server ends at ",
                                ServerTables::size - 1,
                                "; raise ServerTables::size in drivers/modbus/far_end.hpp");
        return Sentence{};
    }();
    TAPPET_ACCEPTED(out_of_reach);

    template <bool write>
    static constexpr auto names = array_of<map.registers.size()>(
        [](std::size_t v) { return map.rows[map.row_of[v]].write == write ? map.name_of(v) : MapName{}; });

public:
    using Read = FarEndName<names<false>>; ///< by the machine
    using Written = FarEndName<names<true>>;

    FarEnd(FarEnds& of, std::string_view device) : FarEndOf{of, device, "modbus"} {}

    [[nodiscard]] double get(Written path) const noexcept {
        const Place place{path.index};
        const auto whole = wire_->whole();
        Words words{wire_->get(place.table, place.address), 0};
        if (place.of.width() == 2) words[1] = wire_->get(place.table, place.address + 1);
        return to_physical(place.of, words);
    }
    void set(Read path, double value) noexcept {
        const Place place{path.index};
        const Encoded encoded = to_words(place.of, value);
        if (encoded.refused) return; // not a number: the previous value stays
        const auto whole = wire_->whole();
        for (std::size_t i = 0; i < place.of.width(); ++i)
            wire_->set(place.table, place.address + i, encoded.words[i]);
    }
    [[nodiscard]] ServerTables& tables() noexcept { return *wire_; }

protected:
    bool take_wire(const ProvidedDevice& provided) noexcept override {
        if (!FarEndOf::take_wire(provided)) return false;
        for (const Row& row : map.rows) wire_->have(row.run.table, row.run.address + row.run.count);
        return true;
    }

private:
    struct Place {
        const Register& of;
        Table table;
        std::size_t address;
        explicit Place(std::size_t v)
            : of{map.registers[v]},
              table{map.rows[map.row_of[v]].run.table},
              address{map.rows[map.row_of[v]].run.address + map.registers[v].at} {}
    };
};

} // namespace tappet::modbus
