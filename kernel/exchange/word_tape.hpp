// A tape of words: one writer records over the oldest words without asking. Readers, from any process, do not
// disturb it, and check after reading whether the words were still there.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>

namespace tappet {

/// Written wait-free, record after record: one store for each word and one that publishes, no load of data
/// that another thread wrote, and no line that a reader polls. The derived class defines the contents of a
/// record. The words are in memory after the object.
///
/// Proof that no torn record is handed out: all words are stored with release and loaded with acquire. Assume
/// that a reader loads a word of a later round than it meant. Then it sees in head() at least the position at
/// which that later record began, which is less than most_words() before the word, and holds() returns false.
class WordTape {
public:
    static constexpr std::size_t alignment = 128; // two lines: the processor fetches them in pairs

    WordTape(const WordTape&) = delete;
    WordTape& operator=(const WordTape&) = delete;

    /// Switches recording on or off, from the next record on; any thread, at any time.
    void turn(bool on) noexcept TAPPET_REALTIME {
        on_.store(on, std::memory_order_relaxed); // no step: it holds from the next record on
    }
    [[nodiscard]] bool is_on() const noexcept TAPPET_REALTIME {
        return on_.load(std::memory_order_relaxed); // no step: it holds from the next record on
    }
    /// Returns the position after the last complete record; any thread, any process.
    [[nodiscard]] std::uint64_t head() const noexcept {
        return head_.load(std::memory_order_acquire); // tape.look
    }
    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }
    /// Returns the largest number of words of one record.
    [[nodiscard]] std::size_t most_words() const noexcept { return most_words_; }
    /// Returns whether the words read from `at` on were not overwritten meanwhile; call it after reading.
    [[nodiscard]] bool holds(std::uint64_t at) const noexcept {
        return at + capacity_ >= head() + most_words(); // tape.check
    }
    /// Copies words from `at` on, as many as `into` has room for. Returns false when they are not there.
    [[nodiscard]] bool copy(std::uint64_t at, std::span<std::uint64_t> into) const noexcept {
        if (at + into.size() > head()) return false;
        for (std::size_t i = 0; i < into.size(); ++i) into[i] = get(at + i);
        return holds(at);
    }

protected:
    /// `words`: a power of two, more than twice `most_words`. No record exceeds `most_words`.
    WordTape(std::size_t words, std::size_t most_words) noexcept : capacity_{words}, most_words_{most_words} {
        for (std::size_t i = 0; i < words; ++i)
            ::new (static_cast<void*>(first() + i)) std::atomic<std::uint64_t>{0};
    }
    ~WordTape() = default;

    /// The writer's place in a record, which the compiler keeps in registers over many words in a row.
    class Pen {
    public:
        void put(std::uint64_t word) noexcept TAPPET_REALTIME {
            first_[at_++ & mask_].store(word, std::memory_order_release); // tape.word
        }
        [[nodiscard]] std::uint64_t at() const noexcept TAPPET_REALTIME { return at_; }

    private:
        friend class WordTape;
        Pen(std::atomic<std::uint64_t>* first, std::uint64_t mask, std::uint64_t at) noexcept TAPPET_REALTIME
            : first_{first},
              mask_{mask},
              at_{at} {}
        std::atomic<std::uint64_t>* first_;
        std::uint64_t mask_;
        std::uint64_t at_;
    };

    // For the writer.
    [[nodiscard]] Pen pen() noexcept TAPPET_REALTIME { return {first(), capacity_ - 1, position_}; }
    [[nodiscard]] std::uint64_t position() const noexcept TAPPET_REALTIME { return position_; }
    void put(std::uint64_t at, std::uint64_t word) noexcept TAPPET_REALTIME {
        first()[at & (capacity_ - 1)].store(word, std::memory_order_release); // tape.word
    }
    /// Publishes the record that began at position() and ends before `after`.
    void publish(std::uint64_t after) noexcept TAPPET_REALTIME {
        position_ = after;
        head_.store(position_, std::memory_order_release); // tape.head
    }

    [[nodiscard]] std::uint64_t get(std::uint64_t at) const noexcept {
        return first()[at & (capacity_ - 1)].load(std::memory_order_acquire); // tape.take
    }

private:
    [[nodiscard]] std::atomic<std::uint64_t>* first() noexcept TAPPET_REALTIME {
        return reinterpret_cast<std::atomic<std::uint64_t>*>(this + 1);
    }
    [[nodiscard]] const std::atomic<std::uint64_t>* first() const noexcept {
        return reinterpret_cast<const std::atomic<std::uint64_t>*>(this + 1);
    }

    // Read by everybody, hardly ever written.
    alignas(alignment) std::uint64_t capacity_;
    std::uint64_t most_words_;
    std::atomic<bool> on_{true};
    // Polled by readers.
    alignas(alignment) std::atomic<std::uint64_t> head_{0};
    // For the writer, and for the derived class.
    alignas(alignment) std::uint64_t position_ = 0;
};
static_assert(sizeof(WordTape) == 3 * WordTape::alignment && std::atomic<std::uint64_t>::is_always_lock_free);

} // namespace tappet
