// The machine's map says what a frame may contain.
#include "drivers/can/simulated_frames.hpp"

#include <cmath>
#include <limits>

namespace tappet::can {

namespace {

WireNumbers numbers_of(const Signal& signal) {
    if (signal.has_range) return {signal.least, signal.most, std::abs(signal.factor)};
    constexpr double largest_float = std::numeric_limits<float>::max();
    const double wide = std::ldexp(1.0, static_cast<int>(signal.bits));
    const auto between = [&signal](double low, double high) {
        return WireNumbers::between(low * signal.factor + signal.offset, high * signal.factor + signal.offset,
                                    std::abs(signal.factor));
    };
    switch (signal.kind) {
    case Kind::unsigned_integer: return between(0, wide - 1);
    case Kind::signed_integer: return between(-wide / 2, wide / 2 - 1);
    default: return between(-largest_float, largest_float);
    }
}

} // namespace

SentFrames::SentFrames(std::string_view bus, const Identifiers& map) : bus_{bus}, map_{&map} {
    for (const FrameRow& row : map.frames)
        if (row.direction == Direction::transmit) sent_.push_back({&row});
}

std::vector<WireOutput> SentFrames::outputs() const {
    std::vector<WireOutput> all;
    for (const Sent& sent : sent_)
        for (const Signal& signal : signals_of(*sent.row)) {
            WireOutput output{.name = std::string{sent.row->name} + "." + std::string{signal.name},
                              .is_switch = signal.bits == 1,
                              .settles = sent.row->every,
                              .goes_in = static_cast<std::size_t>(sent.row - map_->frames.data())};
            // A multiplexed frame, or one that selects others, goes out in turns.
            if (sent.row->every > Duration{} && !signal.is_bits && !sent.row->multiplexed) {
                output.numbers = numbers_of(signal);
                output.physical = [&signal](std::uint64_t raw) { return to_physical(signal, raw); };
            }
            if (signal.says_safe) output.safe = to_raw(signal, signal.safe_value).bits;
            output.read = [this, &sent, &signal](Time now) { return read(sent, signal, now); };
            all.push_back(std::move(output));
        }
    return all;
}

std::optional<std::uint64_t> SentFrames::read(const Sent& sent, const Signal& signal, Time now) const {
    if (!sent.last || !is_in(*sent.row, signal, *sent.last)) return {};
    // A silent wire is the receiver's to detect.
    if (sent.row->every > Duration{} && now - sent.last->stamp > usual_settling) return {};
    return extract(sent.last->data, signal);
}

/// Returns whether a signal is in its frame: the selecting signal must have one of its values.
bool SentFrames::is_in(const FrameRow& row, const Signal& signal, const Frame& frame) const {
    if (signal.multiplexor.empty()) return true;
    for (const Signal& each : signals_of(row))
        if (each.name == signal.multiplexor)
            return is_in(row, each, frame) && signal.is_selected_by(extract(frame.data, each));
    return false;
}

void SentFrames::hear(const Frame& frame) {
    for (Sent& sent : sent_) {
        if (sent.row->identifier != Identifier{frame.id, frame.extended}) continue;
        sent.last = frame;
        for (const Signal& signal : signals_of(*sent.row))
            if (is_in(*sent.row, signal, frame)) judge(*sent.row, signal, frame);
    }
}

void SentFrames::judge(const FrameRow& row, const Signal& signal, const Frame& frame) {
    const std::uint64_t raw = extract(frame.data, signal);
    const double value = to_physical(signal, raw), rounding = std::abs(signal.factor);
    const bool is_named = is_integer(signal) && signal.has_name(to_integer(signal, raw));
    const bool is_safe = signal.says_safe && raw == to_raw(signal, signal.safe_value).bits;
    Sentence text{"\"", bus_, "\": ", row.name, ".", signal.name, " is sent "};
    if (!std::isfinite(value))
        fault_ = text.add("and is not a number");
    else if (signal.has_range && !is_named && !is_safe &&
             (value < signal.least - rounding || value > signal.most + rounding))
        fault_ = text.add("as ").add(std::int64_t{std::llround(value)}).add(", outside its range");
}

} // namespace tappet::can
