// The server's side of an SDO connection: answers each request at once, expedited or segmented.
#pragma once

#include "drivers/canopen/sdo.hpp"

namespace tappet::canopen {

/// The objects that a server gives access to. Real-time.
class ObjectAccess {
public:
    ObjectAccess() = default;
    ObjectAccess(const ObjectAccess&) = default;
    ObjectAccess& operator=(const ObjectAccess&) = default;
    virtual ~ObjectAccess() = default;
    /// Reads an object; `size` becomes the number of bytes written to `into`.
    [[nodiscard]] virtual SdoAbort read_object(Address at, std::span<std::uint8_t> into,
                                               std::size_t& size) noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual SdoAbort write_object(Address at, std::span<const std::uint8_t> value) noexcept
        TAPPET_REALTIME = 0;
};

/// Real-time; each call takes bounded time. Refuses block transfers, as the standard allows.
class SdoServer {
public:
    void forget() noexcept TAPPET_REALTIME { transfer_ = Transfer::none; }

    /// Serves a request of the client. Returns false when there is no answer to send.
    [[nodiscard]] bool serve(const sdo::Payload& request, ObjectAccess& objects,
                             sdo::Payload& answer) noexcept TAPPET_REALTIME {
        switch (request[0] >> 5) {
        case 0: return take_segment(request, objects, answer);
        case 1: return begin_write(request, objects, answer);
        case 2: return begin_read(request, objects, answer);
        case 3: return give_segment(request, answer);
        case 4: transfer_ = Transfer::none; return false;
        default: return refuse(sdo::address_in(request), SdoAbort::unknown_command, answer);
        }
    }

private:
    enum class Transfer : std::uint8_t { none, reading, writing };
    static constexpr auto unsaid = ~std::size_t{};

    bool refuse(Address at, SdoAbort why, sdo::Payload& answer) noexcept TAPPET_REALTIME {
        transfer_ = Transfer::none;
        answer = sdo::abort_frame(at, why);
        return true;
    }
    void begin(Address at, Transfer transfer) noexcept TAPPET_REALTIME {
        at_ = at;
        transfer_ = transfer;
        toggle_ = 0;
        moved_ = 0;
    }

    bool begin_write(const sdo::Payload& request, ObjectAccess& objects, sdo::Payload& answer) noexcept
        TAPPET_REALTIME {
        const Address at = sdo::address_in(request);
        const bool expedited = (request[0] & 2u) != 0;
        const bool says_size = (request[0] & 1u) != 0;
        if (expedited) {
            const std::size_t size = says_size ? 4u - (request[0] >> 2 & 3u) : 4u;
            const SdoAbort why = objects.write_object(at, std::span{request}.subspan(4, size));
            if (why != SdoAbort::none) return refuse(at, why, answer);
            transfer_ = Transfer::none;
        } else {
            const std::uint64_t size = from_bytes(std::span{request}.subspan(4, 4));
            if (says_size && size > sdo::most_bytes) return refuse(at, SdoAbort::too_long, answer);
            begin(at, Transfer::writing);
            announced_ = says_size ? static_cast<std::size_t>(size) : unsaid;
        }
        answer = sdo::with_address(0x60, at);
        return true;
    }
    bool take_segment(const sdo::Payload& request, ObjectAccess& objects, sdo::Payload& answer) noexcept
        TAPPET_REALTIME {
        if (transfer_ != Transfer::writing) return refuse(at_, SdoAbort::unknown_command, answer);
        if ((request[0] >> 4 & 1u) != toggle_) return refuse(at_, SdoAbort::toggle_bit, answer);
        const std::size_t count = sdo::in_segment - (request[0] >> 1 & 7u);
        if (moved_ + count > sdo::most_bytes) return refuse(at_, SdoAbort::too_long, answer);
        for (std::size_t i = 0; i < count; ++i) bytes_[moved_ + i] = request[1 + i];
        moved_ += count;
        answer = {};
        answer[0] = static_cast<std::uint8_t>(0x20 | toggle_ << 4);
        toggle_ ^= 1u;
        if ((request[0] & 1u) == 0) return true;
        transfer_ = Transfer::none;
        if (announced_ != unsaid && announced_ != moved_) return refuse(at_, SdoAbort::wrong_length, answer);
        const SdoAbort why = objects.write_object(at_, std::span{bytes_}.first(moved_));
        return why == SdoAbort::none || refuse(at_, why, answer);
    }

    bool begin_read(const sdo::Payload& request, ObjectAccess& objects, sdo::Payload& answer) noexcept
        TAPPET_REALTIME {
        const Address at = sdo::address_in(request);
        std::size_t size = 0;
        const SdoAbort why = objects.read_object(at, bytes_, size);
        if (why != SdoAbort::none) return refuse(at, why, answer);
        const auto bytes = std::span{bytes_}.first(size < bytes_.size() ? size : bytes_.size());
        if (size >= 1 && size <= 4) {
            transfer_ = Transfer::none;
            answer = sdo::with_address(0x43u | static_cast<unsigned>(4 - size) << 2, at,
                                       static_cast<std::uint32_t>(from_bytes(bytes)));
            return true;
        }
        begin(at, Transfer::reading);
        announced_ = size;
        answer = sdo::with_address(0x41, at, static_cast<std::uint32_t>(size));
        return true;
    }
    bool give_segment(const sdo::Payload& request, sdo::Payload& answer) noexcept TAPPET_REALTIME {
        if (transfer_ != Transfer::reading) return refuse(at_, SdoAbort::unknown_command, answer);
        if ((request[0] >> 4 & 1u) != toggle_) return refuse(at_, SdoAbort::toggle_bit, answer);
        const std::size_t left = announced_ - moved_;
        const std::size_t count = left < sdo::in_segment ? left : sdo::in_segment;
        const auto unused = static_cast<unsigned>(sdo::in_segment - count);
        answer = {};
        answer[0] = static_cast<std::uint8_t>(toggle_ << 4 | unused << 1 | (count == left ? 1u : 0u));
        for (std::size_t i = 0; i < count; ++i) answer[1 + i] = bytes_[moved_ + i];
        moved_ += count;
        toggle_ ^= 1u;
        if (count == left) transfer_ = Transfer::none;
        return true;
    }

    Transfer transfer_ = Transfer::none;
    Address at_{};
    unsigned toggle_ = 0;
    std::size_t moved_ = 0;
    std::size_t announced_ = 0;
    std::array<std::uint8_t, sdo::most_bytes> bytes_{};
};

} // namespace tappet::canopen
