// SPDX-License-Identifier: Apache-2.0
// Writes lines of one word and its values.
#include "toolchain/machine/board_text.hpp"

#include "kernel/base/digest.hpp"
#include "kernel/machine/check/board.hpp"

#include <array>
#include <bit>

namespace tappet {

namespace {

void add(Digest& digest, std::string_view text) {
    for (const char character : text) digest.add(std::uint64_t{static_cast<unsigned char>(character)});
    digest.add(std::uint64_t{256}); // separates "ab", "c" from "a", "bc"
}

/// Returns a digest of all properties stored in files: their names, types and ranges. Two versions with the
/// same digest can read each other's files.
std::uint64_t layout_of(const MachineView& table) {
    Digest digest;
    for (const ComponentRow& row : table.components) {
        if (!row.has_properties_file) continue;
        add(digest, row.name);
        add(digest, row.properties.name);
        for (const Facet& facet : row.type->facets) {
            if (facet.kind != FacetKind::property) continue;
            add(digest, facet.name);
            add(digest, facet.type->name);
            add(digest, facet.unit);
            digest.add(std::bit_cast<std::uint64_t>(facet.range.low));
            digest.add(std::bit_cast<std::uint64_t>(facet.range.high));
            for (const std::string_view each : facet.property->element->names) add(digest, each);
        }
    }
    return digest.value();
}

std::array<char, 16> hexadecimal(std::uint64_t value) {
    std::array<char, 16> digits{};
    for (std::size_t i = digits.size(); i-- != 0; value >>= 4) digits[i] = "0123456789abcdef"[value & 15];
    return digits;
}

} // namespace

void describe_board(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view)) {
    const Board& board = *machine.board;
    const auto say = [&](const auto&... words) { line(to, Sentence{words...}.view()); };
    say("machine ", machine.table.name);
    say("board ", board.name);
    say("world ", board.world);
    say("kernel ", board.kernel_command_line);
    for (const std::string_view each : board.image.consoles) say("console ", each);
    for (const std::string_view each : board.image.modules) say("module ", each);
    for (const std::string_view each : board.image.later_modules) say("later-module ", each);
    for (const BoundDevice& bound : machine.binding->devices)
        if (const BoardDevice* device = checks::find_named(board.devices, bound.at); device != nullptr) {
            Sentence text{"device ", device->kind, " ", device->address};
            for (const Fact& fact : device->facts)
                for (const std::int64_t number : fact.numbers)
                    if (fact.word->is_for_box && number != 0) text.add(" ").add(number);
            say(text);
        }
    for (const BoardNetwork& each : board.image.networks) say("network ", each.name, " ", each.address);
    if (board.image.interrupt_priority != 0) say("interrupts ", board.image.interrupt_priority);
    if (board.watchdog != nullptr)
        say("watchdog ", board.watchdog, " ", static_cast<std::int64_t>(board.watchdog_within / 1s));
    const auto layout = hexadecimal(layout_of(machine.table));
    say("layout ", std::string_view{layout.data(), layout.size()});
    if (board.image.service_port != 0) say("service ", board.image.service_port);
#ifndef __OPTIMIZE__
    say("build debug");
#endif
    say("restarts ", board.image.restarts.most, " ",
        static_cast<std::int64_t>(board.image.restarts.within / 1s));
}

} // namespace tappet
