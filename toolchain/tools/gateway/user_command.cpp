// Adds, changes, lists and removes users.
#include "toolchain/tools/gateway/user_command.hpp"

#include "toolchain/tools/gateway/users.hpp"

#include <istream>
#include <ostream>

#include <sys/stat.h>

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

/// Returns the fault; empty: done.
std::string change(Users& users, std::span<const std::string_view> words, std::istream& in,
                   std::ostream& out) {
    const std::string_view what = words[0];
    const std::string_view name = words[1];
    const User* const known = users.find(name);
    const std::string unknown = "there is no user '" + std::string{name} + "'; `user list` shows them";
    if (what == "remove") return users.remove(name) ? "" : unknown;
    if (what == "password" && known == nullptr) return unknown;
    if (what == "add" && known != nullptr)
        return "'" + std::string{name} + "' is there already; remove it first, or change its password";
    if (std::string fault = fault_in_name(name); !fault.empty()) return fault;
    const auto role = what == "add" ? role_from(words[2]) : known->role;
    if (!role) return "\"" + std::string{words[2]} + "\" is no role; write observer, operator or engineer";
    auto password = password_from(in, out);
    if (!password) return password.error();
    users.put(user_with(name, *role, *password));
    return {};
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
    if (const std::string fault = change(*users, words, in, out); !fault.empty()) return fail(fault);
    if (const std::string fault = users->write(file); !fault.empty()) return fail(fault);
    return 0;
}

} // namespace tappet::network
