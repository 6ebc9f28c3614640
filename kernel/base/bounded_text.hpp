// A text of at most N characters, in place: a value like a number, copied as bytes.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

template <std::size_t N>
struct Text {
    std::array<char, N> characters{};
    std::uint32_t length = 0;

    constexpr Text() = default;
    // NOLINTNEXTLINE: a literal is a text
    template <std::size_t M>
        requires(M <= N + 1)
    constexpr Text(const char (&from)[M]) noexcept {
        static_cast<void>(assign({from, M - 1}));
    }
    /// Replaces the text. Returns false, and changes nothing, when `from` is too long. Real-time.
    constexpr bool assign(std::string_view from) noexcept TAPPET_REALTIME {
        if (from.size() > N) return false;
        characters = {};
        for (std::size_t i = 0; i < from.size(); ++i) characters[i] = from[i];
        length = static_cast<std::uint32_t>(from.size());
        return true;
    }
    /// Appends; the part that does not fit is left out. Real-time.
    constexpr void append(std::string_view more) noexcept TAPPET_REALTIME {
        for (const char each : more)
            if (length < N) characters[length++] = each;
    }
    [[nodiscard]] constexpr std::string_view view() const noexcept TAPPET_REALTIME {
        return {characters.data(), length};
    }
    friend constexpr bool operator==(const Text&, const Text&) = default;
};

} // namespace tappet
