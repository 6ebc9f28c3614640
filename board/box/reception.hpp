// SPDX-License-Identifier: Apache-2.0
// Handles the clients at a box's network port. Strangers can reach the port, too: all clients are served in
// parallel, none waits for another, and each uses little memory for a short time.
#pragma once

#include "board/box/service.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

/// Guarantees, whatever others send:
/// - A client is greeted at once, and answered when its request is complete. It keeps its place until 16
///   later clients have come. Clients of an address with more places are removed first, so that one address
///   cannot lock out the others.
/// - Only a header signed with the key takes the single place for updates; any other is refused before the
///   rest of its file is read. An update may be as slow as its line, but must not pause for 10 s. It gives
///   way to a newer version; when it is slower than 64 KiB/s after its first 5 s, also to another one of its
///   version.
/// - Memory: one update, and less than 5 KiB for each other client.
/// Not guaranteed: a signed header can be replayed. Somebody who recorded one of the same or a newer version
/// can take the place of a slow update with it, and hold that place. An update by stick is not affected.
class Reception {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;
    static constexpr std::size_t most_clients = 16;
    static constexpr std::chrono::seconds for_a_request{10}; ///< its line, then an update's header
    static constexpr std::chrono::seconds longest_pause{10}; ///< of an update
    static constexpr std::chrono::seconds for_goodbye{2};
    static constexpr double slow_bytes_per_s = 65536.0;

    /// `facts` must outlive it.
    explicit Reception(const ServiceFacts& facts) : facts_{facts} {}
    ~Reception();
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

    /// Greets a client and takes ownership of its socket.
    void greet(int socket, std::uint32_t address, Time now);
    /// Waits until a client sends something or a new one connects to `listener`, for a second at most.
    /// Returns whether a new one connected.
    [[nodiscard]] bool wait(int listener) const;
    /// Reads a piece from each client, and closes those that are late.
    void hear(Time now);

private:
    enum class Stage : std::uint8_t { line, header, kernel, goodbye, gone };
    struct Client {
        int socket = -1;
        std::uint32_t address = 0;
        Stage stage = Stage::line;
        Time since{};                              // start of its stage
        Time heard{};                              // last arrival
        std::string said{};                        // received in its stage; an update with its header
        std::uint64_t bytes = update_header_bytes; // of its update
        std::uint32_t version = 0;
    };

    void make_room();
    void take_from(Client& client, Time now);
    void advance(Client& client, Time now);
    void take_line(Client& client, Time now);
    void take_header(Client& client, Time now);
    void end_if_late(Client& client, Time now);
    static void enter(Client& client, Stage stage, Time now);
    static void answer(Client& client, std::string_view text, Time now);
    [[nodiscard]] std::string refusal_of_header(const Client& client) const;
    [[nodiscard]] std::string judge_update(const Client& client) const;

    const ServiceFacts& facts_;
    std::vector<Client> clients_{}; // in the order of their arrival
};

} // namespace tappet::box
