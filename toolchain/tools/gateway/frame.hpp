// The binary frames of a watch: values with their stamps, as little-endian bytes.
#pragma once

#include "toolchain/tools/gateway/station.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::network {

/// A frame: u32 magic, u32 id of the watch, u32 sequence, u32 frames lost so far, i64 machine time in ns
/// (-1: unknown), i64 age in ns of the newest cycle seen, u16 number of values. Then per value: u16 index in
/// the watch's names, u8 flags, u8 kind, i64 stamp in ns (-1: none), and the value: 8 bytes, for a boolean 1
/// byte, for a text u16 length and UTF-8, for no value nothing.
inline constexpr std::uint32_t frame_magic = 0x31465054; ///< "TPF1"
inline constexpr std::size_t frame_head_bytes = 34;

enum FrameFlag : std::uint8_t {
    frame_busy = 1, ///< its activity was in a cycle at every attempt: no value
    frame_forced = 2,
    frame_stale = 4,
    frame_never_written = 8,
    frame_unread = 16
};

/// The kind of a value; the numbers are part of the protocol.
enum class FrameKind : std::uint8_t {
    none = 0,
    real = 1,
    integer = 2,
    natural = 3,
    boolean = 4,
    text = 5,
    duration = 6
};

/// Returns the kind in which a facet's values are sent: real, integer, natural, boolean, duration (ns) and
/// text as they are, everything else as JSON in a text.
[[nodiscard]] FrameKind frame_kind(const browser::MapReader& map, std::uint32_t type);
[[nodiscard]] std::string_view to_text(FrameKind kind);
/// Appends one value without its index: flags, kind, stamp, bytes.
void add_value(std::string& frame, const browser::MapReader& map, const browser::Reading& reading);

/// The values of a watch that its client has, so that a frame holds the changed ones only.
class Frames {
public:
    Frames() = default;
    Frames(std::uint32_t id, std::size_t values) : id_{id}, known_(values) {}

    /// Starts a frame of the readings that differ from what the client has; returns its bytes.
    [[nodiscard]] std::string make(const Station& station, std::span<const std::uint32_t> facets,
                                   std::int64_t now_ns);
    /// The client gets the last frame made.
    void keep();
    /// It does not: the next frame holds its values again, and says so.
    void lose() { ++lost_; }
    [[nodiscard]] std::uint32_t lost() const { return lost_; }

private:
    std::uint32_t id_ = 0;
    std::uint32_t sequence_ = 0;
    std::uint32_t lost_ = 0;
    std::vector<std::string> known_{};
    std::vector<std::pair<std::size_t, std::string>> fresh_{};
};

} // namespace tappet::network
