// Writes values as text: a walk over the type's tag.
#include "kernel/base/value_text.hpp"

#include "kernel/base/real_text.hpp"
#include "kernel/base/utf8.hpp"
#include "kernel/base/value_bytes.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace tappet {

namespace {

enum class Spelling : bool { plain, json };

class ValueWriter {
public:
    ValueWriter(Spelling spelling, std::span<char> into) noexcept
        : spelling_{spelling}, at_{into.data()}, begin_{at_}, end_{at_ + into.size()} {}

    void write(const TypeTag& tag, const std::byte* value) noexcept {
        switch (tag.kind) {
        case ValueKind::opaque: return put_opaque(tag);
        case ValueKind::boolean: return put(load<std::uint8_t>(value) != 0 ? "true" : "false");
        case ValueKind::integer: return put_number(load_integer(value, tag.size));
        case ValueKind::natural: return put_number(load_natural(value, tag.size));
        case ValueKind::real:
            return tag.size == sizeof(float) ? put_real(load<float>(value)) : put_real(load<double>(value));
        case ValueKind::duration: return put_duration(load<std::int64_t>(value));
        case ValueKind::text: return put_text({reinterpret_cast<const char*>(value), length_of(tag, value)});
        case ValueKind::enumeration: return put_enumeration(tag, value);
        case ValueKind::matrix: return put_matrix(tag, value);
        case ValueKind::sequence: return put_sequence(tag, value);
        case ValueKind::record: return put_record(tag, value);
        case ValueKind::arguments: return put_arguments(tag, value);
        }
    }

    [[nodiscard]] std::size_t size() const noexcept {
        return fits_ ? static_cast<std::size_t>(at_ - begin_) : 0;
    }

private:
    [[nodiscard]] bool json() const noexcept { return spelling_ == Spelling::json; }

    void put(std::string_view text) noexcept {
        if (static_cast<std::size_t>(end_ - at_) < text.size()) {
            fits_ = false;
            end_ = at_; // nothing shorter may follow an omitted part
            return;
        }
        std::memcpy(at_, text.data(), text.size());
        at_ += text.size();
    }
    void quoted_in_json(std::string_view word) noexcept {
        if (json()) put("\"");
        put(word);
        if (json()) put("\"");
    }
    template <class Number>
    void put_number(Number number) noexcept {
        char digits[40];
        const auto done = std::to_chars(digits, digits + sizeof digits, number);
        put({digits, static_cast<std::size_t>(done.ptr - digits)});
    }
    template <class Real>
    void put_real(Real real) noexcept {
        char digits[max_real_text];
        if (std::isfinite(real))
            put({digits, write_shortest(digits, real)});
        else
            quoted_in_json(std::isnan(real) ? "nan" : real > 0 ? "inf" : "-inf");
    }
    void put_duration(std::int64_t ns) noexcept {
        const TimeUnit* unit = &time_units[0];
        for (const TimeUnit& each : time_units)
            if (each.ns <= largest_written_unit && ns % each.ns == 0) unit = &each;
        if (json()) put("\"");
        put_number(ns / unit->ns);
        put(unit->name);
        if (json()) put("\"");
    }
    void put_opaque(const TypeTag& tag) noexcept {
        if (json()) put("\"");
        put("<");
        put_number(tag.size);
        put(tag.size == 1 ? " byte>" : " bytes>");
        if (json()) put("\"");
    }
    void put_enumeration(const TypeTag& tag, const std::byte* value) noexcept {
        const bool is_signed = tag.element->kind == ValueKind::integer;
        const std::uint64_t index = load_natural(value, tag.size);
        if (index < tag.names.size()) return quoted_in_json(tag.names[index]);
        if (is_signed) return put_number(load_integer(value, tag.size));
        put_number(index);
    }
    void put_text(std::string_view text) noexcept {
        put("\"");
        while (!text.empty()) {
            const std::size_t whole = utf8_length(text);
            const auto code = static_cast<unsigned char>(text.front());
            if (whole > 1)
                put(text.substr(0, whole));
            else if (whole == 0 && json())
                put("\xEF\xBF\xBD"); // U+FFFD
            else
                put_character(code);
            text.remove_prefix(whole == 0 ? 1 : whole);
        }
        put("\"");
    }
    void put_character(unsigned char code) noexcept {
        constexpr char hex[] = "0123456789abcdef";
        const char escape[] = {'\\', static_cast<char>(code == '\n'   ? 'n'
                                                       : code == '\t' ? 't'
                                                       : code == '\r' ? 'r'
                                                                      : code)};
        const char character = static_cast<char>(code);
        if (code == '"' || code == '\\' || code == '\n' || code == '\t' || code == '\r')
            return put({escape, 2});
        if (code >= ' ' && code < 0x7f) return put({&character, 1});
        put(json() ? "\\u00" : "\\x");
        const char digits[] = {hex[code >> 4], hex[code & 15]};
        put({digits, 2});
    }
    void put_matrix(const TypeTag& tag, const std::byte* value) noexcept {
        if (is_vector(tag)) return put_list(tag, value, tag.rows * tag.columns, 1);
        put("[");
        for (std::size_t row = 0; row < tag.rows; ++row) {
            if (row != 0) put(", ");
            put_list(tag, value + tag.element->size * (tag.row_major ? row * tag.columns : row), tag.columns,
                     tag.row_major ? 1 : tag.rows);
        }
        put("]");
    }
    void put_sequence(const TypeTag& tag, const std::byte* value) noexcept {
        put_list(tag, value, length_of(tag, value), 1);
    }
    void put_list(const TypeTag& tag, const std::byte* first, std::size_t count,
                  std::size_t stride) noexcept {
        put("[");
        for (std::size_t i = 0; i < count; ++i) {
            if (i != 0) put(", ");
            write(*tag.element, first + i * stride * tag.element->size);
        }
        put("]");
    }
    void put_record(const TypeTag& tag, const std::byte* value) noexcept {
        put("{");
        for (std::size_t i = 0; i < tag.fields.size(); ++i) {
            if (i != 0) put(", ");
            quoted_in_json(tag.fields[i].name);
            put(": ");
            write(*tag.fields[i].type, value + tag.fields[i].offset());
        }
        put("}");
    }
    void put_arguments(const TypeTag& tag, const std::byte* value) noexcept {
        put(json() ? "[" : "(");
        for (std::size_t i = 0; i < tag.elements.size(); ++i) {
            if (i != 0) put(", ");
            write(*tag.elements[i], value);
            value += tag.elements[i]->size;
        }
        put(json() ? "]" : ")");
    }

    Spelling spelling_;
    char* at_;
    char* begin_;
    char* end_;
    bool fits_ = true;
};

std::size_t format(Spelling spelling, const TypeTag& tag, const std::byte* value,
                   std::span<char> into) noexcept {
    ValueWriter writer{spelling, into};
    writer.write(tag, value);
    return writer.size();
}

} // namespace

std::size_t format_value(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept {
    return format(Spelling::plain, tag, value, into);
}

std::size_t format_json(const TypeTag& tag, const std::byte* value, std::span<char> into) noexcept {
    return format(Spelling::json, tag, value, into);
}

} // namespace tappet
