// Runs a browser's command on its thread, with streams that wait for the client.
#include "toolchain/tools/gateway/run.hpp"

#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include "kernel/base/utf8.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <streambuf>

namespace tappet::network {

namespace {

/// Returns the length of the text without the beginning of a character at its end.
std::size_t whole_characters(std::string_view text) {
    for (std::size_t back = 1; back <= std::min<std::size_t>(3, text.size()); ++back) {
        const auto byte = static_cast<unsigned char>(text[text.size() - back]);
        if ((byte & 0xC0) == 0x80) continue;
        const std::size_t length = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC0 ? 2 : 1;
        return length > back ? text.size() - back : text.size();
    }
    return text.size();
}

} // namespace

bool only_looks(std::string_view command) {
    static constexpr std::array looking{"list",      "get",    "watch",  "tree",  "info",  "manifest",
                                        "reactions", "forced", "events", "why",   "scope", "post-mortem",
                                        "report",    "help",   "",       "--help"};
    return std::ranges::find(looking, command) != looking.end();
}

/// Text of one of the two streams, sent when it is flushed or long.
class Run::Stream : public std::streambuf {
public:
    Stream(Run& run, std::string_view name) : run_{run}, name_{name} {}
    ~Stream() override { send(text_.size()); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

protected:
    int_type overflow(int_type character) override {
        if (character != traits_type::eof()) text_ += static_cast<char>(character);
        return text_.size() < longest || send(whole_characters(text_)) ? traits_type::not_eof(character)
                                                                       : traits_type::eof();
    }
    std::streamsize xsputn(const char* from, std::streamsize count) override {
        for (std::string_view rest{from, static_cast<std::size_t>(count)}; !rest.empty();) {
            const std::string_view part = rest.substr(0, longest);
            text_ += part;
            rest.remove_prefix(part.size());
            if (text_.size() >= longest && !send(whole_characters(text_))) return 0;
        }
        return count;
    }
    int sync() override { return send(whole_characters(text_)) ? 0 : -1; }

private:
    static constexpr std::size_t longest = 8 * 1024;

    bool send(std::size_t count) {
        if (count == 0) return true;
        const std::string part = text_.substr(0, count);
        text_.erase(0, count);
        return run_.put("\"" + std::string{name_} + "\": " + browser::in_quotes(as_utf8(part)));
    }

    Run& run_;
    std::string_view name_;
    std::string text_{};
};

Run::Run(const Message& message, LoggedIn who, std::string directory, std::string black_boxes,
         std::function<void()> wake)
    : id_{message.id},
      words_{message.words},
      user_{who.user, std::string{tappet::to_text(who.role)}, "network"},
      directory_{std::move(directory)},
      black_boxes_{std::move(black_boxes)},
      wake_{std::move(wake)} {
    for (const auto& [name, text] : message.files) files_.emplace(name, text);
    if (message.screen)
        screen_ = browser::Size{std::min(message.width, bounds.screen_most),
                                std::min(message.height, bounds.screen_most)};
}

void Run::run() {
    int code = 0;
    {
        Stream out_bytes{*this, "out"};
        Stream error_bytes{*this, "err"};
        std::ostream out{&out_bytes};
        std::ostream errors{&error_bytes};
        browser::FarFiles files{
            std::move(files_), [this](const std::string& name, std::string_view part, bool last) {
                return put("\"file\": " + browser::in_quotes(as_utf8(name)) + ", \"part\": \"" +
                           to_base64(part) + "\", \"last\": " + (last ? "true" : "false"));
            }};
        code = browser::run_remote_line(
            {words_, directory_, black_boxes_, user_, files, out, errors, stop_, screen_});
    }
    {
        const std::lock_guard lock{mutex_};
        code_ = code;
    }
    wake_();
}

bool Run::put(std::string fields) {
    {
        std::unique_lock lock{mutex_};
        room_.wait(lock, [this] { return bytes_ < bounds.run_bytes || is_left_; });
        if (is_left_) return false;
        bytes_ += fields.size();
        waiting_.push_back("{\"id\": " + std::to_string(id_) + ", " + std::move(fields) + "}");
    }
    wake_();
    return true;
}

void Run::leave() {
    stop();
    const std::lock_guard lock{mutex_};
    is_left_ = true;
    waiting_.clear();
    room_.notify_all();
}

std::optional<std::string> Run::next() {
    const std::lock_guard lock{mutex_};
    if (waiting_.empty()) return std::nullopt;
    std::string first = std::move(waiting_.front());
    waiting_.pop_front();
    if (waiting_.empty())
        bytes_ = 0;
    else
        bytes_ -= std::min(bytes_, first.size());
    room_.notify_all();
    return first;
}

std::optional<int> Run::exit_code() {
    const std::lock_guard lock{mutex_};
    return waiting_.empty() ? code_ : std::nullopt;
}

} // namespace tappet::network
