// A classic CAN frame as the plant sees it, its little-endian fields, and the queue of frames on their way
// out.
#pragma once

#include "kernel/base/digest.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tappet::loom {

struct CanFrame {
    std::uint32_t id = 0; // 11 bits
    std::uint8_t length = 0;
    std::array<std::uint8_t, 8> data{};
    bool operator==(const CanFrame&) const = default;
};

/// Appends little-endian fields to a frame.
class FrameWriter {
public:
    explicit constexpr FrameWriter(std::uint32_t id) noexcept TAPPET_REALTIME { frame_.id = id; }
    constexpr FrameWriter& u8(std::uint8_t value) noexcept TAPPET_REALTIME { return field(value, 1); }
    constexpr FrameWriter& u16(std::uint16_t value) noexcept TAPPET_REALTIME { return field(value, 2); }
    constexpr FrameWriter& u32(std::uint32_t value) noexcept TAPPET_REALTIME { return field(value, 4); }
    constexpr FrameWriter& i32(std::int32_t value) noexcept TAPPET_REALTIME {
        return u32(static_cast<std::uint32_t>(value));
    }
    constexpr FrameWriter& i16(std::int16_t value) noexcept TAPPET_REALTIME {
        return u16(static_cast<std::uint16_t>(value));
    }
    [[nodiscard]] constexpr const CanFrame& frame() const noexcept TAPPET_REALTIME { return frame_; }

private:
    constexpr FrameWriter& field(std::uint32_t value, unsigned bytes) noexcept TAPPET_REALTIME {
        for (unsigned i = 0; i < bytes && frame_.length < 8; ++i)
            frame_.data[frame_.length++] = static_cast<std::uint8_t>(value >> (8 * i));
        return *this;
    }
    CanFrame frame_;
};

/// The little-endian number of `bytes` bytes from `offset`; the caller has checked the frame's length.
constexpr std::uint32_t field_of(const CanFrame& frame, std::size_t offset, unsigned bytes) noexcept
    TAPPET_REALTIME {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < bytes; ++i) value |= std::uint32_t{frame.data[offset + i]} << (8 * i);
    return value;
}

/// A ring of what waits to be fetched. When nobody fetches, the oldest is lost and counted.
template <class T, std::size_t N> class Outbox {
public:
    constexpr void push(const T& item) noexcept TAPPET_REALTIME {
        if (used_ == N) {
            first_ = (first_ + 1) % N;
            --used_;
            ++lost_;
        }
        items_[(first_ + used_) % N] = item;
        ++used_;
    }
    [[nodiscard]] constexpr bool pop(T& item) noexcept TAPPET_REALTIME {
        if (used_ == 0) return false;
        item = items_[first_];
        first_ = (first_ + 1) % N;
        --used_;
        return true;
    }
    [[nodiscard]] constexpr bool empty() const noexcept TAPPET_REALTIME { return used_ == 0; }
    [[nodiscard]] constexpr std::uint64_t lost() const noexcept TAPPET_REALTIME { return lost_; }

private:
    std::array<T, N> items_{};
    std::size_t first_ = 0;
    std::size_t used_ = 0;
    std::uint64_t lost_ = 0;
};

struct SentFrame {
    CanFrame frame;
    Time due; // when the node asks for the bus
};

/// Keeps a digest of everything that ever went out, fetched or not.
class FrameOutbox : public Outbox<SentFrame, 256> {
public:
    constexpr void push(const SentFrame& sent) noexcept TAPPET_REALTIME {
        log_.add(to_ns(sent.due));
        log_.add((std::uint64_t{sent.frame.id} << 8) | sent.frame.length);
        log_.add(std::bit_cast<std::uint64_t>(sent.frame.data));
        Outbox::push(sent);
    }
    [[nodiscard]] constexpr const Digest& log() const noexcept TAPPET_REALTIME { return log_; }

private:
    Digest log_;
};

} // namespace tappet::loom
