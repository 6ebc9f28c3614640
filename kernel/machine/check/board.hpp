// Checks of a machine against a board and its binding: every device and line that a driver names is bound to
// one that the board has, and every row of the binding is used.
#pragma once

#include "kernel/base/address.hpp"
#include "kernel/machine/check/components.hpp"
#include "kernel/machine/table/binding.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::checks {

template <class Rows>
constexpr const auto* find_named(const Rows& rows, std::string_view name) noexcept {
    for (const auto& row : rows)
        if (row.name == name) return &row;
    return decltype(&*rows.begin()){nullptr};
}

template <class... Words>
constexpr Sentence of_binding(const Board& board, std::string_view device, const Words&... words) {
    return Sentence{"binding to board \"", board.name, "\", wired(\"", device, "\"): ", words...};
}

/// Checks that each word fits the kind of device and is stated once. No word is ignored.
constexpr Sentence check_words(std::span<const Fact> facts, std::string_view kind) {
    for (std::size_t i = 0; i < facts.size(); ++i) {
        const Word& word = *facts[i].word;
        Sentence said{word.name, "("};
        if (word.is_of_parts)
            said.add("\"").add(facts[i].part).add("\"");
        else
            said.add("...");
        said.add(")");
        if (word.kind != kind)
            return Sentence{said, " is for a ",        word.kind, " device, and this is a ",
                            kind, " device; remove it"};
        for (std::size_t j = 0; j < i && !word.is_of_parts; ++j)
            if (facts[j].word == &word) return Sentence{said, " appears twice; remove one"};
    }
    return {};
}

constexpr Sentence check_bound_device(const ComponentRow& row, const Board& board, const BoundDevice& bound,
                                      std::span<const Fact> facts) {
    const DeviceKind& kind = *row.type->device_kind;
    const BoardDevice* device = find_named(board.devices, bound.at);
    DeviceAsked asked{.bound = facts};
    if (device != nullptr) {
        if (device->kind != kind.on_board())
            return of_binding(board, bound.name, "it drives a ", kind.name, " device but \"", device->name,
                              "\" is of kind ", device->kind, "; name another");
        asked.device = device->name;
        asked.of_board = device->facts;
    } else if (!kind.takes_address || port_of(bound.at) == 0) {
        Nearest nearest{bound.at};
        for (const auto& each : board.devices)
            if (each.kind == kind.on_board()) nearest.consider(each.name);
        Sentence text = of_binding(board, bound.name, "the board has no device \"", bound.at, "\"");
        detail::add_suggestion(text, nearest, kind.cure);
        return text;
    }
    asked.parts = row.type->device_lines;
    Sentence fault = check_words(facts, kind.name);
    // A component that shares the device leaves this check to the row that drives it.
    if (fault.empty() && kind.check != nullptr && !row.type->shares_device) fault = kind.check(asked);
    return fault.empty() ? fault : of_binding(board, bound.name, fault);
}

constexpr Sentence check_proof(const MachineView& m, const Board& board, const Proof& proof) {
    if (proof.output.empty()) return {};
    const auto fault = [&](const auto&... words) {
        return Sentence{"binding to board \"", board.name, "\", proven_by(\"",
                        proof.output,          "\"): ",    words...};
    };
    End found{};
    if (const Sentence wrong = resolve(m, proof.output, FacetKind::output, found); !wrong.empty())
        return fault(wrong);
    const Facet& facet = facet_at(m, found);
    if (facet.kind != FacetKind::output || facet.type != type_id<std::int64_t>)
        return fault("it is not an integer output; name one that counts what the machine makes");
    if (proof.count <= 0) return fault("its count is not above 0; write a count above 0");
    return {};
}

/// Checks each row by itself: the board has its device, and the device is of its kind.
constexpr Sentence check_each_device(const MachineView& m, const Board& board, const Binding& binding) {
    for (std::size_t c = 0; c < m.components.size(); ++c) {
        const ComponentRow& row = m.components[c];
        if (row.type->device_kind == nullptr) continue;
        for (std::size_t j = 0; j < c; ++j)
            if (m.components[j].device == row.device && !row.type->shares_device &&
                !m.components[j].type->shares_device)
                return of_component(row.name, " drives device \"", row.device, "\", as component \"",
                                    m.components[j].name, "\" does; a device has one driver");
        if (row.type->shares_device) {
            bool opened = false;
            for (const auto& other : m.components)
                opened |= other.device == row.device && !other.type->shares_device;
            if (!opened)
                return of_component(row.name, " shares device \"", row.device,
                                    "\", which no component drives; correct the name");
        }
        if (board.simulated) continue;
        const BoundDevice* bound = find_named(binding.devices, row.device);
        if (bound == nullptr) {
            Nearest nearest{row.device};
            for (const auto& each : binding.devices) nearest.consider(each.name);
            Sentence text = of_component(row.name, ": the binding to board \"", board.name,
                                         "\" has no wired(...) for device \"", row.device, "\"");
            detail::add_suggestion(text, nearest, "add wired(\"...\", \"a device of the board\") to it");
            return text;
        }
        if (const Sentence fault = check_bound_device(row, board, *bound, binding.facts_of(*bound));
            !fault.empty())
            return of_component(row.name, ": ", fault);
    }
    return {};
}

/// Checks that each gateway is bounded: by a role that exists, and by one row.
constexpr Sentence check_gateways(const Board& board) {
    const auto& rows = board.browsing.roles;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].is_gateway) continue;
        const auto fault = [&](const auto&... words) {
            return Sentence{
                "board \"",          board.name, "\", gateway(", rows[i].peer.is_group ? "group(" : "user(",
                rows[i].peer.number, "), ..): ", words...};
        };
        if (rows[i].peer.number == 0)
            return fault(
                "root may do everything, whatever bounds it; run the gateway as a user of its own, and "
                "name that user");
        if (rows[i].role > Role::engineer)
            return fault(
                "up_to(..) states no role; write up_to(Role::observer), up_to(Role::machine_operator) or "
                "up_to(Role::engineer)");
        for (std::size_t j = 0; j < rows.size(); ++j)
            if (j != i && rows[j].peer == rows[i].peer)
                return fault(
                    "roles(..) has another row for it, and a gateway has one bound; remove one of them");
    }
    return {};
}

constexpr Sentence check_devices(const MachineView& m, const Board& board, const Binding& binding) {
    if (binding.too_many)
        return Sentence{"binding to board \"", board.name,
                        "\": it has more rows than a binding holds: 16 devices, 256 words of them, 64 "
                        "placements; raise the bound in "
                        "kernel/machine/table/binding.hpp"};
    for (const BoardDevice& device : board.devices)
        if (Sentence fault = check_words(device.facts, device.kind); !fault.empty())
            return Sentence{"board \"", board.name, "\", device \"", device.name, "\": ", fault};
    if (Sentence fault = check_gateways(board); !fault.empty()) return fault;
    if (Sentence fault = check_each_device(m, board, binding); !fault.empty()) return fault;
    const auto address_of = [&board](const BoundDevice& bound) {
        const BoardDevice* device = find_named(board.devices, bound.at);
        return device != nullptr && !device->address.empty() ? device->address : bound.at;
    };
    for (std::size_t i = 0; i < binding.devices.size(); ++i) {
        const BoundDevice& bound = binding.devices[i];
        for (std::size_t j = 0; j < i; ++j)
            if (bound.name == binding.devices[j].name || address_of(bound) == address_of(binding.devices[j]))
                return of_binding(board, bound.name, "wired(\"", binding.devices[j].name,
                                  "\") has the same name or the same device of the board; correct one");
        bool driven = false;
        for (const auto& row : m.components) driven |= row.device == bound.name;
        if (!driven)
            return of_binding(board, bound.name,
                              "no component of the machine drives it; correct the name or remove the row");
    }
    return check_proof(m, board, binding.proof);
}

} // namespace tappet::checks
