// The plain page of a gateway: machines and their values as a table that refreshes, and a login.
#pragma once

#include "toolchain/tools/gateway/sessions.hpp"
#include "toolchain/tools/gateway/station.hpp"

namespace tappet::network {

[[nodiscard]] std::string values_page(std::span<const Station* const> stations, const LoggedIn& who,
                                      bool can_leave);
/// `fault`: of the login before; empty: none.
[[nodiscard]] std::string login_page(std::string_view fault);
[[nodiscard]] std::string_view page_style();

/// Returns the tree of a machine's facets as JSON: components with name, kind, type, unit, role and help.
[[nodiscard]] std::string facets_json(const Station& station);
/// Returns {"name", "answers", "board", "world", "build_id", "framework"} or the reason.
[[nodiscard]] std::string machine_json(const Station& station);

} // namespace tappet::network
