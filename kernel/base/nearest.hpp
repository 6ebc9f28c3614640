// Did you mean ...? The name nearest to a misspelt one, found in a constant expression so that a diagnostic
// can suggest it.
#pragma once

#include "kernel/base/text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace tappet {

/// Longer names are not compared: they are not typing errors.
inline constexpr std::size_t nearest_max_length = 64;

enum class LetterCase { matters, ignored };

constexpr char lower_case(char character) noexcept {
    return character >= 'A' && character <= 'Z' ? static_cast<char>(character - 'A' + 'a') : character;
}

/// Returns the least number of characters inserted, omitted, changed, or swapped with their neighbour that
/// turns one text into the other (Damerau 1964, with no character edited twice). If it is more than `limit`,
/// limit + 1 is returned early.
constexpr std::size_t edit_distance(std::string_view from, std::string_view to,
                                    std::size_t limit = nearest_max_length,
                                    LetterCase letter_case = LetterCase::matters) noexcept {
    const std::size_t gap = from.size() > to.size() ? from.size() - to.size() : to.size() - from.size();
    if (gap > limit || from.size() > nearest_max_length || to.size() > nearest_max_length) return limit + 1;

    const auto same = [letter_case](char a, char b) {
        return letter_case == LetterCase::matters ? a == b : lower_case(a) == lower_case(b);
    };
    using Row = std::array<std::size_t, nearest_max_length + 1>;
    Row rows[3] = {};
    Row* before_last = &rows[0];
    Row* last = &rows[1];
    Row* row = &rows[2];
    for (std::size_t j = 0; j <= to.size(); ++j) (*last)[j] = j;
    for (std::size_t i = 1; i <= from.size(); ++i) {
        (*row)[0] = i;
        std::size_t least = i;
        for (std::size_t j = 1; j <= to.size(); ++j) {
            const bool equal = same(from[i - 1], to[j - 1]);
            std::size_t best =
                std::min({(*last)[j] + 1, (*row)[j - 1] + 1, (*last)[j - 1] + (equal ? 0u : 1u)});
            if (i > 1 && j > 1 && same(from[i - 1], to[j - 2]) && same(from[i - 2], to[j - 1])) {
                best = std::min(best, (*before_last)[j - 2] + 1);
            }
            (*row)[j] = best;
            least = std::min(least, best);
        }
        if (least > limit)
            return limit + 1; // the rows' least values never decrease: a swap costs what it skips
        Row* const oldest = before_last;
        before_last = last;
        last = row;
        row = oldest;
    }
    return std::min((*last)[to.size()], limit + 1);
}

/// Keeps the nearest of the candidates given to consider() that is near enough to be meant: at most two
/// edits, or a third of the written name. Between two equally near ones the one nearer in lower case wins,
/// then the first. The same name in other case always counts as near, and so does one that continues after a
/// dot. The candidates' characters must outlive it.
class Nearest {
public:
    explicit constexpr Nearest(std::string_view written) noexcept
        : written_{written}, distance_{std::max<std::size_t>(2, written.size() / 3) + 1} {}

    constexpr void consider(std::string_view candidate) noexcept {
        if (candidate.size() > written_.size() && candidate.starts_with(written_) &&
            candidate[written_.size()] == '.') {
            if (distance_ > 1) best_ = candidate, distance_ = folded_ = 1;
            return;
        }
        const std::size_t folded = edit_distance(written_, candidate, distance_, LetterCase::ignored);
        if (folded > distance_) return; // comparing case never brings texts nearer
        std::size_t distance = edit_distance(written_, candidate, distance_);
        if (folded == 0) distance = std::min<std::size_t>(distance, 1);
        // Texts without a character in common are no suggestion, however short.
        if (folded >= std::max(written_.size(), candidate.size()) && folded != 0) return;
        if (distance > distance_ || (distance == distance_ && folded >= folded_)) return;
        best_ = candidate;
        distance_ = distance;
        folded_ = folded;
    }
    /// Returns the nearest name; empty when none was near enough.
    [[nodiscard]] constexpr std::string_view best() const noexcept { return best_; }

private:
    std::string_view written_;
    std::string_view best_{};
    std::size_t distance_; // of the best name; at first one more than the limit for a suggestion
    std::size_t folded_ =
        0; // its distance in lower case; 0 at first, so that a distance over the limit loses
};

namespace detail {

constexpr void add_suggestion(Sentence& text, const Nearest& nearest, std::string_view otherwise) {
    if (nearest.best().empty())
        text.add("; ").add(otherwise);
    else
        text.add("; did you mean \"").add(nearest.best()).add("\"?");
}

} // namespace detail

} // namespace tappet
