// Checks a network's table at compile time: contradictions in itself, with the signal map and with the
// devices' dictionaries.
#pragma once

#include "drivers/canopen/eds_notes.hpp"
#include "drivers/canopen/network_rows.hpp"

#include <algorithm>

namespace tappet::canopen::detail {

/// The predefined PDO of a node that a frame is.
struct PdoPlace {
    bool known = false;
    bool sent_by_node = false; ///< a TPDO
    std::uint8_t number = 0;   ///< from 0
    [[nodiscard]] constexpr std::uint16_t communication() const noexcept {
        return static_cast<std::uint16_t>((sent_by_node ? 0x1800 : 0x1400) + number);
    }
    [[nodiscard]] constexpr std::uint16_t mapping() const noexcept {
        return static_cast<std::uint16_t>(communication() + 0x200);
    }
};
constexpr PdoPlace pdo_place(can::Identifier identifier, std::uint8_t node) noexcept {
    for (std::uint8_t number = 0; number < predefined_pdos && !identifier.extended; ++number)
        for (const bool sent : {true, false})
            if (identifier.id == (sent ? cob::tpdo : cob::rpdo) + 0x100u * number + node)
                return {true, sent, number};
    return {};
}

constexpr Sentence who(const NodeRow& node) noexcept {
    return Sentence{"node ", unsigned{node.id}, " \"", node.name, "\""};
}

constexpr bool is_configured_by_rows(std::uint16_t index) noexcept {
    return (index >= 0x1000 && index <= 0x1019 && index != 0x1012) || (index >= 0x1400 && index < 0x1C00);
}

/// Collects the faults of a file in the objects that a node's rows need, for one sentence. The objects' flaws
/// and the doubted identity decide; the notes only say it.
class FlawsTold {
public:
    constexpr explicit FlawsTold(const NodeRow& node) noexcept : node_{node} {}

    constexpr void need_identity() noexcept {
        for (std::uint8_t sub = 1; sub <= 3; ++sub) {
            if ((node_.dictionary.doubted >> sub & 1) == 0 || (node_.any_revision && sub == 3) || !begin())
                continue;
            const Address at{0x1018, sub};
            const FileNote* const note = note_of(at, FileNote::Kind::identity_twice);
            tell(note != nullptr ? note->line : node_.dictionary.find(at)->line,
                 note != nullptr ? meaning(*note) : Sentence{to_text(at), " is not what [DeviceInfo] says"});
            told_.add("; state the device's: .identity(vendor, product, revision)");
        }
    }
    constexpr void need(Address at, std::uint8_t parts) noexcept {
        const Object* const object = node_.dictionary.find(at);
        if (object == nullptr || (object->flaws & parts) == 0) return;
        if (!begin()) return;
        const FileNote* const note = note_of(*object, static_cast<std::uint8_t>(object->flaws & parts));
        tell(note != nullptr ? note->line : object->line,
             note != nullptr ? meaning(*note) : Sentence{to_text(at), " has a fault"});
        add_cure(*object, parts);
    }
    [[nodiscard]] constexpr Sentence told() const noexcept {
        Sentence all = told_;
        if (more_ != 0) all.add("; and ").add(more_).add(" more of its faults");
        return all;
    }

private:
    /// False: there is no room for another fault.
    constexpr bool begin() noexcept {
        const bool has_room = told_.size() <= 210; // for one of the longest
        if (has_room)
            told_.add(told_.empty() ? who(node_).add(": ") : Sentence{"; "});
        else
            ++more_;
        return has_room;
    }
    constexpr void tell(std::uint32_t line, const Sentence& fault) noexcept {
        told_.add(node_.dictionary.file).add(":").add(line).add(": ").add(fault);
    }
    constexpr const FileNote* note_of(Address at, FileNote::Kind kind) const noexcept {
        for (const FileNote& each : node_.dictionary.notes)
            if (each.kind == kind && each.at == at) return &each;
        return nullptr;
    }
    constexpr const FileNote* note_of(const Object& object, std::uint8_t flaws) const noexcept {
        for (const bool exactly : {true, false}) // a compact array has one note for all
            for (const FileNote& each : node_.dictionary.notes)
                if ((each.flaws & flaws) != 0 &&
                    (exactly ? each.at == object.at : each.at.index == object.at.index))
                    return &each;
        return nullptr;
    }
    constexpr void add_cure(const Object& object, std::uint8_t parts) noexcept {
        const Sentence index = hex(object.at.index, 4);
        Sentence at{"0x", index.view().substr(0, 4)};
        if (object.at.sub != 0) at = Sentence{"{", at, ", ", unsigned{object.at.sub}, "}"};
        if ((parts & object.flaws) == flaw::value) {
            told_.add("; write the value meant: .write(").add(at).add(", ..)");
            return;
        }
        const std::string_view type = name_of(object.type);
        told_.add("; believe the device: canopen::dictionary<.., canopen::despite(")
            .add(at)
            .add(", canopen::DataType::");
        told_.add((object.flaws & flaw::type) != 0 || type.empty() ? std::string_view{".."} : type).add(")>");
    }

    const NodeRow& node_;
    Sentence told_{};
    std::size_t more_ = 0;
};

/// Checks that the file has no fault in what the node's rows and its start-up need.
constexpr Sentence flaw_fault(const NodeRow& node, bool counts_sync, bool beats) noexcept {
    FlawsTold flaws{node};
    flaws.need_identity();
    flaws.need(0x1017, flaw::type);
    if (beats) flaws.need({0x1016, 1}, flaw::type);
    if (counts_sync) flaws.need(0x1019, flaw::type);
    for (const PdoRow& row : node.pdos)
        for (const Address& at : row.objects) flaws.need(at, flaw::type);
    for (const ParameterRow& row : node.parameters) flaws.need(row.at, flaw::type | flaw::limits);
    for (const Object& object : node.dictionary.objects) {
        if (object.at.index >= 0x1400 && object.at.index < 0x1C00) flaws.need(object.at, flaw::type);
        if (object.is_parameter && !is_configured_by_rows(object.at.index) &&
            std::ranges::find(node.parameters, object.at, &ParameterRow::at) == node.parameters.end())
            flaws.need(object.at, flaw::type | flaw::value);
    }
    return flaws.told();
}

/// Checks an object in a PDO against the dictionary.
constexpr Sentence mapping_fault(const NodeRow& node, const PdoRow& row, const PdoPlace& place,
                                 Address at) noexcept {
    const Object* const object = node.dictionary.find(at);
    const Sentence subject{who(node), ": frame \"", row.frame, "\" holds object ", to_text(at)};
    if (object == nullptr)
        return Sentence{subject, ", which ", node.dictionary.file, " does not have; correct one of them"};
    if (!object->mappable || bits_of(object->type) == 0)
        return Sentence(subject, ", which may not be mapped into a PDO (", node.dictionary.file, ":",
                        object->line, "); take another one");
    const bool wrong_way = place.sent_by_node
                               ? !readable(object->access) || object->access == Access::read_write_write
                               : !writable(object->access) || object->access == Access::read_write_read;
    if (wrong_way)
        return Sentence(subject, ", which the device ", place.sent_by_node ? "only receives" : "only sends",
                        " (", node.dictionary.file, ":", object->line, "); map it in the other direction");
    return {};
}

/// Checks the signals of a frame against the objects in it.
template <std::size_t F, std::size_t S>
constexpr Sentence signals_fault(const can::SignalMap<F, S>& signals, const NodeRow& node, const PdoRow& row,
                                 const can::FrameRow& frame) noexcept {
    for (std::size_t s = frame.first; s < frame.end(); ++s) {
        const can::Signal& signal = signals.signals[s];
        const Sentence subject{who(node), ": signal \"", frame.name, ".", signal.name, "\""};
        if (signal.order == can::Order::motorola && signal.bits > 8)
            return Sentence{subject,
                            " is big-endian, and CANopen has no such values; take big_endian() away"};
        unsigned begin = 0;
        for (const Address& at : row.objects) {
            const Object& object = *node.dictionary.find(at);
            const unsigned end = begin + bits_of(object.type);
            const unsigned low = can::bit_place(signal, 0), high = can::bit_place(signal, signal.bits - 1u);
            const bool starts_inside = low >= begin && low < end;
            if (starts_inside && high >= end)
                return Sentence(subject, " reaches from bit ", low, " to ", high, ", but object ",
                                to_text(at), " \"", object.name, "\" from ", begin, " to ", end - 1,
                                "; move it or shorten it");
            const bool whole = low == begin && high + 1 == end;
            const bool real = signal.kind == can::Kind::float32 || signal.kind == can::Kind::float64;
            const bool with_sign = signal.kind == can::Kind::signed_integer;
            if (whole && (real != is_real(object.type) || (!real && with_sign != is_signed(object.type))))
                return Sentence(subject, " is ",
                                real        ? "a real"
                                : with_sign ? "signed"
                                            : "unsigned",
                                ", but object ", to_text(at), " \"", object.name, "\" is ",
                                is_real(object.type)     ? "a real; write as_float()"
                                : is_signed(object.type) ? "signed; write as_signed()"
                                                         : "unsigned; take as_signed() or as_float() away");
            begin = end;
        }
    }
    return {};
}

constexpr Sentence times_fault(const Sentence& subject, const NodeRow& node, const PdoRow& row,
                               const PdoPlace& place) noexcept {
    const auto fits = [](Duration time, Duration unit) {
        return time % unit == Duration{} && time / unit <= 65535;
    };
    if (!fits(row.how.event_timer, 1ms) || !fits(row.how.inhibit_time, 100us))
        return Sentence{subject, " has an event timer that is not a multiple of 1 ms, or an inhibit time "
                                 "that is not one of 100 us, up to 65535; round it"};
    if (row.how.event_timer != Duration{} && node.dictionary.find({place.communication(), 5}) == nullptr)
        return Sentence(
            subject, " has an event timer, which the device does not have: ", node.dictionary.file,
            " has no ", to_text({place.communication(), 5}), "; let it be synchronous, or send by itself");
    if (row.how.inhibit_time != Duration{} && node.dictionary.find({place.communication(), 3}) == nullptr)
        return Sentence(subject,
                        " has an inhibit time, which the device does not have: ", node.dictionary.file,
                        " has no ", to_text({place.communication(), 3}), "; take it away");
    return {};
}

template <std::size_t F, std::size_t S>
constexpr Sentence pdo_fault(const can::SignalMap<F, S>& signals, const ManagerRow& manager,
                             const NodeRow& node, const PdoRow& row) noexcept {
    const Sentence subject{who(node), ": frame \"", row.frame, "\""};
    const std::size_t f = signals.frame(row.frame);
    if (f == no_such) return Sentence{subject, " is not in the signal map; write its row there"};
    const can::FrameRow& frame = signals.frames[f];
    const PdoPlace place = pdo_place(frame.identifier, node.id);
    if (!place.known)
        return Sentence(subject, " has the identifier ", hex(frame.identifier.id, 3),
                        ", which is not one of the node's PDOs; its first are ", hex(cob::tpdo + node.id, 3),
                        " (it sends) and ", hex(cob::rpdo + node.id, 3), " (it receives)");
    if (place.sent_by_node != (frame.direction == can::Direction::receive))
        return Sentence{subject, " is one that the node ", place.sent_by_node ? "sends" : "receives",
                        ", by its identifier; exchange can::receive and can::transmit"};
    if (node.dictionary.find({place.communication(), 1}) == nullptr ||
        node.dictionary.find({place.mapping(), 0}) == nullptr)
        return Sentence(
            subject, " is a PDO that the device does not have: ", node.dictionary.file, " has no ",
            hex(place.communication(), 4), " or no ", hex(place.mapping(), 4), "; take another identifier",
            std::ranges::find(node.dictionary.notes, FileNote::Kind::compact_pdo, &FileNote::kind) ==
                    node.dictionary.notes.end()
                ? ""
                : ", or believe that CompactPDO stands for them: a canopen::despite(..) for each");
    if (frame.format != can::Format::classical)
        return Sentence{subject, " is CAN FD, and CANopen has classical frames; write bytes(8) or less"};
    unsigned bits = 0;
    for (const Address& at : row.objects) {
        if (const Sentence fault = mapping_fault(node, row, place, at); !fault.empty()) return fault;
        bits += bits_of(node.dictionary.find(at)->type);
    }
    if (bits != 8u * frame.length)
        return Sentence(subject, " has ", unsigned{frame.length}, " bytes, but its objects take ", bits,
                        " bits; correct one of them");
    if (row.how.type > 240 && row.how.type < 252)
        return Sentence{subject, " is synchronous(", unsigned{row.how.type}, "); the standard ends at 240"};
    if (row.how.type <= 240 && manager.sync_every == Duration{})
        return Sentence{subject, " is synchronous, but nothing produces SYNC; write manager(..).sync(..)"};
    if (const Sentence fault = times_fault(subject, node, row, place); !fault.empty()) return fault;
    return signals_fault(signals, node, row, frame);
}

/// Checks that a drive's statusword and mode display are received together. The meaning of the word's bits
/// depends on the displayed mode (CiA 402): in two frames that do not both come at each SYNC, bits of the
/// previous mode would be taken for bits of the new one.
constexpr Sentence moment_fault(const NodeRow& node) noexcept {
    const auto has = [](const PdoRow& row, std::uint16_t index) {
        return std::ranges::find(row.objects, Address{index, 0}) != row.objects.end();
    };
    const auto row_with = [&](std::uint16_t index) {
        return std::ranges::find_if(node.pdos, [&](const PdoRow& row) { return has(row, index); });
    };
    const auto word = row_with(0x6041), mode = row_with(0x6061);
    if (word == node.pdos.end() || mode == node.pdos.end() || has(*mode, 0x6041)) return {};
    if (word->how.type == 1 && mode->how.type == 1) return {};
    return Sentence{who(node),   ": its status word (6041) comes with frame \"",
                    word->frame, "\" and the mode that it belongs to (6061) with frame \"",
                    mode->frame, "\", at other times; map both into one frame, or let both be synchronous()"};
}

constexpr Sentence parameter_fault(const NodeRow& node, const ParameterRow& row) noexcept {
    const Object* const object = node.dictionary.find(row.at);
    const Sentence subject{who(node), ": write(", to_text(row.at), ", ", row.value, ")"};
    if (is_configured_by_rows(row.at.index))
        return Sentence{subject, " is written by heartbeat(), pdo() and sync(); set it there"};
    if (object == nullptr)
        return Sentence{subject, ": ", node.dictionary.file, " has no such object; correct one of them"};
    if (!writable(object->access))
        return Sentence(subject, ": the object is only read (", node.dictionary.file, ":", object->line,
                        "); take it away");
    const unsigned wide = bits_of(object->type);
    const auto bits = static_cast<std::uint64_t>(row.value);
    const bool fits = wide >= 64 || (row.value >= 0 ? bits <= low_bits(~std::uint64_t{0}, wide)
                                                    : is_signed(object->type) && ~bits >> (wide - 1) == 0);
    if (wide == 0 || is_real(object->type) || !fits || !within_limits(*object, low_bits(bits, wide), node.id))
        return Sentence(subject, ": the value is outside of the range of the object (", node.dictionary.file,
                        ":", object->line, "); correct it");
    return {};
}

/// Checks that the numbers that a node's row states can be compared with the device's.
constexpr Sentence identity_fault(const NodeRow& node) noexcept {
    const Identity& wanted = node.dictionary.identity;
    const std::array numbers{wanted.vendor, wanted.product, node.any_revision ? 0 : wanted.revision};
    for (std::uint8_t sub = 1; sub <= numbers.size() && node.states_identity; ++sub)
        if (const Address at{0x1018, sub}; numbers[sub - 1u] != 0 && node.dictionary.find(at) == nullptr)
            return Sentence(who(node), " states an identity(..), but ", node.dictionary.file, " has no ",
                            to_text(at),
                            ", so that the device's number would not be compared; believe that "
                            "the device has it: canopen::dictionary<.., canopen::despite({0x1018, ",
                            unsigned{sub},
                            "}, canopen::DataType::unsigned32, canopen::Access::read_only)>, "
                            "or take identity(..) away");
    return {};
}

/// Object 1016h, in which a node stores 3.5 heartbeat periods of the manager, has 16 bits in ms.
inline constexpr std::int64_t most_beats_ms = 65535 * 2 / 7;

constexpr Sentence node_fault(const ManagerRow& manager, const NodeRow& node) noexcept {
    const Sentence subject = who(node);
    if (node.id == 0 || node.id > most_nodes)
        return Sentence{subject, " has no identifier from 1 to 127; give it one"};
    if (node.id == manager.id)
        return Sentence{subject, " has the identifier of the manager; give one of them another"};
    if (node.name.empty()) return Sentence{subject, " has no name; name it"};
    if (node.too_many)
        return Sentence(subject, " has more than ", NodeRow::most_pdos, " PDOs of 8 objects, or more than ",
                        NodeRow::most_parameters, " values to write; keep those in the device");
    if (node.dictionary.objects.empty())
        return Sentence{subject, " has no dictionary; name it: canopen::dictionary<files::..>"};
    if (node.dictionary.node != 0 && node.dictionary.node != node.id)
        return Sentence(subject, ": ", node.dictionary.file, " is the configuration of node ",
                        unsigned{node.dictionary.node}, "; take the one of this node");
    if (node.beats == Duration{})
        return Sentence{subject,
                        " has no heartbeat, so that its loss would not be detected; write .heartbeat(100ms)"};
    if (node.beats % 1ms != Duration{} || node.beats / 1ms > 65535 || node.beats < 1ms)
        return Sentence{subject, " has a heartbeat that is not a whole number of ms up to 65535; round it"};
    if (node.lost_after <= node.beats)
        return Sentence{
            subject,
            " would be lost before its next heartbeat comes; let heartbeat(every, lost) wait longer"};
    if (const Sentence fault = identity_fault(node); !fault.empty()) return fault;
    const Object* const beat = node.dictionary.find(0x1017);
    if (beat == nullptr || !writable(beat->access))
        return Sentence{subject, " produces no heartbeat: ", node.dictionary.file,
                        " has no object 1017h that is written; take a device that does"};
    return {};
}

template <std::size_t F, std::size_t S, std::size_t N>
constexpr Sentence network_fault(const can::SignalMap<F, S>& signals, const NetworkMap<N>& map) noexcept {
    const ManagerRow& manager = map.manager;
    if (manager.id == 0 || manager.id > most_nodes)
        return Sentence{"manager(", unsigned{manager.id}, "): its identifier is from 1 to 127; give it one"};
    if (manager.beats < Duration{} || manager.beats % 1ms != Duration{} ||
        manager.beats / 1ms > most_beats_ms)
        return Sentence{"manager: its heartbeat must be a whole number of ms up to ", most_beats_ms,
                        ", since its nodes wait for three and a half of them; shorten it"};
    if (manager.sync_overflow == 1 || manager.sync_overflow > 240)
        return Sentence{"manager: SYNC counts to ", unsigned{manager.sync_overflow},
                        "; the standard allows 2 to 240"};
    for (std::size_t n = 0; n < N; ++n) {
        const NodeRow& node = map.nodes[n];
        if (const Sentence fault =
                flaw_fault(node, manager.sync_every != Duration{}, manager.beats != Duration{});
            !fault.empty())
            return fault;
        if (const Sentence fault = node_fault(manager, node); !fault.empty()) return fault;
        for (std::size_t other = 0; other < n; ++other)
            if (map.nodes[other].id == node.id || map.nodes[other].name == node.name)
                return Sentence{who(node), " has the identifier or the name of ", who(map.nodes[other]),
                                "; give it its own"};
        if (const Sentence fault = moment_fault(node); !fault.empty()) return fault;
        for (std::size_t p = 0; p < node.pdos.size(); ++p) {
            if (const Sentence fault = pdo_fault(signals, manager, node, node.pdos[p]); !fault.empty())
                return fault;
            for (std::size_t other = 0; other < p; ++other)
                if (node.pdos[other].frame == node.pdos[p].frame)
                    return Sentence{who(node), ": frame \"", node.pdos[p].frame,
                                    "\" is mapped twice; keep one row"};
        }
        for (const ParameterRow& row : node.parameters) {
            if (const Sentence fault = parameter_fault(node, row); !fault.empty()) return fault;
            std::size_t times = 0;
            for (const ParameterRow& other : node.parameters) times += other.at == row.at ? 1u : 0u;
            if (times > 1) return Sentence{who(node), " writes ", to_text(row.at), " twice; keep one row"};
        }
    }
    for (const can::FrameRow& frame : signals.frames) {
        const std::uint32_t id = frame.identifier.id;
        if (frame.identifier.extended) continue;
        const bool is_heartbeat = id > cob::heartbeat && id <= cob::heartbeat + most_nodes;
        const bool is_sdo = id > cob::sdo_answer && id <= cob::sdo_request + most_nodes;
        if (id == cob::nmt || (id >= cob::sync && id <= cob::time) || is_heartbeat || is_sdo)
            return Sentence{"frame \"", frame.name, "\" has the identifier ", hex(id, 3),
                            ", which is the network's own; take it out of the signal map"};
        for (const NodeRow& node : map.nodes) {
            if (!pdo_place(frame.identifier, node.id).known) continue;
            bool is_mapped = false;
            for (const PdoRow& row : node.pdos) is_mapped |= row.frame == frame.name;
            if (!is_mapped)
                return Sentence{who(node),  ": frame \"",
                                frame.name, "\" is one of its PDOs, but no row configures it; write .pdo(\"",
                                frame.name, "\", {..})"};
        }
    }
    return {};
}

} // namespace tappet::canopen::detail
