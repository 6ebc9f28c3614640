// The rows of a CANopen network's table, as the user writes them; network.hpp combines them.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/canopen/object_dictionary.hpp"
#include "drivers/canopen/protocol.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/copy_with.hpp"

#include <initializer_list>

namespace tappet::canopen {

/// When a PDO is sent, or takes effect (CiA 301, 7.5.2.36).
struct Transmission {
    std::uint8_t type = 255;
    Duration event_timer{}; ///< 0: none
    Duration inhibit_time{};
};
/// At the device's own events, and by a timer; no more often than the inhibit time allows.
constexpr Transmission on_event(Duration timer = {}, Duration inhibit_time = {}) noexcept {
    return {255, timer, inhibit_time};
}
/// At each n-th SYNC, n = 1..240; 0: at the next SYNC after a change.
constexpr Transmission synchronous(std::uint8_t every = 1) noexcept { return {every, {}, {}}; }

struct PdoRow {
    std::string_view frame{};
    Transmission how{};
    Bounded<Address, 8> objects{};
};
struct ParameterRow {
    Address at{};
    std::int64_t value = 0;
};

struct NodeRow {
    static constexpr std::size_t most_pdos = 2 * predefined_pdos;
    static constexpr std::size_t most_parameters = 24;

    std::uint8_t id = 0;
    std::string_view name{};
    Dictionary dictionary{};
    Duration beats{};
    Duration lost_after{};
    Duration answers_within = 100ms; ///< time-out of each request of an SDO transfer
    bool any_revision = false;
    bool states_identity = false; ///< instead of its file
    Bounded<PdoRow, most_pdos> pdos{};
    Bounded<ParameterRow, most_parameters> parameters{};
    bool too_many = false;

    /// Sets the heartbeat period. Without a heartbeat for `lost` (default 3.5 periods) the node is lost.
    constexpr NodeRow heartbeat(Duration every, Duration lost = {}) const noexcept {
        return copy_with(*this, &NodeRow::beats, every, &NodeRow::lost_after,
                         lost != Duration{} ? lost : every * 7 / 2);
    }
    /// Maps these objects, in this order, to the frame of the signal map.
    constexpr NodeRow pdo(std::string_view frame, Transmission how,
                          std::initializer_list<Address> objects) const noexcept {
        NodeRow copy = *this;
        PdoRow row{frame, how, {}};
        for (const Address& each : objects) copy.too_many |= !row.objects.push(each);
        copy.too_many |= !copy.pdos.push(row);
        return copy;
    }
    constexpr NodeRow pdo(std::string_view frame, std::initializer_list<Address> objects) const noexcept {
        return pdo(frame, on_event(), objects);
    }
    /// Writes the value before the network is started.
    constexpr NodeRow write(Address at, std::int64_t value) const noexcept {
        NodeRow copy = *this;
        copy.too_many |= !copy.parameters.push({at, value});
        return copy;
    }
    /// States the numbers of object 1018h, in place of the file's; 0: any.
    constexpr NodeRow identity(std::uint32_t vendor, std::uint32_t product,
                               std::uint32_t revision = 0) const noexcept {
        NodeRow copy = *this;
        copy.dictionary.identity = {dictionary.identity.device_type, vendor, product, revision};
        copy.dictionary.doubted = 0;
        copy.states_identity = true;
        return copy;
    }
    /// Accepts a node of another revision, too.
    constexpr NodeRow of_any_revision() const noexcept {
        return copy_with(*this, &NodeRow::any_revision, true);
    }
    constexpr NodeRow answers(Duration within) const noexcept {
        return copy_with(*this, &NodeRow::answers_within, within);
    }
};
constexpr NodeRow node(std::uint8_t id, std::string_view name, const Dictionary& dictionary) noexcept {
    NodeRow row;
    row.id = id;
    row.name = name;
    row.dictionary = dictionary;
    return row;
}

/// The machine's own part in the network.
struct ManagerRow {
    std::uint8_t id = 127;
    Duration beats{};               ///< 0: produces no heartbeat
    Duration sync_every{};          ///< 0: no SYNC
    std::uint8_t sync_overflow = 0; ///< 1019h: the counter runs from 1 to this; 0: no counter
    Duration time_every{};          ///< 0: no TIME

    constexpr ManagerRow heartbeat(Duration every) const noexcept {
        return copy_with(*this, &ManagerRow::beats, every);
    }
    constexpr ManagerRow sync(Duration every, std::uint8_t counts_to = 0) const noexcept {
        return copy_with(*this, &ManagerRow::sync_every, every, &ManagerRow::sync_overflow, counts_to);
    }
    constexpr ManagerRow time(Duration every) const noexcept {
        return copy_with(*this, &ManagerRow::time_every, every);
    }
};
constexpr ManagerRow manager(std::uint8_t id) noexcept { return {.id = id}; }

/// One transfer during a node's start-up.
struct ConfigurationStep {
    enum class Kind : std::uint8_t {
        identity, ///< must read this value; otherwise it is another device
        write,
        confirm, ///< the written object must read this value
    };
    Kind kind = Kind::write;
    std::uint8_t bytes = 0;
    Address at{};
    std::uint64_t value = 0;
    bool operator==(const ConfigurationStep&) const = default;
};

/// The rows of a network, checked and processed.
template <std::size_t N> struct NetworkMap {
    static constexpr std::size_t most_steps = 96 * N;

    ManagerRow manager{};
    std::array<NodeRow, N> nodes{};
    Bounded<ConfigurationStep, most_steps> steps{};
    std::array<std::size_t, N + 1> first_step{}; ///< first step of each node; the last entry is the end
    Sentence fault{};                            ///< empty when the table is correct
};

} // namespace tappet::canopen
