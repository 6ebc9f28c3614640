// The output of the box so far: its last lines of status and of timing, word by word, the stops between them,
// and everything else.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet::demo {

/// Pairs such as "speed" and "599rpm", in the order of their line.
using Words = std::vector<std::pair<std::string, std::string>>;

/// Returns the words "name=value" of a line that begins with `kind` and ends with the word `last`. Empty when
/// it is another line, is cut off, or is mixed with another one.
[[nodiscard]] Words words_of(std::string_view line, std::string_view kind, std::string_view last);
[[nodiscard]] std::string_view text_of(const Words& words, std::string_view name);
/// Returns the whole number in front of the unit; 0 when there is none.
[[nodiscard]] std::int64_t number_of(std::string_view value);

class Story {
public:
    enum class Kind : std::uint8_t { status, timing, message };
    Kind take(std::string_view line);

    /// Returns the last status line, as apps/carpet_loom/console.hpp writes it.
    [[nodiscard]] const Words& status() const { return status_; }
    [[nodiscard]] std::int64_t number(std::string_view name) const {
        return number_of(text_of(status_, name));
    }
    /// Returns the activity that came nearest to its deadline, and the misses of all: "io=90/300us misses=0".
    [[nodiscard]] const std::string& timing() const { return timing_; }
    /// The stops as the machine sees them: cause and angle; the summary has the plant's own measurement.
    [[nodiscard]] const Words& stops() const { return stops_; }
    /// Returns the last foreign lines: warnings, refusals with their cures, lines of the plant.
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }
    /// Returns the loom's own time since the last pick or the start, ms.
    [[nodiscard]] std::int64_t idle_ms() const { return number("t") - last_pick_ms_; }

private:
    void note_stop(const Words& now);

    static constexpr std::size_t most_messages = 200;

    Words status_, stops_;
    std::string timing_;
    std::vector<std::string> messages_;
    std::int64_t last_pick_ms_ = 0;
};

/// Splits a stream of bytes into lines, whatever the chunks.
class Lines {
public:
    /// Calls take(line) for each line that is complete now; drops carriage returns.
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
