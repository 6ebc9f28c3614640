// Logins from their beginning to a session, and what ends sessions.
#include "toolchain/tools/gateway/access.hpp"

namespace tappet::network {

namespace {

/// Whether nothing changed, its mode and its owner included.
bool is_same(const struct stat& one, const struct stat& other) {
    const auto equal = [](const timespec& a, const timespec& b) {
        return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
    };
    return one.st_ino == other.st_ino && one.st_size == other.st_size && equal(one.st_mtim, other.st_mtim) &&
           equal(one.st_ctim, other.st_ctim);
}

} // namespace

bool Attempt::matches() const {
    const bool equal = are_equal(scrypt(password, user.salt, user.cost), user.hash);
    return equal && known;
}

Access::Access(std::string users_file, Users users)
    : path_{std::move(users_file)}, users_{std::move(users)}, pepper_{random_bytes(32)} {
    nobody_.salt = random_bytes(16);
    nobody_.hash = random_bytes(32);
}

std::expected<Attempt, std::string> Access::begin(std::string_view user, std::string_view password,
                                                  std::string_view address, Clock::time_point now) {
    if (local_) return std::unexpected("this gateway has no users; everyone here is " + local_->user);
    const std::string_view name = user.size() <= bounds.name_characters ? user : std::string_view{};
    if (const auto left = lockout_.left(name, address, now); left.count() > 0)
        return std::unexpected("too many failed logins; try again in " + std::to_string(left.count()) + " s");
    lockout_.begin(name, address, now);
    const User* const found = users_.find(name);
    // An overlong password is cut: it cannot be right, and hashing it would take longer.
    return Attempt{found != nullptr ? *found : nobody_,
                   found != nullptr && password.size() <= bounds.password_most, std::string{name},
                   std::string{password.substr(0, bounds.password_most)}, std::string{address}};
}

std::expected<Access::Admitted, std::string> Access::finish(const Attempt& attempt, bool matched,
                                                            Clock::time_point now) {
    // The file may have changed while the password was checked.
    const User* const present = users_.find(attempt.name);
    if (!matched || present == nullptr || !(*present == attempt.user)) {
        const auto left = lockout_.left(attempt.name, attempt.address, now);
        return std::unexpected("user or password is wrong" +
                               (left.count() > 0
                                    ? "; the next try is possible in " + std::to_string(left.count()) + " s"
                                    : std::string{"; check both"}));
    }
    lockout_.succeed(attempt.name, attempt.address);
    LoggedIn who{attempt.name, present->role};
    std::string token = sessions_.begin(who, now);
    return Admitted{std::move(who), std::move(token)};
}

std::optional<LoggedIn> Access::remembered(std::string_view user, std::string_view password,
                                           std::string_view address, Clock::time_point now) {
    if (lockout_.left(user, address, now).count() > 0) return std::nullopt;
    const auto found = remembered_.find(sha256(pepper_ + std::string{user} + "\n" + std::string{password}));
    if (found == remembered_.end()) return std::nullopt;
    auto who = sessions_.find(found->second, now);
    if (!who) remembered_.erase(found);
    return who;
}

void Access::remember(std::string_view user, std::string_view password, const std::string& token) {
    if (remembered_.size() >= bounds.sessions) remembered_.clear();
    remembered_[sha256(pepper_ + std::string{user} + "\n" + std::string{password})] = token;
}

std::string Access::refresh() {
    if (local_) return {};
    struct stat state{};
    const bool there = ::stat(path_.c_str(), &state) == 0;
    if (there && fault_.empty() && is_same(state, read_)) return {};
    auto users = Users::read(path_);
    if (!users) {
        std::string fault = "the users stay as they were: " + users.error();
        if (fault == fault_) return {};
        return fault_ = std::move(fault);
    }
    fault_.clear();
    read_ = state; // from before the reading: a change in between is read the next time
    for (const User& each : users_.all()) {
        const User* const now = users->find(each.name);
        if (now == nullptr || !(*now == each)) sessions_.end_of(each.name);
    }
    users_ = std::move(*users);
    return {};
}

} // namespace tappet::network
