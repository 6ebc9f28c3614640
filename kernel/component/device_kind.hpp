// A kind of device as its driver declares it: the words that boards and bindings may use for it, and the
// table's check of them. The kernel knows no kind; each driver declares its own in its folder.
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
    std::string_view kind{};  ///< kind of the devices that it applies to
    bool is_of_parts = false; ///< it applies to one part of the device, by name, and so may be repeated
    bool is_for_box = false;  ///< the box's init gets its numbers, to bring the device up
};

/// A word as a row states it. A driver writes a function for each of its words that returns a Fact, and reads
/// it with said().
struct Fact {
    const Word* word = nullptr;
    std::string_view part{};               ///< the part, of a word that is of parts
    std::array<std::int64_t, 3> numbers{}; ///< the driver defines their meaning
};

/// Returns the fact with that word; null: there is none.
constexpr const Fact* said(std::span<const Fact> facts, const Word& word,
                           std::string_view part = {}) noexcept {
    for (const Fact& each : facts)
        if (each.word == &word && each.part == part) return &each;
    return nullptr;
}

/// A driver's row that is bound to a device, as the check of its kind sees it.
struct DeviceAsked {
    std::span<const std::string_view> parts{}; ///< parts that the driver needs, by logical name
    std::span<const Fact> bound{};             ///< facts of the binding about it
    std::string_view device{};                 ///< the board's name of it; "": it is reached by an address
    std::span<const Fact> of_board{};          ///< facts of the board about that device
};

/// A component that drives a device has a member `device_kind` of this type.
struct DeviceKind {
    std::string_view name{};    ///< "can"
    std::string_view carrier{}; ///< kind of the board's device that carries it; "": its own name
    /// It may be bound to "192.168.7.2:502" in place of a device of the board.
    bool takes_address = false;
    /// The components that drive it open it themselves; otherwise each has a `device_map` for start-up.
    bool is_opened_by_driver = false;
    std::string_view cure = "add it to the board's devices"; ///< cure if the board has no device of that name
    /// Returns the first fault, with its cure; empty: none. Words for other kinds and repeated words are
    /// refused before.
    Sentence (*check)(const DeviceAsked&) = nullptr;

    [[nodiscard]] constexpr std::string_view on_board() const noexcept {
        return carrier.empty() ? name : carrier;
    }
};

} // namespace tappet
