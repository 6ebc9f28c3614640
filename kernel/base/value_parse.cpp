// Reads values from text: two walks over the type's tag, the first to find faults, the second to store.
#include "kernel/base/nearest.hpp"
#include "kernel/base/quoted_text.hpp"
#include "kernel/base/real_text.hpp"
#include "kernel/base/value_bytes.hpp"
#include "kernel/base/value_text.hpp"

#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>

namespace tappet {

namespace {

class ValueReader {
public:
    enum class Pass : bool { check, store };

    ValueReader(std::string_view text, Pass pass) noexcept : text_{text}, pass_{pass} {}

    /// Reads the whole text as one value. Returns false with the reason in fault().
    bool read_all(const TypeTag& tag, std::byte* into) noexcept {
        skip_spaces();
        if (tag.kind == ValueKind::text && !next_is('"')) {
            std::string_view rest = text_.substr(at_);
            while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
            return store_text(tag, rest, into);
        }
        if (!read(tag, into)) return false;
        skip_spaces();
        if (at_ == text_.size()) return true;
        return refuse("\"", quotable(text_.substr(at_)), "\" is left over after the value; remove it");
    }
    [[nodiscard]] const Sentence& fault() const noexcept { return fault_; }

private:
    template <class... Pieces>
    bool refuse(const Pieces&... pieces) noexcept {
        fault_ = Sentence{pieces...};
        return false;
    }
    template <class... Pieces>
    bool refused_at(const Pieces&... where) noexcept {
        fault_ = Sentence{where..., ": ", fault_};
        return false;
    }

    static bool is_space(char character) noexcept {
        return character == ' ' || character == '\t' || character == '\n' || character == '\r';
    }
    static bool ends_word(char character) noexcept {
        return is_space(character) || character == ',' || character == ']' || character == '}' ||
               character == ')';
    }
    void skip_spaces() noexcept {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }
    [[nodiscard]] bool next_is(char character) const noexcept {
        return at_ < text_.size() && text_[at_] == character;
    }
    bool take(char character) noexcept {
        skip_spaces();
        if (!next_is(character)) return false;
        ++at_;
        return true;
    }
    /// Returns the next word, including quotes, without reading it.
    [[nodiscard]] std::string_view glance() noexcept {
        skip_spaces();
        std::size_t end = at_;
        while (end < text_.size() && !ends_word(text_[end])) ++end;
        return text_.substr(at_, end - at_);
    }
    /// Reads a word without quotes; "": there is none. `also_ends` ends it too.
    std::string_view word(char also_ends = ',') noexcept {
        skip_spaces();
        if (next_is('"')) return quoted_word();
        const std::size_t begin = at_;
        while (at_ < text_.size() && !ends_word(text_[at_]) && text_[at_] != also_ends) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    /// A word longer than its buffer is neither a number nor a name.
    std::string_view quoted_word() noexcept {
        QuotedText quoted{text_.substr(at_ + 1)};
        std::size_t used = 0;
        char piece[4];
        std::size_t bytes = 0;
        QuotedText::Next next = quoted.take(piece, bytes);
        for (; next == QuotedText::Next::characters; next = quoted.take(piece, bytes)) {
            if (used + bytes > sizeof word_) return {};
            std::memcpy(word_ + used, piece, bytes);
            used += bytes;
        }
        if (next == QuotedText::Next::broken) return {};
        at_ += 1 + quoted.taken();
        return {word_, used};
    }

    void store(std::byte* into, const void* from, std::size_t bytes) const noexcept {
        if (pass_ == Pass::store) std::memcpy(into, from, bytes);
    }
    void clear(std::byte* into, std::size_t bytes) const noexcept {
        if (pass_ == Pass::store) std::memset(into, 0, bytes);
    }

    bool read(const TypeTag& tag, std::byte* into) noexcept {
        switch (tag.kind) {
        case ValueKind::opaque:
            return refuse("a value of type ", tag.name, " has no spelling; name its fields with fields_of");
        case ValueKind::boolean: return read_boolean(into);
        case ValueKind::integer: return read_integer(tag, word(), into);
        case ValueKind::natural: return read_natural(tag, word(), into);
        case ValueKind::real:
            return tag.size == sizeof(float) ? read_real<float>(into) : read_real<double>(into);
        case ValueKind::duration: return read_duration(into);
        case ValueKind::text: return read_text(tag, into);
        case ValueKind::enumeration: return read_enumeration(tag, into);
        case ValueKind::matrix: return read_matrix(tag, into);
        case ValueKind::sequence: return read_sequence(tag, into);
        case ValueKind::record: return read_record(tag, into);
        case ValueKind::arguments: return read_arguments(tag, into);
        }
        return false;
    }

    bool read_boolean(std::byte* into) noexcept {
        const std::string_view found = glance(), spelled = word();
        if (spelled != "true" && spelled != "false")
            return refuse("\"", quotable(found), "\" is neither true nor false; write one of them");
        const bool value = spelled == "true";
        store(into, &value, sizeof value);
        return true;
    }
    bool read_integer(const TypeTag& tag, std::string_view spelled, std::byte* into) noexcept {
        const std::int64_t most = std::numeric_limits<std::int64_t>::max() >> (64 - 8 * tag.size);
        std::int64_t value = 0;
        const auto done = std::from_chars(spelled.data(), spelled.data() + spelled.size(), value);
        if (done.ptr != spelled.data() + spelled.size() || done.ec == std::errc::invalid_argument)
            return refuse("\"", quotable(spelled), "\" is not a whole number; write one such as -12");
        if (done.ec != std::errc{} || value > most || value < -most - 1)
            return refuse(quotable(spelled), " is out of range; write a number from ", -most - 1, " to ",
                          most);
        store(into, &value, tag.size); // the low bytes come first
        return true;
    }
    bool read_natural(const TypeTag& tag, std::string_view spelled, std::byte* into) noexcept {
        const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() >> (64 - 8 * tag.size);
        const std::string_view digits = spelled.starts_with('-') ? spelled.substr(1) : spelled;
        std::uint64_t value = 0;
        const auto done = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (done.ptr != digits.data() + digits.size() || done.ec == std::errc::invalid_argument)
            return refuse("\"", quotable(spelled), "\" is not a whole number; write one such as 12");
        if (done.ec != std::errc{} || value > most || digits.size() != spelled.size()) {
            char limit[24];
            const auto end = std::to_chars(limit, limit + sizeof limit, most).ptr;
            return refuse(quotable(spelled), " is out of range; write a number from 0 to ",
                          std::string_view{limit, static_cast<std::size_t>(end - limit)});
        }
        store(into, &value, tag.size);
        return true;
    }
    template <class Real>
    bool read_real(std::byte* into) noexcept {
        const std::string_view spelled = word();
        Real value = 0;
        const RealTextFault fault = read_real_text(spelled, value);
        if (fault == RealTextFault::not_a_number)
            return refuse("\"", quotable(spelled), "\" is not a number; write one such as 0.5 or 2e-3");
        if (fault != RealTextFault::none)
            return refuse(quotable(spelled), " is out of range; a number of ", sizeof value,
                          " bytes is too small for it");
        store(into, &value, sizeof value);
        return true;
    }

    bool read_duration(std::byte* into) noexcept {
        std::int64_t ns = 0;
        fault_ = parse_duration(word(), ns);
        if (!fault_.empty()) return false;
        store(into, &ns, sizeof ns);
        return true;
    }

    bool read_text(const TypeTag& tag, std::byte* into) noexcept {
        skip_spaces();
        if (!next_is('"')) {
            const std::string_view bare = word();
            if (bare.empty()) return refuse("a text is missing; write one such as \"weft\"");
            return store_text(tag, bare, into);
        }
        QuotedText quoted{text_.substr(at_ + 1)};
        clear(into, tag.size);
        std::size_t used = 0;
        char piece[4];
        std::size_t bytes = 0;
        QuotedText::Next next = quoted.take(piece, bytes);
        for (; next == QuotedText::Next::characters; next = quoted.take(piece, bytes)) {
            if (used + bytes <= tag.columns) store(into + used, piece, bytes);
            used += bytes;
        }
        if (next == QuotedText::Next::broken)
            return refuse("the text ", quotable(text_.substr(at_)),
                          " does not end well; close the quotes, and write \\\\ for a backslash");
        if (used > tag.columns) return text_too_long(tag, used);
        store(into + tag.length_at, &used, tag.length_bytes);
        at_ += 1 + quoted.taken();
        return true;
    }
    bool store_text(const TypeTag& tag, std::string_view text, std::byte* into) noexcept {
        if (text.size() > tag.columns) return text_too_long(tag, text.size());
        const std::size_t used = text.size();
        clear(into, tag.size);
        store(into, text.data(), used);
        store(into + tag.length_at, &used, tag.length_bytes);
        return true;
    }
    bool text_too_long(const TypeTag& tag, std::size_t used) noexcept {
        return refuse("the text has ", used, " characters, but there is room for ", tag.columns,
                      "; shorten it");
    }

    bool read_enumeration(const TypeTag& tag, std::byte* into) noexcept {
        const std::string_view spelled = word();
        for (std::size_t i = 0; i < tag.names.size(); ++i)
            if (tag.names[i] == spelled) {
                store(into, &i, tag.size);
                return true;
            }
        const bool number = !spelled.empty() &&
                            (spelled.front() == '-' || (spelled.front() >= '0' && spelled.front() <= '9'));
        if (number) // a value without a name is written as a number
            return tag.element->kind == ValueKind::integer ? read_integer(tag, spelled, into)
                                                           : read_natural(tag, spelled, into);
        Nearest nearest{spelled};
        for (const std::string_view name : tag.names) nearest.consider(name);
        if (!nearest.best().empty())
            return refuse("\"", quotable(spelled), "\" is not a ", tag.name, "; did you mean \"",
                          nearest.best(), "\"?");
        refuse("\"", quotable(spelled), "\" is not a ", tag.name, "; write one of");
        for (const std::string_view name : tag.names)
            fault_.add(name == tag.names.front() ? " " : ", ").add(name);
        return false;
    }

    bool read_matrix(const TypeTag& tag, std::byte* into) noexcept {
        if (is_vector(tag)) {
            std::size_t count = 0;
            return read_list(tag, into, tag.rows * tag.columns, 1, count) &&
                   has_all(count, tag.rows * tag.columns, "elements");
        }
        if (!take('[')) return no_list();
        std::size_t row = 0;
        for (bool more = !take(']'); more; ++row) {
            if (row == tag.rows) return refuse("has more than ", tag.rows, " rows; remove what is too much");
            std::byte* first = into + tag.element->size * (tag.row_major ? row * tag.columns : row);
            std::size_t count = 0;
            if (!read_list(tag, first, tag.columns, tag.row_major ? 1 : tag.rows, count) ||
                !has_all(count, tag.columns, "elements"))
                return refused_at("row ", row + 1);
            if (!goes_on(']', more)) return false;
        }
        return has_all(row, tag.rows, "rows");
    }
    bool has_all(std::size_t count, std::size_t wanted, std::string_view what) noexcept {
        return count == wanted ||
               refuse("has ", count, " ", what, " instead of ", wanted, "; write all of them");
    }
    bool no_list() noexcept {
        return refuse("\"", quotable(glance()), "\" is not a list; write one in brackets, such as [1, 2]");
    }
    bool read_sequence(const TypeTag& tag, std::byte* into) noexcept {
        clear(into, tag.size);
        std::size_t count = 0;
        if (!read_list(tag, into, tag.columns, 1, count)) return false;
        store(into + tag.length_at, &count, tag.length_bytes);
        return true;
    }
    bool read_list(const TypeTag& tag, std::byte* first, std::size_t most, std::size_t stride,
                   std::size_t& count) noexcept {
        if (!take('[')) return no_list();
        for (bool more = !take(']'); more; ++count) {
            if (count == most) return refuse("has more than ", most, " elements; remove what is too much");
            if (!read(*tag.element, first + count * stride * tag.element->size))
                return refused_at("element ", count + 1);
            if (!goes_on(']', more)) return false;
        }
        return true;
    }
    /// Reads what follows an element: the list's end, or another element, with or without a comma before it.
    bool goes_on(char closing, bool& more) noexcept {
        more = !take(closing);
        if (!more) return true;
        static_cast<void>(take(','));
        skip_spaces();
        if (at_ == text_.size() || next_is(closing))
            return refuse("the list breaks off; write another element, or \"", std::string_view{&closing, 1},
                          "\" without a comma before it");
        return true;
    }

    bool read_record(const TypeTag& tag, std::byte* into) noexcept {
        if (!take('{'))
            return refuse("\"", quotable(glance()), "\" is not a ", tag.name, "; write {", tag.fields[0].name,
                          ": ...}");
        std::uint64_t seen = 0;
        for (bool more = !take('}'); more;) {
            const std::string_view name = word(':');
            std::size_t i = 0;
            while (i < tag.fields.size() && tag.fields[i].name != name) ++i;
            if (i == tag.fields.size()) return unknown_field(tag, name);
            if ((seen >> i & 1) != 0)
                return refuse("field \"", tag.fields[i].name, "\" is given twice; remove one");
            seen |= std::uint64_t{1} << i;
            if (!take(':'))
                return refuse("after \"", tag.fields[i].name, "\" a colon is missing; write ",
                              tag.fields[i].name, ": ...");
            if (!read(*tag.fields[i].type, into + tag.fields[i].offset()))
                return refused_at("field \"", tag.fields[i].name, "\"");
            if (!goes_on('}', more)) return false;
        }
        for (std::size_t i = 0; i < tag.fields.size(); ++i)
            if ((seen >> i & 1) == 0)
                return refuse("field \"", tag.fields[i].name, "\" is missing; a ", tag.name,
                              " is written with all of its fields");
        return true;
    }
    bool unknown_field(const TypeTag& tag, std::string_view name) noexcept {
        Nearest nearest{name};
        for (const RecordField& each : tag.fields) nearest.consider(each.name);
        refuse("a ", tag.name, " has no field \"", quotable(name), "\"");
        if (!nearest.best().empty())
            fault_.add("; did you mean \"").add(nearest.best()).add("\"?");
        else
            fault_.add("; its first is \"").add(tag.fields[0].name).add("\"");
        return false;
    }

    bool read_arguments(const TypeTag& tag, std::byte* into) noexcept {
        const bool open = take('(');
        for (std::size_t i = 0; i < tag.elements.size(); ++i) {
            if (i != 0) static_cast<void>(take(','));
            skip_spaces();
            if (at_ == text_.size() || next_is(')'))
                return refuse("argument ", i + 1, " is missing; write ", tag.elements.size(), ": ", tag.name);
            if (!read(*tag.elements[i], into)) return refused_at("argument ", i + 1);
            into += tag.elements[i]->size;
        }
        if (open && !take(')'))
            return refuse("there are more than ", tag.elements.size(), " arguments; write (", tag.name, ")");
        return true;
    }

    std::string_view text_;
    Pass pass_;
    std::size_t at_ = 0;
    char word_[64] = {};
    Sentence fault_{};
};

} // namespace

Sentence parse_value(const TypeTag& tag, std::string_view text, std::byte* into) noexcept {
    ValueReader check{text, ValueReader::Pass::check};
    if (!check.read_all(tag, into)) return check.fault();
    ValueReader reader{text, ValueReader::Pass::store};
    static_cast<void>(reader.read_all(tag, into));
    return {};
}

} // namespace tappet
