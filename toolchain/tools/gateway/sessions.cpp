// Keeps sessions by the digests of their tokens.
#include "toolchain/tools/gateway/sessions.hpp"

#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/secrets.hpp"

#include <algorithm>

namespace tappet::network {

void Sessions::expire(Clock::time_point now) {
    std::erase_if(all_, [&](const auto& each) {
        return now - each.second.used > bounds.session_idle ||
               now - each.second.begun > bounds.session_longest;
    });
}

void Sessions::end_oldest(std::string_view user) {
    auto oldest = all_.end();
    for (auto each = all_.begin(); each != all_.end(); ++each)
        if ((user.empty() || each->second.who.user == user) &&
            (oldest == all_.end() || each->second.used < oldest->second.used))
            oldest = each;
    if (oldest != all_.end()) all_.erase(oldest);
}

std::string Sessions::begin(const LoggedIn& who, Clock::time_point now) {
    expire(now);
    const auto of_user =
        std::ranges::count_if(all_, [&](const auto& each) { return each.second.who.user == who.user; });
    if (static_cast<std::size_t>(of_user) >= bounds.sessions_of_user) end_oldest(who.user);
    if (all_.size() >= bounds.sessions) end_oldest({});
    std::string token = to_base64(random_bytes(32), true);
    all_[sha256(token)] = {who, now, now};
    return token;
}

std::optional<LoggedIn> Sessions::find(std::string_view token, Clock::time_point now, bool use) {
    expire(now);
    const auto found = all_.find(sha256(token));
    if (found == all_.end()) return std::nullopt;
    if (use) found->second.used = now;
    return found->second.who;
}

bool Sessions::lasts(std::string_view token, Clock::time_point now) {
    expire(now);
    return all_.contains(sha256(token));
}

void Sessions::end(std::string_view token) { all_.erase(sha256(token)); }

void Sessions::end_of(std::string_view user) {
    std::erase_if(all_, [&](const auto& each) { return each.second.who.user == user; });
}

} // namespace tappet::network
