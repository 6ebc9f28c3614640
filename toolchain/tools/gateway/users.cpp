// Reads and writes the users file.
#include "toolchain/tools/gateway/users.hpp"

#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::network {

namespace {

constexpr std::size_t most_bytes = 1024 * 1024;
constexpr std::size_t most_users = 1000;

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    while (!line.empty()) {
        const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
        line.remove_prefix(begin);
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
        if (!word.empty()) words.push_back(word);
        line.remove_prefix(word.size());
    }
    return words;
}

bool read_number(std::string_view text, std::uint32_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size();
}

std::expected<User, std::string> user_of(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() != 8 || words[2] != "scrypt")
        return std::unexpected("is not `name role scrypt N r p salt hash`");
    User user;
    user.name = words[0];
    if (const std::string fault = fault_in_name(user.name); !fault.empty()) return std::unexpected(fault);
    const auto role = role_from(words[1]);
    if (!role) return std::unexpected("the role is none of observer, operator, engineer");
    user.role = *role;
    if (!read_number(words[3], user.cost.n) || !read_number(words[4], user.cost.r) ||
        !read_number(words[5], user.cost.p) || !is_affordable(user.cost))
        return std::unexpected("the cost of scrypt is none that the gateway affords");
    auto salt = from_base64(words[6]);
    auto hash = from_base64(words[7]);
    if (!salt || salt->size() < 16 || !hash || hash->size() != 32)
        return std::unexpected("the salt or the hash is cut off");
    user.salt = std::move(*salt);
    user.hash = std::move(*hash);
    return user;
}

std::string why(const std::string& path, const char* what) {
    return "'" + path + "' " + what + ": " + std::strerror(errno);
}

std::string write_all(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return std::strerror(errno);
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return ::fsync(file) == 0 ? "" : std::strerror(errno);
}

} // namespace

std::optional<Role> role_from(std::string_view text) {
    for (const Role role : {Role::observer, Role::machine_operator, Role::engineer})
        if (text == tappet::to_text(role)) return role;
    return std::nullopt;
}

std::string fault_in_name(std::string_view name) {
    const bool fits =
        !name.empty() && name.size() <= bounds.name_characters &&
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789._-") == std::string_view::npos;
    return fits ? ""
                : "a user's name has 1 to 32 characters of a-z, 0-9, '.', '_' and '-'; choose such a name";
}

std::string fault_in_password(std::string_view password) {
    if (password.size() >= bounds.password_least && password.size() <= bounds.password_most) return {};
    return "a password has " + std::to_string(bounds.password_least) + " to " +
           std::to_string(bounds.password_most) + " bytes, this one has " + std::to_string(password.size()) +
           "; choose another";
}

User user_with(std::string_view name, Role role, std::string_view password) {
    User user{std::string{name}, role, Cost{}, random_bytes(16), {}};
    user.hash = scrypt(password, user.salt, user.cost);
    return user;
}

std::expected<Users, std::string> Users::parse(std::string_view text) {
    Users users;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        if (words_of(line).empty() || words_of(line).front().starts_with('#')) continue;
        const std::string head = "line " + std::to_string(number) + ": ";
        auto user = user_of(line);
        if (!user) return std::unexpected(head + user.error() + "; write it with tappet-gateway user");
        if (users.find(user->name) != nullptr)
            return std::unexpected(head + "'" + user->name + "' stands there twice; delete one line");
        if (users.all_.size() == most_users)
            return std::unexpected(head + "there are too many users; delete some");
        users.all_.push_back(std::move(*user));
    }
    return users;
}

std::expected<Users, std::string> Users::read(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) return std::unexpected(why(path, "cannot be opened"));
    struct stat state{};
    std::string text;
    std::array<char, 4096> part{};
    const bool known = ::fstat(file, &state) == 0;
    for (ssize_t n = 0; text.size() <= most_bytes && (n = ::read(file, part.data(), part.size())) > 0;)
        text.append(part.data(), static_cast<std::size_t>(n));
    ::close(file);
    if (!known || !S_ISREG(state.st_mode)) return std::unexpected("'" + path + "' is no file; name one");
    if ((state.st_mode & 0077) != 0 || (state.st_uid != ::geteuid() && state.st_uid != 0))
        return std::unexpected("others may read or change '" + path +
                               "', which holds the hashes of passwords; " +
                               "chmod 600 it, as a file of the gateway's own user");
    if (text.size() > most_bytes)
        return std::unexpected("'" + path + "' is longer than 1 MiB; is it a users file?");
    auto users = parse(text);
    if (!users) return std::unexpected("'" + path + "', " + users.error());
    return users;
}

std::string Users::text() const {
    std::string all = "# Users of tappet-gateway: name role scrypt N r p salt hash\n";
    for (const User& each : all_)
        all += each.name + " " + std::string{tappet::to_text(each.role)} + " scrypt " +
               std::to_string(each.cost.n) + " " + std::to_string(each.cost.r) + " " +
               std::to_string(each.cost.p) + " " + to_base64(each.salt) + " " + to_base64(each.hash) + "\n";
    return all;
}

std::string Users::write(const std::string& path) const {
    const std::string beside = path + ".new";
    ::unlink(beside.c_str());
    const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return why(beside, "cannot be created");
    const std::string fault = write_all(file, text());
    ::close(file);
    if (!fault.empty()) return "'" + beside + "' cannot be written: " + fault;
    return ::rename(beside.c_str(), path.c_str()) == 0 ? "" : why(path, "cannot be replaced");
}

const User* Users::find(std::string_view name) const {
    const auto found = std::ranges::find(all_, name, &User::name);
    return found == all_.end() ? nullptr : &*found;
}

void Users::put(User user) {
    const auto found = std::ranges::find(all_, user.name, &User::name);
    if (found == all_.end())
        all_.push_back(std::move(user));
    else
        *found = std::move(user);
}

bool Users::remove(std::string_view name) {
    return std::erase_if(all_, [&](const User& each) { return each.name == name; }) != 0;
}

} // namespace tappet::network
