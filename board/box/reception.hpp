// SPDX-License-Identifier: Apache-2.0
// Hears the clients at a box's network port. Strangers reach the port, too: all clients are heard side by
// side, none waits for another, and each holds little memory for a short time.
#pragma once

#include "board/box/service.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::box {

/// Promises, whatever others send:
/// - A client is greeted at once, and answered when its request is here. It keeps its place until 16 later
///   clients have come; the clients of an address that holds more places go first, so that one address keeps
///   no other out.
/// - Only a header that the key has signed takes the one place for updates; any other is refused before the
///   rest of its file is read. An update may be as slow as its line, but not pause for 10 s. It leaves its
///   place to a newer version; if it is slower than 64 KiB/s after its first 5 s, to another one of its
///   version, too.
/// - Memory: one update, and less than 5 KiB for each other client.
/// Not: a header that the key signed is the same for everybody. Who has recorded one of the same version, or
/// of a newer one, can take the place of a slow update with it, and hold that place. A stick is no such way.
class Reception {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;
    static constexpr std::size_t most_clients = 16;
    static constexpr std::chrono::seconds for_a_request{10}; ///< its line, and then the header of an update
    static constexpr std::chrono::seconds longest_pause{10}; ///< of an update
    static constexpr std::chrono::seconds for_goodbye{2};
    static constexpr double slow_bytes_per_s = 65536.0;

    /// `facts` outlive it.
    explicit Reception(const ServiceFacts& facts) : facts_{facts} {}
    ~Reception();
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

    /// Greets a client; its socket belongs to the reception from here on.
    void greet(int socket, std::uint32_t address, Time now);
    /// Waits until a client says something or somebody comes to `listener`, for a second at most. Returns
    /// whether somebody came.
    [[nodiscard]] bool wait(int listener) const;
    /// Takes a piece of what each client has said, and hangs up on those that are late.
    void hear(Time now);

private:
    enum class Stage : std::uint8_t { line, header, kernel, goodbye, gone };
    struct Client {
        int socket = -1;
        std::uint32_t address = 0;
        Stage stage = Stage::line;
        Time since{};                              // in its stage
        Time heard{};                              // last
        std::string said{};                        // in its stage; an update with its header
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
    std::vector<Client> clients_{}; // in the order in which they came
};

} // namespace tappet::box
