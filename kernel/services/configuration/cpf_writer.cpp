// Writes CPF into existing memory: after arming there is no heap for a document.
#include "kernel/services/configuration/cpf.hpp"

#include "kernel/base/value_text.hpp"
#include "kernel/services/configuration/cpf_types.hpp"

#include <algorithm>
#include <array>

namespace tappet {

namespace {

class Writer {
public:
    Writer(const PropertyTransaction& from, std::span<char> into) noexcept : from_{from}, into_{into} {}

    std::size_t write(Sentence& fault) noexcept {
        put("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE properties SYSTEM "
            "\"cpf.dtd\">\n<properties>\n");
        const auto facets = from_.type().facets;
        write_members(0, facets.size(), 1);
        put("</properties>\n");
        if (fault_.empty() && overflow_)
            fault_ = Sentence{"component \"", from_.name(), "\": its properties take more than ",
                              into_.size(), " bytes of file; shorten their descriptions"};
        fault = fault_;
        return fault_.empty() ? length_ : 0;
    }

private:
    // A bag in a bag is a nested call: the depth of the component's interface, which its names bound.
    void write_members(std::size_t begin, std::size_t end, std::size_t depth) noexcept {
        const auto facets = from_.type().facets;
        for (std::size_t f = begin; f < end; ++f) {
            const Facet& facet = facets[f];
            if (facet.kind == FacetKind::property) {
                write_property(f, depth);
            } else if (facet.kind == FacetKind::bag) {
                indent(depth);
                put("<struct name=\"");
                escape(own_name(facet));
                put("\" type=\"PropertyBag\">\n");
                indent(depth + 1);
                describe(facet);
                put("\n");
                write_members(f + 1, f + 1 + facet.members, depth + 1);
                indent(depth);
                put("</struct>\n");
                f += facet.members;
            }
        }
    }

    void write_property(std::size_t f, std::size_t depth) noexcept {
        const Facet& facet = from_.type().facets[f];
        const auto values = from_.values();
        const auto found = std::ranges::find(values, f, &ProposedValue::facet);
        if (found == values.end()) return;
        const PropertyOperations& operations = *facet.property;
        indent(depth);
        put(operations.is_list ? "<sequence name=\"" : "<simple name=\"");
        escape(own_name(facet));
        put("\" type=\"");
        put(cpf::type_name(*operations.element));
        put("\">");
        describe(facet);
        if (!operations.is_list) {
            write_value(facet, *facet.type, found->value);
            put("</simple>\n");
            return;
        }
        put("\n");
        for (std::size_t i = 0; i < operations.size(found->value); ++i) {
            indent(depth + 1);
            put("<simple type=\"");
            put(cpf::type_name(*operations.element));
            put("\">");
            // The element is only read.
            write_value(facet, *operations.element, operations.at(const_cast<std::byte*>(found->value), i));
            put("</simple>\n");
        }
        indent(depth);
        put("</sequence>\n");
    }

    void write_value(const Facet& facet, const TypeTag& type, const std::byte* value) noexcept {
        put("<value>");
        if (type.kind == ValueKind::text) {
            std::uint32_t length = 0;
            std::memcpy(&length, value + type.length_at, sizeof length);
            const std::string_view text{reinterpret_cast<const char*>(value),
                                        std::min<std::size_t>(length, type.columns)};
            if (text.find('\0') != text.npos && fault_.empty())
                fault_ = Sentence{"component \"", from_.name(), "\": property \"", facet.name,
                                  "\" holds a zero character, which no file keeps; set another text"};
            escape(text);
        } else {
            std::array<char, 64> text{};
            const std::size_t length = format_value(type, value, text);
            if (length == 0 && fault_.empty())
                fault_ = Sentence{"component \"", from_.name(), "\": property \"", facet.name,
                                  "\" has no text; give its enumeration a name for every value"};
            escape({text.data(), length});
        }
        put("</value>");
    }

    void describe(const Facet& facet) noexcept {
        put("<description>");
        escape(facet.doc);
        if (!facet.unit.empty()) {
            put(" [");
            escape(facet.unit);
            put("]");
        }
        put("</description>");
    }

    static std::string_view own_name(const Facet& facet) noexcept {
        return facet.name.substr(facet.name.rfind('.') + 1);
    }
    void indent(std::size_t depth) noexcept {
        for (std::size_t i = 0; i < depth; ++i) put("  ");
    }
    void escape(std::string_view text) noexcept {
        for (const char character : text) {
            switch (character) {
            case '&': put("&amp;"); break;
            case '<': put("&lt;"); break;
            case '>': put("&gt;"); break;
            case '"': put("&quot;"); break;
            default:
                if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f)
                    put(Sentence{"&#", static_cast<int>(character), ";"}.view());
                else
                    put({&character, 1});
            }
        }
    }
    void put(std::string_view text) noexcept {
        if (text.size() > into_.size() - length_) {
            overflow_ = true;
            return;
        }
        std::copy(text.begin(), text.end(), into_.begin() + static_cast<std::ptrdiff_t>(length_));
        length_ += text.size();
    }

    const PropertyTransaction& from_;
    std::span<char> into_;
    std::size_t length_ = 0;
    bool overflow_ = false;
    Sentence fault_{};
};

} // namespace

std::size_t write_cpf(const PropertyTransaction& from, std::span<char> into, Sentence& fault) noexcept {
    return Writer{from, into}.write(fault);
}

} // namespace tappet
