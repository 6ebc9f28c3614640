// What the box has said so far: its last lines of status and of timing, word by word, the stops between them,
// and everything else.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet::demo {

/// "speed" and "599rpm", in the order of their line.
using Words = std::vector<std::pair<std::string, std::string>>;

/// The words "name=value" of a line that begins with `kind` and ends with the word `last`. None: it is
/// another line, or is cut, or ran into another one.
[[nodiscard]] Words words_of(std::string_view line, std::string_view kind, std::string_view last);
[[nodiscard]] std::string_view text_of(const Words& words, std::string_view name);
/// The whole number in front of the unit; 0 where none is.
[[nodiscard]] std::int64_t number_of(std::string_view value);

class Story {
public:
    enum class Kind : std::uint8_t { status, timing, message };
    Kind take(std::string_view line);

    /// Of apps/carpet_loom/console.hpp.
    [[nodiscard]] const Words& status() const { return status_; }
    [[nodiscard]] std::int64_t number(std::string_view name) const {
        return number_of(text_of(status_, name));
    }
    /// The activity that came nearest to its deadline, and the misses of all: "io=90/300us misses=0".
    [[nodiscard]] const std::string& timing() const { return timing_; }
    /// As the machine itself sees them: which, and where; the plant's own measurement is in the summary.
    [[nodiscard]] const Words& stops() const { return stops_; }
    /// Lines that are none of ours: warnings, refusals with their cures, words of the plant. The last ones.
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }
    /// The loom's own time since the last pick or the beginning.
    [[nodiscard]] std::int64_t idle_ms() const { return number("t") - last_pick_ms_; }

private:
    void note_stop(const Words& now);

    static constexpr std::size_t most_messages = 200;

    Words status_, stops_;
    std::string timing_;
    std::vector<std::string> messages_;
    std::int64_t last_pick_ms_ = 0;
};

/// Cuts a stream of bytes into lines, however it comes in pieces.
class Lines {
public:
    /// Calls take(line) for each line that is complete now; carriage returns are dropped.
    template <class Take> void add(std::string_view bytes, Take&& take) {
        for (const char character : bytes) {
            if (character == '\n') {
                take(std::string_view{rest_});
                rest_.clear();
            } else if (character != '\r' && rest_.size() < longest) {
                rest_ += character;
            }
        }
    }

private:
    static constexpr std::size_t longest = 4096;
    std::string rest_;
};

} // namespace tappet::demo
