// Reads a machine's map from its shared memory, in another process: checked once, then read by plain access.
// Live values are copied under the generation counter of their activity, never torn.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/machine/map/layout.hpp"

#include <atomic>
#include <cstddef>
#include <cstring>
#include <expected>
#include <iterator>
#include <span>
#include <string_view>

namespace tappet::map {

/// The records of one section.
template <class Record>
class Records {
public:
    class Iterator {
    public:
        using value_type = Record;
        using difference_type = std::ptrdiff_t;
        Iterator() = default;
        Iterator(const std::byte* at, std::size_t stride) noexcept : at_{at}, stride_{stride} {}
        const Record& operator*() const noexcept { return *reinterpret_cast<const Record*>(at_); }
        const Record* operator->() const noexcept { return &**this; }
        Iterator& operator++() noexcept { return at_ += stride_, *this; }
        Iterator operator++(int) noexcept {
            const Iterator before = *this;
            ++*this;
            return before;
        }
        bool operator==(const Iterator&) const noexcept = default;

    private:
        const std::byte* at_ = nullptr;
        std::size_t stride_ = 0;
    };

    Records() = default;
    Records(const std::byte* block, const Section& section) noexcept
        : first_{block + section.at}, count_{section.count}, stride_{section.stride} {}
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    /// The index is below size().
    const Record& operator[](std::size_t i) const noexcept {
        return *reinterpret_cast<const Record*>(first_ + i * stride_);
    }
    [[nodiscard]] Iterator begin() const noexcept { return {first_, stride_}; }
    [[nodiscard]] Iterator end() const noexcept { return {first_ + count_ * stride_, stride_}; }

private:
    const std::byte* first_ = nullptr;
    std::size_t count_ = 0;
    std::size_t stride_ = sizeof(Record);
};

class View {
public:
    View() = default;

    /// Opens a map. `block` is the mapped memory; it must outlive the view. The error says why the map cannot
    /// be read.
    static std::expected<View, Sentence> open(std::span<const std::byte> block) noexcept {
        if (block.size() < sizeof(Header))
            return std::unexpected(Sentence{"the memory is too short for a map"});
        View view{block};
        const Header& header = view.header();
        if (header.magic != magic) return std::unexpected(Sentence{"the memory does not begin with a map"});
        if (header.layout_version != layout_version)
            return std::unexpected(Sentence{"the machine's map has layout ", header.layout_version,
                                            ", this program reads layout ", layout_version,
                                            "; use the browser that was built with the firmware"});
        if (header.ready != 1)
            return std::unexpected(Sentence{"the machine is still being configured; ask again"});
        const bool sound = header.block_bytes <= block.size() && header.map_bytes <= header.block_bytes &&
                           view.fits<Component>(header.components) && view.fits<Facet>(header.facets) &&
                           view.fits<Activity>(header.activities) &&
                           view.fits<Connection>(header.connections) &&
                           view.fits<Reaction>(header.reactions) && view.fits<Behaviour>(header.behaviours) &&
                           view.fits<Type>(header.types) && view.fits<Field>(header.fields) &&
                           view.fits<Enumerator>(header.enumerators) && view.fits<Figure>(header.figures) &&
                           view.fits<char>(header.texts);
        if (!sound) return std::unexpected(Sentence{"the map's sections lie outside of it: it is damaged"});
        return view;
    }

    [[nodiscard]] const Header& header() const noexcept {
        return *reinterpret_cast<const Header*>(block_.data());
    }
    [[nodiscard]] std::span<const std::byte> block() const noexcept { return block_; }
    /// Returns the characters; empty when the text lies outside the map.
    [[nodiscard]] std::string_view text(const Text& text) const noexcept {
        const std::uint64_t end = std::uint64_t{text.at} + text.length;
        return end <= header().map_bytes
                   ? std::string_view{reinterpret_cast<const char*>(block_.data()) + text.at, text.length}
                   : std::string_view{};
    }
    [[nodiscard]] Records<Component> components() const noexcept {
        return records<Component>(header().components);
    }
    [[nodiscard]] Records<Facet> facets() const noexcept { return records<Facet>(header().facets); }
    [[nodiscard]] Records<Activity> activities() const noexcept {
        return records<Activity>(header().activities);
    }
    [[nodiscard]] Records<Connection> connections() const noexcept {
        return records<Connection>(header().connections);
    }
    [[nodiscard]] Records<Reaction> reactions() const noexcept {
        return records<Reaction>(header().reactions);
    }
    [[nodiscard]] Records<Behaviour> behaviours() const noexcept {
        return records<Behaviour>(header().behaviours);
    }
    [[nodiscard]] Records<Type> types() const noexcept { return records<Type>(header().types); }
    [[nodiscard]] Records<Field> fields() const noexcept { return records<Field>(header().fields); }
    [[nodiscard]] Records<Enumerator> enumerators() const noexcept {
        return records<Enumerator>(header().enumerators);
    }
    [[nodiscard]] Records<Figure> figures() const noexcept { return records<Figure>(header().figures); }

    /// Reads a counter or flag, which is a single atomic word.
    template <class Word>
    [[nodiscard]] Word word(std::uint64_t at) const noexcept {
        if (at == 0 || at > block_.size() - sizeof(Word)) return Word{};
        return __atomic_load_n(reinterpret_cast<const Word*>(block_.data() + at), __ATOMIC_ACQUIRE);
    }

    /// Repeats `copy()`, which copies live values of one activity from block(), until the activity's
    /// generation shows that no cycle changed them during the copy; at most `attempts` times. False: the
    /// activity was busy each time, and the copy may be torn.
    template <class Copy>
    [[nodiscard]] bool consistent(std::uint32_t activity, int attempts, Copy&& copy) const noexcept {
        if (activity >= activities().size()) return false;
        const std::uint64_t generation_at = activities()[activity].generation_at;
        for (int attempt = 0; attempt < attempts; ++attempt) {
            const auto before = word<std::uint64_t>(generation_at); // observe.before
            if (before % 2 != 0) continue;
            copy();
            std::atomic_thread_fence(std::memory_order_acquire);
            if (word<std::uint64_t>(generation_at) == before) return true; // observe.after
        }
        return false;
    }
    /// Copies bytes that the machine may be writing; false when they lie outside the block. The copy is whole
    /// only inside consistent().
    [[nodiscard]] bool copy(std::uint64_t at, std::span<std::byte> into) const noexcept {
        if (at == 0 || into.size() > block_.size() || at > block_.size() - into.size()) return false;
        std::memcpy(into.data(), block_.data() + at, into.size());
        return true;
    }

private:
    explicit View(std::span<const std::byte> block) noexcept : block_{block} {}
    template <class Record>
    [[nodiscard]] Records<Record> records(const Section& section) const noexcept {
        return {block_.data(), section};
    }
    template <class Record>
    [[nodiscard]] bool fits(const Section& section) const noexcept {
        return section.stride >= sizeof(Record) && section.at % alignof(Record) == 0 &&
               section.stride % alignof(Record) == 0 &&
               section.at + std::uint64_t{section.count} * section.stride <= header().map_bytes;
    }

    std::span<const std::byte> block_{};
};

} // namespace tappet::map
