// Text in constant expressions: a sentence built piece by piece, and a text that may be a template argument.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

/// A sentence of at most `capacity` characters, built piece by piece. A longer one is cut, visibly.
struct Sentence {
    static constexpr std::size_t capacity = 480;
    char characters[capacity + 1] = {};
    std::size_t length = 0;

    constexpr Sentence() = default;
    template <class... Pieces>
    explicit constexpr Sentence(const Pieces&... pieces) {
        (add(pieces), ...);
    }
    constexpr Sentence& add(std::string_view piece) noexcept {
        for (char character : piece) {
            if (length == capacity) {
                characters[capacity - 1] = characters[capacity - 2] = characters[capacity - 3] = '.';
                return *this;
            }
            characters[length++] = character;
        }
        return *this;
    }
    constexpr Sentence& add(const char* piece) noexcept { return add(std::string_view{piece}); }
    constexpr Sentence& add(const Sentence& other) noexcept { return add(other.view()); }
    constexpr Sentence& add(std::int64_t number) noexcept {
        if (number >= 0) return add(static_cast<std::size_t>(number));
        return add("-").add(~static_cast<std::size_t>(number) + 1);
    }
    constexpr Sentence& add(std::size_t number) noexcept {
        char digits[20] = {};
        std::size_t n = 0;
        do digits[n++] = static_cast<char>('0' + number % 10);
        while (number /= 10);
        std::reverse(digits, digits + n);
        return add(std::string_view{digits, n});
    }
    constexpr Sentence& add(int number) noexcept { return add(static_cast<std::int64_t>(number)); }
    constexpr Sentence& add(unsigned number) noexcept { return add(static_cast<std::size_t>(number)); }

    [[nodiscard]] constexpr std::string_view view() const noexcept { return {characters, length}; }
    [[nodiscard]] constexpr bool empty() const noexcept { return length == 0; }
    // Required by static_assert(ok, message) of a message object.
    [[nodiscard]] constexpr std::size_t size() const noexcept { return length; }
    [[nodiscard]] constexpr const char* data() const noexcept { return characters; }
};

/// A text of exactly N characters as a template argument: for a compiler that cannot print a message object.
template <std::size_t N>
struct text {
    char characters[N + 1] = {};
    constexpr text() = default;
    explicit constexpr text(std::string_view from) { std::copy_n(from.data(), N, characters); }
    // NOLINTNEXTLINE: a literal is a text
    constexpr text(const char (&from)[N + 1]) { std::copy_n(from, N, characters); }
    [[nodiscard]] constexpr std::string_view view() const noexcept { return {characters, N}; }
};
template <std::size_t M>
text(const char (&)[M]) -> text<M - 1>;

/// A compiler that cannot print message objects prints: 'accepted' is not a member of refused<the sentence>.
template <text sentence>
struct refused {};
/// No refusal.
template <>
struct refused<text<0>{}> {
    static constexpr bool accepted = true;
};

} // namespace tappet

/// Stops the compiler with a constant's sentence, unless the sentence is empty.
#if defined(__clang__)
#define TAPPET_ACCEPTED(fault) static_assert((fault).empty(), fault)
#else
#define TAPPET_ACCEPTED(fault)                                                                               \
    static_assert(::tappet::refused<::tappet::text<(fault).size()>{(fault).view()}>::accepted)
#endif
