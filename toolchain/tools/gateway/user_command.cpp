// Adds, changes, lists and removes users.
#include "toolchain/tools/gateway/user_command.hpp"

#include "toolchain/tools/gateway/users.hpp"

#include <filesystem>
#include <istream>
#include <ostream>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::network {

namespace {

std::expected<std::string, std::string> password_from(std::istream& in, std::ostream& out) {
    out << "password: " << std::flush;
    std::string once, again;
    std::getline(in, once);
    out << "\nthe same again: " << std::flush;
    std::getline(in, again);
    out << "\n";
    if (once != again) return std::unexpected("the two passwords differ; type the same twice");
    if (std::string fault = fault_in_password(once); !fault.empty()) return std::unexpected(std::move(fault));
    return once;
}

std::expected<Users, std::string> present(const std::string& file) {
    struct stat state{};
    return ::stat(file.c_str(), &state) == 0 ? Users::read(file) : Users{};
}

/// Returns why the change cannot be made; empty: it can.
std::string fault_of(const Users& users, std::span<const std::string_view> words) {
    const std::string_view what = words[0];
    const std::string_view name = words[1];
    const User* const known = users.find(name);
    const std::string unknown = "there is no user '" + std::string{name} + "'; `user list` shows them";
    if (what != "add") return known == nullptr ? unknown : "";
    if (known != nullptr)
        return "'" + std::string{name} + "' is there already; remove it first, or change its password";
    if (std::string fault = fault_in_name(name); !fault.empty()) return fault;
    if (!role_from(words[2]))
        return "\"" + std::string{words[2]} + "\" is no role; write observer, operator or engineer";
    return {};
}

/// Holds the file's folder against other user commands until the end of this object.
class Held {
public:
    explicit Held(const std::string& file) {
        const std::filesystem::path folder = std::filesystem::path{file}.parent_path();
        folder_ = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder_ >= 0 && ::flock(folder_, LOCK_EX) == 0) is_held_ = true;
    }
    ~Held() {
        if (folder_ >= 0) ::close(folder_);
    }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;
    [[nodiscard]] bool is_held() const { return is_held_; }

private:
    int folder_ = -1;
    bool is_held_ = false;
};

/// Makes the change in the file as it is now: it may have changed while somebody typed a password.
std::string change(const std::string& file, std::span<const std::string_view> words,
                   const std::string& password) {
    const Held held{file};
    if (!held.is_held()) return "the folder of '" + file + "' cannot be locked; is it there?";
    auto users = present(file);
    if (!users) return users.error();
    if (std::string fault = fault_of(*users, words); !fault.empty()) return fault;
    const std::string_view name = words[1];
    if (words[0] == "remove")
        users->remove(name);
    else
        users->put(
            user_with(name, words[0] == "add" ? *role_from(words[2]) : users->find(name)->role, password));
    return users->write(file);
}

} // namespace

int run_user_command(std::span<const std::string_view> words, const std::string& file, std::istream& in,
                     std::ostream& out, std::ostream& errors) {
    const auto fail = [&](const std::string& fault) {
        return errors << "tappet-gateway: " << fault << "\n", 2;
    };
    const std::string_view what = words.empty() ? std::string_view{} : words[0];
    const std::size_t wanted = what == "add"                            ? 3
                               : what == "remove" || what == "password" ? 2
                               : what == "list"                         ? 1
                                                                        : 0;
    if (wanted == 0 || words.size() != wanted || file.empty())
        return fail("a user command is spelled:\n" + std::string{user_usage});
    auto users = present(file);
    if (!users) return fail(users.error());
    if (what == "list") {
        for (const User& each : users->all()) out << each.name << " " << tappet::to_text(each.role) << "\n";
        return 0;
    }
    if (const std::string fault = fault_of(*users, words); !fault.empty()) return fail(fault);
    std::expected<std::string, std::string> password;
    if (what != "remove") password = password_from(in, out);
    if (!password) return fail(password.error());
    if (const std::string fault = change(file, words, *password); !fault.empty()) return fail(fault);
    return 0;
}

} // namespace tappet::network
