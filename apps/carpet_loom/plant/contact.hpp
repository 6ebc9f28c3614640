// A contact wired to an input of the machine: its level, its bouncing, and its edges, each with its time.
#pragma once

#include "apps/carpet_loom/plant/outbox.hpp"
#include "kernel/base/digest.hpp"
#include "kernel/base/random.hpp"

#include <algorithm>

namespace tappet::loom {

struct Edge {
    unsigned line = 0; // wires::line
    bool level = false;
    Time at;
};

/// Keeps a digest of every edge, fetched or not.
class EdgeOutbox : public Outbox<Edge, 128> {
public:
    constexpr void push(const Edge& edge) noexcept TAPPET_REALTIME {
        log_.add(to_ns(edge.at));
        log_.add(std::uint64_t{edge.line} * 2 + (edge.level ? 1 : 0));
        Outbox::push(edge);
    }
    [[nodiscard]] constexpr const Digest& log() const noexcept TAPPET_REALTIME { return log_; }

private:
    Digest log_;
};

class Contact {
public:
    constexpr Contact(unsigned line, bool bounces) noexcept TAPPET_REALTIME : line_(line),
                                                                              bounces_(bounces) {}

    [[nodiscard]] bool level() const noexcept TAPPET_REALTIME { return level_; }
    [[nodiscard]] bool closed() const noexcept TAPPET_REALTIME { return wanted_; }
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME { return std::min(flip_at_, open_at_); }

    /// Opens or closes the contact now; a closed one opens again at `open_at`.
    void set(bool closed, Time now, Random& random, EdgeOutbox& out, Time open_at = never) noexcept
        TAPPET_REALTIME {
        open_at_ = closed ? open_at : never;
        if (closed == wanted_) return;
        wanted_ = closed;
        if (level_ != wanted_) flip(now, out);
        // An even number of flips follows, so that the contact ends at its commanded level.
        flips_left_ = bounces_ ? 2 * static_cast<int>(random.below(3)) : 0;
        flip_at_ = flips_left_ > 0 ? after(now, random) : never;
    }
    void tick(Time now, Random& random, EdgeOutbox& out) noexcept TAPPET_REALTIME {
        if (flip_at_ <= now) {
            const Time at = flip_at_;
            flip(at, out);
            flip_at_ = --flips_left_ > 0 ? after(at, random) : never;
        }
        if (open_at_ <= now) {
            const Time at = open_at_;
            set(false, at, random, out);
        }
    }

private:
    void flip(Time at, EdgeOutbox& out) noexcept TAPPET_REALTIME {
        level_ = !level_;
        out.push({line_, level_, at});
    }
    static Time after(Time now, Random& random) noexcept TAPPET_REALTIME {
        return now + Duration{random.between(50'000, 400'000)};
    }

    unsigned line_;
    bool bounces_;
    bool level_ = false;
    bool wanted_ = false;
    int flips_left_ = 0;
    Time flip_at_ = never;
    Time open_at_ = never;
};

} // namespace tappet::loom
