// SDO transfers as CiA 301 defines them, decoded a second time, and objects that accept only complete
// downloads.
#pragma once

#include "drivers/canopen/sdo_server.hpp"
#include "tests/fuzz/input.hpp"

#include <map>
#include <vector>

namespace tappet::fuzz {

using namespace canopen;
using Bytes = std::vector<std::uint8_t>;
using Frames = std::vector<sdo::Payload>;

/// Appends the data of an expedited transfer; returns whether it is one.
inline bool is_expedited(const sdo::Payload& frame, Bytes& into) {
    if ((frame[0] & 2u) == 0) return false;
    const std::ptrdiff_t unused = (frame[0] & 1u) != 0 ? frame[0] >> 2 & 3u : 0;
    into.assign(frame.begin() + 4, frame.begin() + 8 - unused);
    return true;
}
/// Returns whether these segments continue `begun` without a gap. Written from the standard.
inline bool are_segments(const sdo::Payload& begun, std::span<const sdo::Payload> frames, Bytes& into) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::uint8_t head = frames[i][0];
        if (head >> 5 != 0 || (head >> 4 & 1u) != i % 2 || (head & 1u) != (i + 1 == frames.size() ? 1 : 0))
            return false;
        into.insert(into.end(), frames[i].begin() + 1, frames[i].begin() + 8 - (head >> 1 & 7));
    }
    return (begun[0] & 1u) == 0 || from_bytes(std::span{begun}.subspan(4, 4)) == into.size();
}

/// Accepts only complete downloads.
struct Objects final : ObjectAccess {
    std::map<std::uint16_t, Bytes> values{{0x2000, {1}}, {0x2001, Bytes(20, 'a')}, {0x2002, {}}};
    Frames heard{}; ///< since a transfer began

    SdoAbort read_object(Address at, std::span<std::uint8_t> into, std::size_t& size) noexcept override {
        const auto found = values.find(at.index);
        if (found == values.end() || at.sub != 0) return SdoAbort::no_object;
        size = found->second.size();
        std::ranges::copy(found->second, into.begin());
        return SdoAbort::none;
    }
    SdoAbort write_object(Address at, std::span<const std::uint8_t> value) noexcept override {
        SdoAbort why = SdoAbort::none;
        TAPPET_ESCAPE("a test's lists", why = take(at, value));
        return why;
    }
    SdoAbort take(Address at, std::span<const std::uint8_t> value) {
        demand(!heard.empty() && heard[0][0] >> 5 == 1 && sdo::address_in(heard[0]) == at);
        Bytes sent;
        demand(is_expedited(heard[0], sent) ? heard.size() == 1
                                            : are_segments(heard[0], std::span{heard}.subspan(1), sent));
        demand(std::ranges::equal(sent, value));
        const auto found = values.find(at.index);
        if (found == values.end() || at.sub != 0) return SdoAbort::no_object;
        found->second = sent;
        return SdoAbort::none;
    }
};

} // namespace tappet::fuzz
