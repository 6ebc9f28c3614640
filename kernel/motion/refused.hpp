// Reasons why kernel/motion could not compute a result: an error of operation, as a value.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::motion {

enum class Refusal : std::uint8_t {
    not_a_number,
    limit_not_positive,
    out_of_reach,
    outside_limits,
    not_converged,
    no_direction,
    beyond_half_rate,
    not_positive,
    outlier,
    wrong_state,
};

/// Returns the reason and its cure. Real-time.
constexpr std::string_view to_text(Refusal why) noexcept TAPPET_REALTIME {
    switch (why) {
    case Refusal::not_a_number: return "a value is not a finite number; check values where they enter";
    case Refusal::limit_not_positive: return "a limit is not positive; give each one a value above 0";
    case Refusal::out_of_reach:
        return "no joint positions reach the target; choose one that is nearer, or further from the base";
    case Refusal::outside_limits:
        return "it lies outside the joint's limits; choose another target or branch";
    case Refusal::not_converged: return "it did not converge within its steps; begin nearer to the target";
    case Refusal::no_direction:
        return "the points leave a direction open; choose three that are apart and not on one line";
    case Refusal::beyond_half_rate:
        return "a frequency is not between 0 and half of the sampling rate; sample faster";
    case Refusal::not_positive:
        return "a covariance is not positive definite; give each measurement a variance above 0";
    case Refusal::outlier:
        return "it is further from the expected value than the gate allows; check its source";
    case Refusal::wrong_state:
        return "the axis does not take this command in its state; bring it to standstill, or reset it";
    }
    return "?";
}

/// The failed computation, and its axis, joint or point, counted from zero.
struct Refused {
    Refusal why;
    int element = 0;
    constexpr bool operator==(const Refused&) const = default;
};

/// Returns "element 2: a limit is not positive; give ...". For people, not for a cycle.
inline Sentence describe(const Refused& refused) noexcept {
    return Sentence{"element ", refused.element, ": ", to_text(refused.why)};
}

using tappet::is_number;

} // namespace tappet::motion
