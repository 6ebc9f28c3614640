// Messages from one node to another over a wire that may lose or repeat them. Each message is served at most
// once, in order, and both ends know each loss within the time that the message has. Only one is in progress
// at a time, so that the wire's load is what its row says.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace tappet {

/// Identifies a pair of starts, one of each node: frames of other sessions are ignored.
constexpr std::uint8_t session_of(std::uint16_t sender, std::uint16_t receiver) noexcept TAPPET_REALTIME {
    const std::uint32_t mixed = (sender * 0x9E37'79B1u) ^ (receiver * 0x85EB'CA77u);
    return static_cast<std::uint8_t>((mixed >> 24) ^ (mixed >> 12));
}

/// The meaning of a channel's frame.
enum class ChannelWord : std::uint8_t {
    message,  ///< a message with its bytes
    given_up, ///< this message, and every earlier one without an answer, will not be sent again
    taken     ///< the answer: every message up to this one was served or is known to be lost
};

/// Written by the sender's activity alone. Each offered message is in the end delivered, lost, or unknown:
/// its session ended before its answer, and it may have been served or not.
struct SendCounts {
    std::uint64_t offered = 0;
    std::uint64_t delivered = 0; ///< served at the other end
    std::uint64_t lost = 0;      ///< known to be lost at both ends
    std::uint64_t unknown = 0;
    std::uint64_t given_up = 0; ///< no answer within their time; their fate is reported later
    std::uint64_t repeated = 0; ///< frames
    bool operator==(const SendCounts&) const = default;
};
struct ReceiveCounts {
    std::uint64_t served = 0, lost = 0;
    std::uint64_t repeated = 0; ///< frames
    bool operator==(const ReceiveCounts&) const = default;
};

/// The sending end. All of it real-time.
class ChannelSender {
public:
    static constexpr std::size_t most_bytes = 58;
    /// Numbers have 8 bits: with more unanswered messages, new ones could be taken for old ones.
    static constexpr std::uint8_t most_unanswered = 100;
    enum class State : std::uint8_t { idle, sends, gives_up };

    struct Frame {
        ChannelWord word{};
        std::uint8_t number = 0;
        std::span<const std::uint8_t> bytes{};
    };

    /// A message is repeated after `again`, but not later than `sent_by`, and given up after `within`.
    constexpr void configure(Duration within, Duration again, Duration sent_by) noexcept {
        within_ = within, again_ = again, sent_by_ = sent_by;
    }

    /// Begins a new session with the other end.
    constexpr void begin() noexcept TAPPET_REALTIME {
        count.unknown += unanswered();
        state_ = State::idle;
        number_ = answered_ = lost_answered_ = 0;
    }
    /// Gives up the message in progress because the other end is silent: it waits for no answer. Its fate is
    /// requested when the other end is heard again.
    constexpr void give_up() noexcept TAPPET_REALTIME {
        if (state_ != State::sends) return;
        ++count.given_up;
        state_ = State::gives_up;
    }
    /// Whether offer() accepts a message.
    [[nodiscard]] constexpr bool is_free() const noexcept TAPPET_REALTIME {
        return state_ != State::sends && unanswered() < most_unanswered;
    }
    /// Offers a message. `since`: when its event was emitted; its time runs from then.
    constexpr void offer(std::span<const std::uint8_t> bytes, Time since) noexcept TAPPET_REALTIME {
        length_ = static_cast<std::uint8_t>(std::min(bytes.size(), most_bytes));
        std::copy_n(bytes.begin(), length_, bytes_.begin());
        ++number_;
        ++count.offered;
        state_ = State::sends;
        ends_ = since + within_;
        last_ = since + sent_by_;
        was_sent_ = false;
    }
    /// Returns when due() has work.
    [[nodiscard]] constexpr Time next() const noexcept TAPPET_REALTIME {
        if (state_ == State::idle) return never;
        if (state_ == State::gives_up) return may_send_;
        return may_send_ <= last_ ? std::min(may_send_, ends_) : ends_;
    }
    /// Returns the frame to send at `now`, if any. Two frames of a channel are at least `again` apart.
    [[nodiscard]] constexpr bool due(Time now, Frame& frame) noexcept TAPPET_REALTIME {
        if (now >= ends_) give_up();
        if (state_ == State::idle || now < may_send_) return false;
        const bool sends = state_ == State::sends;
        if (sends && now > last_) return false; // it would be served after its time
        if (was_sent_) ++count.repeated;
        was_sent_ = true;
        may_send_ = now + again_;
        frame = {sends ? ChannelWord::message : ChannelWord::given_up, number_,
                 std::span{bytes_}.first(sends ? length_ : 0)};
        return true;
    }
    /// Accepts an answer: the other end knows the fate of every message up to `number`; `lost` of them were
    /// lost in this session, modulo 256.
    constexpr void taken(std::uint8_t number, std::uint8_t lost) noexcept TAPPET_REALTIME {
        const auto ahead = static_cast<std::uint8_t>(number - answered_);
        const auto newly_lost = static_cast<std::uint8_t>(lost - lost_answered_);
        if (ahead == 0 || ahead > unanswered() || newly_lost > ahead) return; // an old one
        count.delivered += static_cast<std::uint64_t>(ahead - newly_lost);
        count.lost += newly_lost;
        answered_ = number, lost_answered_ = lost;
        if (number == number_) state_ = State::idle;
    }
    /// Returns the number of the message that was offered last.
    [[nodiscard]] constexpr std::uint8_t number() const noexcept TAPPET_REALTIME { return number_; }
    [[nodiscard]] constexpr State state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] constexpr std::uint8_t unanswered() const noexcept TAPPET_REALTIME {
        return static_cast<std::uint8_t>(number_ - answered_);
    }

    SendCounts count{};

private:
    Duration within_{}, again_{}, sent_by_{};
    std::array<std::uint8_t, most_bytes> bytes_{};
    std::uint8_t length_ = 0;
    std::uint8_t number_ = 0, answered_ = 0, lost_answered_ = 0;
    State state_ = State::idle;
    bool was_sent_ = false;
    Time ends_{}, last_{};
    Time may_send_ = Time::min();
};

/// The serving end. All of it real-time.
class ChannelReceiver {
public:
    constexpr void begin() noexcept TAPPET_REALTIME { last_ = lost_ = 0; }
    /// Accepts a frame; returns whether to serve its message. In any case, answer with last() and lost().
    [[nodiscard]] constexpr bool take(ChannelWord word, std::uint8_t number) noexcept TAPPET_REALTIME {
        const auto ahead = static_cast<std::int8_t>(number - last_);
        if (ahead <= 0) {
            ++count.repeated;
            return false;
        }
        const bool serves = word == ChannelWord::message;
        const auto lost = static_cast<std::uint8_t>(ahead - (serves ? 1 : 0));
        count.lost += lost;
        lost_ = static_cast<std::uint8_t>(lost_ + lost);
        count.served += serves ? 1 : 0;
        last_ = number;
        return serves;
    }
    [[nodiscard]] constexpr std::uint8_t last() const noexcept TAPPET_REALTIME { return last_; }
    [[nodiscard]] constexpr std::uint8_t lost() const noexcept TAPPET_REALTIME { return lost_; }

    ReceiveCounts count{};

private:
    std::uint8_t last_ = 0, lost_ = 0;
};

} // namespace tappet
