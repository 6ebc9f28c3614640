// The last value of one writer for any number of readers, wait-free for all of them (thesis 4.4: the data
// object): several slots in turn, each with the generation it holds, as in a sequence lock with more than one
// slot.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/exchange/words.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tappet {

/// write() is one copy and four stores, and loads nothing that a reader writes: readers write nothing at all.
/// read() is at most Attempts copies; it fails only if, during each of them, the writer finished Slots - 1
/// values and began one more. Real-time on both sides; no allocation; all zero until the first value.
template <Exchangeable T, std::size_t Slots = 4, std::size_t Attempts = 3,
          template <class> class Atomic = std::atomic>
class DataObject {
    static_assert(Slots >= 2,
                  "with one slot a writer that is preempted in its copy leaves readers nothing to read");
    static_assert(Slots <= 16, "a slot is a whole copy of the value: give the reader attempts, not slots");
    static_assert(Attempts >= 1 && Attempts <= 16,
                  "the attempts are a reader's worst case: at least one, and few");

public:
    /// Writes a value. One thread only.
    void write(const T& value) noexcept TAPPET_REALTIME {
        typename Value::Copy
            packed; // before anything is stored, so that what the caller just copied is at hand
        if constexpr (Value::fits_registers) Value::pack(value, packed);
        const std::uint64_t generation = ++own_;
        Slot& slot = slots_[generation % Slots];
        slot.generation.store(being_written, std::memory_order_relaxed); // data.write_mark
        if constexpr (Value::fits_registers)
            slot.value.store(packed);
        else
            slot.value.store(value);
        slot.generation.store(generation, std::memory_order_release); // data.write_number
        published_.store(generation, std::memory_order_release);      // data.write_publish
    }

    /// Reads a value newer than the caller's. `generation` is the number of the caller's value (0: none).
    /// True: `into` is newer, and `generation` is its number. False: both are unchanged, because nothing
    /// newer was written, or, if generation() differs, because the writer overtook every attempt. Any thread.
    [[nodiscard]] bool read(T& into, std::uint64_t& generation) const noexcept TAPPET_REALTIME {
        for (std::size_t attempt = 0; attempt < Attempts; ++attempt) {
            const std::uint64_t published = published_.load(std::memory_order_acquire); // data.read_index
            if (published == generation || published == never_written) return false;
            const Slot& slot = slots_[published % Slots];
            typename Value::Copy copy;
            slot.value.load(copy);
            // Equal to the published number, not merely unchanged: a slot at rest may hold a value older than
            // one that this reader has seen.
            if (slot.generation.load(std::memory_order_relaxed) != published) continue; // data.read_check
            Value::unpack(copy, into);
            generation = published;
            return true;
        }
        return false;
    }

    /// Returns the number of values written so far; 0: never written. Any thread.
    [[nodiscard]] std::uint64_t generation() const noexcept TAPPET_REALTIME {
        return published_.load(std::memory_order_acquire); // data.generation
    }

private:
    using Value = Words<T, Atomic>;
    static constexpr std::uint64_t never_written = 0;
    static constexpr std::uint64_t being_written = 0;

    struct alignas(64) Slot {
        Value value{}; // first, so that no pair of its words lies across two lines
        Atomic<std::uint64_t> generation{};
    };

    std::array<Slot, Slots> slots_{};
    alignas(line_pair_bytes) Atomic<std::uint64_t> published_{};
    // For the writer alone: a load of the published line would fetch it back from readers that poll it.
    alignas(line_pair_bytes) std::uint64_t own_ = 0;
};

} // namespace tappet
