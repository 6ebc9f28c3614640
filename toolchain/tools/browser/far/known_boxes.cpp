// Trust at first use, as ssh does it.
#include "toolchain/tools/browser/far/known_boxes.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <arpa/inet.h>
#include <fcntl.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

/// Appends the line to a file that only this user reads. Returns what is wrong; empty: nothing.
std::string append(const std::string& file, const std::string& line) {
    const std::filesystem::path folder = std::filesystem::path{file}.parent_path();
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (descriptor < 0) return std::strerror(errno);
    const bool is_written =
        ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
        ::fsync(descriptor) == 0;
    const std::string wrong = is_written ? "" : std::strerror(errno);
    ::close(descriptor);
    return wrong;
}

} // namespace

bool Address::is_loopback() const {
    in_addr number{}; // a name such as 127.mill.example is no number
    return host == "localhost" || host == "::1" ||
           (host.starts_with("127.") && ::inet_pton(AF_INET, host.c_str(), &number) == 1);
}

std::optional<Address> parse_address(std::string_view word) {
    const std::size_t colon = word.rfind(':');
    if (colon == std::string_view::npos || colon == 0 || colon + 1 == word.size() || word.size() - colon > 6)
        return std::nullopt;
    std::string_view host = word.substr(0, colon);
    const std::string_view port = word.substr(colon + 1);
    if (port.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    if (host.starts_with('[') && host.ends_with(']')) {
        host = host.substr(1, host.size() - 2);
        if (host.find_first_not_of("0123456789abcdefABCDEF:.%") != std::string_view::npos)
            return std::nullopt;
    } else if (std::ranges::any_of(host, [](char each) {
                   return each != '.' && each != '-' && each != '_' &&
                          std::isalnum(static_cast<unsigned char>(each)) == 0;
               })) {
        return std::nullopt;
    }
    std::string written{word};
    std::ranges::transform(written, written.begin(),
                           [](unsigned char each) { return static_cast<char>(std::tolower(each)); });
    std::string lower = written.substr(static_cast<std::size_t>(host.data() - word.data()), host.size());
    return Address{std::move(lower), std::string{port}, std::move(written)};
}

std::string KnownBoxes::usual_file() {
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    const char* const home = std::getenv("HOME");
    if (config != nullptr && *config != 0) return std::string{config} + "/tappet/known_boxes";
    return home == nullptr || *home == 0 ? "" : std::string{home} + "/.config/tappet/known_boxes";
}

bool KnownBoxes::knows(const Address& address) const {
    std::ifstream known{file_};
    for (std::string line; std::getline(known, line);)
        if (line.starts_with(address.text + " ")) return true;
    return false;
}

Result<std::string> KnownBoxes::check(const Address& address, const std::string& fingerprint) {
    if (file_.empty())
        return failure(Fault::no_machine,
                       "the box's certificate cannot be remembered, since HOME is not set; set it, "
                       "or name the certificate's authority with --ca FILE");
    std::ifstream known{file_};
    if (!known && std::filesystem::exists(file_))
        return failure(Fault::no_machine, "'" + file_ + "' cannot be read; give it back to yourself");
    for (std::string line; std::getline(known, line);) {
        std::istringstream words{line};
        std::string box, print;
        words >> box >> print;
        if (box != address.text) continue;
        if (print == fingerprint) return std::string{};
        return failure(
            Fault::no_machine,
            "the certificate of " + address.text + " has changed: it is " + fingerprint + " and was " +
                print +
                "; somebody may stand between you and the box. If its gateway has a new certificate, remove "
                "its line from '" +
                file_ + "'");
    }
    if (const std::string wrong = append(file_, address.text + " " + fingerprint + "\n"); !wrong.empty())
        return failure(Fault::no_machine,
                       "'" + file_ + "' cannot be written: " + wrong +
                           "; correct that, or name the certificate's authority with --ca FILE");
    return address.text + " is new here; its certificate " + fingerprint +
           " is trusted from now on: compare it with the one that its gateway prints";
}

} // namespace tappet::browser
