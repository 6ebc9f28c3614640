// The machine whose ports are measured: packets of 8, 160 and 4096 bytes. Each goes to a reader in the
// writer's activity and to one in another activity, as a last value and through a buffer.
#pragma once

#include "kernel/machine/worlds/virtual_world.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::figures {

template <std::size_t bytes>
struct Packet {
    std::array<std::uint64_t, bytes / 8> words{};
};

template <class T>
struct Writer {
    Output<T> near, far;
    BufferOutput<T> near_each, far_each;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(output<&Writer::near>("near", "", "the last one, for the own activity"),
                      output<&Writer::far>("far", "", "the last one, for another activity"),
                      output<&Writer::near_each>("near_each", "", "each of them"),
                      output<&Writer::far_each>("far_each", "", "each of them"));
    }
};

template <class T>
struct Reader {
    Input<T> last;
    BufferInput<T> each;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Reader::last>("last", "", "the last one"),
                      input<&Reader::each>("each", "", "each of them"));
    }
};

inline constexpr Board exchange_board{.name = "host",
                                      .world = "host",
                                      .memory_budget_bytes = 4'000'000,
                                      .processors = 2,
                                      .highest_priority = 40};

inline constexpr std::size_t queue_places = 16; ///< of each buffer, and of the peers' queues

// clang-format off
inline constexpr auto exchange_machine = machine("exchange",
    components(component<Writer<Packet<8>>>("writer_8"),       component<Writer<Packet<160>>>("writer_160"),
               component<Writer<Packet<4096>>>("writer_4096"), component<Reader<Packet<8>>>("near_8"),
               component<Reader<Packet<160>>>("near_160"),     component<Reader<Packet<4096>>>("near_4096"),
               component<Reader<Packet<8>>>("far_8"),          component<Reader<Packet<160>>>("far_160"),
               component<Reader<Packet<4096>>>("far_4096")),
    activities(activity("here",  every(1ms), runs("writer_8", "writer_160", "writer_4096", "near_8", "near_160", "near_4096"),
                        budget(10us)),
               activity("there", every(5ms), runs("far_8", "far_160", "far_4096"), budget(10us))),
    connections(data("writer_8.near", "near_8.last"),       data("writer_8.far", "far_8.last"),
                data("writer_160.near", "near_160.last"),   data("writer_160.far", "far_160.last"),
                data("writer_4096.near", "near_4096.last"), data("writer_4096.far", "far_4096.last"),
                buffer<queue_places>("writer_8.near_each", "near_8.each", reject_newest),
                buffer<queue_places>("writer_8.far_each", "far_8.each", reject_newest),
                buffer<queue_places>("writer_160.near_each", "near_160.each", reject_newest),
                buffer<queue_places>("writer_160.far_each", "far_160.each", reject_newest),
                buffer<queue_places>("writer_4096.near_each", "near_4096.each", reject_newest),
                buffer<queue_places>("writer_4096.far_each", "far_4096.each", reject_newest)),
    reactions(), behaviours());
// clang-format on

/// The components of one size, as the machine holds them.
template <std::size_t bytes>
struct Ends {
    static inline Writer<Packet<bytes>>* writer = nullptr;
    static inline Reader<Packet<bytes>>* near = nullptr;
    static inline Reader<Packet<bytes>>* far = nullptr;
};

/// Brings the machine to life and fills Ends.
void start_machine();

} // namespace tappet::figures
