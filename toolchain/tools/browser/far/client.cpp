// The message `run` of protocol tappet.v1, and the frames that answer it.
#include "toolchain/tools/browser/far/client.hpp"

#include "toolchain/tools/browser/far/password.hpp"
#include "toolchain/tools/browser/record_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace tappet::browser {

namespace {

using nlohmann::ordered_json;
using Milliseconds = std::chrono::milliseconds;

constexpr std::uint32_t login_id = 1, run_id = 2, end_id = 3;
/// The longest wait for the answer to a login: its password is hashed slowly, beside those of others.
constexpr Milliseconds login_patience{20'000};
/// The longest wait for the end of a stopped line.
constexpr Milliseconds end_patience = most_remote_patience + Milliseconds{5'000};
constexpr std::size_t most_file_bytes = std::size_t{48}
                                        << 10; ///< of what comes with a line: one frame holds it

/// Returns the bytes; nothing when the text is no base64 (RFC 4648).
std::optional<std::string> from_base64(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (text.size() % 4 != 0) return std::nullopt;
    for (int k = 0; k < 2 && text.ends_with('='); ++k) text.remove_suffix(1);
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char each : text) {
        const std::size_t digit = digits.find(each);
        if (digit == std::string_view::npos) return std::nullopt;
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>((bits >> count) & 0xff);
    }
    return bytes;
}

/// The terminal while a line elsewhere draws on it: keys come without return, and show nothing.
class FarTerminal {
public:
    explicit FarTerminal(bool is_used) : is_used_{is_used && ::tcgetattr(STDIN_FILENO, &before_) == 0} {
        if (!is_used_) return;
        termios raw = before_;
        raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        raw.c_cc[VMIN] = 0;
        raw.c_cc[VTIME] = 0;
        ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    }
    ~FarTerminal() {
        if (is_used_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
    FarTerminal(const FarTerminal&) = delete;
    FarTerminal& operator=(const FarTerminal&) = delete;

    [[nodiscard]] static Size size() {
        winsize seen{};
        if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &seen) != 0 || seen.ws_col == 0 || seen.ws_row == 0) return {};
        return {seen.ws_col, seen.ws_row};
    }
    /// Returns whether the user pressed a key that ends the picture.
    [[nodiscard]] bool quits() const {
        std::array<char, 16> typed{};
        if (!is_used_) return false;
        const ssize_t count = ::read(STDIN_FILENO, typed.data(), typed.size());
        const std::string_view keys{typed.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
        return keys == "q" || keys == "Q" || keys == "\x1b" || keys == "\x04";
    }

private:
    termios before_{};
    bool is_used_;
};

class FarRun {
public:
    FarRun(const FarCall& call, const Line& line, Surroundings& around, FarWire& wire)
        : call_{call}, line_{line}, around_{around}, wire_{wire} {}

    Result<int> run() {
        if (const auto done = log_in(); !done) return std::unexpected(done.error());
        const bool draws = around_.screen && !line_.words.empty() && line_.words[0] == "watch" && !line_.json;
        auto message = message_of(draws);
        if (!message) return std::unexpected(message.error());
        const FarTerminal terminal{draws};
        if (const auto sent =
                wire_.send(message->dump(-1, ' ', false, ordered_json::error_handler_t::replace));
            !sent)
            return std::unexpected(sent.error());
        auto code = follow(terminal);
        if (!code && draws) around_.out << screen_ends << std::flush;
        return code;
    }

private:
    [[nodiscard]] Result<void> log_in() {
        if (!wire_.is_secret()) return {}; // everyone at that host is its user
        auto password = ask_password("password of " + call_.user + " at " + call_.address.text + ": ");
        if (!password) return std::unexpected(password.error());
        const ordered_json login{
            {"id", login_id}, {"do", "login"}, {"user", call_.user}, {"password", std::move(*password)}};
        if (const auto sent = wire_.send(login.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
            !sent)
            return sent;
        const auto until = std::chrono::steady_clock::now() + login_patience;
        while (std::chrono::steady_clock::now() < until && !is_stopped()) {
            auto frame = next();
            if (!frame) return std::unexpected(frame.error());
            if (!*frame || (*frame)->value("id", 0U) != login_id) continue;
            if ((*frame)->value("ok", false)) return {};
            return failure(Fault::refused, (*frame)->value("error", std::string{"refused without a reason"}));
        }
        return failure(Fault::too_late, "the gateway does not answer the login; try again");
    }

    /// Returns the message with the files that the line reads. Creates the file that it writes anew.
    [[nodiscard]] Result<ordered_json> message_of(bool draws) {
        ordered_json message{{"id", run_id}, {"do", "run"}, {"words", call_.words}, {"screen", draws}};
        if (draws) {
            const Size size = FarTerminal::size();
            message["width"] = size.columns;
            message["height"] = size.rows;
        }
        const auto& words = line_.words;
        if (words.size() > 2 && words[0] == "behaviour" && words[1] == "load") {
            auto script = files_.read(words[2]);
            if (!script) return std::unexpected(script.error());
            if (script->size() > most_file_bytes)
                return wrong("'" + words[2] + "' has " + std::to_string(script->size()) +
                             " bytes, and at most " + std::to_string(most_file_bytes) +
                             " go over the network; split the script");
            message["files"] = {{words[2], std::move(*script)}};
        }
        if (words.size() > 2 && words[0] == "report" && words[1] == "start") {
            new_name_ = words[2];
            if (files_.exists(new_name_))
                return wrong("'" + new_name_ + "' is there already; name another file");
        }
        return message;
    }

    /// Shows the frames until the exit code. A stop is passed on once.
    [[nodiscard]] Result<int> follow(const FarTerminal& terminal) {
        using Steady = std::chrono::steady_clock;
        for (auto given_up = Steady::time_point::max();;) {
            const bool is_ending = given_up != Steady::time_point::max();
            if (!is_ending && (is_stopped() || terminal.quits())) {
                given_up = Steady::now() + end_patience;
                const ordered_json end{{"id", end_id}, {"do", "end"}, {"of", run_id}};
                if (const auto sent = wire_.send(end.dump()); !sent) return std::unexpected(sent.error());
            }
            if (Steady::now() > given_up)
                return failure(Fault::too_late, "the gateway does not tell how the line ended");
            auto frame = next();
            if (!frame) return std::unexpected(frame.error());
            if (!*frame || (*frame)->value("id", 0U) != run_id) continue;
            const ordered_json& told = **frame;
            if (told.contains("exit")) return end_of(told["exit"].get<int>());
            if (told.contains("ok") && !told["ok"].get<bool>())
                return failure(Fault::refused, told.value("error", std::string{"refused without a reason"}));
            if (told.contains("out")) around_.out << told["out"].get<std::string>() << std::flush;
            if (told.contains("err")) around_.errors << told["err"].get<std::string>() << std::flush;
            if (!told.contains("file")) continue;
            if (const auto kept = keep(told); !kept) return std::unexpected(kept.error());
        }
    }

    /// Writes a part of a file that the line names, and of no other: a gateway does not choose this user's
    /// files.
    [[nodiscard]] Result<void> keep(const ordered_json& told) {
        const auto name = told["file"].get<std::string>();
        const auto part = from_base64(told.value("part", std::string{}));
        if (name.empty() || (name != line_.to && name != new_name_) || !part)
            return failure(Fault::no_machine,
                           "the gateway sends a file that nobody asked for; its program is not "
                           "this one's");
        if (name == new_name_) {
            if (growing_ == nullptr) {
                auto made = files_.create(name);
                if (!made) return std::unexpected(made.error());
                growing_ = std::move(*made);
            }
            growing_->write(*part);
            if (const std::string fault = growing_->fault(); !fault.empty()) return wrong(fault);
            return {};
        }
        whole_ += *part;
        if (!told.value("last", false)) return {};
        return files_.write(name, std::exchange(whole_, {}));
    }

    [[nodiscard]] Result<int> end_of(int code) {
        if (growing_ != nullptr)
            if (const auto done = growing_->finish(); !done) return std::unexpected(done.error());
        return code;
    }

    [[nodiscard]] Result<std::optional<ordered_json>> next() {
        auto text = wire_.receive(Milliseconds{50});
        if (!text) return std::unexpected(text.error());
        if (!*text) return std::optional<ordered_json>{};
        auto frame = ordered_json::parse(**text, nullptr, false);
        if (!frame.is_object()) return failure(Fault::no_machine, "the gateway's answer is no JSON object");
        return std::optional{std::move(frame)};
    }
    [[nodiscard]] bool is_stopped() const { return around_.signal != nullptr && around_.signal->load() != 0; }

    const FarCall& call_;
    const Line& line_;
    Surroundings& around_;
    FarWire& wire_;
    LocalFiles files_{};
    std::string new_name_{};
    std::string whole_{};
    std::unique_ptr<GrowingFile> growing_{};
};

} // namespace

std::expected<std::optional<FarCall>, std::string> parse_call(std::span<const std::string> words) {
    FarCall call;
    bool is_far = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_ours = words[i] == "--user" || words[i] == "--ca";
        if (is_ours) {
            if (i + 1 == words.size())
                return std::unexpected(words[i] + " needs a value after it; --help shows which");
            (words[i] == "--user" ? call.user : call.ca) = words[i + 1];
            ++i;
            continue;
        }
        if (!is_far && !words[i].starts_with("--")) {
            auto address = parse_address(words[i]);
            if (!address) return std::nullopt;
            call.address = std::move(*address);
            is_far = true;
            continue;
        }
        call.words.push_back(words[i]);
        if (words[i] != "--") continue;
        call.words.insert(call.words.end(), words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
        break;
    }
    if (!is_far) return std::nullopt;
    const char* const own = std::getenv("USER");
    if (call.user.empty()) call.user = own == nullptr ? "" : own;
    return call;
}

int run_far_line(const FarCall& call, Surroundings& surroundings, const OpenWire& open) {
    bool json = false;
    const auto tell = [&](const Failure& failure) {
        return tell_failure(surroundings.errors, failure, json);
    };
    const auto line = accept_line(call.words, surroundings.out, surroundings.errors);
    if (!line) return line.error();
    json = line->json;
    if (is_about_files(*line))
        return tell({Fault::bad_request, "'report " + line->words[1] +
                                             "' is about files of this host; leave the address "
                                             "out"});
    auto wire = open(call);
    if (!wire) return tell(wire.error());
    try {
        const auto code = FarRun{call, *line, surroundings, **wire}.run();
        return code ? *code : tell(code.error());
    } catch (const nlohmann::json::exception& thrown) {
        return tell(
            {Fault::no_machine, std::string{"the gateway's answer violates the protocol: "} + thrown.what()});
    }
}

} // namespace tappet::browser
