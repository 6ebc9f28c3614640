// Writes, rotates and repairs the log of changes.
#include "toolchain/tools/gateway/audit.hpp"

#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::network {

namespace {

using browser::in_quotes;
using nlohmann::json;

std::string wall_time() {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    std::tm parts{};
    ::gmtime_r(&now.tv_sec, &parts);
    std::array<char, 40> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
    std::snprintf(text.data() + length, text.size() - length, ".%03ldZ", now.tv_nsec / 1'000'000);
    return text.data();
}

std::string head_of(std::uint64_t number, std::string_view what) {
    return "{\"time\": \"" + wall_time() + "\", \"number\": " + std::to_string(number) +
           ", \"what\": " + in_quotes(what);
}

} // namespace

Audit::~Audit() {
    if (file_ >= 0) ::close(file_);
}

std::string Audit::open(const std::function<std::string(const Asked&)>& value_now) {
    if (path_.empty()) return {};
    std::map<std::uint64_t, Asked> open;
    for (unsigned file = bounds.log_files; file-- > 0;) {
        std::ifstream lines{name_of(file)};
        for (std::string line; std::getline(lines, line);) {
            const json row = json::parse(line, nullptr, false);
            if (!row.is_object()) continue; // a line that a power cut left half written
            const auto text = [&](const char* name) {
                const auto found = row.find(name);
                return found != row.end() && found->is_string() ? found->get<std::string>() : std::string{};
            };
            const auto found = row.find("number");
            const auto number =
                found != row.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
            last_ = std::max(last_, number);
            if (text("what") == "asked")
                open[number] = {text("user"), text("address"), text("machine"), text("line"), {}};
            else if (text("what") == "answered")
                open.erase(number);
        }
    }
    file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file_ < 0) return "the log '" + path_ + "' cannot be written: " + std::strerror(errno);
    const off_t end = ::lseek(file_, 0, SEEK_END);
    bytes_ = end > 0 ? static_cast<std::size_t>(end) : 0;
    if (bytes_ > 0 && !write("\n"))
        return "the log '" + path_ + "' cannot be written: " + std::strerror(errno);
    for (const auto& [number, row] : open) {
        answered(number, "unknown: the gateway ended before the answer", value_now(row));
        ++repaired_;
    }
    return {};
}

bool Audit::write(const std::string& line) {
    if (file_ < 0) return path_.empty();
    // One call for a whole line, appended: a killed gateway leaves all of it or nothing.
    const ssize_t written = ::write(file_, line.data(), line.size());
    if (written > 0) bytes_ += static_cast<std::size_t>(written);
    return written == static_cast<ssize_t>(line.size());
}

void Audit::rotate() {
    if (file_ < 0 || bytes_ < bounds.log_bytes) return;
    for (unsigned file = bounds.log_files - 1; file > 0; --file)
        ::rename(name_of(file - 1).c_str(), name_of(file).c_str());
    const int next = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (next < 0) return; // the renamed file goes on growing; better than no log
    ::close(std::exchange(file_, next));
    bytes_ = 0;
}

std::uint64_t Audit::asked(const Asked& asked) {
    rotate();
    std::string line = as_utf8(std::string_view{asked.line}.substr(0, bounds.log_line));
    if (asked.line.size() > bounds.log_line)
        line += " .. cut, it has " + std::to_string(asked.line.size()) + " bytes";
    const bool written =
        write(head_of(++last_, "asked") + ", \"user\": " + in_quotes(asked.user) +
              ", \"address\": " + in_quotes(asked.address) + ", \"machine\": " + in_quotes(asked.machine) +
              ", \"line\": " + in_quotes(line) +
              ", \"before\": " + (asked.values.empty() ? "null" : asked.values) + "}\n");
    return written ? last_ : 0;
}

void Audit::answered(std::uint64_t number, std::string_view outcome, std::string_view values_after) {
    static_cast<void>(write(head_of(number, "answered") + ", \"outcome\": " + in_quotes(as_utf8(outcome)) +
                            ", \"after\": " + (values_after.empty() ? "null" : std::string{values_after}) +
                            "}\n"));
}

void Audit::note(std::string_view user, std::string_view address, std::string_view what) {
    rotate();
    static_cast<void>(write(head_of(++last_, "note") + ", \"user\": " + in_quotes(as_utf8(user)) +
                            ", \"address\": " + in_quotes(address) +
                            ", \"note\": " + in_quotes(as_utf8(what)) + "}\n"));
}

std::vector<std::string> names_in(std::string_view line) {
    browsing::Request request;
    const std::string numbered = "1 " + std::string{line};
    if (!browsing::parse_request(numbered, request).empty()) return {};
    std::vector<std::string> names;
    const std::string_view verb = request.verb->name;
    const std::size_t step = verb == "set"                          ? 2
                             : verb == "force" || verb == "release" ? request.arguments.size()
                                                                    : 0;
    for (std::size_t i = 0; step != 0 && i < request.arguments.size(); i += step)
        names.emplace_back(request.arguments[i]);
    return names;
}

bool is_change(std::string_view line) {
    std::string_view rest = line;
    std::string_view word;
    if (!browsing::detail::take_word(rest, word)) return false;
    const browsing::VerbRow* const verb = browsing::find_verb(word);
    return verb != nullptr && (verb->role != Role::observer || verb->name == "execute");
}

} // namespace tappet::network
