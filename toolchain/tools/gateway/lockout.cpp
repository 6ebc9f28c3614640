// Counts failures by user and by address.
#include "toolchain/tools/gateway/lockout.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <arpa/inet.h>

namespace tappet::network {

namespace {

std::string key_of(std::string_view user, std::string_view address) {
    return std::string{user} + "\n" + lock_address(address);
}

/// An address may fail more often than a user at it, for several people may sit behind one.
constexpr unsigned failures_of_address = 4 * bounds.failures;

} // namespace

std::string lock_address(std::string_view address) {
    std::array<unsigned char, 16> bytes{};
    const std::string text{address};
    if (::inet_pton(AF_INET6, text.c_str(), bytes.data()) != 1) return text;
    constexpr std::array<unsigned char, 12> mapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255};
    if (std::equal(mapped.begin(), mapped.end(), bytes.begin())) return text;
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    std::array<char, INET6_ADDRSTRLEN> network{};
    ::inet_ntop(AF_INET6, bytes.data(), network.data(), network.size());
    return network.data();
}

std::chrono::seconds Lockout::left(std::string_view user, std::string_view address,
                                   Clock::time_point now) const {
    Clock::time_point until = now;
    for (const std::string& key : {key_of(user, address), key_of({}, address)})
        if (const auto found = counts_.find(key); found != counts_.end())
            until = std::max(until, found->second.locked_until);
    return std::chrono::ceil<std::chrono::seconds>(until - now);
}

void Lockout::begin(std::string_view user, std::string_view address, Clock::time_point now) {
    fail(key_of(user, address), now);
    fail(key_of({}, address), now);
}

void Lockout::fail(const std::string& key, Clock::time_point now) {
    const auto quiet = [&](const Count& count) { return now - count.last > 2 * bounds.lock_longest; };
    if (counts_.size() >= bounds.failures_kept && !counts_.contains(key)) {
        std::erase_if(counts_, [&](const auto& each) { return quiet(each.second); });
        if (counts_.size() >= bounds.failures_kept)
            counts_.erase(std::ranges::min_element(counts_, {}, [](const auto& each) {
                return std::pair{each.second.locked_until, each.second.last};
            }));
    }
    Count& count = counts_[key];
    if (count.failures != 0 && quiet(count)) count = {};
    count.last = now;
    const unsigned allowed = key.starts_with('\n') ? failures_of_address : bounds.failures;
    if (++count.failures < allowed) return;
    const unsigned doublings = std::min(count.failures - allowed, 10u);
    count.locked_until = now + std::min(bounds.lock_first * (1 << doublings), bounds.lock_longest);
}

void Lockout::succeed(std::string_view user, std::string_view address) {
    counts_.erase(key_of(user, address));
    forgive(key_of({}, address), failures_of_address);
}

void Lockout::take_back(std::string_view user, std::string_view address) {
    forgive(key_of(user, address), bounds.failures);
    forgive(key_of({}, address), failures_of_address);
}

void Lockout::forgive(const std::string& key, unsigned allowed) {
    const auto found = counts_.find(key);
    if (found == counts_.end()) return;
    if (--found->second.failures == 0)
        counts_.erase(found);
    else if (found->second.failures < allowed)
        found->second.locked_until = {};
}

} // namespace tappet::network
