// Priorities and identifiers of a wire's frames: by deadlines, or fixed ones that no other row changes.
#pragma once

#include "kernel/base/digest.hpp"
#include "kernel/system/frames.hpp"

#include <algorithm>
#include <bit>

namespace tappet::systems {

constexpr std::uint16_t folded(const Digest& digest) noexcept {
    const std::uint64_t value = digest.value();
    return static_cast<std::uint16_t>(value ^ value >> 16 ^ value >> 32 ^ value >> 48);
}
constexpr void add_text(Digest& digest, std::string_view text) noexcept {
    for (const char each : text) digest.add(std::uint64_t{static_cast<unsigned char>(each)});
    digest.add(std::uint64_t{text.size()});
}

/// Moves each frame to its new place; the places of crossings follow.
template <std::size_t N, std::size_t X>
constexpr void renumber(SystemPlan<N, X>& plan, std::span<const std::size_t> new_place) {
    const auto moved = [&](std::size_t& frame) {
        if (frame != nowhere) frame = new_place[frame];
    };
    for (CrossingPlace& place : plan.place) {
        moved(place.frame), moved(place.answer), moved(place.reply), moved(place.received);
    }
    const auto before = plan.frames;
    for (std::size_t f = 0; f < before.size(); ++f) plan.frames[new_place[f]] = before[f];
}

/// Returns a digest of a frame's identity, independent of the other rows of the table.
template <std::size_t N, std::size_t X>
constexpr Digest key_of(const SystemView& s, const SystemPlan<N, X>& plan, std::size_t f) {
    const WireFrame& frame = plan.frames[f];
    Digest key;
    add_text(key, s.name);
    add_text(key, s.nodes[frame.node].name);
    // Both frames of the clock share one identifier.
    key.add(static_cast<std::uint64_t>(frame.is_of_clock() ? WireFrameKind::sync : frame.kind));
    if (frame.kind == WireFrameKind::data) {
        std::uint64_t before = 0;
        for (std::size_t i = 0; i < f; ++i)
            if (plan.frames[i].kind == WireFrameKind::data && plan.frames[i].node == frame.node &&
                plan.frames[i].apart == frame.apart)
                ++before;
        key.add(static_cast<std::uint64_t>(frame.apart.count()));
        key.add(before);
    } else if (frame.crossing != nowhere) {
        key.add(std::uint64_t{plan.index[frame.crossing].name});
    }
    return key;
}

/// Returns an identifier of 29 bits: the urgency, in 32 steps an octave of the time until the next frame may
/// follow, and the frame's key. Its deadline is not used: it depends on the activities of its readers.
constexpr std::uint32_t fixed_identifier(const WireFrame& frame, std::uint64_t key) noexcept {
    constexpr unsigned steps_bits = 5, key_bits = 18;
    const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(frame.apart.count() / 1000, 1));
    const unsigned octave = static_cast<unsigned>(std::bit_width(us)) - 1;
    const std::uint64_t step =
        (octave >= steps_bits ? us >> (octave - steps_bits) : us << (steps_bits - octave)) &
        ((1u << steps_bits) - 1);
    const bool goes_first = frame.kind == WireFrameKind::beat || frame.is_of_clock();
    const std::uint64_t urgency = goes_first ? 0 : std::uint64_t{octave} << steps_bits | step;
    return static_cast<std::uint32_t>(urgency << key_bits |
                                      ((key ^ key >> 23 ^ key >> 46) & ((1u << key_bits) - 1)));
}

/// Assigns priorities: deadline-monotonic first, which is right for most systems. Where that fails, Audsley's
/// assignment (1991): the lowest place goes to a frame that meets its deadline there, then the next lowest.
/// Returns the first frame that misses its deadline, or the number of frames.
template <std::size_t N, std::size_t X>
constexpr std::size_t assign(const SystemView& s, SystemPlan<N, X>& plan, WireAnalysis analysis) {
    const std::size_t count = plan.frames.size();
    const bool is_fixed = s.wire.fixed_identifiers;
    const std::size_t go_first = N + (s.wire.has_clock() ? 2 : 0);
    std::array<std::size_t, SystemPlan<N, X>::most_frames> order{}, new_place{};
    for (std::size_t f = 0; f < count; ++f) order[f] = f;
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
              [&](std::size_t a, std::size_t b) {
                  const WireFrame &l = plan.frames[a], &r = plan.frames[b];
                  if (is_fixed) return l.id != r.id ? l.id < r.id : a < b;
                  // Beats have identifiers that no row changes: other versions hear them, too.
                  if ((a < go_first) != (b < go_first)) return a < go_first;
                  if (a < go_first) return a < b;
                  return l.deadline != r.deadline ? l.deadline < r.deadline : a < b;
              });
    auto trial = plan.frames;
    const auto tries = [&] {
        for (std::size_t f = 0; f < count; ++f) trial[f] = plan.frames[order[f]];
        return analysis(s, std::span{trial.items}.first(count));
    };
    std::size_t bad = tries();
    if (bad < count && !is_fixed) {
        const auto monotonic = order;
        const std::size_t first_bad = order[bad];
        // A frame that fails in the best place fails in every place: one trial shows it, not n^2.
        bool may_help = bad > go_first;
        if (may_help) {
            const auto from = order.begin() + static_cast<std::ptrdiff_t>(go_first);
            std::rotate(from, order.begin() + static_cast<std::ptrdiff_t>(bad),
                        order.begin() + static_cast<std::ptrdiff_t>(bad) + 1);
            static_cast<void>(tries());
            may_help = trial[go_first].worst <= trial[go_first].deadline;
            order = monotonic;
        }
        for (std::size_t level = count; may_help && level-- > go_first;) {
            bool found = false;
            for (std::size_t candidate = level + 1; candidate-- > go_first && !found;) {
                std::rotate(order.begin() + static_cast<std::ptrdiff_t>(candidate),
                            order.begin() + static_cast<std::ptrdiff_t>(candidate) + 1,
                            order.begin() + static_cast<std::ptrdiff_t>(level) + 1);
                static_cast<void>(tries());
                found = trial[level].worst <= trial[level].deadline;
                if (!found)
                    std::rotate(order.begin() + static_cast<std::ptrdiff_t>(candidate),
                                order.begin() + static_cast<std::ptrdiff_t>(level),
                                order.begin() + static_cast<std::ptrdiff_t>(level) + 1);
            }
            if (!found) break;
        }
        bad = tries();
        if (bad < count) {
            order = monotonic;
            static_cast<void>(tries());
            bad = first_bad;
        }
    }
    for (std::size_t f = 0; f < count; ++f) new_place[order[f]] = f;
    const std::size_t answer = bad < count ? new_place[bad] : count;
    for (std::size_t f = 0; f < count; ++f) plan.frames[order[f]] = trial[f];
    renumber(plan, std::span{new_place}.first(count));
    return answer;
}

} // namespace tappet::systems
