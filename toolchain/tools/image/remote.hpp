// SPDX-License-Identifier: Apache-2.0
// A box over the network: what runs there, an update for it, an order. board/box/service.hpp is the other
// end.
#pragma once

#include "board/box/update.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tappet::image {

struct Answer {
    bool is_accepted = false;
    std::string text{};
};

/// "192.168.8.1", or "192.168.8.1:4848". What is wrong is thrown as a Fault.
[[nodiscard]] Answer ask_status(const std::string& box);
/// `done` is told how far.
[[nodiscard]] Answer send_update(const std::string& box, const std::filesystem::path& file,
                                 const std::function<void(std::uint64_t bytes, std::uint64_t of)>& done);
/// `verb`: one of box::order_verbs.
[[nodiscard]] Answer send_order(const std::string& box, const std::string& verb, const box::SecretKey& key);

} // namespace tappet::image
