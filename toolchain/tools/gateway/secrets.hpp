// Random numbers, digests and passwords, by OpenSSL.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tappet::network {

/// The cost of scrypt (RFC 7914): 128 * n * r bytes of memory, p times. The default is the one that OWASP
/// lists for 8 MiB (Password Storage Cheat Sheet).
struct Cost {
    std::uint32_t n = 1u << 13;
    std::uint32_t r = 8;
    std::uint32_t p = 10;
    [[nodiscard]] bool operator==(const Cost&) const = default;
};

/// Returns whether n is a power of two, and one calculation needs at most 64 MiB and p is at most 64.
[[nodiscard]] bool is_affordable(const Cost& cost);

/// Returns bytes of the system's random numbers; ends the program when there are none.
[[nodiscard]] std::string random_bytes(std::size_t count);
[[nodiscard]] std::string sha256(std::string_view bytes);
/// Takes the same time wherever the texts differ.
[[nodiscard]] bool are_equal(std::string_view one, std::string_view other);
/// Returns 32 bytes; empty: the memory did not suffice. Takes about 0.1 s.
[[nodiscard]] std::string scrypt(std::string_view password, std::string_view salt, const Cost& cost);

} // namespace tappet::network
