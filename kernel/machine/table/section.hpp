// A section of rows that belongs to another folder: the interface that the table, its checks, its plan and
// start-up use. A new kind of row needs nothing else from the machine.
#pragma once

#include "kernel/base/text.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

namespace tappet {

struct MachineView;
struct TableIndexView;
class MachineInstance;

/// A counter of one row of such a section. An empty `what`: there is no such row.
struct SectionCount {
    std::string_view what{};
    std::uint64_t times = 0;
    std::string_view told{}; ///< said of `what` at the end of a run when it is not 0; empty: nothing
};

/// The rows are constants of the table; data that change while the machine runs are in the memory that the
/// plan reserves.
class ExtraSection {
public:
    /// Returns the first fault of its rows, with its cure; empty: none. Called after all other sections have
    /// passed.
    [[nodiscard]] constexpr virtual Sentence check(const MachineView& table,
                                                   const TableIndexView& index) const = 0;
    /// Whether two components never run at the same time, so that both may write one input. Called before
    /// check(), after all components and activities have passed.
    [[nodiscard]] constexpr virtual bool take_turns(const MachineView&, std::size_t, std::size_t) const {
        return false;
    }
    /// Whether a component waits, before it starts, for a valid value of another one in a required input, as
    /// if that were valid_to_start. Needs an accepted table.
    [[nodiscard]] constexpr virtual bool awaits(const MachineView&, std::size_t /*from*/,
                                                std::size_t /*to*/) const {
        return false;
    }
    /// Returns its name when a table may have only one; empty: it may have several.
    [[nodiscard]] constexpr virtual std::string_view stands_once() const { return {}; }
    /// Returns the bytes that it needs of the machine's memory; they begin at maximum alignment.
    [[nodiscard]] constexpr virtual std::size_t bytes(const MachineView& table) const = 0;
    /// Returns the events whose emissions are counted for it, one for each number, each event once; empty: no
    /// more. Needs a checked table.
    [[nodiscard]] constexpr virtual std::string_view counts(std::size_t /*number*/) const { return {}; }
    /// Returns the counter once the section is connected. The emitter increments it, in any activity.
    [[nodiscard]] virtual std::atomic<std::uint64_t>* counter(std::span<std::byte> /*memory*/,
                                                              std::size_t /*number*/) const noexcept {
        return nullptr;
    }
    /// Connects the section at start-up, when ports are wired and no component is configured yet. `number`:
    /// the section's number for ask_section_stop.
    virtual void connect(MachineInstance& machine, std::size_t number, std::span<std::byte> memory) const = 0;
    /// Says why a row asked the machine to stop (ask_section_stop).
    [[nodiscard]] virtual Sentence describe_stop(std::size_t row) const = 0;

    /// Returns the count of one row, for summaries. Any thread.
    [[nodiscard]] virtual SectionCount counted(std::span<const std::byte> memory,
                                               std::size_t row) const noexcept = 0;

protected:
    constexpr ~ExtraSection() = default;
};

/// The sections of a table after the five that every machine has; none here. They are looked up by number,
/// since g++ 12 refuses a constant that holds the address of a part of itself.
struct ExtraList {
    [[nodiscard]] constexpr virtual std::size_t size() const noexcept { return 0; }
    /// `number` is below size().
    [[nodiscard]] constexpr virtual const ExtraSection* at(std::size_t) const noexcept { return nullptr; }

protected:
    constexpr ~ExtraList() = default;
};

template <class... Extra>
struct ExtraSections final : ExtraList {
    std::tuple<Extra...> sections;

    // NOLINTNEXTLINE(google-explicit-constructor): a table is one braced list
    constexpr ExtraSections(const Extra&... each) : sections{each...} {}

    [[nodiscard]] constexpr std::size_t size() const noexcept override { return sizeof...(Extra); }
    [[nodiscard]] constexpr const ExtraSection* at(std::size_t number) const noexcept override {
        const ExtraSection* found = nullptr;
        std::apply(
            [&](const auto&... each) {
                std::size_t passed = 0;
                ((passed++ == number ? static_cast<void>(found = &each) : static_cast<void>(0)), ...);
            },
            sections);
        return found;
    }
};

/// Most tables have no such section, and it needs no storage.
template <>
struct ExtraSections<> final : ExtraList {};
inline constexpr ExtraSections<> no_extras{};

/// Returns the offset at which a section's memory begins, given the end of the previous one.
constexpr std::size_t align_section(std::size_t at) noexcept {
    return (at + alignof(std::max_align_t) - 1) / alignof(std::max_align_t) * alignof(std::max_align_t);
}

} // namespace tappet
