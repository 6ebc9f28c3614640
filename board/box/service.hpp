// SPDX-License-Identifier: Apache-2.0
// What a box says and takes over its network: who asks is told what runs; a signed update or order is kept
// until somebody consents at the machine. It reads what strangers send, so it is a process of its own, which
// may do nothing else: nobody's, in a folder of its own, and after everything that the machine does.
#pragma once

#include "board/box/update.hpp"
#include "board/init/system.hpp"

#include <cstdint>
#include <expected>
#include <string>

namespace tappet::box {

/// Where the process lives. In memory: nothing of it outlives the power. It is init's, which writes there
/// what init alone may write; what was accepted lies in the folder below, which is nobody's.
inline constexpr const char* service_folder = "/run/service";
inline constexpr const char* status_file = "status"; ///< init's text for who asks
inline constexpr const char* offers_folder = "offers";
inline constexpr const char* offered_update = "offers/update";
inline constexpr const char* offered_order = "offers/order"; ///< the verb and the signature, each in a line

/// Before the process is started for the first time.
[[nodiscard]] init::Done make_service_folder();

/// Of boards that do not say another.
inline constexpr std::uint16_t service_port = 4848;

struct ServiceFacts {
    std::uint16_t port = 0;
    std::expected<PublicKey, std::string> key{};
    Manifest own{};
    std::string nonce{};
};

/// Drawn anew at each start of the box; empty when the kernel has no random numbers, and then no order fits.
[[nodiscard]] std::string new_nonce();

/// The whole life of the process, in the folder, which is there. Ends when it cannot listen.
[[noreturn]] void serve_network(const ServiceFacts& facts);

// Line by line, the client first:
//     status                      -> ok, then the box's text
//     update, then the file       -> ok or refused, then a sentence
//     order VERB SIGNATURE        -> ok or refused, then a sentence
// The box says "tappet-box 1 MACHINE BOARD NONCE" before that, and hangs up afterwards. reception.hpp has
// what it promises to each.
inline constexpr std::string_view service_greeting = "tappet-box 1 ";

} // namespace tappet::box
