// No table: identifiers and positions of bits are in the code.
#include "tests/figures/wire/bare.hpp"

#include <cmath>
#include <cstring>

namespace tappet::figures::bare {

namespace {

constexpr unsigned counters = 15;

constexpr std::array<std::uint8_t, 256> sums = [] {
    std::array<std::uint8_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        unsigned sum = i;
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 0x80U) != 0 ? sum << 1 ^ 0x1DU : sum << 1;
        table[i] = static_cast<std::uint8_t>(sum);
    }
    return table;
}();
std::uint8_t sum_of(const can::Frame& frame, std::uint16_t id) {
    std::uint8_t sum = sums[sums[id & 0xFFU] ^ id >> 8];
    for (std::size_t i = 1; i < frame.length; ++i) sum = sums[sum ^ frame.data[i]];
    return sum;
}
/// The bits from 12 on, behind checksum and counter.
void send(can::Device& device, std::uint32_t frame_id, std::uint16_t data_id, std::uint8_t& counter,
          std::uint64_t bits, std::uint8_t length, Time now) {
    can::Frame frame;
    frame.id = frame_id;
    frame.length = length;
    frame.stamp = now;
    const std::uint64_t word = bits << 12 | std::uint64_t{counter} << 8;
    counter = static_cast<std::uint8_t>((counter + 1U) % counters);
    std::memcpy(frame.data.data(), &word, sizeof word);
    frame.data[0] = sum_of(frame, data_id);
    static_cast<void>(device.send(frame, can::Keep::every));
    device.service(now);
}
enum class Seen : std::uint8_t { wrong, again, usable };
Seen look_at(const can::Frame& frame, std::uint16_t data_id, std::uint8_t length, std::uint8_t& counter) {
    if (frame.length != length || frame.data[0] != sum_of(frame, data_id)) return Seen::wrong;
    const auto came = static_cast<std::uint8_t>(frame.data[1] & 0x0FU);
    if (came >= counters) return Seen::wrong;
    const bool again = came == counter;
    counter = came;
    return again ? Seen::again : Seen::usable;
}

} // namespace

void send_level(Sender& sender, Time now) {
    const double steps = std::floor(sender.level / 0.1 + 0.5);
    const double held = steps > 8388607.0 ? 8388607.0 : steps < -8388608.0 ? -8388608.0 : steps;
    const auto whole = static_cast<std::uint64_t>(static_cast<std::int64_t>(held)) & 0xFF'FFFFU;
    send(*sender.device, sender.level_frame, sender.level_data_id, sender.level_counter, whole << 1 | 1U, 5,
         now);
}

void send_full(Sender& sender, std::int32_t number, Time now) {
    ++sender.number;
    sender.waiting = number;
    sender.is_under_way = true;
    sender.repeats_at = now + 15ms, sender.ends_at = now + 30ms;
    const std::uint64_t bits = std::uint64_t{sender.number} << 4 | std::uint64_t{sender.session} << 12 |
                               std::uint64_t{static_cast<std::uint32_t>(number)} << 20;
    send(*sender.device, sender.full_frame, sender.full_data_id, sender.full_counter, bits, 8, now);
}

void serve(Sender& sender, Time now) {
    can::Frame frame;
    while (sender.device->receive(frame).what == can::Received::frame) {
        if (frame.id != sender.answer_frame) continue;
        if (look_at(frame, sender.answer_data_id, 5, sender.answer_counter) == Seen::wrong) {
            ++sender.refused;
            continue;
        }
        if (!sender.is_under_way || frame.data[2] != sender.number || frame.data[3] != sender.session)
            continue;
        sender.is_under_way = false;
        ++sender.delivered;
    }
    if (sender.is_under_way && now >= sender.ends_at) sender.is_under_way = false;
}

void serve(Receiver& receiver, Time now) {
    can::Frame frame;
    while (receiver.device->receive(frame).what == can::Received::frame) {
        if (frame.id == receiver.level_frame) {
            if (look_at(frame, receiver.level_data_id, 5, receiver.level_counter) == Seen::wrong) {
                ++receiver.refused;
                continue;
            }
            std::uint64_t word = 0;
            std::memcpy(&word, frame.data.data(), 5);
            if ((word >> 12 & 1U) == 0) continue;
            const auto steps = static_cast<std::int32_t>(static_cast<std::uint32_t>(word >> 13) << 8) >> 8;
            receiver.level = steps * 0.1;
            receiver.level_at = frame.stamp;
        } else if (frame.id == receiver.full_frame) {
            if (look_at(frame, receiver.full_data_id, 8, receiver.full_counter) == Seen::wrong) {
                ++receiver.refused;
                continue;
            }
            if (frame.data[3] != receiver.session) continue;
            if (frame.data[2] != receiver.number) {
                receiver.lost += static_cast<std::uint8_t>(frame.data[2] - receiver.number - 1U);
                receiver.number = frame.data[2];
                std::int32_t number = 0;
                std::memcpy(&number, &frame.data[4], sizeof number);
                receiver.take(number);
            }
            const std::uint64_t bits = std::uint64_t{receiver.number} << 4 |
                                       std::uint64_t{receiver.session} << 12 |
                                       static_cast<std::uint64_t>(receiver.lost & 0xFF) << 20;
            send(*receiver.device, receiver.answer_frame, receiver.answer_data_id, receiver.answer_counter,
                 bits, 5, now);
        }
    }
}

} // namespace tappet::figures::bare
