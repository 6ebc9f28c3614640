// The manager's state of one node: from boot-up through configuration to operation, and back when it is lost
// (CiA 301, 7.3.2; CiA 302-2, boot NMT slave).
#pragma once

#include "drivers/canopen/frames.hpp"
#include "drivers/canopen/sdo_client.hpp"

namespace tappet::canopen {

enum class NodePhase : std::uint8_t {
    absent,      ///< not heard yet
    configuring, ///< its identity is checked, its configuration written and read back
    starting,    ///< has been sent the start command
    operational,
    lost,    ///< its heartbeat is missing, it answers no request, or cannot do so now: it is polled
    refused, ///< another device, or it rejects its configuration: until it boots again
};

/// The reason why a node does not work.
struct NodeTrouble {
    enum class Kind : std::uint8_t {
        none,
        silent,
        no_answer,
        rebooted,
        left,
        other_device,
        aborted,
        not_kept
    };
    Kind kind = Kind::none;
    std::uint16_t step = 0; ///< index in the network's steps, if any
    SdoAbort why = SdoAbort::none;
    std::uint64_t found = 0;
    bool operator==(const NodeTrouble&) const = default;
};

/// The facts about a node that the manager needs at run time.
struct WatchedNode {
    std::uint8_t id = 0;
    std::string_view name{}, product{}, file{};
    Duration beats{}, lost_after{}, answers_within{};
};

/// Real-time; each call takes bounded time.
class NodeWatch {
public:
    static constexpr Duration poll_every = 1s; ///< for a node that is not heard
    static constexpr int most_tries = 3;       ///< of an unanswered or temporarily aborted transfer

    /// Resets everything; `steps` are those of this node, the first of them has number `first`.
    void start(const WatchedNode& row, std::span<const ConfigurationStep> steps, std::size_t first,
               Time now) noexcept TAPPET_REALTIME {
        row_ = &row;
        steps_ = steps;
        first_ = first;
        client_.set_time_out(row.answers_within);
        client_.forget();
        phase_ = NodePhase::absent;
        trouble_ = {};
        command_ = {};
        heard_ = NmtState::boot_up;
        poll_at_ = now + poll_every;
    }

    [[nodiscard]] NodePhase phase() const noexcept TAPPET_REALTIME { return phase_; }
    [[nodiscard]] const NodeTrouble& trouble() const noexcept TAPPET_REALTIME { return trouble_; }
    [[nodiscard]] std::uint64_t reboots() const noexcept TAPPET_REALTIME { return reboots_; }

    void take_heartbeat(std::uint8_t byte, Time now) noexcept TAPPET_REALTIME {
        const auto state = static_cast<NmtState>(byte & 0x7Fu); // the highest bit belongs to node guarding
        heard_ = state;
        heard_at_ = now;
        if (state == NmtState::boot_up) {
            if (phase_ == NodePhase::operational || phase_ == NodePhase::starting) {
                ++reboots_;
                trouble_ = {.kind = NodeTrouble::Kind::rebooted};
            }
            return configure();
        }
        switch (phase_) {
        case NodePhase::absent:
        case NodePhase::lost: // one that could not be configured is retried later
            if (trouble_.kind != NodeTrouble::Kind::aborted) configure();
            break;
        case NodePhase::starting:
            if (state != NmtState::operational) break;
            phase_ = NodePhase::operational;
            trouble_ = {};
            break;
        case NodePhase::operational:
            if (state == NmtState::operational) break;
            trouble_ = {.kind = NodeTrouble::Kind::left};
            configure();
            break;
        case NodePhase::refused:
            if (state == NmtState::operational) command(NmtCommand::enter_pre_operational);
            break;
        case NodePhase::configuring: break;
        }
    }
    void take_answer(const sdo::Payload& answer) noexcept TAPPET_REALTIME { client_.take(answer); }

    void tick(Time now) noexcept TAPPET_REALTIME {
        client_.tick(now);
        switch (phase_) {
        case NodePhase::absent:
        case NodePhase::lost:
            if (now >= poll_at_) {
                heard_ = NmtState::pre_operational;
                configure();
            }
            break;
        case NodePhase::configuring: go_on(now); break;
        case NodePhase::starting:
            if (now >= start_again_) {
                command(NmtCommand::start);
                start_again_ = now + 2 * row_->beats;
            }
            [[fallthrough]];
        case NodePhase::operational:
            if (now - heard_at_ > row_->lost_after) lose({.kind = NodeTrouble::Kind::silent}, now);
            break;
        case NodePhase::refused: break;
        }
    }

    /// Returns the NMT command for this node that must be sent before anything else.
    [[nodiscard]] bool next_command(NmtCommand& command) noexcept TAPPET_REALTIME {
        if (!command_.wanted) return false;
        command_.wanted = false;
        command = command_.what;
        return true;
    }
    /// Returns the next request: not while a command is pending, and not sooner after the last one than the
    /// bus is proven for.
    [[nodiscard]] bool next_request(sdo::Payload& request, Time now) noexcept TAPPET_REALTIME {
        if (command_.wanted || now < may_request_ || !client_.next(request, now)) return false;
        may_request_ = now + requests_apart;
        return true;
    }

private:
    struct Command {
        bool wanted = false;
        NmtCommand what = NmtCommand::start;
    };

    void command(NmtCommand what) noexcept TAPPET_REALTIME { command_ = {true, what}; }
    void configure() noexcept TAPPET_REALTIME {
        if (heard_ == NmtState::operational || heard_ == NmtState::stopped)
            command(NmtCommand::enter_pre_operational); // its PDOs may differ from the map
        client_.forget();
        phase_ = NodePhase::configuring;
        step_ = 0;
        tries_ = 0;
    }
    void lose(const NodeTrouble& why, Time now) noexcept TAPPET_REALTIME {
        phase_ = NodePhase::lost;
        trouble_ = why;
        poll_at_ = now + poll_every;
    }
    void refuse(NodeTrouble::Kind kind, std::uint64_t found = 0) noexcept TAPPET_REALTIME {
        phase_ = NodePhase::refused;
        trouble_ = trouble_of(kind, found);
    }
    [[nodiscard]] NodeTrouble trouble_of(NodeTrouble::Kind kind, std::uint64_t found = 0) const noexcept
        TAPPET_REALTIME {
        return {kind, static_cast<std::uint16_t>(first_ + step_), client_.why(), found};
    }

    void go_on(Time now) noexcept TAPPET_REALTIME {
        using State = SdoClient::State;
        switch (client_.state()) {
        case State::busy: return;
        case State::aborted:
            if (client_.has_abort_to_send()) return;
            if (!passes(client_.why())) return refuse(NodeTrouble::Kind::aborted);
            if (++tries_ < most_tries) return begin_step();
            return lose(client_.why() == SdoAbort::time_out
                            ? NodeTrouble{.kind = NodeTrouble::Kind::no_answer}
                            : trouble_of(NodeTrouble::Kind::aborted),
                        now);
        case State::done:
            if (const ConfigurationStep& step = steps_[step_]; step.kind != ConfigurationStep::Kind::write) {
                const std::uint64_t found = low_bits(from_bytes(client_.value()), 8u * step.bytes);
                if (found != step.value)
                    return refuse(step.kind == ConfigurationStep::Kind::identity
                                      ? NodeTrouble::Kind::other_device
                                      : NodeTrouble::Kind::not_kept,
                                  found);
            }
            ++step_;
            tries_ = 0;
            break;
        case State::idle: break;
        }
        if (step_ < steps_.size()) return begin_step();
        client_.forget();
        phase_ = NodePhase::starting;
        heard_at_ = start_again_ = now;
    }
    void begin_step() noexcept TAPPET_REALTIME {
        const ConfigurationStep& step = steps_[step_];
        if (step.kind != ConfigurationStep::Kind::write) return client_.read(step.at);
        std::array<std::uint8_t, 8> bytes{};
        to_bytes(step.value, bytes);
        client_.write(step.at, std::span{bytes}.first(step.bytes < bytes.size() ? step.bytes : bytes.size()));
    }

    const WatchedNode* row_ = nullptr;
    std::span<const ConfigurationStep> steps_{};
    std::size_t first_ = 0;
    std::size_t step_ = 0;
    int tries_ = 0;
    SdoClient client_{};
    NodePhase phase_ = NodePhase::absent;
    NodeTrouble trouble_{};
    Command command_{};
    NmtState heard_ = NmtState::boot_up;
    Time heard_at_{};
    Time poll_at_{};
    Time start_again_{};
    Time may_request_{};
    std::uint64_t reboots_ = 0;
};

} // namespace tappet::canopen

template <>
inline constexpr auto tappet::names_of<tappet::canopen::NodePhase> =
    std::array<std::string_view, 6>{"absent", "configuring", "starting", "operational", "lost", "refused"};
