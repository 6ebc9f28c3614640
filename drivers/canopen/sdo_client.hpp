// The client's side of an SDO connection: one transfer at a time, expedited or segmented, with a time-out.
#pragma once

#include "drivers/canopen/sdo.hpp"
#include "kernel/base/time.hpp"

namespace tappet::canopen {

/// Real-time; each call takes bounded time. It has no wire of its own: next() returns what to send to the
/// server, take() receives its answers.
class SdoClient {
public:
    enum class State : std::uint8_t { idle, busy, done, aborted };

    /// Sets the time-out of the server's answer to each request.
    void set_time_out(Duration time_out) noexcept TAPPET_REALTIME { time_out_ = time_out; }

    /// Starts a transfer and forgets an active one.
    void read(Address at) noexcept TAPPET_REALTIME {
        begin(at, Step::initiate_read);
        size_ = 0;
    }
    /// Writes a value of 1..sdo::most_bytes bytes.
    void write(Address at, std::span<const std::uint8_t> value) noexcept TAPPET_REALTIME {
        begin(at, Step::initiate_write);
        size_ = value.size() < sdo::most_bytes ? value.size() : sdo::most_bytes;
        for (std::size_t i = 0; i < size_; ++i) bytes_[i] = value[i];
    }
    void forget() noexcept TAPPET_REALTIME {
        state_ = State::idle;
        to_send_ = false;
    }

    [[nodiscard]] State state() const noexcept TAPPET_REALTIME { return state_; }
    /// Returns why the transfer was aborted, by either side.
    [[nodiscard]] SdoAbort why() const noexcept TAPPET_REALTIME { return why_; }
    /// Returns whether the server does not know of the abort yet: the next transfer would start in this one.
    [[nodiscard]] bool has_abort_to_send() const noexcept TAPPET_REALTIME {
        return state_ == State::aborted && to_send_;
    }
    /// Returns the value that was read.
    [[nodiscard]] std::span<const std::uint8_t> value() const noexcept TAPPET_REALTIME {
        return std::span{bytes_}.first(size_);
    }

    /// Writes the next request, which must be sent at once; returns false when there is none.
    [[nodiscard]] bool next(sdo::Payload& request, Time now) noexcept TAPPET_REALTIME {
        if (!to_send_) return false;
        to_send_ = false;
        if (state_ == State::aborted) {
            request = sdo::abort_frame(at_, why_);
            return true;
        }
        sent_at_ = now;
        switch (step_) {
        case Step::initiate_read: request = sdo::with_address(0x40, at_); break;
        case Step::read_segment:
            request = {};
            request[0] = static_cast<std::uint8_t>(0x60 | toggle_ << 4);
            break;
        case Step::initiate_write:
            if (size_ <= 4) {
                const auto unused = static_cast<unsigned>(4 - size_);
                request = sdo::with_address(0x23 | unused << 2, at_,
                                            static_cast<std::uint32_t>(from_bytes(value())));
            } else {
                request = sdo::with_address(0x21, at_, static_cast<std::uint32_t>(size_));
            }
            break;
        case Step::write_segment: put_segment(request); break;
        }
        return true;
    }

    /// Takes a frame from the server. Ignores one that answers no request, or one that was given up.
    void take(const sdo::Payload& answer) noexcept TAPPET_REALTIME {
        if (state_ != State::busy || to_send_) return;
        const unsigned command = answer[0] >> 5;
        if (command == 4) {
            const SdoAbort why = sdo::abort_in(answer);
            if (sdo::address_in(answer) == at_)
                end(State::aborted, why == SdoAbort::none ? SdoAbort::general : why);
            return;
        }
        if (is_of_before(answer, command)) return;
        switch (step_) {
        case Step::initiate_read: begin_reading(answer, command); break;
        case Step::read_segment: take_segment(answer, command); break;
        case Step::initiate_write:
            if (command != 3) return fail(SdoAbort::unknown_command);
            if (size_ <= 4) return end(State::done, SdoAbort::none);
            step_ = Step::write_segment;
            to_send_ = true;
            break;
        case Step::write_segment:
            if (command != 1) return fail(SdoAbort::unknown_command);
            if ((answer[0] >> 4 & 1u) != toggle_) return fail(SdoAbort::toggle_bit);
            toggle_ ^= 1u;
            if (moved_ == size_) return end(State::done, SdoAbort::none);
            to_send_ = true;
            break;
        }
    }

    void tick(Time now) noexcept TAPPET_REALTIME {
        if (state_ == State::busy && !to_send_ && now - sent_at_ > time_out_) fail(SdoAbort::time_out);
    }

private:
    enum class Step : std::uint8_t { initiate_read, read_segment, initiate_write, write_segment };
    static constexpr auto unsaid = ~std::size_t{};

    void begin(Address at, Step step) noexcept TAPPET_REALTIME {
        at_ = at;
        step_ = step;
        state_ = State::busy;
        to_send_ = true;
        toggle_ = 0;
        moved_ = 0;
        why_ = SdoAbort::none;
    }
    void end(State state, SdoAbort why) noexcept TAPPET_REALTIME {
        state_ = state;
        why_ = why;
        to_send_ = false;
    }
    /// Aborts the transfer from this side, and tells the server.
    void fail(SdoAbort why) noexcept TAPPET_REALTIME {
        end(State::aborted, why);
        to_send_ = true;
    }
    /// Returns true for a late confirmation of an earlier request. The confirmation of a new transfer states
    /// its object, and differs for read and write.
    [[nodiscard]] bool is_of_before(const sdo::Payload& answer, unsigned command) const noexcept
        TAPPET_REALTIME {
        const bool is_initiate = command == 2 || command == 3;
        if (step_ == Step::read_segment || step_ == Step::write_segment) return is_initiate;
        const bool is_own = step_ == Step::initiate_read ? command == 2 : command == 3;
        return sdo::address_in(answer) != at_ || (is_initiate && !is_own);
    }
    void begin_reading(const sdo::Payload& answer, unsigned command) noexcept TAPPET_REALTIME {
        if (command != 2) return fail(SdoAbort::unknown_command);
        const bool expedited = (answer[0] & 2u) != 0;
        const bool says_size = (answer[0] & 1u) != 0;
        if (expedited) {
            size_ = says_size ? 4u - (answer[0] >> 2 & 3u) : 4u;
            for (std::size_t i = 0; i < size_; ++i) bytes_[i] = answer[4 + i];
            return end(State::done, SdoAbort::none);
        }
        const std::uint64_t size = from_bytes(std::span{answer}.subspan(4, 4));
        if (says_size && size > sdo::most_bytes) return fail(SdoAbort::out_of_memory);
        announced_ = says_size ? static_cast<std::size_t>(size) : unsaid;
        step_ = Step::read_segment;
        to_send_ = true;
    }
    void take_segment(const sdo::Payload& answer, unsigned command) noexcept TAPPET_REALTIME {
        if (command != 0) return fail(SdoAbort::unknown_command);
        if ((answer[0] >> 4 & 1u) != toggle_) return fail(SdoAbort::toggle_bit);
        toggle_ ^= 1u;
        const std::size_t count = sdo::in_segment - (answer[0] >> 1 & 7u);
        if (size_ + count > sdo::most_bytes) return fail(SdoAbort::out_of_memory);
        for (std::size_t i = 0; i < count; ++i) bytes_[size_ + i] = answer[1 + i];
        size_ += count;
        const bool is_last = (answer[0] & 1u) != 0;
        // A segment without a byte could repeat for ever.
        if (is_last ? announced_ != unsaid && announced_ != size_ : count == 0)
            return fail(SdoAbort::unknown_command);
        if (is_last) return end(State::done, SdoAbort::none);
        to_send_ = true;
    }
    void put_segment(sdo::Payload& request) noexcept TAPPET_REALTIME {
        const std::size_t left = size_ - moved_;
        const std::size_t count = left < sdo::in_segment ? left : sdo::in_segment;
        const auto unused = static_cast<unsigned>(sdo::in_segment - count);
        request = {};
        request[0] = static_cast<std::uint8_t>(toggle_ << 4 | unused << 1 | (count == left ? 1u : 0u));
        for (std::size_t i = 0; i < count; ++i) request[1 + i] = bytes_[moved_ + i];
        moved_ += count;
    }

    Address at_{};
    Step step_ = Step::initiate_read;
    State state_ = State::idle;
    bool to_send_ = false;
    unsigned toggle_ = 0;
    SdoAbort why_ = SdoAbort::none;
    std::size_t size_ = 0;
    std::size_t moved_ = 0;
    std::size_t announced_ = unsaid; ///< of a segmented read
    Duration time_out_ = 100ms;
    Time sent_at_{};
    std::array<std::uint8_t, sdo::most_bytes> bytes_{};
};

} // namespace tappet::canopen
