// A section of rows that lives in a folder of its own: what the table, its checks, its plan and start-up ask
// of it. A new kind of row needs nothing else of the machine.
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

/// What a row of such a section counted while the machine ran. Nobody's: there is no such row.
struct SectionCount {
    std::string_view what{};
    std::uint64_t times = 0;
};

/// Its rows are constants of the table; what changes while the machine runs lies in the memory that the plan
/// gives it.
class ExtraSection {
public:
    /// The first fault of its rows, with its cure; empty: none. After all other sections were found good.
    [[nodiscard]] constexpr virtual Sentence check(const MachineView& table,
                                                   const TableIndexView& index) const = 0;
    /// Whether two components never run at the same time, so that both may write one input. Before the check,
    /// when all components and activities were found good.
    [[nodiscard]] constexpr virtual bool take_turns(const MachineView&, std::size_t, std::size_t) const {
        return false;
    }
    /// Whether a component waits, before it starts, for a valid value of another one in a required input, as
    /// if that were valid_to_start. Of an accepted table.
    [[nodiscard]] constexpr virtual bool awaits(const MachineView&, std::size_t /*from*/,
                                                std::size_t /*to*/) const {
        return false;
    }
    /// Its name when a table has one of it at most; empty: it may have several.
    [[nodiscard]] constexpr virtual std::string_view stands_once() const { return {}; }
    /// What it takes of the machine's memory; it begins where any object may stand.
    [[nodiscard]] constexpr virtual std::size_t bytes(const MachineView& table) const = 0;
    /// The events whose emissions are counted for it, one number after the other, each once; empty: there are
    /// no more. Of a checked table.
    [[nodiscard]] constexpr virtual std::string_view counts(std::size_t /*number*/) const { return {}; }
    /// Where, once it is connected: by the emitter, in whatever activity it runs.
    [[nodiscard]] virtual std::atomic<std::uint64_t>* counter(std::span<std::byte> /*memory*/,
                                                              std::size_t /*number*/) const noexcept {
        return nullptr;
    }
    /// At start-up, when ports are wired and no component is configured yet. `number`: of this section, for
    /// ask_section_stop.
    virtual void connect(MachineInstance& machine, std::size_t number, std::span<std::byte> memory) const = 0;
    /// Why a row of it asked the machine to stop (ask_section_stop).
    [[nodiscard]] virtual Sentence describe_stop(std::size_t row) const = 0;

    /// Of one row after the other, for summaries; any thread.
    [[nodiscard]] virtual SectionCount counted(std::span<const std::byte> memory,
                                               std::size_t row) const noexcept = 0;

protected:
    constexpr ~ExtraSection() = default;
};

/// The sections of a table after the five that every machine has; here none. They are found by their number,
/// since a constant that holds the address of a part of itself is refused by g++ 12.
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

/// Most tables: nothing is kept of them.
template <>
struct ExtraSections<> final : ExtraList {};
inline constexpr ExtraSections<> no_extras{};

/// Where the memory of a section begins, from where those before it end.
constexpr std::size_t align_section(std::size_t at) noexcept {
    return (at + alignof(std::max_align_t) - 1) / alignof(std::max_align_t) * alignof(std::max_align_t);
}

} // namespace tappet
