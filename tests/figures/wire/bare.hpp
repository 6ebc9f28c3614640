// The same on the wire without a framework, as one would write it by hand for these two rows: bits shifted
// into a frame, a checksum with a counter, the device; and back.
#pragma once

#include "tests/figures/wire/memory.hpp"

namespace tappet::figures::bare {

/// The identifiers by which both know the frames of the two rows.
struct Identifiers {
    std::uint32_t level_frame = 0, full_frame = 0, answer_frame = 0;
    std::uint16_t level_data_id = 0, full_data_id = 0, answer_data_id = 0;
};
struct Sender : Identifiers {
    can::Device* device = nullptr;
    double level = 0; ///< the value to send
    std::uint8_t level_counter = 0, full_counter = 0;
    std::uint8_t answer_counter = 0xFF;       ///< the last one that came
    std::uint8_t number = 0;                  ///< of the event
    std::uint8_t session = 1;                 ///< of this start of both
    std::int32_t waiting = 0;                 ///< the event's number
    bool is_under_way = false;                ///< it awaits its answer
    Time repeats_at = never, ends_at = never; ///< the next repetition, and the end of waiting
    std::int64_t delivered = 0, refused = 0;
};
struct Receiver : Identifiers {
    can::Device* device = nullptr;
    std::uint8_t level_counter = 0xFF, full_counter = 0xFF, answer_counter = 0;
    double level = 0;
    Time level_at{};
    std::uint8_t number = 0; ///< of the last event
    std::uint8_t session = 1;
    void (*take)(std::int32_t) = nullptr; ///< the receiver of the event
    std::int64_t lost = 0, refused = 0;
};

void send_level(Sender& sender, Time now);
void send_full(Sender& sender, std::int32_t number, Time now);
/// Handles arrived frames: answers at the sender, all others at the receiver, each event with its answer.
void serve(Sender& sender, Time now);
void serve(Receiver& receiver, Time now);

} // namespace tappet::figures::bare
