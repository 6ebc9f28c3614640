// A kind of device, as its driver says it: what boards and bindings may say of one, and what the table's
// check asks. The kernel knows no kind; each driver declares its own in its folder.
#pragma once

#include "kernel/base/text.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// A word that a row of a board or a binding may have for one kind of device: bit_rate(500'000),
/// line("brake", 9).
struct Word {
    std::string_view name{};
    std::string_view kind{};  ///< of the devices that it is for
    bool is_of_parts = false; ///< it is said of one part of the device, by name, and so more than once
    bool is_for_box = false;  ///< the box's init is told its numbers, to bring the device up
};

/// A word as a row says it. A driver writes a function for each of its words that returns one, and reads it
/// with said().
struct Fact {
    const Word* word = nullptr;
    std::string_view part{};               ///< of a word that is of parts: which
    std::array<std::int64_t, 3> numbers{}; ///< what they mean is the driver's
};

/// What is said with that word; null: nothing.
constexpr const Fact* said(std::span<const Fact> facts, const Word& word,
                           std::string_view part = {}) noexcept {
    for (const Fact& each : facts)
        if (each.word == &word && each.part == part) return &each;
    return nullptr;
}

/// A driver's row that is bound to a device, as the check of its kind sees it.
struct DeviceAsked {
    std::span<const std::string_view> parts{}; ///< that the driver wants, by logical name
    std::span<const Fact> bound{};             ///< what the binding says of it
    std::string_view device{};                 ///< the board's; "": it is reached by an address
    std::span<const Fact> of_board{};          ///< what the board says of that
};

/// A component that drives a device has a member `device_kind` of this type.
struct DeviceKind {
    std::string_view name{};    ///< "can"
    std::string_view carrier{}; ///< the kind of the board's devices that it stands on; "": its own name
    /// It may be bound to "192.168.7.2:502" in place of a device of the board.
    bool takes_address = false;
    std::string_view cure = "add it to the board's devices"; ///< where the board has no device of that name
    /// The first fault, with its cure; empty: none. Words that are for other kinds, and words that are said
    /// twice, are refused before.
    Sentence (*check)(const DeviceAsked&) = nullptr;

    [[nodiscard]] constexpr std::string_view on_board() const noexcept {
        return carrier.empty() ? name : carrier;
    }
};

} // namespace tappet
