// The start-up steps of a node from a network's table: reads its identity, writes its values and PDOs in the
// order of CiA 301, and reads them back.
#pragma once

#include "drivers/canopen/network_check.hpp"

namespace tappet::canopen::detail {

/// Collects the steps of one node.
template <std::size_t M> class StepWriter {
public:
    constexpr StepWriter(Bounded<ConfigurationStep, M>& steps, const NodeRow& node) noexcept
        : steps_{steps}, node_{node}, first_{steps.size()} {}

    constexpr void identity(Address at, std::uint64_t value) noexcept {
        if (value != 0 && node_.dictionary.find(at) != nullptr)
            push(ConfigurationStep::Kind::identity, at, value, 4);
    }
    /// Writes an object; skips one that the dictionary lacks or that is not writable.
    constexpr void write(Address at, std::uint64_t value) noexcept {
        const Object* const object = node_.dictionary.find(at);
        if (object != nullptr && writable(object->access))
            push(ConfigurationStep::Kind::write, at, value, bytes_of(object->type));
    }
    /// Checks the last value written to an object, or the value required of a read-only one.
    constexpr void confirm(Address at, std::uint64_t value) noexcept {
        const Object* const object = node_.dictionary.find(at);
        if (object != nullptr && readable(object->access))
            push(ConfigurationStep::Kind::confirm, at, value, bytes_of(object->type));
    }
    constexpr void confirm_values() noexcept {
        const std::size_t end = steps_.size();
        for (std::size_t i = first_; i < end; ++i) {
            const ConfigurationStep step = steps_[i];
            if (step.kind != ConfigurationStep::Kind::write || is_pdo(step.at.index)) continue;
            confirm(step.at, step.value);
        }
    }
    [[nodiscard]] constexpr bool has_room() const noexcept { return has_room_; }

private:
    static constexpr bool is_pdo(std::uint16_t index) noexcept { return index >= 0x1400 && index < 0x1C00; }
    constexpr void push(ConfigurationStep::Kind kind, Address at, std::uint64_t value,
                        unsigned bytes) noexcept {
        has_room_ &= steps_.push({kind, static_cast<std::uint8_t>(bytes), at, value});
    }

    Bounded<ConfigurationStep, M>& steps_;
    const NodeRow& node_;
    std::size_t first_;
    bool has_room_ = true;
};

/// Returns a PDO's COB-ID as in 1400h:1 and 1800h:1, with the device's own bit 30.
constexpr std::uint32_t cob_entry(const NodeRow& node, const PdoPlace& place,
                                  std::uint32_t identifier) noexcept {
    constexpr std::uint64_t no_remote_frames = 0x4000'0000;
    const Object* const own = node.dictionary.find({place.communication(), 1});
    return static_cast<std::uint32_t>(identifier | (own->value.of(node.id) & no_remote_frames));
}

/// Writes a PDO: disables it, clears its objects, fills it, sets their number, enables it.
template <std::size_t M>
constexpr void write_pdo(StepWriter<M>& to, const NodeRow& node, const PdoRow& row, const PdoPlace& place,
                         std::uint32_t identifier) noexcept {
    const std::uint16_t communication = place.communication(), mapping = place.mapping();
    const std::uint32_t entry = cob_entry(node, place, identifier);
    to.write({communication, 1}, pdo_invalid | entry);
    to.write({communication, 2}, row.how.type);
    to.write({communication, 3}, static_cast<std::uint64_t>(row.how.inhibit_time / 100us));
    to.write({communication, 5}, static_cast<std::uint64_t>(row.how.event_timer / 1ms));
    to.write({mapping, 0}, 0);
    const auto entry_of = [&](std::size_t i) {
        const Address at = row.objects[i];
        return std::uint64_t{at.index} << 16 | std::uint64_t{at.sub} << 8 |
               bits_of(node.dictionary.find(at)->type);
    };
    for (std::size_t i = 0; i < row.objects.size(); ++i)
        to.write({mapping, static_cast<std::uint8_t>(i + 1)}, entry_of(i));
    to.write({mapping, 0}, row.objects.size());
    to.write({communication, 1}, entry);

    to.confirm({communication, 1}, entry);
    to.confirm({communication, 2}, row.how.type);
    to.confirm({mapping, 0}, row.objects.size());
    for (std::size_t i = 0; i < row.objects.size(); ++i)
        to.confirm({mapping, static_cast<std::uint8_t>(i + 1)}, entry_of(i));
}

/// Disables the PDOs that no row uses: the first four of each way, which are enabled unless the file says
/// otherwise (CiA 301), and each further one that the file enables.
template <std::size_t M>
constexpr void silence_other_pdos(StepWriter<M>& to, const NodeRow& node,
                                  std::span<const bool> used) noexcept {
    const auto silence = [&](const Object& own) {
        const std::uint64_t entry = own.value.of(node.id);
        if ((entry & pdo_invalid) == 0) to.write(own.at, pdo_invalid | entry);
    };
    for (std::uint8_t number = 0; number < predefined_pdos; ++number)
        for (const bool sent : {true, false}) {
            const PdoPlace place{true, sent, number};
            const Object* const own = node.dictionary.find({place.communication(), 1});
            if (own == nullptr || used[2u * number + (sent ? 1u : 0u)]) continue;
            silence(*own);
        }
    for (const Object& own : node.dictionary.objects) {
        const bool is_sent = own.at.index >= 0x1800;
        const unsigned number = own.at.index - (is_sent ? 0x1800u : 0x1400u); // wraps below 1400h
        if (own.at.sub == 1 && number >= predefined_pdos && number < 0x200 && own.value.given) silence(own);
    }
}

template <std::size_t F, std::size_t S, std::size_t N>
constexpr void add_steps(const can::SignalMap<F, S>& signals, NetworkMap<N>& map) noexcept {
    for (std::size_t n = 0; n < N; ++n) {
        const NodeRow& node = map.nodes[n];
        map.first_step[n] = map.steps.size();
        StepWriter to{map.steps, node};
        const Identity& wanted = node.dictionary.identity;
        to.identity(0x1000, wanted.device_type);
        to.identity({0x1018, 1}, wanted.vendor);
        to.identity({0x1018, 2}, wanted.product);
        if (!node.any_revision) to.identity({0x1018, 3}, wanted.revision);

        for (const Object& object : node.dictionary.objects)
            if (object.is_parameter && bits_of(object.type) != 0 && !is_configured_by_rows(object.at.index) &&
                std::ranges::none_of(node.parameters, [&](const auto& row) { return row.at == object.at; }))
                to.write(object.at, object.value.of(node.id));
        for (const ParameterRow& row : node.parameters)
            to.write(row.at, low_bits(static_cast<std::uint64_t>(row.value),
                                      bits_of(node.dictionary.find(row.at)->type)));
        if (map.manager.sync_every != Duration{}) to.write(0x1019, map.manager.sync_overflow);
        if (map.manager.beats != Duration{}) {
            const auto wait = static_cast<std::uint64_t>(map.manager.beats * 7 / 2 / 1ms);
            to.write({0x1016, 1}, std::uint64_t{map.manager.id} << 16 | wait);
        }
        to.write(0x1017, static_cast<std::uint64_t>(node.beats / 1ms));
        to.confirm_values();
        std::array<bool, 2 * predefined_pdos> used{};
        for (const PdoRow& row : node.pdos) {
            const can::Identifier identifier = signals.frames[signals.frame(row.frame)].identifier;
            const PdoPlace place = pdo_place(identifier, node.id);
            used[2u * place.number + (place.sent_by_node ? 1u : 0u)] = true;
            write_pdo(to, node, row, place, identifier.id);
        }
        silence_other_pdos(to, node, used);
        if (!to.has_room())
            map.fault = Sentence{who(node), " takes the network beyond ", NetworkMap<N>::most_steps,
                                 " transfers at its start; keep values in the devices"};
    }
    map.first_step[N] = map.steps.size();
}

} // namespace tappet::canopen::detail
